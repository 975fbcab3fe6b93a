// The neighbours of every vertex in order, in flat arrays: what the simplifier walks and edits.
//
// A ring lists the neighbours of a vertex counter-clockwise. Entry i holds neighbour n_i and the
// face (v, n_i, n_{i+1}); the last entry of a closed ring leads back to the first. Where the
// surface ends, the face is kNone: a gap. A vertex on the border has one gap, a vertex where
// several sheets meet has several: each stretch between gaps is a fan, and a fan that closes on
// itself beside others repeats its first neighbour before its gap.
//
// Eight entries fill a cache line; longer rings live in a pool and leave their address in the line.
#pragma once

#include <varifold/base/math.h>
#include <varifold/simplify/block_pool.h>
#include <cstdint>
#include <span>
#include <vector>

namespace varifold {

struct RingEntry {
  std::uint32_t neighbor;
  std::uint32_t face;  ///< the face between this neighbour and the next, or kNone: a gap
};

/// One directed edge of a vertex' link: the face (v, from, to).
struct LinkEdge {
  std::uint32_t from, to, face;
};

/// Storage for rings of more than eight entries.
using RingPool = BlockPool<RingEntry, 16>;

/// Puts link edges in ring order. Edges that meet head to tail without doubt are joined, all else
/// begins a new fan. Returns true when the result is one closed fan (no gap). O(k) for small k,
/// O(k log k) beyond; `edges` is reordered.
bool order_ring(std::vector<LinkEdge>& edges, std::vector<RingEntry>& ring);

/// Appends the link edges that a ring stands for, in ring order.
void link_edges(std::span<const RingEntry> ring, std::vector<LinkEdge>& edges);

}  // namespace varifold
