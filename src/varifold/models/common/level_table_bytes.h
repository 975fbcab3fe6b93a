// The level table as bytes.
#pragma once

#include <varifold/models/common/level_table.h>
#include <varifold/models/common/section_reader.h>
#include <cstddef>
#include <vector>

namespace varifold {

class LevelTableCoder {
 public:
  static void append(const LevelTable& table, std::vector<std::byte>& bytes);
  /// Checks that counts add up, that vertices go to older ones and that errors fall.
  /// Errors: kInvalidInput with the place. O(bytes).
  [[nodiscard]] static Result<LevelTable> take(SectionReader& section);
};

}  // namespace varifold
