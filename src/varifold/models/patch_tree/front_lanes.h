// Priorities of plain views for many nodes at once.
#pragma once

#include <varifold/models/patch_tree/front_priorities.h>
#include <cstdint>
#include <span>
#include <vector>

namespace varifold::front_lanes {

struct Nodes {
  const FrontTables& tables;
  std::span<const std::uint64_t> exists;
  std::span<float> priorities;
};
struct Run {
  std::uint32_t first, count;
  float limit;
  std::span<float> priorities;
};

/// FrontPriorities::evaluate() for plain views; `parts` are the bits 1: mean squares, 2: culls what
/// is outside, 4: what is turned away.
void evaluate(std::uint8_t parts, const FrontPriorities::Numbers& numbers, const Nodes& nodes);
/// The same without vectors of eight.
void evaluate_narrow(std::uint8_t parts, const FrontPriorities::Numbers& numbers,
                     const Nodes& nodes);
void evaluate_run(std::uint8_t parts, const FrontPriorities::Numbers& numbers,
                  const FrontTables& tables, const Run& run);

/// Of the nodes of `among` those whose priority is above `tolerance`, into `above`.
void find_above(std::span<const std::uint64_t> among, std::span<const float> priorities,
                float tolerance, std::span<std::uint64_t> above);
/// Adds the nodes of `among`, but not of `except`, with `above` < priority <= `up_to`, ascending.
struct Window {
  float above, up_to;
};
void collect(std::span<const std::uint64_t> among, std::span<const std::uint64_t> except,
             std::span<const float> priorities, const Window& window,
             std::vector<std::uint32_t>& nodes);

}  // namespace varifold::front_lanes
