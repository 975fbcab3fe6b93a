// The node hierarchy of glTF.
#pragma once

#include <varifold/io/json_element.h>
#include <cstdint>
#include <glm/mat4x4.hpp>
#include <vector>

namespace varifold::gltf {

/// A mesh at a place.
struct Instance {
  std::uint64_t mesh = 0;
  glm::dmat4 transform{1};
};

/// All meshes below the default scene, else the first one, else the nodes without a parent, in
/// depth-first order; all meshes as they are where there are no nodes. Each node may be reached
/// once: cycles and nodes with two parents are noted as faults. O(nodes), without recursion.
[[nodiscard]] std::vector<Instance> collect_instances(const JsonElement& root);

}  // namespace varifold::gltf
