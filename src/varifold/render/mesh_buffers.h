// Private to this folder: the buffers of one draw list on the graphics card.
#pragma once

#include <varifold/base/result.h>
#include <varifold/render/gl_objects.h>
#include <varifold/render/pose_buffers.h>
#include <varifold/view/draw_list.h>
#include <cstddef>
#include <span>

namespace varifold::gl {

/// A buffer that is uploaded once, grows when it must, and is patched where elements changed.
class PatchedBuffer {
 public:
  /// Brings the buffer to `bytes`. Elements in `changed` and those beyond the previous size are
  /// uploaded; all of them when the buffer has to grow. Returns the number of bytes uploaded.
  std::size_t update(std::span<const std::byte> bytes, std::size_t element_size,
                     std::span<const ElementRange> changed);
  [[nodiscard]] GLuint name() const { return buffer_.name(); }

 private:
  Buffer buffer_;
  std::size_t capacity_ = 0;  // bytes
  std::size_t used_ = 0;      // bytes
};

/// Vertex attributes in one buffer each, an index buffer and the vertex array that joins them.
class MeshBuffers {
 public:
  enum Attribute : GLuint {
    kPosition,
    kNormal,
    kTexcoord,
    kColor,
    kJoints,
    kJointWeights,
    kAttributeCount
  };

  /// Uploads what changed. Returns the bytes uploaded, or kFailed when memory ends.
  [[nodiscard]] Result<std::size_t> update(const DrawList& list);
  [[nodiscard]] GLuint vertex_array() const { return vertex_array_.name(); }
  [[nodiscard]] bool has(Attribute attribute) const { return present_[attribute]; }
  [[nodiscard]] PoseBuffers& poses() { return poses_; }

 private:
  void connect(Attribute attribute, bool present);

  VertexArray vertex_array_;
  PatchedBuffer attributes_[kJointWeights];  // joints and their weights share one
  bool present_[kAttributeCount] = {};
  PatchedBuffer indices_;
  PoseBuffers poses_;
};

/// O(ranges) checks of what a list promises; kInvalidInput with the fault.
[[nodiscard]] Result<void> check_list(const DrawList& list);

}  // namespace varifold::gl
