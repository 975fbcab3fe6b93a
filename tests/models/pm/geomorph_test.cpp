#include <varifold/models/pm/geomorph.h>

#include <gtest/gtest.h>
#include <tests/models/pm/pm_support.h>
#include <tests/support/poses.h>
#include <tests/support/rigged_meshes.h>
#include <varifold/mesh/pose_blend.h>

#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

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

// In every pose and under every joint the ends are those of the levels there, and no step on the
// way is much longer than its part.
TEST(Geomorph, PosesAndJointsMoveAlong) {
  TriangleMesh mesh = with_poses(with_random_rig(icosphere(500), 3, {.poses = 0}), 2, 5, 0.1f);
  for (std::uint32_t v = 0; v < mesh.vertex_count(); ++v)  // two joints, so that none is cut
    mesh.skin[v] = {{0, 1, 0, 0}, {0.1f + 0.01f * (v % 80), 0.9f - 0.01f * (v % 80), 0, 0}};
  const NamedModel named = make_model({"rigged", mesh}, Placement::kKept);
  const ProgressiveMesh& model = *named.model;
  const std::uint32_t coarse = model.finest_level() / 2;
  const std::vector<glm::mat4> joints{glm::mat4(1),
                                      glm::rotate(glm::mat4(1), 1.5f, Vec3(0.6f, 0.8f, 0))};
  const std::vector<float> weights{0.3f, 0.6f};
  const auto places = [&](const TriangleMesh& shown) {
    PosedVertices vertices = blend_poses(shown, weights);
    skin_vertices(shown.skin, joints, vertices);
    return vertices.positions;
  };
  const std::vector<Vec3> full = places(model.attributes());
  Geomorph geomorph(model, model.finest_level(), coarse);
  geomorph.blend(0);
  std::vector<Vec3> before = places(geomorph.mesh());
  for (std::uint32_t v = 0; v < full.size(); ++v)
    ASSERT_LE(glm::distance(before[v], full[model.ancestor(v, coarse)]), 1e-6f);
  constexpr int kSteps = 16;
  for (int i = 1; i <= kSteps; ++i) {
    geomorph.blend(static_cast<float>(i) / kSteps);
    const std::vector<Vec3> now = places(geomorph.mesh());
    for (std::uint32_t v = 0; v < full.size(); ++v) {
      const std::uint32_t from = model.ancestor(v, coarse);
      // Where weights and places move at once the way is a curve.
      const float turn =
          glm::distance(model.attributes().positions[v], model.attributes().positions[from]);
      ASSERT_LE(glm::distance(now[v], before[v]),
                (glm::distance(full[v], full[from]) + 2 * turn) / kSteps + 1e-6f);
    }
    before = now;
  }
  for (std::uint32_t v = 0; v < full.size(); ++v) ASSERT_EQ(before[v], full[v]);
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
