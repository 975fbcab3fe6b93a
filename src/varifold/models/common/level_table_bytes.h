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
  /// No table may have more vertices and triangles than this.
  static constexpr std::uint32_t kMost = 0x7fffffff;
  /// Checks that counts add up, that vertices go to older ones and that errors fall. Vertices of
  /// the base take no bytes here: `most_vertices`, those that the mesh has, keeps a damaged count
  /// from asking for memory.
  /// Errors: kInvalidInput with the place. O(bytes + most_vertices).
  [[nodiscard]] static Result<LevelTable> take(SectionReader& section,
                                               std::uint32_t most_vertices = kMost);
};

}  // namespace varifold
