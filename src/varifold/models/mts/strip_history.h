// The states of one strip, recorded as a graph while they change.
#pragma once

#include <varifold/models/mts/multiresolution_strips.h>
#include <varifold/models/mts/strip_reduction.h>
#include <cstdint>
#include <vector>

namespace varifold::mts {

/// Nodes are made in the order of time, and stand in a list in which every state is a sublist; the
/// list's order is their number in the model, so that all arcs go forward.
class StripHistory {
 public:
  /// Begins with an empty strip; its first state is set by the first advance().
  StripHistory();

  [[nodiscard]] const std::vector<StripItem>& items() const { return items_; }

  /// The strip is `items` from `level` downwards. Nodes of the present state that stay are named;
  /// new ones get nodes, among them such as may stand for the same vertex already. Nothing happens
  /// where the state is the same. Amortised O(length).
  void advance(std::uint32_t level, std::vector<StripItem>& items);

  /// Whether the next state, of at most as many items, and an end fit into a graph of that size.
  [[nodiscard]] bool has_room(std::uint32_t largest_graph) const;

  /// Appends the graph and its slot of the index buffer to the model; the state of the strip stays
  /// to level 0. False, and nothing done, where no state draws anything.
  bool append_to(MultiresolutionStripsData& data) const;

 private:
  struct Arc {
    std::uint32_t from, to, last;
  };
  void take_over_nodes(std::vector<StripItem>& items) const;
  void link(std::uint32_t from, std::uint32_t to, std::uint32_t state);
  void leave(std::uint32_t node, std::uint32_t state);
  [[nodiscard]] std::vector<std::uint32_t> ordered_numbers() const;

  static constexpr std::uint32_t kStart = 0;
  static constexpr std::uint32_t kEnd = 1;
  std::vector<std::uint32_t> vertex_;  // per node
  std::vector<std::uint32_t> next_;    // per node, the next of the list
  std::vector<std::uint32_t> arc_;     // per node, the arc that it follows now, or kNone
  std::vector<Arc> arcs_;
  std::vector<std::uint32_t> changes_;  // levels
  std::vector<StripItem> items_;
  std::uint32_t longest_ = 0;
};

}  // namespace varifold::mts
