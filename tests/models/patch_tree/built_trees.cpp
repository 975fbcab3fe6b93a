#include <tests/models/patch_tree/built_trees.h>

#include <gtest/gtest.h>
#include <varifold/mesh/generators.h>

namespace varifold::test {

namespace {

TriangleMesh without_attributes(TriangleMesh mesh) {
  mesh.normals.clear();
  mesh.texcoords.clear();
  mesh.colors.clear();
  return mesh;
}

void add(std::vector<BuiltTree>& trees, const std::string& name, const TriangleMesh& mesh,
         std::uint32_t triangles_per_patch) {
  PatchTreeOptions options;
  options.triangles_per_patch = triangles_per_patch;
  options.threads = 1;
  auto built = build_patch_tree(mesh, options);
  ASSERT_TRUE(built) << name << ": " << built.error().message;
  trees.push_back({name, mesh, std::make_shared<const PatchTree>(std::move(built->tree))});
}

std::vector<BuiltTree> build_all() {
  std::vector<BuiltTree> trees;
  for (const NamedMesh& named : all_groups()) add(trees, named.name, named.mesh, 12);
  const TriangleMesh blob = without_attributes(planet({{.triangles = 3000}, 0.12f, false}));
  add(trees, "blob of patches of 40", blob, 40);
  add(trees, "blob of patches of 300", blob, 300);
  add(trees, "seams of patches of 60", seamed_sphere({.triangles = 2000}), 60);
  add(trees, "plane of patches of 25", plane({.triangles = 1800}), 25);
  return trees;
}

}  // namespace

const std::vector<BuiltTree>& built_trees() {
  static const std::vector<BuiltTree> trees = build_all();
  return trees;
}

const BuiltTree& built_tree(const std::string& name) {
  for (const BuiltTree& built : built_trees())
    if (built.name == name) return built;
  ADD_FAILURE() << "no tree of the name " << name;
  return built_trees().front();
}

}  // namespace varifold::test
