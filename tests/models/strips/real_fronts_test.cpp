// Fronts of real meshes by the criteria: hundreds of them, none with a crack or a fold.
#include <gtest/gtest.h>
#include <tests/models/strips/strips_support.h>
#include <tests/support/test_files.h>

#include <varifold/base/random.h>
#include <varifold/io/mesh_file.h>
#include <varifold/mesh/topology.h>
#include <varifold/mesh/validation.h>
#include <varifold/view/camera.h>
#include <algorithm>

namespace varifold::test {
namespace {

Vec3 direction(Random& random) {
  for (;;) {
    const Vec3 d(static_cast<float>(2 * random.uniform() - 1),
                 static_cast<float>(2 * random.uniform() - 1),
                 static_cast<float>(2 * random.uniform() - 1));
    if (glm::length(d) > 0.1f && glm::length(d) <= 1) return glm::normalize(d);
  }
}

Camera camera_near(const Box& box, Random& random) {
  Camera camera;
  camera.target = box.center() + 0.2f * box.diagonal() * direction(random);
  camera.eye = box.center() +
               box.diagonal() * static_cast<float>(0.3 + 2 * random.uniform()) * direction(random);
  camera.up = direction(random);
  set_depth_range(camera, sphere_around(box));
  return camera;
}

// In turn a sphere, a plane, and views with all that they have, with and without a budget.
RefineCriteria some_criteria(const Box& box, int turn, Random& random) {
  RefineCriteria criteria;
  const float size = box.diagonal();
  if (turn % 4 == 0)
    criteria.sphere = Sphere{box.center() + 0.4f * size * direction(random),
                             size * static_cast<float>(0.02 + 0.3 * random.uniform())};
  if (turn % 4 == 1) {
    const Vec3 normal = direction(random);
    const Vec3 point = box.center() + 0.4f * size * direction(random);
    criteria.plane = Plane{normal, -glm::dot(normal, point)};
  }
  if (turn % 4 >= 2) {
    criteria.view.emplace(camera_near(box, random));
    criteria.view->silhouette_weight = 4;
    if (turn % 8 >= 6) criteria.view->light = LightCriterion{.to_light = direction(random)};
  }
  return criteria;
}

// A triangle that faces the wrong way is one that some level has.
void expect_no_new_flips(const NamedFramework& named, const TriangleMesh& front,
                         const std::vector<bool>& split) {
  const auto flipped = flipped_triangles(front, named.detailed.mesh, 1);
  if (flipped.empty()) return;
  // The triangle stands at the level that its last change led to: the coarsest step that is done
  // among those on its corners' ways. So it is there at one of those levels.
  const TriangleMesh& full = named.detailed.mesh;
  const CollapseSequence& sequence = named.detailed.sequence;
  const TriangleMesh with_all = mesh_of_front(named.detailed, split);
  const auto bad = flipped_triangles(with_all, full, 1);
  ASSERT_EQ(bad.size(), flipped.size());
  for (const std::uint32_t t : bad) {
    const std::uint32_t* c = &with_all.indices[3 * std::size_t{t}];
    const Triangle triangle = turned(c[0], c[1], c[2], 0);
    bool found = false;
    for (std::uint32_t k = 0; k <= sequence.step_count() && !found; ++k) {
      if (std::any_of(c, c + 3, [&](std::uint32_t v) { return v >= sequence.vertices[k]; }))
        continue;
      // The levels just there and where a corner goes suffice, but there are few flips.
      const std::vector<std::uint32_t> ancestors = sequence.ancestors(k);
      for (std::size_t s = 0; s < full.indices.size() && !found; s += 3)
        found = turned(ancestors[full.indices[s]], ancestors[full.indices[s + 1]],
                       ancestors[full.indices[s + 2]], 0) == triangle;
    }
    EXPECT_TRUE(found) << named.name;
  }
}

void check_fronts(const std::string& file, int fronts) {
  VARIFOLD_REAL_MESH_OR_SKIP(path, file);
  const auto imported = read_mesh(path);
  ASSERT_TRUE(imported);
  const NamedFramework named = make_framework({file, imported->mesh});
  const Box box = bounds(named.detailed.mesh);
  const WeldMap weld = weld_exact(named.detailed.mesh.positions);
  const TopologyReport full = analyze_topology(named.detailed.mesh, weld);
  Random random(11);
  StripFrameworkInstance walker(named.model);
  int no_levels = 0;
  for (int i = 0; i < fronts; ++i) {
    AdaptOptions options;
    options.tolerance = static_cast<float>(0.5 + 8 * random.uniform());
    if (i % 5 == 4) options.max_triangles = named.model->triangle_count(0) + random.below(20000);
    const FrontStatistics statistics = walker.adapt(some_criteria(box, i, random), options);
    const std::vector<bool> split = splits_of(walker);
    const TriangleMesh expected = mesh_of_front(named.detailed, split);
    ASSERT_TRUE(triangle_set(walker.draw_list()) == triangle_set(expected)) << file << " " << i;
    ASSERT_EQ(statistics.triangles, expected.triangle_count());
    if (i % 5 == 4) {
      EXPECT_LE(statistics.triangles,
                std::max(options.max_triangles, named.model->triangle_count(0)));
    }
    const TopologyReport report = analyze_topology(expected, weld);
    ASSERT_EQ(report.euler_characteristic, full.euler_characteristic) << file << " " << i;
    ASSERT_EQ(report.closed, full.closed);
    ASSERT_EQ(report.boundary_loops, full.boundary_loops);
    ASSERT_EQ(report.components, full.components);
    ASSERT_EQ(report.duplicate_triangles, full.duplicate_triangles);
    ASSERT_EQ(report.misoriented_edges > 0, full.misoriented_edges > 0);
    ASSERT_EQ(report.manifold(), full.manifold());
    expect_no_new_flips(named, walker.extract(), split);
    no_levels += walker.level() == kNone ? 1 : 0;
  }
  EXPECT_GT(no_levels, fronts / 2) << file;
}

TEST(RealStripFronts, Bunny) { check_fronts("bunny.ply", 60); }
TEST(RealStripFronts, Armadillo) { check_fronts("armadillo.ply", 50); }
TEST(RealStripFronts, MengerSponge) { check_fronts("mengerSponge3.glb", 60); }
TEST(RealStripFronts, Beetle) { check_fronts("beetle.obj", 60); }
TEST(RealStripFronts, DamagedHelmet) { check_fronts("DamagedHelmet.glb", 80); }

}  // namespace
}  // namespace varifold::test
