#include <varifold/models/lodstrips/strip_bytes.h>
#include <algorithm>
#include <span>

namespace varifold {

void append_range_materials(const TriangleMesh& mesh, std::vector<std::byte>& bytes) {
  append_little(bytes, static_cast<std::uint32_t>(mesh.ranges.size()));
  for (const MaterialRange& range : mesh.ranges) append_little(bytes, range.material);
}

bool take_range_materials(SectionReader& section, TriangleMesh& mesh) {
  const std::uint32_t count = section.take_count(sizeof(std::uint32_t));
  std::vector<bool> seen(mesh.materials.size(), false);
  for (std::uint32_t r = 0; r < count; ++r) {
    const auto material = section.take<std::uint32_t>();
    if (material >= seen.size() || seen[material]) return false;
    seen[material] = true;
    mesh.ranges.push_back({material, 0, 0});
  }
  return true;
}

void append_strips(const TriangleStrips& strips, std::vector<std::byte>& bytes) {
  append_little(bytes, strips.count());
  for (std::uint32_t s = 0; s < strips.count(); ++s)
    append_little(bytes, strips.first[s + 1] - strips.first[s]);
  append_array<std::uint32_t>(bytes, strips.range);
  append_array<std::uint32_t>(bytes, strips.indices);
}

Result<TriangleStrips> take_strips(SectionReader& section, std::uint32_t vertex_count,
                                   std::uint32_t material_range_count) {
  constexpr std::uint64_t kMost = 0x7fffffff;
  TriangleStrips strips;
  const std::uint32_t count = section.take_count(2 * sizeof(std::uint32_t));
  const auto lengths = section.take_array<std::uint32_t>(count);
  strips.range = section.take_array<std::uint32_t>(count);
  if (!section.good()) return section.fault("the strips end too early");
  std::uint64_t total = 0;
  strips.first.reserve(std::size_t{count} + 1);
  for (const std::uint32_t length : lengths) {
    total += length;
    if (length < kLeastStrip || length > kMostStrip || total > kMost)
      return section.fault("a strip has a wrong length");
    strips.first.push_back(static_cast<std::uint32_t>(total));
  }
  const std::uint32_t ranges = std::max(1u, material_range_count);
  if (std::any_of(strips.range.begin(), strips.range.end(),
                  [&](std::uint32_t range) { return range >= ranges; }))
    return section.fault("a strip is of a material range that there is not");
  strips.indices = section.take_array<std::uint32_t>(total);
  if (!section.good()) return section.fault("the strips end too early");
  if (std::any_of(strips.indices.begin(), strips.indices.end(),
                  [&](std::uint32_t vertex) { return vertex >= vertex_count; }))
    return section.fault("a strip has a vertex that there is not");
  return strips;
}

std::size_t strip_bytes(const TriangleStrips& strips) {
  return (strips.indices.size() + strips.first.size() + strips.range.size()) *
         sizeof(std::uint32_t);
}

ChangeChecker::ChangeChecker(const TriangleStrips& strips, const LevelTable& table)
    : table_(table),
      slots_(strips),
      level_(table.finest_level()),
      base_vertices_(table.vertex_count(0)),
      vertex_end_(table.vertex_count(level_)),
      vertex_begin_(level_ == 0 ? vertex_end_ : vertex_end_ - table.step(level_ - 1).vertices),
      drawn_(vertex_end_ - base_vertices_, 0) {
  for (const std::uint32_t vertex : strips.indices) count(vertex, 1);
}

void ChangeChecker::count(std::uint32_t vertex, std::uint32_t change) {
  if (vertex >= base_vertices_) drawn_[vertex - base_vertices_] += change;
}

bool ChangeChecker::is_drawn(std::uint32_t strip) const {
  return strip < slots_.strip_count() && slots_.length(strip) >= kLeastStrip;
}

bool ChangeChecker::collapse(std::uint32_t strip, std::uint32_t position, std::uint32_t moved) {
  if (!is_drawn(strip) || position >= slots_.length(strip)) return false;
  if (moved >= vertex_end_ - vertex_begin_) return false;
  const std::uint32_t vertex = vertex_begin_ + moved;
  if (slots_.at(strip, position) != vertex) return false;
  slots_.set(strip, position, table_.target(vertex));
  count(vertex, ~0u);
  count(table_.target(vertex), 1);
  return true;
}

bool ChangeChecker::remove(std::uint32_t strip, std::uint32_t position) {
  if (!is_drawn(strip) || !slots_.can_remove(strip, position)) return false;
  const std::uint32_t before = slots_.length(strip);
  slots_.remove(strip, position);
  const std::uint32_t kept = is_drawn(strip) ? slots_.length(strip) : 0;
  for (std::uint32_t i = kept; i < before; ++i) count(slots_.at(strip, i), ~0u);
  return true;
}

bool ChangeChecker::finish_level() {
  for (std::uint32_t v = vertex_begin_; v < vertex_end_; ++v)
    if (drawn_[v - base_vertices_] != 0) return false;
  --level_;
  vertex_end_ = vertex_begin_;
  if (level_ > 0) vertex_begin_ -= table_.step(level_ - 1).vertices;
  return true;
}

}  // namespace varifold
