// From a numbered mesh to its LodStrips.
#pragma once

#include <varifold/models/lodstrips/lod_strips.h>
#include <varifold/models/lodstrips/static_build.h>
#include <varifold/simplify/collapse_sequence.h>
#include <varifold/strip/stripify.h>
#include <varifold/strip/triangle_strips.h>

namespace varifold {

struct LodStripsOptions {
  LodStripsForm form = LodStripsForm::kBlocks;
  /// How the strips of the other forms are made.
  StripifyOptions stripify{.max_indices = kStaticStripIndices};
};

/// From a sequence that does not move vertices (Placement::kKept). O(n).
[[nodiscard]] LodStrips build_lod_strips(const DetailedMesh& detailed,
                                         const LodStripsOptions& options = {});

/// The same with given strips of the full level, by material ranges. The form of blocks makes its
/// own and does not look at them.
[[nodiscard]] LodStrips build_lod_strips(const DetailedMesh& detailed, LodStripsForm form,
                                         const TriangleStrips& full_strips);

}  // namespace varifold
