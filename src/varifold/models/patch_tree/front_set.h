// The nodes of a patch tree that are split.
//
// Based on: [Birkholz2007] section 4.
// Differs: marks are bits; a count of dependants says when a node may be merged.
#pragma once

#include <varifold/models/patch_tree/front_bits.h>
#include <varifold/models/patch_tree/front_priorities.h>
#include <varifold/models/patch_tree/front_scan.h>
#include <varifold/models/patch_tree/front_tables.h>
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace varifold {

/// Says which nodes may be split because all of their children are in memory.
struct ResidentChildren {
  /// Null: all are. Must be pure while a front is chosen.
  bool (*are_resident)(const void* context, std::uint32_t node) = nullptr;
  const void* context = nullptr;

  [[nodiscard]] bool of(std::uint32_t node) const {
    return are_resident == nullptr || are_resident(context, node);
  }
};

/// A closed set of split inner nodes, with the priorities of all inner nodes that exist: roots and
/// children of split nodes. Nodes that are split are wanted or forced: required by others, directly
/// or not. Allocates in the constructor, and where a chain is longer than any before.
class FrontSet {
 public:
  explicit FrontSet(const FrontTables& tables);

  [[nodiscard]] bool is_split(std::uint32_t node) const { return front_bits::has(split_, node); }
  [[nodiscard]] bool is_wanted(std::uint32_t node) const { return front_bits::has(wanted_, node); }
  [[nodiscard]] float priority(std::uint32_t node) const { return priorities_[node]; }
  /// Of the front: the nodes that exist and are not split.
  [[nodiscard]] std::uint64_t triangles() const { return triangles_; }
  [[nodiscard]] std::uint32_t split_count() const { return split_count_; }
  [[nodiscard]] std::span<const std::uint64_t> split() const { return split_; }
  /// The words of split() where something may have changed since forget_changes().
  [[nodiscard]] std::span<const std::uint64_t> changed_words() const { return changed_; }
  void forget_changes() { std::fill(changed_.begin(), changed_.end(), 0); }
  /// Split nodes that require the node.
  [[nodiscard]] std::uint32_t dependants(std::uint32_t node) const { return dependants_[node]; }
  [[nodiscard]] std::uint32_t forced_count() const;

  /// Nothing is split any more. O(split nodes).
  void reset();
  /// Priorities of all that exists. O(existing nodes).
  void evaluate(const FrontPriorities& priorities) {
    priorities.evaluate({*tables_, words_, exists_, priorities_});
  }

  /// Wanted are the split nodes with a priority above `tolerance`; all others that are not forced
  /// are merged. What requires a node whose children are not resident is neither.
  void keep_above(float tolerance, const ResidentChildren& resident);

  /// Collects in chain() what splitting a node needs to split: the node and all that it requires,
  /// in an order in which they may be split. False where the children of one are not resident.
  [[nodiscard]] bool gather(std::uint32_t node, const ResidentChildren& resident);
  [[nodiscard]] std::span<const std::uint32_t> chain() const { return chain_; }
  /// Triangles that splitting the chain adds.
  [[nodiscard]] std::uint64_t chain_growth() const;

  /// The node exists and all that it requires is split. The priorities of its children are
  /// evaluated.
  void split(std::uint32_t node, const FrontPriorities& priorities);
  void want(std::uint32_t node) { front_bits::add(wanted_, node); }
  /// A wanted node; it is merged unless others require it, and with it what it alone required.
  void unwant(std::uint32_t node);

  /// Existing nodes that are not wanted, or those that are, with above < priority <= up_to, by
  /// ascending number.
  void collect_unwanted(float above, float up_to, std::vector<std::uint32_t>& nodes) const;
  void collect_wanted(float above, float up_to, std::vector<std::uint32_t>& nodes) const;
  /// Existing nodes that are not split, with a priority above `tolerance`.
  void collect_unsplit(float tolerance, std::vector<std::uint32_t>& nodes) const;

  [[nodiscard]] std::size_t bytes() const;

 private:
  using Bits = std::vector<std::uint64_t>;
  // For split_, exists_ and wanted_; the other sets belong to functions.
  [[nodiscard]] front_scan::Among among(const Bits& nodes) const {
    return {words_, nodes, priorities_};
  }
  void add_roots();
  void add_existing(std::uint32_t first, std::uint32_t end);
  void remove_existing(std::uint32_t first, std::uint32_t end);
  void unwant_blocked(const ResidentChildren& resident);
  void merge(std::uint32_t node);

  const FrontTables* tables_;
  Bits split_, exists_, wanted_, blocked_, gathered_;
  Bits words_, changed_;  // sets of words: where nodes exist; where split_ has changed
  std::vector<std::uint32_t> dependants_;
  std::vector<float> priorities_;
  std::uint64_t triangles_ = 0;
  std::uint32_t split_count_ = 0;
  std::vector<std::uint32_t> chain_, leaving_;
};

}  // namespace varifold
