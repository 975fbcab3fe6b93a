// Priorities of plain views for many nodes at once.
#pragma once

#include <varifold/models/patch_tree/front_tables.h>
#include <varifold/view/frustum.h>
#include <array>
#include <cstdint>
#include <span>

namespace varifold::front_lanes {

/// What a view asks of all nodes.
struct Numbers {
  float eye_x = 0, eye_y = 0, eye_z = 0, focal = 0, near_distance = 0;
  std::array<std::array<float, 4>, Frustum::kSideCount> planes = {};
  bool operator==(const Numbers&) const = default;
};

/// Existing nodes: the words of `exists` are empty but for `words`, a set of words.
struct Nodes {
  const FrontTables& tables;
  std::span<const std::uint64_t> words, exists;
  std::span<float> priorities;
};
/// Children of one node, whose priority is `limit`.
struct Run {
  std::uint32_t first, count;
  float limit;
  std::span<float> priorities;
};

/// What differs between views is compiled in: sums of these.
enum Part : std::uint8_t {
  kMeanSquares = 1,  ///< PatchMeasure::kMeanSquared
  kCulls = 2,        ///< what is outside
  kTurns = 4,        ///< what is turned away
  kPartSets = 8,
};

/// See FrontPriorities.
struct Functions {
  void (*evaluate)(const Numbers& numbers, const Nodes& nodes);
  void (*evaluate_run)(const Numbers& numbers, const FrontTables& tables, const Run& run);
};
/// With the vectors that the machine has.
[[nodiscard]] const Functions& functions_of(std::uint8_t parts);
/// With those that every machine has; the same results.
[[nodiscard]] const Functions& plain_functions_of(std::uint8_t parts);

}  // namespace varifold::front_lanes
