#include <varifold/models/strips/strip_framework.h>

#include <varifold/mesh/vertex_arrays.h>
#include <algorithm>
#include <utility>

namespace varifold {

StripFramework::StripFramework(StripFrameworkData data, TriangleStrips strips)
    : data_(std::move(data)),
      first_slot_(std::move(strips.first)),
      strip_range_(std::move(strips.range)) {
  std::vector<std::uint32_t> own(data_.mesh.vertex_count(), 0);
  for (const std::uint32_t v : strips.indices) ++own[v];
  records_ = nested_ranges(data_.levels.targets(), own);
  slots_.resize(strips.indices.size());
  std::vector<std::uint32_t>& cursor = own;
  for (std::size_t v = 0; v < own.size(); ++v) cursor[v] = records_[v].begin;
  for (std::uint32_t slot = 0; slot < strips.indices.size(); ++slot)
    slots_[cursor[strips.indices[slot]]++] = slot;
}

std::span<const std::uint32_t> StripFramework::slivers_of(std::uint32_t strip) const {
  const auto begin =
      std::lower_bound(data_.slivers.begin(), data_.slivers.end(), first_slot_[strip]);
  const auto end = std::lower_bound(begin, data_.slivers.end(), first_slot_[strip + 1]);
  return {begin, end};
}

TriangleStrips StripFramework::full_strips() const {
  TriangleStrips strips;
  strips.first = first_slot_;
  strips.range = strip_range_;
  strips.indices.resize(slots_.size());
  // A vertex' own slots come first in its range: what is left when its children's are taken away.
  std::vector<std::uint32_t> own(records_.size());
  for (std::size_t v = records_.size(); v-- > 0;) {
    own[v] += records_[v].count;
    const std::uint32_t target = data_.levels.target(static_cast<std::uint32_t>(v));
    if (target != kNone) own[target] -= records_[v].count;
  }
  for (std::uint32_t v = 0; v < records_.size(); ++v)
    for (const std::uint32_t slot : records(v).first(own[v])) strips.indices[slot] = v;
  return strips;
}

std::uint64_t StripFramework::record_count() const {
  std::uint64_t count = 0;
  for (std::size_t v = 0; v < records_.size(); ++v)
    if (data_.levels.target(static_cast<std::uint32_t>(v)) != kNone) count += records_[v].count;
  return count;
}

std::size_t StripFramework::bytes() const {
  const std::size_t words = data_.dependencies.size() + data_.radius.size() + data_.cone.size() +
                            data_.slivers.size() + first_slot_.size() + strip_range_.size() +
                            slots_.size();
  return vertex_bytes(data_.mesh) + data_.levels.bytes() + words * sizeof(std::uint32_t) +
         data_.error_codes.size() * sizeof(std::uint16_t) + records_.size() * sizeof(NestedRange);
}

}  // namespace varifold
