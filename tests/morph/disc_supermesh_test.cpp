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
  // Covered once: another area would be a fold or a gap.
  EXPECT_NEAR(surface_area(shape), surface_area(input),
              (1e-5 + 20 * tolerance) * surface_area(input));
  const auto border = border_of(super, shape.positions);
  const auto wanted = border_of(input, input.positions);
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

}  // namespace
}  // namespace varifold
