// Morph targets of glTF become poses.
#pragma once

#include <varifold/io/gltf_materials.h>
#include <varifold/io/gltf_mover.h>
#include <varifold/io/json_element.h>
#include <varifold/mesh/triangle_mesh.h>
#include <cstdint>
#include <string>
#include <vector>

namespace varifold::gltf {

/// The poses of one instance of a mesh: [first, first + count) of TriangleMesh::poses.
struct PoseRange {
  std::uint32_t first = 0;
  std::uint32_t count = 0;
};

/// Collects the targets of all primitives as they are met, and makes poses of them when all
/// vertices are known. The poses of an instance leave the vertices of all others at rest.
class TargetCollector {
 public:
  TargetCollector(BufferStore& buffers, Budget& budget, FirstFault& faults)
      : buffers_(&buffers), budget_(&budget), faults_(&faults) {}

  /// New poses for an instance of a mesh, with their names and weights: those of the node, else
  /// those of the mesh, else 0.
  PoseRange add_poses(const JsonElement& mesh, const JsonElement& node);

  /// Remembers the targets of a primitive for its vertices, [first_vertex, first_vertex + count).
  /// `normals`: those of the file, three floats each; or empty.
  void read(const JsonElement& primitive, const PoseRange& range, std::uint32_t first_vertex,
            std::size_t count, const std::vector<float>& normals, const Mover& mover);

  /// Gives the mesh all poses. All its vertices must be there, with their normals.
  void make_poses(TriangleMesh& mesh);

  /// The weight of every pose; empty where all are 0.
  [[nodiscard]] std::vector<float> weights() const;

 private:
  struct Offsets {
    std::uint32_t pose;
    std::uint32_t first_vertex;
    std::vector<Vec3> values;
  };
  std::vector<float> read_offsets(const JsonElement& target, const char* name, std::size_t count);

  BufferStore* buffers_;
  Budget* budget_;
  FirstFault* faults_;
  std::vector<std::string> names_;
  std::vector<float> weights_;
  std::vector<Offsets> positions_;
  std::vector<Offsets> normals_;
};

}  // namespace varifold::gltf
