// Split records from bits.
#pragma once

#include <varifold/models/pm/split_record.h>

namespace varifold::pm {

/// Reads records against the state that the ones before left. Linear in the bits of the record,
/// whatever they say.
class RecordReader {
 public:
  /// Reads the next record; changes nothing but `record` and `bits`. nullptr when it is sound, else
  /// the fault. Whether the bits were all there is said by bits.exhausted(): ask it first.
  const char* read(const StreamState& state, BitReader& bits, SplitRecord& record);

 private:
  const char* read_connectivity();
  const char* read_wedges(std::uint32_t count, bool with_flags);
  const char* read_mask(SplitWedge& wedge);
  const char* read_predicted_triangles(bool plain);
  const char* read_explicit_triangles();
  void read_vertices();
  const char* read_placed();
  void read_channels(const Prediction& prediction, std::uint32_t first, Codes& codes);
  std::uint32_t read_number(std::uint16_t model);

  const StreamState* state_ = nullptr;
  BitReader* bits_ = nullptr;
  SplitRecord* record_ = nullptr;
  std::vector<std::uint32_t> scratch_;
};

}  // namespace varifold::pm
