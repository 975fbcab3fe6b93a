// Fewer indices by linking strips whose ends meet.
#pragma once

#include <varifold/strip/strip_paths.h>
#include <cstdint>
#include <vector>

namespace varifold {

/// Joins two strips where an end of one touches an end of the other and the swaps that this takes
/// cost less than a strip; best gains first. Then reaches ends that do not touch: an end takes over
/// the rest of a strip beside it, whose other part is joined to the end of a third (a tunnel).
/// `in_strip` is 0 for triangles that are in no strip. O(n) in practice.
void join_paths(StripPaths& paths, const std::vector<std::uint8_t>& in_strip);

}  // namespace varifold
