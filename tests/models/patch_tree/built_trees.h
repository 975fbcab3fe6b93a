// Patch trees of the groups of meshes.
#pragma once

#include <tests/support/meshes.h>
#include <varifold/models/patch_tree/build.h>
#include <memory>
#include <string>
#include <vector>

namespace varifold::test {

struct BuiltTree {
  std::string name;
  TriangleMesh mesh;
  std::shared_ptr<const PatchTree> tree;
};

/// All groups in small patches, and a few meshes that are large enough for several levels; made
/// once.
[[nodiscard]] const std::vector<BuiltTree>& built_trees();
/// The one of that name, which must be there.
[[nodiscard]] const BuiltTree& built_tree(const std::string& name);

}  // namespace varifold::test
