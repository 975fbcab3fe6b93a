#include <varifold/models/pm/geomorph.h>

#include <gtest/gtest.h>
#include <tests/models/pm/pm_support.h>

#include <cmath>

namespace varifold::test {
namespace {

// Triangles as three positions each, without those that have two equal ones; turned and sorted.
std::vector<std::array<float, 9>> shapes(const TriangleMesh& mesh) {
  std::vector<std::array<float, 9>> result;
  for (std::size_t t = 0; t < mesh.indices.size(); t += 3) {
    std::array<std::array<float, 3>, 3> corners;
    for (std::size_t c = 0; c < 3; ++c) {
      const Vec3& p = mesh.positions[mesh.indices[t + c]];
      corners[c] = {p.x, p.y, p.z};
    }
    if (corners[0] == corners[1] || corners[1] == corners[2] || corners[0] == corners[2]) continue;
    std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()), corners.end());
    std::array<float, 9> shape;
    for (std::size_t i = 0; i < 9; ++i) shape[i] = corners[i / 3][i % 3];
    result.push_back(shape);
  }
  std::sort(result.begin(), result.end());
  return result;
}

bool all_finite(const TriangleMesh& mesh) {
  for (const Vec3& p : mesh.positions)
    if (!(std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z))) return false;
  for (const Vec3& n : mesh.normals)
    if (!(std::isfinite(n.x) && std::isfinite(n.y) && std::isfinite(n.z))) return false;
  for (const Vec2& t : mesh.texcoords)
    if (!(std::isfinite(t.x) && std::isfinite(t.y))) return false;
  return true;
}

TEST(Geomorph, EndsAreTheLevels) {
  for (const NamedModel& named : all_models()) {
    const std::uint32_t finest = named.model->finest_level();
    for (const GeomorphOptions options : {GeomorphOptions{}, GeomorphOptions{true, 0.3f}}) {
      for (const auto& [a, b] : {std::pair(finest, 0u), std::pair(finest / 3, finest * 2 / 3),
                                 std::pair(finest / 2, finest / 2)}) {
        Geomorph geomorph(*named.model, a, b, options);
        EXPECT_EQ(geomorph.fine_level(), std::max(a, b));
        EXPECT_EQ(geomorph.coarse_level(), std::min(a, b));
        const TriangleMesh fine = level_mesh(named, std::max(a, b));
        EXPECT_TRUE(same_attributes(geomorph.mesh(), fine)) << named.name;
        geomorph.blend(0);
        EXPECT_EQ(shapes(geomorph.mesh()), shapes(level_mesh(named, std::min(a, b)))) << named.name;
        geomorph.blend(0.4f);
        geomorph.blend(1);
        EXPECT_TRUE(same_attributes(geomorph.mesh(), fine)) << named.name;
        EXPECT_EQ(geomorph.mesh().indices, fine.indices);
        EXPECT_EQ(geomorph.mesh().ranges, fine.ranges);
      }
    }
  }
}

TEST(Geomorph, StaysFiniteAndNormal) {
  for (const NamedModel& named : all_models()) {
    for (const GeomorphOptions options : {GeomorphOptions{}, GeomorphOptions{true, 0.5f}}) {
      Geomorph geomorph(*named.model, named.model->finest_level(), 0, options);
      for (const float t : {-1.0f, 0.0f, 1e-30f, 0.3f, 0.5f, 0.999f, 1.0f, 7.0f, NAN}) {
        geomorph.blend(t);
        ASSERT_TRUE(all_finite(geomorph.mesh())) << named.name << " at " << t;
        for (const Vec3& normal : geomorph.mesh().normals)
          ASSERT_NEAR(glm::length(normal), 1, 1e-3) << named.name << " at " << t;
      }
    }
  }
}

TEST(Geomorph, VerticesMoveInStraightLines) {
  const NamedModel named = make_model({"icosphere", icosphere(500)}, Placement::kKept);
  const ProgressiveMesh& model = *named.model;
  const std::uint32_t coarse = model.finest_level() / 2;
  Geomorph geomorph(model, model.finest_level(), coarse);
  EXPECT_EQ(geomorph.moving_vertices(),
            model.vertex_count(model.finest_level()) - model.vertex_count(coarse));
  geomorph.blend(0.25f);
  const std::vector<Vec3>& positions = model.data().mesh.positions;
  for (std::uint32_t v = 0; v < positions.size(); ++v) {
    const Vec3 expected = 0.75f * positions[model.ancestor(v, coarse)] + 0.25f * positions[v];
    EXPECT_LT(glm::distance(geomorph.mesh().positions[v], expected), 1e-6f);
  }
}

TEST(Geomorph, VerticesSetOffInOrder) {
  const NamedModel named = make_model({"grid", grid(8, 8)}, Placement::kKept);
  const ProgressiveMesh& model = *named.model;
  Geomorph geomorph(model, 0, model.finest_level(), {false, 0.1f});
  geomorph.blend(0.5f);
  const std::vector<Vec3>& positions = model.data().mesh.positions;
  const std::uint32_t base = model.vertex_count(0);
  EXPECT_EQ(geomorph.mesh().positions[base], positions[base]);
  const auto last = static_cast<std::uint32_t>(positions.size() - 1);
  EXPECT_EQ(geomorph.mesh().positions[last], positions[model.ancestor(last, 0)]);
}

TEST(Geomorph, DrawListNamesWhatMoved) {
  const NamedModel named = make_model({"icosphere", icosphere(500)}, Placement::kKept);
  const std::uint32_t finest = named.model->finest_level();
  Geomorph geomorph(*named.model, finest, finest / 2);
  DrawList list = geomorph.draw_list();
  EXPECT_EQ(list.changed_indices.size(), 1u);
  EXPECT_EQ(submitted_triangles(list), named.model->triangle_count());
  EXPECT_TRUE(geomorph.draw_list().changed_vertices.empty());
  geomorph.blend(0.5f);
  list = geomorph.draw_list();
  EXPECT_TRUE(list.changed_indices.empty());
  ASSERT_EQ(list.changed_vertices.size(), 1u);
  EXPECT_EQ(list.changed_vertices[0].first, named.model->vertex_count(finest / 2));
  EXPECT_EQ(list.changed_vertices[0].count, geomorph.moving_vertices());
}

}  // namespace
}  // namespace varifold::test
