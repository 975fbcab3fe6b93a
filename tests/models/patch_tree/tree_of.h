// A patch tree of a mesh.
#pragma once

#include <gtest/gtest.h>
#include <varifold/models/patch_tree/build.h>
#include <cstdint>
#include <memory>
#include <utility>

namespace varifold::test {

/// With patches of so many triangles, which must succeed.
[[nodiscard]] inline std::shared_ptr<const PatchTree> tree_of(const TriangleMesh& mesh,
                                                              std::uint32_t triangles_per_patch) {
  PatchTreeOptions options;
  options.triangles_per_patch = triangles_per_patch;
  auto built = build_patch_tree(mesh, options);
  EXPECT_TRUE(built.has_value());
  return built ? std::make_shared<const PatchTree>(std::move(built->tree)) : nullptr;
}

}  // namespace varifold::test
