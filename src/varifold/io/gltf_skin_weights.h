// JOINTS_n and WEIGHTS_n of glTF.
#pragma once

#include <varifold/io/gltf_materials.h>
#include <varifold/io/imported_mesh.h>
#include <varifold/io/json_element.h>
#include <cstdint>
#include <span>
#include <vector>

namespace varifold::gltf {

/// Counts of what had to be changed.
struct SkinWeightRepairs {
  std::size_t reduced = 0;     ///< vertices with more than four joints, of which the heaviest stay
  std::size_t normalized = 0;  ///< whose weights did not sum up to 1
  std::size_t unweighted = 0;  ///< without any weight, which follow their first joint
  void warn(ImportedMesh& imported) const;
};

/// The joints of the `count` vertices of a primitive that has JOINTS_0; `joints` maps those of the
/// skin to those of the rig. Weights that are negative or not finite are taken as 0. Faults are
/// noted by the elements.
[[nodiscard]] std::vector<JointWeights> read_joint_weights(const JsonElement& attributes,
                                                           std::size_t count,
                                                           std::span<const std::uint16_t> joints,
                                                           BufferStore& buffers, Budget& budget,
                                                           SkinWeightRepairs& repairs);

}  // namespace varifold::gltf
