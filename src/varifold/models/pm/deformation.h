// What moves a progressive mesh, as bytes of their own beside its stream: skin, poses and rig.
#pragma once

#include <varifold/base/result.h>
#include <varifold/models/pm/progressive_mesh.h>
#include <cstddef>
#include <span>
#include <vector>

namespace varifold {

/// Skin, poses and rig of the model, as floats; empty where it has none. Vertex by vertex in the
/// order of their coming, so that a part of the bytes holds a coarser level. The model must not
/// move vertices back, as simplify() has it of meshes with poses or a skin.
/// Described in docs/formats/progressive_mesh.md. O(vertices * poses).
[[nodiscard]] std::vector<std::byte> encode_deformation(const ProgressiveMesh& model);

/// The model with what encode_deformation() wrote of it, or of the model that it is a part of: the
/// bytes may end behind the vertices that it has. Errors: kInvalidInput with the offset of the
/// fault. Accepts any bytes; allocates no more than they justify. O(bytes).
[[nodiscard]] Result<ProgressiveMesh> decode_deformation(std::span<const std::byte> bytes,
                                                         ProgressiveMesh model);

}  // namespace varifold
