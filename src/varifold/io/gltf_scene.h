// The node hierarchy of glTF.
#pragma once

#include <varifold/base/math.h>
#include <varifold/io/json_element.h>
#include <cstdint>
#include <glm/mat4x4.hpp>
#include <vector>

namespace varifold::gltf {

/// A node of the scene.
struct SceneNode {
  std::uint64_t index = 0;       ///< in "nodes" of the document
  std::uint32_t parent = kNone;  ///< in Scene::nodes, always before its children
  bool has_mesh = false;
  std::uint64_t mesh = 0;   ///< in "meshes", where it has one
  glm::dmat4 transform{1};  ///< from the node to the world, at rest
};

/// In the extras of a node that holds the roots of a rig together and does nothing else, `true`.
inline constexpr const char* kFrameMark = "varifold_frame";

/// All nodes below the default scene, else the first one, else the nodes without a parent, in
/// depth-first order; where there are no nodes, one without an index for each mesh.
struct Scene {
  std::vector<SceneNode> nodes;
  /// In `nodes`, for each node of the document; kNone where it is not in the scene.
  std::vector<std::uint32_t> place_of;
};

/// Each node may be reached once: cycles and nodes with two parents are noted as faults. O(nodes),
/// without recursion.
[[nodiscard]] Scene collect_scene(const JsonElement& root);

}  // namespace varifold::gltf
