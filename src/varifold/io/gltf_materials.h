// Materials and images of glTF.
#pragma once

#include <varifold/io/gltf_buffers.h>
#include <varifold/io/imported_mesh.h>
#include <varifold/io/json_element.h>

namespace varifold::gltf {

/// How many bytes the result may take: a small file must not become a giant mesh.
class Budget {
 public:
  explicit Budget(const BufferStore& buffers) : buffers_(&buffers) {}

  /// False where the bytes do not fit any more.
  [[nodiscard]] bool spend(std::size_t bytes) {
    const std::size_t limit = (std::size_t{256} << 20) + std::size_t{64} * buffers_->total_bytes();
    if (spent_ > limit || bytes > limit - spent_) return false;
    spent_ += bytes;
    return true;
  }

 private:
  const BufferStore* buffers_;
  std::size_t spent_ = 0;
};

/// Appends all images and then all materials of the document to the mesh, in their order. Faults
/// are noted by the elements.
void read_images(const JsonElement& root, BufferStore& buffers, Budget& budget,
                 ImportedMesh& imported);
void read_materials(const JsonElement& root, ImportedMesh& imported);

/// The material of primitives that name none: white, metallic, rough.
[[nodiscard]] Material default_material();

}  // namespace varifold::gltf
