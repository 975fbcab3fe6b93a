// The byte form of a patch tree; described in docs/formats/patch_tree.md.
//
// Based on: [Birkholz2007] section 3.
// Differs: every patch is one run of bytes, coarse levels first, so that patches can be read one by
//   one, each after its ancestors.
#pragma once

#include <varifold/base/result.h>
#include <varifold/models/patch_tree/patch_tree.h>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace varifold {

/// decode_patch_tree() gives the same model. About 26 bytes a triangle of the input with positions
/// alone. O(n).
[[nodiscard]] std::vector<std::byte> encode_patch_tree(const PatchTree& tree);

/// Whether the checksums of head and blocks are compared; those of a container hold for them, too.
enum class Checksums : std::uint8_t { kVerify, kTrust };

/// Errors: kInvalidInput with the offset of the fault. Accepts any bytes: no more is allocated than
/// they justify, and of a tree that is returned every front can be chosen and drawn. O(n).
[[nodiscard]] Result<PatchTree> decode_patch_tree(std::span<const std::byte> bytes,
                                                  Checksums checksums = Checksums::kVerify);

// The parts, for those who read patches one by one.

/// All of a tree but what stands in the blocks of its patches.
struct PatchTreeHead {
  /// Materials and images; which attributes vertices have, of which there are none yet.
  std::vector<Material> materials;
  std::vector<Image> images;
  bool has_normals = false, has_texcoords = false, has_colors = false, has_skin = false;
  std::vector<Pose> poses;               ///< names alone
  std::vector<bool> poses_have_normals;  ///< one for each
  std::shared_ptr<const Rig> rig;        ///< or null
  PatchTopology topology;
  std::vector<PatchBounds> bounds;
  std::vector<PatchOffsets> offsets;
  /// Per node, and one more: where its block begins, counted from the tag, where the head begins.
  std::vector<std::uint64_t> first_byte;
  std::vector<std::uint32_t> checksums;  ///< per node: of its block

  [[nodiscard]] std::uint32_t vertex_count_of(std::uint32_t node) const {
    return offsets[node + 1].vertex - offsets[node].vertex;
  }
  [[nodiscard]] std::uint32_t triangle_count_of(std::uint32_t node) const {
    return offsets[node + 1].triangle - offsets[node].triangle;
  }
};

/// So many bytes tell how large the head is.
inline constexpr std::size_t kPatchTreePrefix = 16;
/// The size of the head, those bytes included. Errors: kInvalidInput.
[[nodiscard]] Result<std::uint64_t> patch_tree_head_bytes(std::span<const std::byte> bytes);

/// `bytes` are at least the head. Topology, bounds and counts of what is returned are sound.
/// Errors: kInvalidInput. O(nodes log neighbours).
[[nodiscard]] Result<PatchTreeHead> decode_patch_tree_head(
    std::span<const std::byte> bytes, Checksums checksums = Checksums::kVerify);

/// Where what is in a block goes; all of the sizes that the head says, those of attributes that
/// are not there empty.
struct PatchArrays {
  std::span<Vec3> positions, normals;
  std::span<Vec2> texcoords;
  std::span<Color> colors;
  std::span<std::uint16_t> survivors, corners;
  std::span<std::uint8_t> controllers;
  std::span<PatchRange> ranges;
  std::span<JointWeights> skin;
  /// All poses of the head; their arrays have room for the vertices from `first_in_poses` on.
  std::span<Pose> poses;
  std::size_t first_in_poses = 0;
};

/// Reads a block, [first_byte[node], first_byte[node + 1]) of all bytes. Of other nodes it needs
/// nothing but the head. Errors: kInvalidInput, with offsets counted in all bytes. Allocates
/// nothing but messages. O(size of the block).
[[nodiscard]] Result<void> decode_patch(const PatchTreeHead& head, std::uint32_t node,
                                        std::span<const std::byte> block, const PatchArrays& to,
                                        Checksums checksums = Checksums::kVerify);

}  // namespace varifold
