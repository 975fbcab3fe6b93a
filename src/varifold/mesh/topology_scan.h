// The pass over all vertex stars that topology.h and validation.h share. Internal to this folder.
#pragma once

#include <varifold/mesh/topology.h>
#include <varifold/mesh/triangle_mesh.h>
#include <varifold/mesh/weld.h>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace varifold::detail {

/// How many things there are of a kind, and the first few of them.
struct Tally {
  static constexpr std::size_t kPlaces = 5;
  std::uint64_t count = 0;
  std::array<std::uint64_t, kPlaces> places{};

  void add(std::uint64_t place) {
    if (count < kPlaces) places[count] = place;
    ++count;
  }
  void append(const Tally& later) {
    for (std::size_t i = 0; i < kPlaces && i < later.count; ++i)
      if (count + i < kPlaces) places[count + i] = later.places[i];
    count += later.count;
  }
};

/// An edge as a place: both classes, the lower one in the upper half.
[[nodiscard]] inline std::uint64_t edge_place(std::uint32_t a, std::uint32_t b) {
  return a < b ? (std::uint64_t{a} << 32) | b : (std::uint64_t{b} << 32) | a;
}

/// What the stars of a range of position classes hold; an edge counts at its lower class, a
/// triangle at its lowest.
struct TopologyScan {
  Tally degenerate_triangles;  ///< places are triangles
  Tally duplicate_triangles;   ///< places are triangles
  Tally boundary_edges;        ///< places are edges (edge_place)
  Tally nonmanifold_edges;
  Tally misoriented_edges;
  Tally nonmanifold_vertices;  ///< places are classes
  std::uint64_t edges = 0;
  std::uint64_t odd_edges = 0;  ///< with an odd number of triangles
  std::uint32_t used_classes = 0;
  /// Boundary edges by the corner that they start at, and pairs of them that a fan joins.
  std::vector<std::uint32_t> boundary_ids;
  std::vector<std::array<std::uint32_t, 2>> boundary_joints;

  void append(const TopologyScan& later);
};

[[nodiscard]] TopologyScan scan_topology(const TriangleMesh& mesh, const WeldMap& weld,
                                         int threads);

}  // namespace varifold::detail
