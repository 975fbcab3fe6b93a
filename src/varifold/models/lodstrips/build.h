// From a numbered mesh to its LodStrips.
#pragma once

#include <varifold/models/lodstrips/lod_strips.h>
#include <varifold/simplify/collapse_sequence.h>

namespace varifold {

struct LodStripsOptions {
  LodStripsForm form = LodStripsForm::kBlocks;
};

/// One replay of the sequence, which must not move vertices (Placement::kKept). O(n).
[[nodiscard]] LodStrips build_lod_strips(const DetailedMesh& detailed,
                                         const LodStripsOptions& options = {});

}  // namespace varifold
