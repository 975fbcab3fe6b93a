// Draw ranges of strips that change their lengths.
#pragma once

#include <varifold/mesh/triangle_mesh.h>
#include <varifold/models/lodstrips/strip_slots.h>
#include <varifold/view/draw_list.h>
#include <cstdint>
#include <span>
#include <vector>

namespace varifold {

/// One range per strip that draws something. Allocates in its constructor only.
class StripRanges {
 public:
  /// `attributes` names the materials. `strips` must outlive this.
  StripRanges(const TriangleStrips& strips, const TriangleMesh& attributes)
      : first_(strips.first.data()) {
    materials_.reserve(strips.count());
    for (const std::uint32_t range : strips.range)
      materials_.push_back(attributes.ranges.empty() ? 0 : attributes.ranges[range].material);
    ranges_.reserve(strips.count());
  }

  /// `lengths` per strip. O(strips).
  [[nodiscard]] std::span<const DrawRange> update(std::span<const std::uint32_t> lengths) {
    ranges_.clear();
    for (std::uint32_t s = 0; s < lengths.size(); ++s)
      if (lengths[s] >= kLeastStrip)
        ranges_.push_back({first_[s], lengths[s], Primitive::kStrips, materials_[s]});
    return ranges_;
  }
  [[nodiscard]] std::size_t bytes() const {
    return materials_.size() * sizeof(std::uint32_t) + ranges_.capacity() * sizeof(DrawRange);
  }

 private:
  const std::uint32_t* first_;
  std::vector<std::uint32_t> materials_;
  std::vector<DrawRange> ranges_;
};

}  // namespace varifold
