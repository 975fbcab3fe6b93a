// The vertices of glTF's primitives.
#pragma once

#include <varifold/io/gltf_materials.h>
#include <varifold/io/gltf_mover.h>
#include <varifold/io/gltf_rig.h>
#include <varifold/io/gltf_skin_weights.h>
#include <varifold/io/gltf_targets.h>
#include <varifold/io/imported_mesh.h>
#include <array>
#include <set>
#include <string>
#include <vector>

namespace varifold::gltf {

/// Vertices that a primitive has brought.
struct VertexBlock {
  std::uint32_t first = 0;
  std::uint32_t count = 0;
};

/// What is done with the vertices of a primitive.
struct Placement {
  Mover mover;
  JointBinding binding;
  PoseRange poses;
};

/// Appends the vertices of primitives to a mesh: POSITION, NORMAL, TEXCOORD_0, COLOR_0, JOINTS_n
/// and WEIGHTS_n, and morph targets. Faults are noted by the elements.
class VertexReader {
 public:
  VertexReader(BufferStore& buffers, Budget& budget, FirstFault& faults, ImportedMesh& imported)
      : buffers_(buffers),
        budget_(budget),
        fault_(faults),
        imported_(imported),
        targets_(buffers, budget, faults) {}

  /// The accessors that a primitive's vertices come from: those of equal keys are the same.
  using Key = std::vector<std::uint64_t>;
  [[nodiscard]] Key key_of(const JsonElement& primitive);

  VertexBlock read(const JsonElement& primitive, const Placement& placement);

  [[nodiscard]] TargetCollector& targets() { return targets_; }

  /// Completes arrays that only some primitives have, makes poses, and warns. Needs all triangles.
  void finish();

 private:
  static constexpr std::array<const char*, 4> kAttributes{"POSITION", "NORMAL", "TEXCOORD_0",
                                                          "COLOR_0"};
  using Values = std::array<std::vector<float>, kAttributes.size()>;

  void spend(const JsonElement& element, std::size_t bytes);
  void check_attribute(const JsonElement& attributes, std::size_t attribute,
                       const Accessor& accessor);
  void append(const Values& values, std::size_t count, unsigned color_components,
              const Mover& mover);
  void append_joints(const JsonElement& attributes, std::size_t count, const JointBinding& binding);
  void fill_normals();

  BufferStore& buffers_;
  Budget& budget_;
  FirstFault& fault_;
  ImportedMesh& imported_;
  TargetCollector targets_;
  std::vector<VertexBlock> without_normals_;
  std::set<std::string> dropped_attributes_;
  std::size_t colors_not_finite_ = 0;
  SkinWeightRepairs repairs_;
};

}  // namespace varifold::gltf
