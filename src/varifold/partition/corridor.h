// The neighbourhood of a stretch of border, and the shortest path through it.
#pragma once

#include <varifold/partition/border_stretches.h>
#include <varifold/partition/edge_links.h>
#include <varifold/partition/surface_view.h>
#include <atomic>
#include <cstdint>
#include <span>
#include <vector>

namespace varifold {

/// A surface with patches that change hands triangle by triangle. Threads may work on stretches
/// that have no patch in common; what they read of other patches is never decisive.
struct PatchedSurface {
  const SurfaceView& surface;
  const EdgeLinks& links;
  std::span<std::uint32_t> patch_of;
  BorderStretches& borders;
  LargeVector<std::uint32_t> node_of;  ///< per inner point of a corridor: its node; else kNone

  [[nodiscard]] std::uint32_t patch(std::uint32_t triangle) const {
    return std::atomic_ref<std::uint32_t>(patch_of[triangle]).load(std::memory_order_relaxed);
  }
  void set_patch(std::uint32_t triangle, std::uint32_t patch) const {
    std::atomic_ref<std::uint32_t>(patch_of[triangle]).store(patch, std::memory_order_relaxed);
  }
};

/// The points of a stretch and all points adjacent to them that are inside its two patches: free to
/// become part of the path. Reused from stretch to stretch.
class Corridor {
 public:
  /// Looks for a path from end to end that is shorter than the stretch by more than rounding.
  /// Where there is one, its points are in path(). Call clear() afterwards.
  [[nodiscard]] bool find_shorter(PatchedSurface& patched, std::uint32_t stretch);
  void clear(PatchedSurface& patched);

  [[nodiscard]] const std::vector<std::uint32_t>& path() const { return path_; }

  /// Where a point stands in the old and in the new path; kNone: not there.
  struct Places {
    std::uint32_t in_old = kNone, in_new = kNone;
  };
  [[nodiscard]] Places places(const PatchedSurface& patched, std::uint32_t point) const {
    const std::uint32_t node = node_at(patched, point);
    return node == kNone ? Places{} : Places{nodes_[node].in_old, nodes_[node].in_new};
  }
  /// A half-edge with an end at the point, in one of the two patches, beside the stretch.
  [[nodiscard]] std::uint32_t spoke(const PatchedSurface& patched, std::uint32_t point) const {
    return nodes_[node_at(patched, point)].spoke;
  }

 private:
  struct Node {
    std::uint32_t point = 0, spoke = kNone, parent = kNone;
    std::uint32_t in_old = kNone, in_new = kNone;
    float distance = 0;   // from the start of the stretch
    float remaining = 0;  // at least so far to its end
    bool is_settled = false;
  };
  struct Entry {
    float key;
    std::uint32_t node;
  };

  [[nodiscard]] std::uint32_t node_at(const PatchedSurface& patched, std::uint32_t point) const {
    if (point == nodes_[0].point) return 0;
    if (point == nodes_[1].point) return 1;
    return patched.node_of[point];
  }
  void collect(PatchedSurface& patched);
  void add(PatchedSurface& patched, std::uint32_t point, std::uint32_t spoke);
  void find_end_spoke(const PatchedSurface& patched, std::uint32_t node, std::uint32_t neighbor);
  template <class Visit>
  void for_each_neighbor(const PatchedSurface& patched, std::uint32_t point, std::uint32_t spoke,
                         const Visit& visit) const;
  [[nodiscard]] bool search(const PatchedSurface& patched);
  void relax(std::uint32_t from, std::uint32_t to, float length);

  std::uint32_t stretch_ = 0, a_ = 0, b_ = 0;
  float old_length_ = 0;
  std::vector<Node> nodes_;  // the ends of the stretch first
  std::vector<Entry> heap_;
  std::vector<std::uint32_t> path_;
};

}  // namespace varifold
