#include <varifold/simplify/simplify.h>

#include <gtest/gtest.h>
#include <tests/simplify/sequence_checks.h>
#include <tests/support/meshes.h>
#include <varifold/mesh/generators.h>
#include <varifold/mesh/normals.h>
#include <cstring>
#include <limits>
#include <tuple>

namespace varifold {
namespace {

using test::NamedMesh;

Simplification simplified(const TriangleMesh& mesh, const SimplifyOptions& options = {}) {
  auto result = simplify(mesh, options);
  EXPECT_TRUE(result) << result.error().message;
  return result ? std::move(*result) : Simplification{};
}

template <class T>
bool same_bytes(const std::vector<T>& a, const std::vector<T>& b) {
  return a.size() == b.size() &&
         (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0);
}

bool same_result(const Simplification& a, const Simplification& b) {
  const DetailedMesh& x = a.detailed;
  const DetailedMesh& y = b.detailed;
  return same_bytes(x.mesh.positions, y.mesh.positions) &&
         same_bytes(x.mesh.indices, y.mesh.indices) &&
         same_bytes(x.sequence.target, y.sequence.target) &&
         same_bytes(x.sequence.vertices, y.sequence.vertices) &&
         same_bytes(x.sequence.triangles, y.sequence.triangles) &&
         same_bytes(x.sequence.error, y.sequence.error) &&
         same_bytes(x.sequence.placed.positions, y.sequence.placed.positions) &&
         same_bytes(x.original_vertex, y.original_vertex) &&
         same_bytes(x.original_triangle, y.original_triangle);
}

class EveryMesh : public testing::TestWithParam<std::tuple<Placement, Metric>> {
 protected:
  static SimplifyOptions options() {
    SimplifyOptions options;
    std::tie(options.placement, options.metric) = GetParam();
    return options;
  }
};

TEST_P(EveryMesh, KeepsItsTopologyAtEveryLevel) {
  const SimplifyOptions options = EveryMesh::options();
  for (const NamedMesh& named : test::all_groups()) {
    SCOPED_TRACE(named.name);
    const Simplification result = simplified(named.mesh, options);
    test::expect_consistent(result.detailed);
    test::expect_wedges_move_together(result.detailed);
    for (const std::uint32_t level : test::spread_levels(result.detailed.sequence, 40))
      test::expect_sound_level(result.detailed, level);
    if (HasFatalFailure()) return;
  }
}

TEST_P(EveryMesh, IsTheSameForAnyNumberOfThreads) {
  for (const char* shape : {"planet", "seamed_sphere"}) {
    GeneratorOptions generator;
    SimplifyOptions options = EveryMesh::options();
    generator.triangles = options.placement == Placement::kKept ? 80000 : 15000;  // several cells
    if (options.metric == Metric::kEnergy) generator.triangles = 10000;
    const TriangleMesh mesh = *generate(shape, generator);
    options.threads = 1;
    const Simplification one = simplified(mesh, options);
    for (const int threads : {2, 3}) {
      options.threads = threads;
      EXPECT_TRUE(same_result(one, simplified(mesh, options))) << shape << ", " << threads;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Orders, EveryMesh,
                         testing::Combine(testing::Values(Placement::kKept, Placement::kOptimal),
                                          testing::Values(Metric::kQuadric, Metric::kEnergy)));

TEST(Simplify, KeptLevelsUseVerticesOfTheInput) {
  const TriangleMesh mesh = planet({{.triangles = 2000}});
  const Simplification result = simplified(mesh);
  for (std::uint32_t v = 0; v < result.detailed.mesh.vertex_count(); ++v)
    ASSERT_EQ(result.detailed.mesh.positions[v],
              mesh.positions[result.detailed.original_vertex[v]]);
}

TEST(Simplify, FullLevelIsTheInput) {
  for (const NamedMesh& named : test::group_closed()) {
    const DetailedMesh detailed = simplified(named.mesh).detailed;
    ASSERT_EQ(detailed.mesh.triangle_count(), named.mesh.triangle_count()) << named.name;
    for (std::uint32_t t = 0; t < detailed.mesh.triangle_count(); ++t)
      for (std::size_t k = 0; k < 3; ++k)
        ASSERT_EQ(detailed.mesh.positions[detailed.mesh.indices[3 * t + k]],
                  named.mesh.positions[named.mesh.indices[3 * detailed.original_triangle[t] + k]]);
  }
}

TEST(Simplify, ClosedSphereEndsAsATetrahedron) {
  const Simplification result = simplified(test::icosphere(3));
  EXPECT_EQ(result.detailed.sequence.triangles[0], 4u);
  EXPECT_EQ(result.detailed.sequence.vertices[0], 4u);
  EXPECT_EQ(result.stop.reason, StopReason::kExhausted);
}

TEST(Simplify, FlatSquareEndsAsOneTriangle) {
  const Simplification result = simplified(test::grid(8, 8));
  EXPECT_EQ(result.detailed.sequence.triangles[0], 1u);
  EXPECT_LE(result.detailed.sequence.step_count(), 78u);
}

TEST(Simplify, FlatRegionsCostNothing) {
  TriangleMesh box = *generate("box", {.triangles = 3000});
  const CollapseSequence sequence = simplified(box).detailed.sequence;
  const std::uint32_t level = sequence.level_for_error(1e-6f);
  EXPECT_EQ(sequence.triangles[level], 12u);
}

TEST(Simplify, StopsAtTheTarget) {
  SimplifyOptions options;
  options.target_triangles = 500;
  const Simplification result = simplified(planet({{.triangles = 20000}}), options);
  EXPECT_EQ(result.stop.reason, StopReason::kTargetReached);
  EXPECT_EQ(result.stop.triangles, 500u);
  EXPECT_EQ(result.detailed.sequence.triangles[0], 500u);
}

TEST(Simplify, StopsAtTheError) {
  SimplifyOptions options;
  options.max_error = 0.01f;
  const Simplification result = simplified(planet({{.triangles = 5000}}), options);
  EXPECT_EQ(result.stop.reason, StopReason::kErrorReached);
  EXPECT_LE(result.detailed.sequence.error[0], options.max_error);
  EXPECT_GT(result.detailed.sequence.error[0], 0.5f * options.max_error);
  test::expect_consistent(result.detailed);
}

TEST(Simplify, ASequenceCutByErrorIsThatOfTheWholeOne) {
  const TriangleMesh mesh = planet({{.triangles = 3000}});
  SimplifyOptions options;
  options.placement = Placement::kOptimal;
  const DetailedMesh whole = simplified(mesh, options).detailed;
  options.max_error = 0.02f;
  const DetailedMesh cut = simplified(mesh, options).detailed;
  test::expect_consistent(cut);
  const std::uint32_t level = whole.sequence.step_count() - cut.sequence.step_count();
  ASSERT_GT(level, 0u);
  EXPECT_EQ(mesh_at_level(cut, 0).positions, mesh_at_level(whole, level).positions);
  EXPECT_EQ(mesh_at_level(cut, 0).indices, mesh_at_level(whole, level).indices);
  EXPECT_EQ(cut.sequence.placed_vertex.size(), cut.sequence.first_placed.back());
}

TEST(Simplify, PerFaceNormalsAreNoWalls) {
  TriangleMesh mesh = planet({{.triangles = 5000}});
  TriangleMesh split;
  for (std::uint32_t t = 0; t < mesh.triangle_count(); ++t)
    for (std::size_t k = 0; k < 3; ++k) {
      split.indices.push_back(split.vertex_count());
      split.positions.push_back(mesh.positions[mesh.indices[3 * t + k]]);
      split.normals.push_back(face_normal(mesh, t));
    }
  SimplifyOptions options;
  options.target_triangles = split.triangle_count() / 10;
  const Simplification result = simplified(split, options);
  EXPECT_EQ(result.stop.reason, StopReason::kTargetReached) << result.stop.advice;
  EXPECT_LE(result.detailed.sequence.triangles[0], options.target_triangles);
}

TEST(Simplify, MaterialsKeepTheirTriangles) {
  const TriangleMesh mesh = *generate("seamed_sphere", {.triangles = 4000});
  ASSERT_GT(mesh.ranges.size(), 1u);
  const DetailedMesh detailed = simplified(mesh).detailed;
  const auto before = triangle_materials(mesh);
  const auto after = triangle_materials(detailed.mesh);
  for (std::uint32_t t = 0; t < detailed.mesh.triangle_count(); ++t)
    ASSERT_EQ(after[t], before[detailed.original_triangle[t]]);
  EXPECT_EQ(mesh_at_level(detailed, 0).ranges.size(), mesh.ranges.size());
}

TEST(Simplify, SaysWhyItIsStuck) {
  SimplifyOptions options;
  options.target_triangles = 10;
  for (const NamedMesh& named : test::group_components()) {
    const Simplification result = simplified(named.mesh, options);
    if (result.stop.triangles <= options.target_triangles) continue;
    EXPECT_EQ(result.stop.reason, StopReason::kStuck) << named.name;
    EXPECT_FALSE(result.stop.advice.empty()) << named.name;
    std::uint32_t left = 0, refused = 0;
    for (const std::uint32_t n : result.stop.left_by_kind) left += n;
    for (const std::uint32_t n : result.stop.refusals) refused += n;
    EXPECT_EQ(left, refused) << named.name;
    EXPECT_GT(left, 0u) << named.name;
    EXPECT_EQ(result.stop.refusals[static_cast<int>(Refusal::kLegal)], 0u) << named.name;
  }
}

TEST(Simplify, RejectsBrokenMeshes) {
  TriangleMesh mesh = test::tetrahedron();
  mesh.indices[4] = 99;
  EXPECT_EQ(simplify(mesh).error().message, "triangle 1 uses vertex 99 of 4");
  mesh = test::tetrahedron();
  mesh.positions[2].y = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(simplify(mesh).error().message, "vertex 2 has a position that is not finite");
  mesh = test::tetrahedron();
  mesh.indices.pop_back();
  EXPECT_FALSE(simplify(mesh));
  mesh = test::tetrahedron();
  mesh.normals.resize(3);
  EXPECT_FALSE(simplify(mesh));
  mesh = test::tetrahedron();
  mesh.ranges = {{0, 0, 3}};
  EXPECT_FALSE(simplify(mesh));
}

TEST(Simplify, CanBeCancelled) {
  SimplifyOptions options;
  options.progress = [](std::string_view, float) { return false; };
  const auto result = simplify(planet({{.triangles = 20000}}), options);
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error().kind, ErrorKind::kCancelled);
}

// Coordinates far from the origin, as maps have them, must not spoil the quadrics: float resolves
// half a unit there, and the grid has steps of 64.
TEST(Simplify, WorksFarFromTheOrigin) {
  TriangleMesh mesh = test::grid(20, 20);
  for (Vec3& p : mesh.positions) p = 64.0f * p + Vec3(4e6f, 5e6f, 0);
  const CollapseSequence sequence = simplified(mesh).detailed.sequence;
  EXPECT_EQ(sequence.triangles[0], 1u);
  EXPECT_LT(sequence.error[sequence.level_for_triangles(2)], 1e-3f);
}

// A wheel of 70,000 spokes has more neighbours than a ring may hold: it stays as it is.
TEST(Simplify, SurvivesAGiantFan) {
  TriangleMesh fan;
  constexpr std::uint32_t kSpokes = 70000;
  fan.positions.emplace_back(0, 0, 0);
  for (std::uint32_t i = 0; i < kSpokes; ++i) {
    const double angle = 6.283185307179586 * i / kSpokes;
    fan.positions.emplace_back(std::cos(angle), std::sin(angle), 0);
    fan.indices.insert(fan.indices.end(), {0, i + 1, (i + 1) % kSpokes + 1});
  }
  const Simplification result = simplified(fan);
  test::expect_consistent(result.detailed);
}

}  // namespace
}  // namespace varifold
