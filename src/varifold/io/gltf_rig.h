// Nodes and skins of glTF become a Rig.
#pragma once

#include <varifold/io/gltf_materials.h>
#include <varifold/io/gltf_mover.h>
#include <varifold/io/gltf_scene.h>
#include <varifold/io/json_element.h>
#include <varifold/mesh/rig.h>
#include <cstdint>
#include <span>
#include <vector>

namespace varifold::gltf {

/// What the vertices of a primitive follow.
struct JointBinding {
  enum class Kind { kNone, kOneJoint, kSkin };
  Kind kind = Kind::kNone;
  std::uint16_t joint = 0;                ///< of all vertices: kOneJoint
  std::span<const std::uint16_t> joints;  ///< in Rig::joints, for each of the skin: kSkin
};

/// Builds the joints that the vertices of a scene need.
///
/// A skinned mesh stays in the space that its skin was bound in, and its node does not move it, as
/// glTF has it. Its places in the world at rest would differ from those by the blended matrix of
/// each vertex, which cannot be put into joints again: kept as they are, vertices, weights and
/// matrices survive bit by bit. A mesh without a skin that an animated node moves is placed in the
/// world at rest and follows that node as its one joint. As all vertices of a mesh have joints or
/// none, what never moves then follows a joint of its own that stands still.
class RigBuilder {
 public:
  /// Faults are noted by the elements of the document.
  RigBuilder(const JsonElement& root, const Scene& scene, BufferStore& buffers, Budget& budget,
             FirstFault& faults);

  /// For a node with a skin, which must be called first for skins with a fault to be noticed.
  [[nodiscard]] JointBinding bind_to_skin(std::uint32_t place);
  /// For vertices without a skin; kNone where no vertex of the scene has joints.
  [[nodiscard]] JointBinding bind_to_node(std::uint32_t place);
  /// How vertices without a skin come to their places: to the world at rest; not at all where they
  /// move, and their places at rest are lost because the node is flat then.
  [[nodiscard]] Mover mover_of(std::uint32_t place) const;

  /// The nodes that joints need and the joints.
  [[nodiscard]] Rig take();
  /// After take(): in Rig::nodes, for each node of the document; kNone for those that joints do
  /// not need.
  [[nodiscard]] const std::vector<std::uint32_t>& rig_node_of() const { return rig_node_of_; }

 private:
  struct BoundJoint {
    std::uint32_t place;  ///< in Scene::nodes; kNone stands still
    Mat4 inverse_bind;
  };
  void find_moving_nodes();
  std::uint16_t add_joint(const BoundJoint& joint);
  void read_skin(std::uint64_t skin);
  [[nodiscard]] bool is_frame(std::uint32_t place) const;
  /// The node above in the rig.
  [[nodiscard]] std::uint32_t parent_of(std::uint32_t place) const {
    const std::uint32_t parent = scene_.nodes[place].parent;
    return parent != kNone && is_frame(parent) ? kNone : parent;
  }
  [[nodiscard]] std::vector<std::uint32_t> needed_places() const;

  JsonElement root_;
  const Scene& scene_;
  BufferStore& buffers_;
  Budget& budget_;
  FirstFault& fault_;
  std::vector<bool> moves_;  ///< whether an animation moves the node: for Scene::nodes
  bool has_joints_ = false;
  std::vector<BoundJoint> joints_;
  std::vector<std::vector<std::uint16_t>> joints_of_skin_;  ///< empty: not read yet
  std::vector<std::vector<std::uint16_t>> joints_at_;       ///< for Scene::nodes, kNone last
  std::vector<std::uint32_t> rig_node_of_;
};

}  // namespace varifold::gltf
