// Animations of glTF.
#pragma once

#include <varifold/io/gltf_materials.h>
#include <varifold/io/gltf_targets.h>
#include <varifold/io/imported_mesh.h>
#include <varifold/io/json_element.h>
#include <varifold/mesh/rig.h>
#include <vector>

namespace varifold::gltf {

/// What the nodes of a document have become, one entry for each.
struct AnimatedNodes {
  Rig& rig;
  const std::vector<std::uint32_t>& rig_node;  ///< in Rig::nodes, or kNone
  const std::vector<PoseRange>& poses;         ///< count 0: none
};

/// Appends the animations of the document to nodes.rig: all channels that move its nodes or weigh
/// poses; others are dropped with a warning, and so are animations without any. Faults are noted
/// by the elements.
void read_animations(const JsonElement& root, const AnimatedNodes& nodes, BufferStore& buffers,
                     Budget& budget, FirstFault& faults, ImportedMesh& imported);

}  // namespace varifold::gltf
