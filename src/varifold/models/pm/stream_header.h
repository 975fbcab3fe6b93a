// What stands before the splits of a progressive mesh stream.
#pragma once

#include <varifold/base/result.h>
#include <varifold/models/pm/attribute_codes.h>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace varifold::pm {

/// The first bytes, of fixed size: the tag and the sizes of the three sections that follow.
struct StreamPreamble {
  static constexpr std::size_t kSize = 24;
  std::uint32_t header_size = 0;
  std::uint64_t images_size = 0;
  std::uint64_t base_size = 0;
};

struct StreamRange {
  std::uint32_t material = 0;
  std::uint32_t base_triangles = 0;
};

/// Counts are those of the whole stream; a part of it has fewer.
struct StreamHeader {
  AttributeFormat format;
  bool error_is_measured = false;
  bool moves_vertices = false;
  bool has_ranges = false;  ///< otherwise `ranges` has one nameless range
  std::uint32_t levels = 0;
  std::uint32_t vertices = 0;
  std::uint32_t triangles = 0;
  std::uint32_t base_vertices = 0;
  std::uint32_t base_triangles = 0;
  std::uint32_t error = 0;  ///< of the base, as its code
  std::vector<StreamRange> ranges;
  std::vector<Material> materials;
};

void append_preamble(const StreamPreamble& preamble, std::vector<std::byte>& bytes);
void append_header(const StreamHeader& header, std::vector<std::byte>& bytes);

/// `bytes` is the section; `offset` where it stands in the stream, for messages. kInvalidInput.
[[nodiscard]] Result<StreamPreamble> read_preamble(std::span<const std::byte> bytes);
[[nodiscard]] Result<StreamHeader> read_header(std::span<const std::byte> bytes,
                                               std::size_t offset);

}  // namespace varifold::pm
