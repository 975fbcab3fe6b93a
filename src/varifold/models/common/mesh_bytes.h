// Vertex attributes, materials and images as bytes: the part that all model formats have.
#pragma once

#include <varifold/base/result.h>
#include <varifold/mesh/triangle_mesh.h>
#include <varifold/models/common/section_reader.h>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace varifold {

/// Which arrays are stored, and whether there is a rig: bits of a word in files of all models.
enum StoredAttribute : std::uint32_t {
  kStoredNormals = 1,
  kStoredTexcoords = 2,
  kStoredColors = 4,
  kStoredSkin = 8,
  kStoredPoses = 16,
  kStoredRig = 32,
  kStoredAll = 63
};
/// Those of a mesh.
[[nodiscard]] std::uint32_t stored_attributes(const TriangleMesh& mesh);

void append_materials(const std::vector<Material>& materials, std::vector<std::byte>& bytes);
void append_images(const std::vector<Image>& images, std::vector<std::byte>& bytes);
/// The vertex count, which attributes there are, and these as they are in memory: skin, poses and
/// rig too. A mesh of vertices that belong to another one has its rig, which need not be stored
/// twice: `has_rig` false.
void append_attributes(const TriangleMesh& mesh, std::vector<std::byte>& bytes,
                       bool has_rig = true);

/// What the functions above appended; where bytes are missing, section.good() is false afterwards.
/// No more is allocated than the bytes justify.
[[nodiscard]] std::vector<Material> take_materials(SectionReader& section);
[[nodiscard]] std::vector<Image> take_images(SectionReader& section);
/// Unknown attributes, values that are not finite and joints that are not there make
/// section.good() false, too. `rig` is that of the other mesh, of bytes without one.
void take_attributes(SectionReader& section, TriangleMesh& mesh,
                     const std::shared_ptr<const Rig>& rig = nullptr);

/// Whether two meshes have the same arrays: what holds for the vertices of one mesh.
[[nodiscard]] bool have_same_attributes(const TriangleMesh& a, const TriangleMesh& b);

/// The images that are all of a section. `offset` is where it stands, for messages. kInvalidInput.
[[nodiscard]] Result<std::vector<Image>> read_images(std::span<const std::byte> bytes,
                                                     std::size_t offset);

}  // namespace varifold
