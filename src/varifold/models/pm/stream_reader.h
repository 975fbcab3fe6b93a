// A progressive mesh that refines while its bytes arrive.
#pragma once

#include <varifold/base/result.h>
#include <varifold/models/pm/progressive_mesh.h>
#include <varifold/models/pm/record_reader.h>
#include <varifold/models/pm/stream_header.h>
#include <varifold/view/draw_list.h>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

namespace varifold {

/// Reads a stream of encode_progressive_mesh() in pieces of any size. What has arrived is a mesh at
/// any moment: nothing before the base is there, then level by level. Memory is in proportion to
/// the bytes pushed, whatever they say. Moved from, it can only be destroyed or assigned to.
class ProgressiveStreamReader {
 public:
  /// Levels beyond `last_level` are not read.
  explicit ProgressiveStreamReader(
      std::uint32_t last_level = std::numeric_limits<std::uint32_t>::max())
      : last_level_(last_level) {}

  /// The next bytes of the stream; refines as far as they allow (a split of more than 512 bytes may
  /// wait for more bytes, or for finish()). kInvalidInput with the offset of
  /// the fault; then the mesh stays as it is, and every later push fails in the same way.
  Result<void> push(std::span<const std::byte> bytes);

  [[nodiscard]] bool has_base() const { return stage_ == Stage::kSplits; }
  /// The last level that is there as a whole, and the last one of the whole stream; 0 before the
  /// base is there.
  [[nodiscard]] std::uint32_t level() const {
    return static_cast<std::uint32_t>(data_.splits.size());
  }
  [[nodiscard]] std::uint32_t finest_level() const { return header_.levels; }
  [[nodiscard]] std::uint32_t vertex_count() const { return state_.surface.vertex_count(); }
  [[nodiscard]] std::uint32_t triangle_count() const { return state_.surface.triangle_count(); }
  /// Of the level, against the whole mesh; see ProgressiveMesh::error().
  [[nodiscard]] float error() const { return data_.error.empty() ? 0 : data_.error.back(); }
  /// Bytes that the levels up to level() take, the last one counted as a whole.
  [[nodiscard]] std::size_t bytes_used() const { return offset_ + (first_bit_ + 7) / 8; }

  /// Draw-ready buffers of level(); everything counts as changed. A range of materials may be given
  /// as several. Valid until the next push(). Copies nothing; O(ranges).
  [[nodiscard]] DrawList draw_list();
  /// A copy of level() as a mesh of its own, with materials. O(level).
  [[nodiscard]] TriangleMesh extract() const;

  /// The levels that arrived. kInvalidInput where the base is not there or bytes were bad.
  [[nodiscard]] Result<ProgressiveMesh> finish() &&;

 private:
  enum class Stage : std::uint8_t { kPreamble, kHeader, kImages, kBase, kSplits };

  [[nodiscard]] std::uint64_t section_size() const;
  Result<void> read_section(std::span<const std::byte> section);
  Result<void> read_base(std::span<const std::byte> section);
  void reserve(std::size_t bytes);
  Result<void> read_splits();
  Result<void> check_end();
  Result<void> refuse(Error error);
  [[nodiscard]] bool take_record();
  void take_placed(std::uint32_t first_new);
  void undo_splits();
  void sort_triangles_by_range();

  std::uint32_t last_level_;
  Stage stage_ = Stage::kPreamble;
  std::vector<std::byte> pending_;  // not yet used, beginning at offset_
  std::size_t offset_ = 0;
  std::size_t first_bit_ = 0;  // of pending_, in the splits
  std::size_t try_at_ = 0;     // do not try again with fewer bytes pending
  Error fault_;                // what went wrong, once something has
  bool faulty_ = false;

  pm::StreamPreamble preamble_;
  pm::StreamHeader header_;
  pm::StreamState state_;
  pm::RecordReader record_reader_;
  pm::SplitRecord record_;
  ProgressiveMeshData data_;
  std::vector<std::uint32_t> latest_placed_;  // per vertex, the last record of placed attributes
  std::vector<DrawRange> draw_ranges_;
  std::vector<ElementRange> changed_;
};

}  // namespace varifold
