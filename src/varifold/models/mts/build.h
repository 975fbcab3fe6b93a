// From a numbered mesh and its strips to multiresolution triangle strips.
#pragma once

#include <varifold/models/mts/multiresolution_strips.h>
#include <varifold/simplify/collapse_sequence.h>
#include <varifold/strip/triangle_strips.h>
#include <cstdint>

namespace varifold {

struct MtsOptions {
  /// Longer strips are cut before anything else: a strip is walked as a whole whenever it changes.
  std::uint32_t longest_strip = 256;  ///< indices, at least 4
  /// A graph with more nodes, arcs or changes ends, and the strip goes on as another one.
  std::uint32_t largest_graph = MultiresolutionStripsData::kStripLimit;
};

/// Follows every strip down the sequence and records its states as a graph. `full_strips` draw the
/// full level of `detailed`, every triangle once in its orientation, by material ranges. Sequences
/// that move vertices (optimal placement) are not supported: an assertion. O(n) time where strips
/// have a bounded length.
[[nodiscard]] MultiresolutionStrips build_mts(const DetailedMesh& detailed,
                                              const TriangleStrips& full_strips,
                                              const MtsOptions& options = {});

}  // namespace varifold
