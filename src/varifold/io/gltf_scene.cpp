#include <varifold/io/gltf_scene.h>

#include <algorithm>
#include <array>
#include <string>

namespace varifold::gltf {
namespace {

/// The rotation of a unit quaternion x, y, z, w.
glm::dmat4 rotation(const std::array<double, 4>& q) {
  const auto [x, y, z, w] = q;
  glm::dmat4 m(1);
  m[0] = {1 - 2 * (y * y + z * z), 2 * (x * y + z * w), 2 * (x * z - y * w), 0};
  m[1] = {2 * (x * y - z * w), 1 - 2 * (x * x + z * z), 2 * (y * z + x * w), 0};
  m[2] = {2 * (x * z + y * w), 2 * (y * z - x * w), 1 - 2 * (x * x + y * y), 0};
  return m;
}

glm::dmat4 local_transform(const JsonElement& node) {
  std::array<double, 16> numbers{};
  glm::dmat4 m(1);
  if (node.numbers("matrix", numbers)) {
    for (std::size_t i = 0; i < numbers.size(); ++i)
      m[static_cast<int>(i / 4)][static_cast<int>(i % 4)] = numbers[i];
    return m;
  }
  std::array<double, 4> quaternion{0, 0, 0, 1};
  if (node.numbers("rotation", quaternion)) m = rotation(quaternion);
  std::array<double, 3> scale{1, 1, 1};
  node.numbers("scale", scale);
  for (int column = 0; column < 3; ++column) m[column] *= scale[static_cast<std::size_t>(column)];
  std::array<double, 3> move{0, 0, 0};
  node.numbers("translation", move);
  m[3] = {move[0], move[1], move[2], 1};
  return m;
}

/// The nodes that no other node names as a child.
std::vector<std::uint64_t> parentless(const JsonElement& nodes) {
  std::vector<bool> has_parent(nodes.size(), false);
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const JsonElement children = nodes.item(i).array("children");
    for (std::size_t c = 0; c < children.size(); ++c)
      if (const std::uint64_t child = children.whole_item(c); child < nodes.size())
        has_parent[child] = true;
  }
  std::vector<std::uint64_t> roots;
  for (std::size_t i = 0; i < nodes.size(); ++i)
    if (!has_parent[i]) roots.push_back(i);
  return roots;
}

std::vector<std::uint64_t> whole_items(const JsonElement& array) {
  std::vector<std::uint64_t> items;
  for (std::size_t i = 0; i < array.size(); ++i) items.push_back(array.whole_item(i));
  return items;
}

}  // namespace

Scene collect_scene(const JsonElement& root) {
  Scene scene;
  const JsonElement nodes = root.array("nodes");
  const JsonElement scenes = root.array("scenes");
  if (nodes.size() == 0) {
    for (std::size_t i = 0; i < root.array("meshes").size(); ++i)
      scene.nodes.push_back({kNone, kNone, true, i, glm::dmat4(1)});
    return scene;
  }
  const bool has_scene = root.has("scene") || scenes.size() > 0;
  const std::vector<std::uint64_t> roots =
      has_scene ? whole_items(scenes.item(root.whole("scene", 0)).array("nodes"))
                : parentless(nodes);

  struct Visit {
    std::uint64_t node;
    std::uint32_t parent;  ///< in Scene::nodes
  };
  std::vector<Visit> stack;
  const auto push = [&](const std::vector<std::uint64_t>& ids, std::uint32_t parent) {
    std::for_each(ids.rbegin(), ids.rend(), [&](std::uint64_t id) {
      stack.push_back({id, parent});
    });
  };
  push(roots, kNone);
  scene.place_of.assign(nodes.size(), kNone);
  while (!stack.empty()) {
    const Visit visit = stack.back();
    stack.pop_back();
    const JsonElement node = nodes.item(visit.node);
    if (!node.exists()) return scene;
    if (scene.place_of[visit.node] != kNone) {
      node.fault("is reached twice: nodes form a cycle, or one has two parents");
      return scene;
    }
    const auto place = static_cast<std::uint32_t>(scene.nodes.size());
    scene.place_of[visit.node] = place;
    const bool has_mesh = node.has("mesh");
    const glm::dmat4 local = local_transform(node);
    scene.nodes.push_back(
        {visit.node, visit.parent, has_mesh, has_mesh ? node.whole("mesh") : 0,
         visit.parent == kNone ? local : scene.nodes[visit.parent].transform * local});
    push(whole_items(node.array("children")), place);
  }
  return scene;
}

}  // namespace varifold::gltf
