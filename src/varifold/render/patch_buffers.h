// Private to this folder: the buffers of a draw list of patches on the graphics card.
#pragma once

#include <varifold/base/result.h>
#include <varifold/render/gl_objects.h>
#include <varifold/render/mesh_buffers.h>
#include <varifold/render/pose_buffers.h>
#include <varifold/view/patch_draws.h>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace varifold::gl {

/// Vertices and indices, uploaded once; and the commands, patched where they change.
class PatchBuffers {
 public:
  enum Storage : GLuint {
    kPositions,
    kNormals,
    kColors,
    kRemap,
    kMorphs,
    kSkin,
    kMaterials,
    kCount
  };

  /// Uploads all. kUnsupported where an array is greater than what shaders can read on the device,
  /// kFailed when memory ends. Returns the bytes uploaded.
  [[nodiscard]] Result<std::size_t> create(const PatchDrawList& list);
  /// Uploads the commands that changed, neighbouring ones together. Returns the bytes uploaded;
  /// kInvalidInput where a command does not fit the list, or the list what create() uploaded.
  [[nodiscard]] Result<std::size_t> update(const PatchDrawList& list);
  /// Uploads colours by material, unless they are those of the call before. Returns their number.
  int set_materials(std::span<const Vec4> colors);

  [[nodiscard]] PoseBuffers& poses() { return poses_; }
  [[nodiscard]] bool has(Storage storage) const { return static_cast<bool>(storages_[storage]); }
  /// All commands in one call, with a program that follows patch_shaders.h.
  void draw() const;

 private:
  VertexArray vertex_array_;
  Buffer storages_[kCount];
  Buffer indices_;
  PatchedBuffer commands_;
  PoseBuffers poses_;
  std::size_t vertex_count_ = 0, index_count_ = 0;
  std::uint32_t draw_count_ = 0;
  std::vector<std::uint32_t> changed_;  // sorted; kept, so that frames do not allocate
  std::vector<ElementRange> ranges_;
  std::vector<Vec4> materials_;
};

/// Checks of what a list promises, but for its draws, which update() looks at where they are new;
/// kInvalidInput with the fault. Indices are trusted. O(changed draws).
[[nodiscard]] Result<void> check_list(const PatchDrawList& list);

}  // namespace varifold::gl
