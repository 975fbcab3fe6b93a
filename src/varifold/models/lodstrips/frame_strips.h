// LodStrips of a mesh that moves, with an order of collapses for every frame or for groups of them.
//
// Based on: [Ramos2008] chapter 6: one connectivity, strips of which serve all frames, and a
//   sequence of simplification for each frame.
// Differs: a change of frame does not undo one sequence to do the other: no strip is changed in
//   place. What is drawn is made of the strips of full detail, whose vertices are replaced by those
//   that stand for them, and degenerate triangles are left out, so that going anywhere costs the
//   same. Sequences are pairs of vertices, not records of changes in strips. Frames that are alike
//   may share one sequence.
#pragma once

#include <varifold/base/result.h>
#include <varifold/mesh/triangle_mesh.h>
#include <varifold/models/common/level_table.h>
#include <varifold/strip/triangle_strips.h>
#include <varifold/view/draw_list.h>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace varifold {

/// A shape of the mesh, and the sequence that simplifies it.
struct StripFrame {
  std::vector<float> weights;  ///< of TriangleMesh::poses; those that are missing are 0
  std::uint32_t sequence = 0;
};

/// The order of collapses of some frames, in numbers of its own: level k has those below
/// levels.vertex_count(k).
struct FrameSequence {
  LevelTable levels;
  std::vector<std::uint32_t> vertex;  ///< of the mesh, per number
};

/// The parts of the model, plain data.
struct FrameStripsData {
  TriangleMesh mesh;      ///< vertices with poses, materials, ranges; indices are not kept
  TriangleStrips strips;  ///< of full detail, by material ranges
  std::vector<StripFrame> frames;
  std::vector<FrameSequence> sequences;  ///< all with as many levels
};

/// Immutable, shared by any number of instances and threads. Levels are those of every frame; what
/// counts and errors say of a level holds in all of them.
class FrameStrips {
 public:
  FrameStrips() = default;
  /// Everything must be consistent, as from build_frame_strips() or decode_frame_strips().
  explicit FrameStrips(FrameStripsData data);

  [[nodiscard]] const FrameStripsData& data() const { return data_; }
  [[nodiscard]] const TriangleMesh& attributes() const { return data_.mesh; }
  [[nodiscard]] std::uint32_t frame_count() const {
    return static_cast<std::uint32_t>(data_.frames.size());
  }
  /// The frame whose weights are nearest, the first of those at equal distances. O(frames).
  [[nodiscard]] std::uint32_t frame_for(std::span<const float> weights) const;
  /// Of the sequence of a frame.
  [[nodiscard]] const FrameSequence& sequence_of(std::uint32_t frame) const {
    return data_.sequences[data_.frames[frame].sequence];
  }

  /// Of all sequences the greatest; for levels, that which is right for all. O(sequences * log).
  [[nodiscard]] std::uint32_t finest_level() const;
  [[nodiscard]] std::uint32_t vertex_count(std::uint32_t level) const;
  [[nodiscard]] std::uint32_t triangle_count(std::uint32_t level) const;
  [[nodiscard]] float error(std::uint32_t level) const;
  [[nodiscard]] bool error_is_measured() const;
  [[nodiscard]] std::uint32_t level_for_triangles(std::uint32_t count) const;
  [[nodiscard]] std::uint32_t level_for_vertices(std::uint32_t count) const;
  [[nodiscard]] std::uint32_t level_for_error(float bound) const;
  [[nodiscard]] std::uint32_t level_for_fraction(float fraction) const;

  /// Memory of all arrays but images; vertices included.
  [[nodiscard]] std::size_t bytes() const;
  /// Of the sequences alone.
  [[nodiscard]] std::size_t sequence_bytes() const;

  /// Per vertex the point where it is; empty where there is one vertex at a point.
  [[nodiscard]] const std::vector<std::uint32_t>& point_of() const { return point_of_; }

 private:
  FrameStripsData data_;
  std::vector<std::uint32_t> point_of_;
};

/// All of the model as bytes; docs/formats/frame_strips.md. O(n).
[[nodiscard]] std::vector<std::byte> encode_frame_strips(const FrameStrips& model);

/// The same model again. Accepts any bytes; O(bytes) time and memory.
/// Errors: kInvalidInput with the offset of the fault.
[[nodiscard]] Result<FrameStrips> decode_frame_strips(std::span<const std::byte> bytes);

/// One place in a scene where a model stands, at a frame and a level of its own.
class FrameStripsInstance {
 public:
  /// Begins at frame 0, level 0. O(size of the model).
  explicit FrameStripsInstance(std::shared_ptr<const FrameStrips> model);

  [[nodiscard]] const FrameStrips& model() const { return *model_; }
  [[nodiscard]] std::uint32_t level() const { return level_; }
  [[nodiscard]] std::uint32_t frame() const { return frame_; }
  /// Of the present level in the present frame.
  [[nodiscard]] std::uint32_t vertex_count() const;
  [[nodiscard]] std::uint32_t triangle_count() const;

  /// O(1): the work is done when the list is asked for. Levels are at most the finest.
  void go_to_level(std::uint32_t level);
  void go_to_frame(std::uint32_t frame);

  /// Strips of the present level and frame. Valid until the next call. O(vertices + indices of the
  /// strips) where level or sequence have changed since the last one, else O(1); allocates nothing.
  [[nodiscard]] DrawList draw_list();

  /// A copy as a mesh of its own, with poses and materials. O(model).
  [[nodiscard]] TriangleMesh extract() const;

  /// Memory of the instance alone.
  [[nodiscard]] std::size_t bytes() const;

 private:
  void find_shown();
  void fill();
  void append(std::span<const std::uint32_t> strip);
  void append_pieces(std::size_t size);

  std::shared_ptr<const FrameStrips> model_;
  std::uint32_t level_ = 0, frame_ = 0;
  bool is_stale_ = true;
  std::vector<std::uint32_t> shown_;    // per vertex of the mesh: the one that stands for it
  std::vector<std::uint32_t> indices_;  // what is drawn, at the beginning of the room for it
  std::vector<std::uint32_t> present_;  // one strip before it is filtered
  std::vector<std::uint32_t> piece_;    // a part of it
  std::vector<DrawRange> ranges_;
  ElementRange changed_;  // all that is drawn
};

}  // namespace varifold
