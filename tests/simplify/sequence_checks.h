// What must hold for every sequence, checked by brute force.
#pragma once

#include <varifold/mesh/topology.h>
#include <varifold/simplify/simplify.h>

namespace varifold::test {

/// Arrays fit together, targets come before their vertices, levels grow, errors never rise.
void expect_consistent(const DetailedMesh& detailed);

/// Euler characteristic, components, borders and the like of the level are those of the full mesh;
/// no triangle is degenerate, doubled or turned over that was not so before.
void expect_sound_level(const DetailedMesh& detailed, std::uint32_t level);

/// Up to `count` levels, the base and the full level among them.
[[nodiscard]] std::vector<std::uint32_t> spread_levels(const CollapseSequence& sequence,
                                                       std::uint32_t count);

/// Every wedge goes to a wedge of the target's position class, on the same side of the charts
/// where texture coordinates tell sides apart.
void expect_wedges_move_together(const DetailedMesh& detailed);

[[nodiscard]] TopologyReport topology_of(const TriangleMesh& mesh);

}  // namespace varifold::test
