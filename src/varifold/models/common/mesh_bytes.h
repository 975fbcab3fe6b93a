// Vertex attributes, materials and images as bytes: the part that all model formats have.
#pragma once

#include <varifold/base/result.h>
#include <varifold/mesh/triangle_mesh.h>
#include <varifold/models/common/section_reader.h>
#include <cstddef>
#include <span>
#include <vector>

namespace varifold {

void append_materials(const std::vector<Material>& materials, std::vector<std::byte>& bytes);
void append_images(const std::vector<Image>& images, std::vector<std::byte>& bytes);
/// The vertex count, which attributes there are, and these as they are in memory.
void append_attributes(const TriangleMesh& mesh, std::vector<std::byte>& bytes);

/// What the functions above appended; where bytes are missing, section.good() is false afterwards.
/// No more is allocated than the bytes justify.
[[nodiscard]] std::vector<Material> take_materials(SectionReader& section);
[[nodiscard]] std::vector<Image> take_images(SectionReader& section);
/// Unknown attributes and values that are not finite make section.good() false, too.
void take_attributes(SectionReader& section, TriangleMesh& mesh);

/// The images that are all of a section. `offset` is where it stands, for messages. kInvalidInput.
[[nodiscard]] Result<std::vector<Image>> read_images(std::span<const std::byte> bytes,
                                                     std::size_t offset);

}  // namespace varifold
