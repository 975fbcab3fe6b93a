// Whether the changes of a block form, read from outside, can be played.
#pragma once

#include <varifold/models/lodstrips/block_form.h>

namespace varifold {

/// Plays all changes forward with every bound checked: no block may grow beyond its size or into
/// another, every change must be one that its inverse undoes, every index must be a vertex of the
/// level. Then playing them, in any order of levels, needs no checks. What is wrong, or nothing.
/// O(records + buffer) time and memory.
[[nodiscard]] const char* check_block_form(const BlockForm& form, const LevelTable& levels);

}  // namespace varifold
