// The vertices of a front in a vertex buffer of their own.
#pragma once

#include <varifold/base/math.h>
#include <varifold/mesh/triangle_mesh.h>
#include <varifold/models/vdpm/dirty_pages.h>
#include <varifold/view/draw_list.h>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace varifold {

/// Each active vertex has a slot of the buffer, which it keeps; slots of vertices that go are used
/// again. 4 bytes a vertex of the model, and the attributes of the most that were active at once.
class ActiveVertices {
 public:
  /// None is active. `attributes` tells how many there are and what they have.
  explicit ActiveVertices(const TriangleMesh& attributes);

  [[nodiscard]] bool is_active(std::uint32_t vertex) const { return slot_of_[vertex] != kNone; }
  /// Of an active vertex.
  [[nodiscard]] std::uint32_t slot(std::uint32_t vertex) const { return slot_of_[vertex]; }
  [[nodiscard]] std::uint32_t count() const {
    return slots() - static_cast<std::uint32_t>(free_.size());
  }
  /// Size of the buffer; some slots may be free.
  [[nodiscard]] std::uint32_t slots() const {
    return static_cast<std::uint32_t>(buffer_.positions.size());
  }

  /// An inactive vertex gets a slot, with the attributes `index` of `from`; which slot depends on
  /// what was added and removed before. Returns it. O(1) amortised.
  std::uint32_t add(std::uint32_t vertex, const TriangleMesh& from, std::uint32_t index) {
    std::uint32_t slot = 0;
    if (free_.empty()) {
      slot = new_slot();
    } else {
      slot = free_.back();
      free_.pop_back();
    }
    slot_of_[vertex] = slot;
    write(slot, from, index);
    return slot;
  }
  void remove(std::uint32_t vertex) {
    free_.push_back(slot_of_[vertex]);  // has room for all slots
    slot_of_[vertex] = kNone;
  }
  void write(std::uint32_t slot, const TriangleMesh& from, std::uint32_t index) {
    buffer_.positions[slot] = from.positions[index];
    if (has_more_) write_more(slot, from, index);
    dirty_.mark(slot);
  }

  /// Moves a slot toward the attributes `index` of `goal`, by the n-th part of what is left; with
  /// n = 1 it has them, byte for byte. Normals keep a length of 1, of joints the weights are mixed
  /// (mix_joints). `goal` may be buffer().
  void approach(std::uint32_t slot, const TriangleMesh& goal, std::uint32_t index,
                std::uint32_t n) {
    if (n == 1) {
      write(slot, goal, index);
      return;
    }
    const float part = 1 / static_cast<float>(n);
    Vec3& position = buffer_.positions[slot];
    position += part * goal.positions[index] - part * position;  // no overflow
    if (has_more_) approach_more(slot, goal, index, part);
    dirty_.mark(slot);
  }

  void reserve(std::uint32_t vertices);
  /// The attributes, by slot; no indices.
  [[nodiscard]] const TriangleMesh& buffer() const { return buffer_; }
  /// What was written since the last call. Valid until the next.
  [[nodiscard]] std::span<const ElementRange> take_changed() { return dirty_.take(slots(), 1); }
  [[nodiscard]] std::size_t bytes() const;

 private:
  template <class Visit>
  void for_each_used(const Visit& visit);
  std::uint32_t new_slot();
  void write_more(std::uint32_t slot, const TriangleMesh& from, std::uint32_t index);
  void approach_more(std::uint32_t slot, const TriangleMesh& goal, std::uint32_t index, float part);

  TriangleMesh buffer_;
  std::vector<bool> is_used_;  // the arrays of the mesh, in the order of for_each_vertex_array()
  bool has_more_ = false;      // than positions
  std::vector<std::uint32_t> slot_of_;  // per vertex of the model
  std::vector<std::uint32_t> free_;
  DirtyPages dirty_;
};

}  // namespace varifold
