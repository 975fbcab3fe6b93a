// Finding the keys that are due: the only work that each frame does for all of the front.
#pragma once

#include <varifold/models/vdpm/odometers.h>
#include <cstdint>
#include <span>
#include <vector>

namespace varifold {

/// The places of the keys that are due, ascending; with vector instructions where the processor has
/// them. `room` is where they lie; it is never made smaller. O(keys).
[[nodiscard]] std::span<const std::uint32_t> find_due_keys(std::span<const float> keys,
                                                           const Odometers& odometers,
                                                           std::vector<std::uint32_t>& room);
/// Without; the same result.
[[nodiscard]] std::span<const std::uint32_t> find_due_keys_plain(std::span<const float> keys,
                                                                 const Odometers& odometers,
                                                                 std::vector<std::uint32_t>& room);

}  // namespace varifold
