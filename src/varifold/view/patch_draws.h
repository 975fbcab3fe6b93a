// PatchDrawList: what a model of patches gives to whatever draws it without rewriting indices.
#pragma once

#include <varifold/mesh/pose.h>
#include <cstddef>
#include <cstdint>
#include <span>

namespace varifold {

/// Where a vertex is drawn when its border is switched: a vertex of the parent's patch, counted in
/// that, and the bit of PatchDrawCommand::mask that says so.
using PatchRemap = std::uint32_t;
inline constexpr std::uint32_t kPatchNeverMoves = 32;  ///< a bit that no mask has

[[nodiscard]] constexpr PatchRemap patch_remap(std::uint32_t survivor, std::uint32_t bit) {
  return survivor | bit << 16u;
}

/// The vertex whose attributes are drawn for vertex `v`, as the vertex shader finds it.
[[nodiscard]] constexpr std::uint32_t switched_vertex(std::uint32_t v, PatchRemap remap,
                                                      std::uint32_t parent_vertex,
                                                      std::uint32_t mask) {
  const std::uint32_t bit = remap >> 16u;
  const bool moves = bit < kPatchNeverMoves && (mask >> bit & 1u) != 0;
  return moves ? parent_vertex + (remap & 0xffffu) : v;
}

/// A patch as the device reads it: an indexed indirect command, laid out as OpenGL, Vulkan and
/// Direct3D 12 take it, and behind that what the vertex shader needs to know. 40 bytes.
struct PatchDrawCommand {
  std::uint32_t index_count = 0;  ///< 0: nothing is drawn
  std::uint32_t instance_count = 1;
  std::uint32_t first_index = 0;
  std::uint32_t first_vertex = 0;   ///< is added to all indices
  std::uint32_t draw = 0;           ///< its own number: the instance that it is
  std::uint32_t parent_vertex = 0;  ///< the first vertex of the parent's patch
  std::uint32_t mask = 0;           ///< which borders are switched
  std::uint32_t material = 0;
  std::uint32_t patch = 0;  ///< names the patch as long as the model lives; for colours
  float level = 0;          ///< 0 (coarsest) to 1 (finest); only for show
};
static_assert(sizeof(PatchDrawCommand) == 40);
static_assert(offsetof(PatchDrawCommand, parent_vertex) == 20);

/// How a vertex blends into what the next coarser patches have in its place (patch_morph.h).
struct PatchMorph {
  std::uint32_t target = 0;  ///< a vertex, counted in all; the vertex itself where it never moves
  /// While this length covers up to so many pixels, the vertex stands at its target; model units.
  float error = 0;
};

/// Spans over arrays that a model or an instance owns. All but `draws` and `changed_draws` are the
/// same for as long as the model lives; those are valid until the instance changes.
///
/// `normals`, `texcoords` and `colors` are empty or have one entry per position, `remap` has one
/// per position, `morphs` too or is empty: then there is nothing to blend. `changed_draws` has the
/// draws that are others than in the previous list of the same instance, each once, in any order;
/// draws beyond the end of that list are new, whether they are named or not. Whoever saw no
/// previous list takes everything.
struct PatchDrawList {
  std::span<const Vec3> positions;
  std::span<const Vec3> normals;
  std::span<const Vec2> texcoords;
  std::span<const Color> colors;
  std::span<const JointWeights> skin;
  std::span<const Pose> poses;
  std::span<const PatchRemap> remap;
  std::span<const PatchMorph> morphs;
  std::span<const std::uint16_t> indices;  ///< three per triangle, counted in the patch
  std::span<const PatchDrawCommand> draws;
  std::span<const std::uint32_t> changed_draws;
};

/// Triangles in all draws, those that the switches collapse included. O(draws).
[[nodiscard]] inline std::uint64_t submitted_triangles(const PatchDrawList& list) {
  std::uint64_t triangles = 0;
  for (const PatchDrawCommand& draw : list.draws) triangles += draw.index_count / 3;
  return triangles;
}

}  // namespace varifold
