// Split records to bits.
#pragma once

#include <varifold/models/pm/split_record.h>

namespace varifold::pm {

/// The twin of RecordReader.
class RecordWriter {
 public:
  /// Finds the shortest kind that says what `record` says, sets kind and flags, puts the triangles
  /// in the order in which they will be read, and notes the lessons. Wedges, moved slots,
  /// triangles, codes, placed vertices and the drop of the error are given; triangles of one range
  /// keep their order.
  void write(const StreamState& state, SplitRecord& record, BitWriter& bits);

 private:
  void choose_kind();
  [[nodiscard]] bool predict();
  void write_wedges();
  void write_mask(const SplitWedge& wedge);
  void write_predicted_triangles();
  void write_explicit_triangles();
  void write_vertices();
  void write_placed();
  void write_channels(const Prediction& prediction, std::uint32_t first, const Codes& codes);
  void write_number(std::uint16_t model, std::uint32_t value);

  const StreamState* state_ = nullptr;
  BitWriter* bits_ = nullptr;
  SplitRecord* record_ = nullptr;
  std::vector<NewTriangle> predicted_;  // as the reader will expect them, ranges included
  std::vector<std::uint32_t> scratch_;
};

}  // namespace varifold::pm
