// LodStrips over strips that were made once, of the full mesh.
#pragma once

#include <varifold/models/lodstrips/grouped_form.h>
#include <varifold/models/lodstrips/thesis_form.h>
#include <varifold/simplify/collapse_sequence.h>
#include <varifold/strip/triangle_strips.h>
#include <cstdint>

namespace varifold {

/// A good StripifyOptions::max_indices for these forms: shifts stay short, and so few strips are
/// cut that it costs one index in a hundred.
inline constexpr std::uint32_t kStaticStripIndices = 64;

/// `full_strips` are of detailed.mesh, as by stripify(). Strips are cut where they have more than
/// kMostStrip indices, and where a triangle vanishes at a seam (static_removal.h). O(n), and a scan
/// of every strip that a collapse touches, so that long strips are slow.
[[nodiscard]] ThesisForm build_thesis_form(const DetailedMesh& detailed,
                                           const TriangleStrips& full_strips);
/// The same levels in grouped records.
[[nodiscard]] GroupedForm build_grouped_form(const DetailedMesh& detailed,
                                             const TriangleStrips& full_strips);

}  // namespace varifold
