// Patch trees without vertices: topology, bounds and numbers of triangles, all that choosing a
// front looks at.
#pragma once

#include <varifold/models/patch_tree/patch_tree.h>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace varifold::test {

/// The finest level: where its patches are, and which share a vertex.
struct LeafPatches {
  std::vector<Vec3> centers, normals;
  std::vector<std::vector<std::uint32_t>> neighbors;  ///< ascending, symmetric
  float radius = 0;                                   ///< of a patch
};

/// Of each level, from the leaves on: the group of each patch. Groups are the patches of the next
/// coarser level, numbered from 0 without gaps.
using Grouping = std::vector<std::vector<std::uint32_t>>;

struct SyntheticOptions {
  std::uint32_t leaf_triangles = 128;
  /// Of the patches just above the leaves; each level above has about twice that.
  float error = 1e-4f;
  std::uint64_t seed = 1;
  bool nests = true;  ///< otherwise balls, errors and cones are anything at all
};

/// Neighbours are those that leaves give; balls nest and errors are saturated.
[[nodiscard]] PatchTree make_tree(const LeafPatches& leaves, const Grouping& grouping,
                                  const SyntheticOptions& options);

/// The unit sphere in patches of about the same size, merged two by two where neighbours are left,
/// down to one root.
[[nodiscard]] PatchTree planet_tree(std::uint32_t leaves, const SyntheticOptions& options);
/// A torus in 2^a times 2^b patches, merged two by two in turns.
[[nodiscard]] PatchTree torus_tree(std::uint32_t a, std::uint32_t b,
                                   const SyntheticOptions& options);
/// A piece of the sphere merged at random: groups of one to many, whole levels of chains, several
/// roots, sometimes several components.
[[nodiscard]] PatchTree irregular_tree(std::uint64_t seed);

struct NamedTree {
  std::string name;
  std::shared_ptr<const PatchTree> tree;
};
/// Small ones of all kinds, made once; the degenerate ones first.
[[nodiscard]] const std::vector<NamedTree>& small_trees();

}  // namespace varifold::test
