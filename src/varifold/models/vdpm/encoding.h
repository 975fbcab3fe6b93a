// The byte form of a view-dependent mesh; described in docs/formats/view_dependent_mesh.md.
#pragma once

#include <varifold/base/result.h>
#include <varifold/models/vdpm/view_dependent_mesh.h>
#include <cstddef>
#include <span>
#include <vector>

namespace varifold {

/// decode_view_dependent_mesh() gives the same model, byte for byte. About 36 bytes a vertex with
/// positions alone. O(n).
[[nodiscard]] std::vector<std::byte> encode_view_dependent_mesh(const ViewDependentMesh& model);

/// Errors: kInvalidInput with the offset of the fault. Accepts any bytes: no more is allocated than
/// they justify, and steps of a model that is returned may be split and collapsed in any order that
/// its requirements allow. Those are found anew from the sequence: O(n) expected. The same for any
/// number of threads (0 = all).
[[nodiscard]] Result<ViewDependentMesh> decode_view_dependent_mesh(std::span<const std::byte> bytes,
                                                                   int threads = 0);

}  // namespace varifold
