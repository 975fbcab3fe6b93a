#include <tests/simplify/sequence_checks.h>

#include <gtest/gtest.h>
#include <varifold/mesh/validation.h>
#include <varifold/mesh/weld.h>
#include <algorithm>

namespace varifold::test {

TopologyReport topology_of(const TriangleMesh& mesh) {
  return analyze_topology(mesh, weld_exact(mesh.positions));
}

std::vector<std::uint32_t> spread_levels(const CollapseSequence& sequence, std::uint32_t count) {
  const std::uint32_t steps = sequence.step_count();
  std::vector<std::uint32_t> levels;
  if (steps < count) {
    for (std::uint32_t k = 0; k <= steps; ++k) levels.push_back(k);
    return levels;
  }
  for (std::uint32_t i = 0; i < count; ++i)
    levels.push_back(static_cast<std::uint32_t>(std::uint64_t{steps} * i / (count - 1)));
  return levels;
}

void expect_consistent(const DetailedMesh& detailed) {
  const CollapseSequence& sequence = detailed.sequence;
  const TriangleMesh& mesh = detailed.mesh;
  const std::uint32_t steps = sequence.step_count();
  ASSERT_EQ(sequence.vertices.size(), steps + 1);
  ASSERT_EQ(sequence.triangles.size(), steps + 1);
  ASSERT_EQ(sequence.error.size(), steps + 1);
  ASSERT_EQ(sequence.target.size(), mesh.vertex_count());
  ASSERT_EQ(sequence.triangle_level.size(), mesh.triangle_count());
  EXPECT_EQ(sequence.vertices.back(), mesh.vertex_count());
  EXPECT_EQ(sequence.triangles.back(), mesh.triangle_count());
  EXPECT_EQ(sequence.error.back(), 0);
  for (std::uint32_t k = 0; k < steps; ++k) {
    ASSERT_LT(sequence.vertices[k], sequence.vertices[k + 1]);
    ASSERT_LT(sequence.triangles[k], sequence.triangles[k + 1]);
    ASSERT_GE(sequence.error[k], sequence.error[k + 1]);
  }
  for (std::uint32_t k = 0; k <= steps; ++k) {
    const auto removed_later = [&](std::uint32_t level) { return level <= k; };
    if (k % std::max(1u, steps / 16) != 0) continue;
    ASSERT_EQ(std::count_if(sequence.triangle_level.begin(), sequence.triangle_level.end(),
                            removed_later),
              sequence.triangles[k]);
  }
  for (std::uint32_t v = 0; v < mesh.vertex_count(); ++v) {
    if (v < sequence.vertices[0])
      ASSERT_EQ(sequence.target[v], kNone);
    else
      ASSERT_LT(sequence.target[v], v);
  }
}

void expect_sound_level(const DetailedMesh& detailed, std::uint32_t level) {
  const TriangleMesh mesh = mesh_at_level(detailed, level);
  ASSERT_EQ(mesh.triangle_count(), detailed.sequence.triangles[level]);
  ASSERT_EQ(mesh.vertex_count(), detailed.sequence.vertices[level]);
  const TopologyReport full = topology_of(detailed.mesh);
  const TopologyReport report = topology_of(mesh);
  EXPECT_EQ(report.euler_characteristic, full.euler_characteristic) << "level " << level;
  EXPECT_EQ(report.components, full.components) << "level " << level;
  EXPECT_EQ(report.boundary_loops, full.boundary_loops) << "level " << level;
  EXPECT_EQ(report.closed, full.closed) << "level " << level;
  EXPECT_LE(report.boundary_edges, full.boundary_edges) << "level " << level;
  EXPECT_LE(report.nonmanifold_edges, full.nonmanifold_edges) << "level " << level;
  EXPECT_LE(report.misoriented_edges, full.misoriented_edges) << "level " << level;
  EXPECT_LE(report.nonmanifold_vertices, full.nonmanifold_vertices) << "level " << level;
  EXPECT_LE(report.duplicate_triangles, full.duplicate_triangles) << "level " << level;
  EXPECT_EQ(report.degenerate_triangles, 0u) << "level " << level;
  EXPECT_EQ(count_flipped(mesh, detailed.mesh), 0u) << "level " << level;
}

void expect_wedges_move_together(const DetailedMesh& detailed) {
  const CollapseSequence& sequence = detailed.sequence;
  const WeldMap weld = weld_exact(detailed.mesh.positions);
  for (std::uint32_t k = 0; k < sequence.step_count(); ++k) {
    const std::uint32_t begin = sequence.vertices[k];
    const std::uint32_t end = sequence.vertices[k + 1];
    for (std::uint32_t v = begin; v < end; ++v) {
      ASSERT_EQ(weld.class_of[v], weld.class_of[begin]);
      ASSERT_EQ(weld.class_of[sequence.target[v]], weld.class_of[sequence.target[begin]]);
      ASSERT_NE(weld.class_of[sequence.target[v]], weld.class_of[v]);
    }
  }
}

}  // namespace varifold::test
