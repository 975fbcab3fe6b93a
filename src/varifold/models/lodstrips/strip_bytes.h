// Strips as bytes, and checks of bytes that change them.
#pragma once

#include <varifold/models/common/level_table.h>
#include <varifold/models/common/section_reader.h>
#include <varifold/models/lodstrips/strip_slots.h>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace varifold {

/// The materials of the ranges, whose triangles are not kept.
void append_range_materials(const TriangleMesh& mesh, std::vector<std::byte>& bytes);
/// Sets the ranges of a mesh that has its materials. False where one has no material of its own.
[[nodiscard]] bool take_range_materials(SectionReader& section, TriangleMesh& mesh);

void append_strips(const TriangleStrips& strips, std::vector<std::byte>& bytes);
/// Every strip has kLeastStrip to kMostStrip indices, all below `vertex_count`, and a material
/// range below `material_range_count`, or 0 where there are none. kInvalidInput.
[[nodiscard]] Result<TriangleStrips> take_strips(SectionReader& section, std::uint32_t vertex_count,
                                                 std::uint32_t material_range_count);

/// Memory of the strips at full detail.
[[nodiscard]] std::size_t strip_bytes(const TriangleStrips& strips);

/// Replays changes that nobody has checked, from the finest level down. What it lets through stays
/// within its strips at every level, undoes exactly, and draws no vertex that a level has not.
class ChangeChecker {
 public:
  /// Both must outlive this. O(strips + vertices).
  ChangeChecker(const TriangleStrips& strips, const LevelTable& table);

  /// The level that the next changes lead away from.
  [[nodiscard]] std::uint32_t level() const { return level_; }
  [[nodiscard]] bool collapse(std::uint32_t strip, std::uint32_t position, std::uint32_t moved);
  [[nodiscard]] bool remove(std::uint32_t strip, std::uint32_t position);
  /// False where a vertex that has vanished is still drawn. Otherwise one level down.
  [[nodiscard]] bool finish_level();

 private:
  void count(std::uint32_t vertex, std::uint32_t change);
  [[nodiscard]] bool is_drawn(std::uint32_t strip) const;

  const LevelTable& table_;
  StripSlots slots_;
  std::uint32_t level_;
  std::uint32_t base_vertices_;
  std::uint32_t vertex_end_, vertex_begin_;  // those that move to the level below
  std::vector<std::uint32_t> drawn_;         // per vertex beyond the base: slots that are drawn
};

}  // namespace varifold
