// The level table as bytes.
#pragma once

#include <varifold/models/common/level_table.h>
#include <varifold/models/common/section_reader.h>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace varifold {

class LevelTableCoder {
 public:
  static void append(const LevelTable& table, std::vector<std::byte>& bytes);
  /// Checks that counts add up, that vertices go to older ones and that errors fall.
  /// `most_vertices` is what the bytes read before justify, such as the number of positions: the
  /// base's history is not in the bytes, but takes memory.
  /// Errors: kInvalidInput with the place. O(bytes + most_vertices).
  [[nodiscard]] static Result<LevelTable> take(SectionReader& section,
                                               std::uint64_t most_vertices = 0x7fffffff);
};

}  // namespace varifold
