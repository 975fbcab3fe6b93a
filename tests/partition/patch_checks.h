// Surfaces for tests of partitions, and checks that share no code with what they check.
#pragma once

#include <tests/support/meshes.h>
#include <varifold/mesh/triangle_mesh.h>
#include <varifold/partition/patches.h>
#include <varifold/partition/surface_view.h>
#include <array>
#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace varifold::test {

/// Welded, without degenerate triangles, numbered along a curve in space.
struct TestSurface {
  std::string name;
  std::vector<std::uint32_t> corners;
  std::vector<Vec3> positions;
  std::vector<std::uint32_t> materials;

  [[nodiscard]] SurfaceView view() const { return {corners, positions, materials}; }
};

[[nodiscard]] TestSurface make_surface(const std::string& name, const TriangleMesh& mesh);

/// All groups of meshes, and larger ones: planets, grids with holes, many components, materials in
/// stripes.
[[nodiscard]] std::vector<TestSurface> partition_surfaces();

using Edge = std::pair<std::uint32_t, std::uint32_t>;  // lower and upper point

/// The triangles of every edge.
[[nodiscard]] std::map<Edge, std::vector<std::uint32_t>> triangles_of_edges(
    const TestSurface& surface);

/// Points - edges + triangles of the given triangles.
[[nodiscard]] std::int64_t euler_of(const TestSurface& surface,
                                    const std::vector<std::uint32_t>& triangles);

/// Per triangle, the lowest triangle that edges with two triangles join it to, among those of equal
/// label; `through_nonmanifold`: also by points of edges with more triangles.
[[nodiscard]] std::vector<std::uint32_t> connected_parts(const TestSurface& surface,
                                                         const std::vector<std::uint32_t>& label,
                                                         bool through_nonmanifold);

[[nodiscard]] std::vector<std::vector<std::uint32_t>> triangles_by_label(
    const std::vector<std::uint32_t>& label, std::uint32_t count);

}  // namespace varifold::test
