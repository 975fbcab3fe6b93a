// The shortest path from end to end of a stretch of border.
#pragma once

#include <varifold/partition/border_stretches.h>
#include <varifold/partition/edge_links.h>
#include <varifold/partition/surface_view.h>
#include <array>
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

/// The points inside the two patches of a stretch and those of the stretch itself: free to become
/// part of the path. Only those are looked at that a shorter path may lead through. Reused from
/// stretch to stretch.
class Corridor {
 public:
  /// Looks for a path from end to end that is shorter than the stretch by more than rounding.
  /// Where there is one, its points are in path(). Call clear() afterwards.
  [[nodiscard]] bool find_shorter(PatchedSurface& patched, std::uint32_t stretch);
  void clear(PatchedSurface& patched);
  /// After a search in vain: whether it met another stretch that may move out of the way.
  [[nodiscard]] bool is_blocked() const { return is_blocked_; }

  [[nodiscard]] const std::vector<std::uint32_t>& path() const { return path_; }

  /// Where a point stands in the old and in the new path; kNone: not there.
  struct Places {
    std::uint32_t in_old = kNone, in_new = kNone;
  };
  [[nodiscard]] Places places(const PatchedSurface& patched, std::uint32_t point) const {
    const std::uint32_t node = node_at(patched, point);
    return node == kNone ? Places{} : Places{nodes_[node].in_old, nodes_[node].in_new};
  }
  /// Half-edges on the first and the last edge of the new path.
  [[nodiscard]] std::array<std::uint32_t, 2> end_spokes() const { return end_spokes_; }
  /// A half-edge with an end at the point, in one of the two patches, beside the stretch.
  [[nodiscard]] std::uint32_t spoke(const PatchedSurface& patched, std::uint32_t point) const {
    return nodes_[node_at(patched, point)].spoke;
  }

 private:
  struct Node {
    std::uint32_t point = 0, spoke = kNone, parent = kNone;
    std::uint32_t via = kNone;  // a half-edge on the edge from the parent
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
  void add_path(PatchedSurface& patched);
  [[nodiscard]] std::uint32_t reach(PatchedSurface& patched, std::uint32_t point,
                                    std::uint32_t spoke);
  template <class Visit>
  void for_each_neighbor(const PatchedSurface& patched, std::uint32_t point, std::uint32_t spoke,
                         const Visit& visit) const;
  [[nodiscard]] bool search(PatchedSurface& patched);
  [[nodiscard]] bool is_promising(const PatchedSurface& patched, std::uint32_t point) const;
  void look_beyond(const PatchedSurface& patched, std::uint32_t end);
  void relax(std::uint32_t from, std::uint32_t to, float length, std::uint32_t via);

  std::uint32_t stretch_ = 0, a_ = 0, b_ = 0;
  float old_length_ = 0;
  bool is_blocked_ = false;
  std::vector<Node> nodes_;  // the ends of the stretch first
  std::vector<Entry> heap_;
  std::vector<std::uint32_t> path_;
  std::array<std::uint32_t, 2> end_spokes_{};
};

}  // namespace varifold
