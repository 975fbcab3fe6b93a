// Rows: strips that turn left and right in turn, found over the whole mesh before any is taken.
#pragma once

#include <varifold/strip/strip_paths.h>
#include <cstdint>
#include <vector>

namespace varifold {

/// Links the longest rows of free triangles first, down to rows of `least` triangles, and sets
/// `taken` for theirs. Every triangle lies on three rows; what a row loses to another that crosses
/// it makes it shorter, or two of it. O(n) in practice.
void link_rows(StripPaths& paths, std::vector<std::uint8_t>& taken, std::uint32_t least);

}  // namespace varifold
