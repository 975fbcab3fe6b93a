// Supermeshes of discs, judged by oracles that share no code with them.
#include <gtest/gtest.h>
#include <tests/morph/disc_shapes.h>
#include <tests/support/test_files.h>
#include <varifold/base/random.h>
#include <varifold/io/mesh_file.h>
#include <varifold/measure/surface_distance.h>
#include <varifold/mesh/generators.h>
#include <varifold/mesh/normals.h>
#include <varifold/mesh/topology.h>
#include <varifold/mesh/validation.h>
#include <varifold/morph/supermesh.h>
#include <algorithm>
#include <cmath>
#include <map>

namespace varifold {
namespace {

using test::NamedMesh;

TriangleMesh shape_of(const TriangleMesh& mesh, bool moved) {
  TriangleMesh shape;
  shape.positions = moved ? mesh.poses[0].positions : mesh.positions;
  shape.indices = mesh.indices;
  return shape;
}

// The border as pieces of straight lines, by the edges that run one way only. Vertices are told
// apart by what they are on both shapes where there are two.
using Segment = std::pair<Vec3, Vec3>;
std::vector<Segment> border_of(const TriangleMesh& mesh, const std::vector<Vec3>& positions) {
  const WeldMap weld = weld_points(mesh);
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> runs;
  const auto ends = [&](std::size_t h) {
    return std::pair(weld.class_of[mesh.indices[h]],
                     weld.class_of[mesh.indices[h % 3 == 2 ? h - 2 : h + 1]]);
  };
  for (std::size_t h = 0; h < mesh.indices.size(); ++h) ++runs[ends(h)];
  std::vector<Segment> border;
  for (std::size_t h = 0; h < mesh.indices.size(); ++h) {
    const auto [from, to] = ends(h);
    if (!runs.contains({to, from}))
      border.emplace_back(positions[mesh.indices[h]],
                          positions[mesh.indices[h % 3 == 2 ? h - 2 : h + 1]]);
  }
  return border;
}

double to_segment(const DVec3& p, const Segment& segment) {
  const DVec3 a(segment.first), way = DVec3(segment.second) - a;
  const double square = glm::dot(way, way);
  const double t = square > 0 ? std::clamp(glm::dot(p - a, way) / square, 0.0, 1.0) : 0.0;
  return glm::distance(p, a + t * way);
}

double one_sided(const std::vector<Segment>& from, const std::vector<Segment>& to) {
  double farthest = 0;
  for (const Segment& segment : from)
    for (const float t : {0.0f, 0.3f, 0.5f, 0.8f}) {
      const DVec3 p(segment.first + t * (segment.second - segment.first));
      double nearest = 1e300;
      for (const Segment& other : to) nearest = std::min(nearest, to_segment(p, other));
      farthest = std::max(farthest, nearest);
    }
  return farthest;
}

double length_of(const std::vector<Segment>& border) {
  double sum = 0;
  for (const auto& [p, q] : border) sum += glm::distance(DVec3(p), DVec3(q));
  return sum;
}

void expect_disc(const TriangleMesh& mesh) {
  const TopologyReport topology = analyze_topology(mesh, weld_points(mesh));
  EXPECT_TRUE(topology.manifold() && topology.oriented());
  EXPECT_EQ(topology.euler_characteristic, 1);
  EXPECT_EQ(topology.boundary_loops, 1u);
  EXPECT_EQ(topology.components, 1u);
  EXPECT_EQ(topology.degenerate_triangles, 0u);
  EXPECT_EQ(topology.used_classes, topology.classes);
}

void expect_shape(const TriangleMesh& super, bool moved, const TriangleMesh& input,
                  double tolerance) {
  DistanceOptions options;
  options.samples = 10'000;
  options.vertices = true;
  const TriangleMesh shape = shape_of(super, moved);
  const SurfaceDistanceReport distance = surface_distance(shape, input, options);
  EXPECT_LE(distance.hausdorff, tolerance * distance.diagonal);
  const auto border = border_of(super, shape.positions);
  const auto wanted = border_of(input, input.positions);
  // Covered once: another area would be a fold or a gap. A band as wide as the tolerance may go.
  EXPECT_NEAR(surface_area(shape), surface_area(input),
              (1e-5 + 20 * tolerance) * surface_area(input) +
                  tolerance * distance.diagonal * length_of(wanted));
  EXPECT_LE(one_sided(border, wanted), tolerance * distance.diagonal);
  EXPECT_LE(one_sided(wanted, border), tolerance * distance.diagonal);
  // Once along it: not back and forth.
  EXPECT_NEAR(length_of(border), length_of(wanted), (1e-5 + 50 * tolerance) * length_of(wanted));
}

void expect_supermesh(const Supermesh& super, const TriangleMesh& a, const TriangleMesh& b,
                      double tolerance) {
  EXPECT_EQ(super.report.flipped_on_sphere, 0u);
  ASSERT_EQ(super.mesh.poses.size(), 1u);
  expect_disc(super.mesh);
  expect_shape(super.mesh, false, a, tolerance);
  expect_shape(super.mesh, true, b, tolerance);
}

TEST(DiscSupermesh, OverlaysMeetBothInputsExactly) {
  SupermeshOptions options;
  options.tolerance = 0;
  const std::vector<NamedMesh> discs = test::small_discs();
  for (const NamedMesh& a : discs)
    for (const NamedMesh& b : discs) {
      SCOPED_TRACE(a.name + " to " + b.name);
      const auto super = build_supermesh(a.mesh, b.mesh, options);
      ASSERT_TRUE(super) << super.error().message;
      expect_supermesh(*super, a.mesh, b.mesh, 2e-6);
    }
}

TEST(DiscSupermesh, ReductionStaysWithinItsTolerance) {
  const std::vector<NamedMesh> discs = test::small_discs();
  std::uint32_t before = kNone;
  for (const double tolerance : {1e-4, 1e-3, 1e-2}) {
    std::uint32_t sum = 0;
    for (std::size_t i = 0; i < discs.size(); ++i) {
      const TriangleMesh &a = discs[i].mesh, &b = discs[(i + 3) % discs.size()].mesh;
      SCOPED_TRACE(discs[i].name + " " + std::to_string(tolerance));
      SupermeshOptions options;
      options.tolerance = tolerance;
      const auto super = build_supermesh(a, b, options);
      ASSERT_TRUE(super) << super.error().message;
      EXPECT_LE(super->mesh.triangle_count(), super->report.overlay_triangles);
      sum += super->mesh.triangle_count();
      expect_supermesh(*super, a, b, tolerance + 1e-6);
    }
    EXPECT_LT(sum, before);
    before = sum;
  }
}

TEST(DiscSupermesh, SameBytesForAnyNumberOfThreads) {
  const TriangleMesh a = test::rough_grid(60, 50, 1), b = test::rough_grid(31, 70, 2);
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

// The distance of the vertex that is nearest to two places on both shapes.
float nearest_to_both(const TriangleMesh& mesh, const Vec3& at_rest, const Vec3& moved) {
  float nearest = 1e9f;
  for (std::uint32_t v = 0; v < mesh.vertex_count(); ++v)
    nearest = std::min(nearest, glm::distance(mesh.positions[v], at_rest) +
                                    glm::distance(mesh.poses[0].positions[v], moved));
  return nearest;
}

TEST(DiscSupermesh, FeaturesMeetInsideAndOnTheBoundary) {
  const TriangleMesh a = test::rough_grid(24, 20, 1), b = test::rough_grid(18, 30, 2);
  const auto in_a = [](std::uint32_t x, std::uint32_t y) { return y * 25 + x; };
  const auto in_b = [](std::uint32_t x, std::uint32_t y) { return y * 19 + x; };
  const std::vector<FeaturePoint> inside{{in_a(12, 10), in_b(7, 18)}, {in_a(5, 5), in_b(6, 4)}},
      corners{{in_a(0, 0), in_b(0, 0)},
              {in_a(24, 0), in_b(9, 0)},
              {in_a(24, 20), in_b(18, 30)},
              {in_a(0, 20), in_b(0, 25)}},
      one{{in_a(24, 7), in_b(0, 3)}};
  std::vector<FeaturePoint> both = corners;
  both.insert(both.end(), inside.begin(), inside.end());
  SupermeshOptions options;
  options.tolerance = 0;
  for (const auto& features : {inside, corners, one, both}) {
    options.features = features;
    const auto super = build_supermesh(a, b, options);
    ASSERT_TRUE(super) << super.error().message;
    EXPECT_EQ(super->report.feature_distance, 0);
    expect_supermesh(*super, a, b, 2e-6);
    for (const auto& [p, q] : features)
      EXPECT_LT(nearest_to_both(super->mesh, a.positions[p], b.positions[q]), 1e-6f);
  }
  const auto refusal = [&](const std::vector<FeaturePoint>& features) {
    options.features = features;
    const auto super = build_supermesh(a, b, options);
    EXPECT_FALSE(super);
    return super ? "" : super.error().message;
  };
  EXPECT_NE(refusal({{in_a(0, 0), in_b(5, 5)}}).find("boundary of the first mesh"),
            std::string::npos);
  EXPECT_NE(refusal({{in_a(9, 9), in_b(18, 3)}}).find("boundary of the second mesh"),
            std::string::npos);
  std::vector<FeaturePoint> crossed = corners;
  std::swap(crossed[0].second, crossed[1].second);
  EXPECT_NE(refusal(crossed).find("another order"), std::string::npos);
}

TEST(DiscSupermesh, EdgesOfTheBoundaryGoFarWhereFeaturesSaySo) {
  // One edge of b shall become three sides of a.
  const TriangleMesh a = test::rough_grid(8, 8, 1), b = test::rough_grid(4, 4, 2);
  SupermeshOptions options;
  options.tolerance = 0;
  options.features = {{0, 0}, {8 * 9, 1}, {4 * 9, 4 * 5 + 4}};
  const auto super = build_supermesh(a, b, options);
  ASSERT_TRUE(super) << super.error().message;
  expect_supermesh(*super, a, b, 2e-6);
}

TEST(DiscSupermesh, FitsTurnedShapes) {
  const TriangleMesh a = test::rough_grid(20, 15, 3);
  TriangleMesh b = a;
  for (Vec3& p : b.positions) p = 5.0f * Vec3(p.z, p.x, p.y) + Vec3(100, 0, 0);
  SupermeshOptions options;
  options.tolerance = 0;
  options.fit = true;
  const auto super = build_supermesh(a, b, options);
  ASSERT_TRUE(super) << super.error().message;
  EXPECT_NEAR(super->report.moved_b.scale, 0.2, 1e-6);
  for (std::uint32_t v = 0; v < super->mesh.vertex_count(); ++v)
    EXPECT_LT(glm::distance(super->mesh.positions[v], super->mesh.poses[0].positions[v]), 1e-3f);
}

TEST(DiscSupermesh, CarriesSeamsAndMaterials) {
  // Texture coordinates jump along a column, and another material begins along a row.
  TriangleMesh a = test::rough_grid(16, 16, 4);
  const std::uint32_t count = a.vertex_count();
  const std::vector<Vec3> places = a.positions;
  a.positions.insert(a.positions.end(), places.begin(), places.end());
  for (std::uint32_t v = 0; v < 2 * count; ++v) {
    a.texcoords.emplace_back((v < count ? 0.0f : 10.0f) + a.positions[v].x, a.positions[v].y);
    a.colors.emplace_back(v < count ? 10 : 200, 0, 0, 255);
    a.normals.emplace_back(0, 0, 1);
  }
  a.materials.resize(2);
  std::vector<std::uint32_t> materials;
  for (std::uint32_t t = 0; t < a.triangle_count(); ++t) {
    const std::uint32_t square = t / 2;
    materials.push_back(square / 16 < 6 ? 1 : 0);
    for (std::uint32_t k = 0; k < 3 && square % 16 >= 9; ++k) a.indices[3 * t + k] += count;
  }
  set_triangle_materials(a, materials);
  a = without_unused_vertices(a);
  for (const TriangleMesh& b : {test::spiral(40, 2), test::rough_grid(7, 9, 1)}) {
    const auto super = build_supermesh(a, b);
    ASSERT_TRUE(super) << super.error().message;
    const TriangleMesh& mesh = super->mesh;
    ASSERT_TRUE(mesh.has_texcoords() && mesh.has_normals() && mesh.has_colors());
    EXPECT_TRUE(is_sound(validate(mesh)));
    ASSERT_EQ(mesh.ranges.size(), 2u);
    expect_supermesh(*super, a, b, 1e-4);
    // What the attributes were made of still tells where a vertex is.
    for (std::uint32_t v = 0; v < mesh.vertex_count(); ++v) {
      const bool is_right = mesh.colors[v].r > 100;
      EXPECT_NEAR(mesh.texcoords[v].x, mesh.positions[v].x + (is_right ? 10.0f : 0.0f), 1e-3f);
      EXPECT_NEAR(mesh.texcoords[v].y, mesh.positions[v].y, 1e-3f);
    }
    double areas[2] = {0, 0}, wanted[2] = {0, 0};
    const auto area_of = [](const TriangleMesh& of, std::uint32_t t) {
      const Vec3 &p = of.positions[of.indices[3 * t]], &q = of.positions[of.indices[3 * t + 1]],
                 &r = of.positions[of.indices[3 * t + 2]];
      return 0.5 * glm::length(glm::cross(DVec3(q - p), DVec3(r - p)));
    };
    const auto add_areas = [&](const TriangleMesh& of, double* sums) {
      const std::vector<std::uint32_t> material_of = triangle_materials(of);
      for (std::uint32_t t = 0; t < of.triangle_count(); ++t)
        sums[material_of[t]] += area_of(of, t);
    };
    add_areas(mesh, areas);
    add_areas(a, wanted);
    for (int i = 0; i < 2; ++i) EXPECT_NEAR(areas[i], wanted[i], 2e-3 * wanted[i]);
  }
}

TEST(DiscSupermesh, RefusesWhatIsNeitherDiscNorSphere) {
  GeneratorOptions shape;
  shape.triangles = 500;
  const TriangleMesh disc = test::grid(4, 4), sphere = test::icosphere(80);
  TriangleMesh holes = test::grid(6, 6), pierced = torus(shape);
  holes.indices.erase(holes.indices.begin() + 96, holes.indices.begin() + 102);
  pierced.indices.resize(pierced.indices.size() - 3);
  const struct {
    TriangleMesh mesh;
    const char* message;
  } cases[] = {{sphere, "1 hole"},
               {holes, "2 holes"},
               {pierced, "1 handle"},
               {test::join(disc, disc, {9, 0, 0}), "2 components"}};
  for (const auto& refused : cases)
    for (const bool is_first : {true, false}) {
      const auto super =
          is_first ? build_supermesh(refused.mesh, disc) : build_supermesh(disc, refused.mesh);
      ASSERT_FALSE(super) << refused.message;
      EXPECT_EQ(super.error().kind, ErrorKind::kInvalidInput);
      EXPECT_NE(super.error().message.find(refused.message), std::string::npos)
          << super.error().message;
      EXPECT_EQ(super.error().message.find('\n'), std::string::npos);
    }
  for (const test::NamedMesh& named : test::all_groups()) {
    const auto super = build_supermesh(named.mesh, disc);
    const TopologyReport topology = analyze_topology(named.mesh, weld_exact(named.mesh.positions));
    const bool is_disc = topology.manifold() && topology.oriented() && topology.components == 1 &&
                         topology.boundary_loops == 1 && topology.euler_characteristic == 1;
    EXPECT_EQ(super.has_value(), is_disc) << named.name;
    if (super && topology.degenerate_triangles == 0) expect_disc(super->mesh);
  }
}

TEST(DiscSupermesh, CanBeCancelled) {
  const TriangleMesh a = test::rough_grid(10, 10, 1);
  for (int last = 0; last < 6; ++last) {
    int calls = 0;
    SupermeshOptions options;
    options.progress = [&](std::string_view, float) { return calls++ < last; };
    const auto super = build_supermesh(a, a, options);
    ASSERT_FALSE(super);
    EXPECT_EQ(super.error().kind, ErrorKind::kCancelled);
  }
}

TEST(DiscSupermesh, RandomDiscs) {
  Random random(11);
  const auto any = [&](std::uint64_t seed) {
    const std::uint32_t kind = random.below(5), one = random.below(80), other = random.below(30);
    if (kind == 0) return test::rough_grid(1 + one % 30, 1 + other, seed);
    if (kind == 1) return test::random_chords(3 + one, seed);
    if (kind == 2) return test::spiral(1 + 2 * one, 1 + 0.1f * static_cast<float>(other));
    if (kind == 3) return test::with_ears(test::with_ears(test::random_chords(3 + other, seed)));
    return test::fan(3 + other);
  };
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    SCOPED_TRACE(seed);
    const TriangleMesh a = any(2 * seed), b = any(2 * seed + 1);
    SupermeshOptions options;
    options.tolerance = seed % 2 == 0 ? 0 : 5e-4;
    const auto super = build_supermesh(a, b, options);
    ASSERT_TRUE(super) << super.error().message;
    expect_supermesh(*super, a, b, options.tolerance + 2e-6);
  }
}

TEST(DiscSupermesh, RealMeshes) {
  VARIFOLD_REAL_MESH_OR_SKIP(igea, "igea.ply");
  VARIFOLD_REAL_MESH_OR_SKIP(bunny, "bunny.ply");
  const auto is_anywhere = [](const Vec3&) { return true; };
  const TriangleMesh face =
      test::cut_disc(read_mesh(igea)->mesh, [](const Vec3& p) { return p.z > 0.02f; });
  const TriangleMesh open_bunny = test::cut_disc(read_mesh(bunny)->mesh, is_anywhere);
  const TriangleMesh patch = test::rough_grid(60, 60, 1);
  for (const TriangleMesh& b : {open_bunny, patch}) {
    const auto super = build_supermesh(face, b);
    ASSERT_TRUE(super) << super.error().message;
    expect_supermesh(*super, face, b, 1e-4);
    EXPECT_LT(super->mesh.triangle_count(), 4 * (face.triangle_count() + b.triangle_count()));
  }
}

// Every spoke of the one crosses most rungs of the other.
TEST(DiscSupermesh, TooManyCrossingsAreRefused) {
  const auto super = build_supermesh(test::spiral(1'500, 8), test::fan(6'000));
  ASSERT_FALSE(super);
  EXPECT_EQ(super.error().kind, ErrorKind::kFailed);
  EXPECT_NE(super.error().message.find("cross each other too often"), std::string::npos)
      << super.error().message;
}

}  // namespace
}  // namespace varifold
