#include <gtest/gtest.h>
#include <tests/support/meshes.h>
#include <tests/support/test_files.h>
#include <varifold/base/random.h>
#include <varifold/io/mesh_file.h>
#include <varifold/measure/surface_distance.h>
#include <varifold/mesh/generators.h>
#include <varifold/mesh/normals.h>
#include <varifold/mesh/topology.h>
#include <varifold/mesh/validation.h>
#include <varifold/morph/repair_sphere.h>
#include <varifold/morph/supermesh.h>
#include <varifold/simplify/simplify.h>
#include <cmath>

namespace varifold {
namespace {

TriangleMesh shape_of(const TriangleMesh& mesh, bool moved) {
  TriangleMesh shape;
  shape.positions = moved ? mesh.poses[0].positions : mesh.positions;
  shape.indices = mesh.indices;
  return shape;
}

void expect_shape(const TriangleMesh& shape, const TriangleMesh& input, double tolerance) {
  DistanceOptions options;
  options.samples = 20'000;
  options.vertices = true;
  const SurfaceDistanceReport distance = surface_distance(shape, input, options);
  EXPECT_LE(distance.hausdorff, tolerance * distance.diagonal);
  // Covered once: another area would be a fold or a gap.
  EXPECT_NEAR(surface_area(shape), surface_area(input), 0.01 * surface_area(input));
}

void expect_supermesh(const Supermesh& super, const TriangleMesh& a, const TriangleMesh& b,
                      double tolerance) {
  EXPECT_EQ(super.report.flipped_on_sphere, 0u);
  ASSERT_EQ(super.mesh.poses.size(), 1u);
  const TopologyReport topology = analyze_topology(super.mesh, weld_points(super.mesh));
  EXPECT_TRUE(topology.closed && topology.manifold() && topology.oriented());
  EXPECT_EQ(topology.euler_characteristic, 2);
  EXPECT_EQ(topology.components, 1u);
  EXPECT_EQ(topology.degenerate_triangles, 0u);
  EXPECT_EQ(topology.used_classes, topology.classes);
  expect_shape(shape_of(super.mesh, false), a, tolerance);
  expect_shape(shape_of(super.mesh, true), b, tolerance);
}

TriangleMesh rough_planet(std::uint32_t triangles, std::uint64_t seed) {
  PlanetOptions options;
  options.triangles = triangles;
  options.seed = seed;
  options.relief = 0.4f;
  return planet(options);
}

// A sphere of which some vertices stand out as needles, up to ten radii.
TriangleMesh spiked(std::uint32_t triangles, std::uint64_t seed) {
  TriangleMesh mesh = test::icosphere(triangles);
  mesh.normals.clear();
  Random random(seed);
  for (int i = 0; i < 12; ++i)
    mesh.positions[random.below(mesh.vertex_count())] *=
        1 + 9 * static_cast<float>(random.uniform());
  return mesh;
}

TEST(Supermesh, OverlaysMeetBothInputsExactly) {
  const std::vector<test::NamedMesh> meshes{{"tetrahedron", test::tetrahedron()},
                                            {"octahedron", test::octahedron()},
                                            {"cube", test::cube()},
                                            {"planet", rough_planet(1000, 1)},
                                            {"other planet", rough_planet(700, 2)},
                                            {"spiked", spiked(500, 3)}};
  SupermeshOptions options;
  options.tolerance = 0;
  for (const auto& a : meshes)
    for (const auto& b : meshes) {
      SCOPED_TRACE(a.name + " to " + b.name);
      const auto super = build_supermesh(a.mesh, b.mesh, options);
      ASSERT_TRUE(super) << super.error().message;
      expect_supermesh(*super, a.mesh, b.mesh, 2e-6);
      // Euler: every crossing is a vertex of four edges.
      const SupermeshReport& told = super->report;
      EXPECT_EQ(told.overlay_triangles,
                2 * (told.input_vertices[0] + told.input_vertices[1] + told.crossings) - 4);
    }
}

TEST(Supermesh, ReductionStaysWithinItsTolerance) {
  const TriangleMesh a = rough_planet(3000, 5), b = spiked(2000, 6);
  std::uint32_t before = kNone;
  for (const double tolerance : {1e-5, 1e-4, 1e-3, 1e-2}) {
    SCOPED_TRACE(tolerance);
    SupermeshOptions options;
    options.tolerance = tolerance;
    const auto super = build_supermesh(a, b, options);
    ASSERT_TRUE(super) << super.error().message;
    EXPECT_LT(super->mesh.triangle_count(), before);
    before = super->mesh.triangle_count();
    const TopologyReport topology = analyze_topology(super->mesh, weld_points(super->mesh));
    EXPECT_TRUE(topology.closed && topology.manifold() && topology.oriented());
    EXPECT_EQ(topology.euler_characteristic, 2);
    for (const bool moved : {false, true}) {
      DistanceOptions sampling;
      sampling.samples = 20'000;
      sampling.vertices = true;
      const auto distance = surface_distance(shape_of(super->mesh, moved), moved ? b : a, sampling);
      EXPECT_LE(distance.hausdorff, (tolerance + 1e-6) * distance.diagonal);
      EXPECT_GT(distance.hausdorff, 0);
    }
  }
}

TEST(Supermesh, SameBytesForAnyNumberOfThreads) {
  const TriangleMesh a = rough_planet(4000, 1), b = rough_planet(3000, 2);
  SupermeshOptions options;
  options.threads = 1;
  const auto one = build_supermesh(a, b, options);
  options.threads = 4;
  const auto four = build_supermesh(a, b, options);
  ASSERT_TRUE(one && four);
  EXPECT_EQ(one->mesh.indices, four->mesh.indices);
  EXPECT_EQ(one->mesh.positions, four->mesh.positions);
  EXPECT_EQ(one->mesh.poses, four->mesh.poses);
}

std::uint32_t vertex_towards(const TriangleMesh& mesh, const Vec3& way) {
  std::uint32_t best = 0;
  float largest = -2;
  for (std::uint32_t v = 0; v < mesh.vertex_count(); ++v) {
    const float cosine = glm::dot(glm::normalize(mesh.positions[v]), glm::normalize(way));
    if (cosine > largest) largest = cosine, best = v;
  }
  return best;
}

TEST(Supermesh, FeaturesMeet) {
  const TriangleMesh a = rough_planet(2000, 1), b = rough_planet(2000, 2);
  SupermeshOptions options;
  options.tolerance = 0;
  // Points that lie in about the same direction, but for a turn and a quarter of a radian.
  const Vec3 ways[] = {{1, 0.1f, 0}, {-0.5f, 0.8f, 0.2f}, {-0.5f, -0.8f, 0.3f}, {0, 0.3f, 1}};
  const Vec3 shifts[] = {{0, 0.25f, 0}, {0, 0, -0.25f}, {0.2f, 0, 0}, {-0.2f, 0, 0}};
  for (int i = 0; i < 4; ++i) {
    const Vec3 other = ways[i] + shifts[i];
    options.features.emplace_back(vertex_towards(a, ways[i]),
                                  vertex_towards(b, {-other.y, other.x, other.z}));
  }
  const auto super = build_supermesh(a, b, options);
  ASSERT_TRUE(super) << super.error().message;
  EXPECT_EQ(super->report.feature_distance, 0);
  expect_supermesh(*super, a, b, 2e-6);
  for (const auto& [in_a, in_b] : options.features) {
    // A vertex that is at the one feature and goes to the other.
    float nearest = 1e9f;
    for (std::uint32_t v = 0; v < super->mesh.vertex_count(); ++v)
      nearest = std::min(nearest,
                         glm::distance(super->mesh.positions[v], a.positions[in_a]) +
                             glm::distance(super->mesh.poses[0].positions[v], b.positions[in_b]));
    EXPECT_LT(nearest, 1e-5f);
  }
  options.features = {{3, 500}, {3, 77}};
  EXPECT_FALSE(build_supermesh(a, b, options));
  options.features = {{3, 50'000}};
  EXPECT_FALSE(build_supermesh(a, b, options));
}

TEST(Supermesh, FitsTurnedShapes) {
  // Three unlike axes, so that one turn alone fits.
  TriangleMesh a = test::icosphere(500);
  a.normals.clear();
  for (Vec3& p : a.positions)
    p *= Vec3(1, p.y > 0 ? 2.0f : 1.5f, 3) * (p.x > 0 ? 1.0f : 0.6f) * (p.z > 0 ? 1.0f : 0.7f);
  TriangleMesh b = a;
  for (Vec3& p : b.positions) p = 5.0f * Vec3(p.y, p.z, p.x) + Vec3(100, 0, 0);
  SupermeshOptions options;
  options.tolerance = 0;
  options.fit = true;
  const auto super = build_supermesh(a, b, options);
  ASSERT_TRUE(super) << super.error().message;
  EXPECT_NEAR(super->report.moved_b.scale, 0.2, 1e-3);
  expect_shape(shape_of(super->mesh, true), a, 1e-3);
  double sum = 0;
  for (std::uint32_t v = 0; v < super->mesh.vertex_count(); ++v)
    sum += glm::distance(super->mesh.positions[v], super->mesh.poses[0].positions[v]);
  EXPECT_LT(sum / super->mesh.vertex_count(), 0.15);
}

TEST(Supermesh, CarriesSeamsAndMaterials) {
  GeneratorOptions shape;
  shape.triangles = 800;
  const TriangleMesh a = seamed_sphere(shape), b = rough_planet(500, 2);
  const auto super = build_supermesh(a, b);
  ASSERT_TRUE(super) << super.error().message;
  const TriangleMesh& mesh = super->mesh;
  ASSERT_TRUE(mesh.has_texcoords() && mesh.has_normals());
  EXPECT_EQ(mesh.poses[0].normals.size(), mesh.positions.size());
  ASSERT_EQ(mesh.ranges.size(), a.ranges.size());
  expect_supermesh(*super, a, b, 1e-4);
  // North stays north: no triangle of a material lies on the other side of the equator.
  const std::vector<std::uint32_t> materials = triangle_materials(mesh);
  const std::uint32_t top = triangle_materials(a)[0];
  const float side =
      a.positions[a.indices[0]].y + a.positions[a.indices[1]].y + a.positions[a.indices[2]].y;
  for (std::uint32_t t = 0; t < mesh.triangle_count(); ++t) {
    float height = 0;
    for (std::uint32_t k = 0; k < 3; ++k) height += mesh.positions[mesh.indices[3 * t + k]].y;
    EXPECT_GE((materials[t] == top ? 1 : -1) * (side > 0 ? 1 : -1) * height, -1e-3f);
  }
}

TEST(Supermesh, RefusesWhatIsNoSphere) {
  GeneratorOptions shape;
  shape.triangles = 500;
  const TriangleMesh good = test::octahedron();
  TriangleMesh open = test::icosphere(80), two = test::join(good, good, {5, 0, 0});
  open.indices.resize(open.indices.size() - 3);
  TriangleMesh bad = good;
  bad.indices[0] = 99;
  const struct {
    TriangleMesh mesh;
    const char* message;
  } cases[] = {{torus(shape), "genus 1"},   {open, "1 hole"},
               {two, "2 components"},       {plane(shape), "1 hole"},
               {bad, "index_out_of_range"}, {{}, "no triangles"}};
  for (const auto& refused : cases) {
    for (const bool is_first : {true, false}) {
      const auto super =
          is_first ? build_supermesh(refused.mesh, good) : build_supermesh(good, refused.mesh);
      ASSERT_FALSE(super) << refused.message;
      EXPECT_EQ(super.error().kind, ErrorKind::kInvalidInput);
      EXPECT_NE(super.error().message.find(refused.message), std::string::npos)
          << super.error().message;
      EXPECT_EQ(super.error().message.find(is_first ? "first mesh" : "second mesh"), 0u);
    }
  }
  for (const auto& pinched : test::group_nonmanifold())
    EXPECT_FALSE(build_supermesh(pinched.mesh, good)) << pinched.name;
}

TEST(Supermesh, CanBeCancelled) {
  const TriangleMesh a = rough_planet(500, 1);
  for (int last = 0; last < 6; ++last) {
    int calls = 0;
    SupermeshOptions options;
    options.progress = [&](std::string_view, float) { return calls++ < last; };
    const auto super = build_supermesh(a, a, options);
    ASSERT_FALSE(super);
    EXPECT_EQ(super.error().kind, ErrorKind::kCancelled);
  }
}

TriangleMesh with_triangles(const std::filesystem::path& path, std::uint32_t triangles) {
  auto repaired = repair_to_sphere(read_mesh(path)->mesh);
  SimplifyOptions options;
  options.target_triangles = triangles;
  options.measure_error = false;
  const auto simplified = simplify(repaired->mesh, options);
  return without_unused_vertices(mesh_at_level(simplified->detailed, 0));
}

TEST(Supermesh, RealMeshes) {
  VARIFOLD_REAL_MESH_OR_SKIP(horse, "horse.ply");
  VARIFOLD_REAL_MESH_OR_SKIP(bunny, "bunny.ply");
  VARIFOLD_REAL_MESH_OR_SKIP(igea, "igea.ply");
  const TriangleMesh a = with_triangles(horse, 20'000);
  const TriangleMesh planets = rough_planet(20'000, 1);
  for (const auto& path : {bunny, igea}) {
    const TriangleMesh b = with_triangles(path, 20'000);
    for (const TriangleMesh& other : {a, planets}) {
      SCOPED_TRACE(path.string());
      const auto super = build_supermesh(other, b);
      ASSERT_TRUE(super) << super.error().message;
      expect_supermesh(*super, other, b, 1e-4);
      EXPECT_LT(super->mesh.triangle_count(), 4 * (other.triangle_count() + b.triangle_count()));
    }
  }
}

}  // namespace
}  // namespace varifold
