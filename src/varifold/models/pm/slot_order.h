// One model has one form: the slots of every new vertex ascend.
#pragma once

#include <varifold/models/pm/progressive_mesh.h>
#include <algorithm>
#include <cstdint>
#include <vector>

namespace varifold {

/// Sorts ProgressiveMeshData::slots within each new vertex.
inline void sort_slots(std::vector<std::uint32_t>& slots) {
  constexpr std::uint32_t kLastSlot = ProgressiveMeshData::kLastSlot;
  auto first = slots.begin();
  for (auto at = slots.begin(); at != slots.end(); ++at) {
    if ((*at & kLastSlot) == 0) continue;
    *at &= ~kLastSlot;
    std::sort(first, at + 1);
    *at |= kLastSlot;
    first = at + 1;
  }
}

}  // namespace varifold
