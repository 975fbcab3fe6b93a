// Finds equal corners of faces: a hash table from (position, texture coordinate, normal) to vertex.
#pragma once

#include <varifold/base/math.h>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace varifold {

/// Indices into the lists of a file; kNone where a corner has no such attribute.
struct Wedge {
  std::uint32_t position = kNone;
  std::uint32_t texcoord = kNone;
  std::uint32_t normal = kNone;
  friend bool operator==(const Wedge&, const Wedge&) = default;
};

/// Numbers distinct wedges in the order of first use. Open addressing; O(1) expected.
class WedgeTable {
 public:
  /// The number of the wedge, which is new where size() grew.
  std::uint32_t find_or_add(const Wedge& wedge) {
    if (2 * (wedges_.size() + 1) > slots_.size()) grow();
    std::uint32_t* const slot = find_slot(wedge);
    if (*slot == kNone) {
      *slot = static_cast<std::uint32_t>(wedges_.size());
      wedges_.push_back(wedge);
    }
    return *slot;
  }
  [[nodiscard]] const std::vector<Wedge>& wedges() const { return wedges_; }

 private:
  std::uint32_t* find_slot(const Wedge& wedge) {
    const std::size_t mask = slots_.size() - 1;
    std::size_t at = hash(wedge) & mask;
    while (slots_[at] != kNone && !(wedges_[slots_[at]] == wedge)) at = (at + 1) & mask;
    return &slots_[at];
  }
  static std::size_t hash(const Wedge& wedge) {
    std::uint64_t h = wedge.position * 0x9e3779b97f4a7c15u;
    h = (h ^ (h >> 29) ^ wedge.texcoord) * 0xbf58476d1ce4e5b9u;
    h = (h ^ (h >> 32) ^ wedge.normal) * 0x94d049bb133111ebu;
    return static_cast<std::size_t>(h ^ (h >> 31));
  }
  void grow() {
    slots_.assign(slots_.empty() ? 1024 : 2 * slots_.size(), kNone);
    for (std::uint32_t i = 0; i < wedges_.size(); ++i) *find_slot(wedges_[i]) = i;
  }

  std::vector<Wedge> wedges_;
  std::vector<std::uint32_t> slots_;  ///< a power of two, at most half full
};

}  // namespace varifold
