#include <varifold/models/common/level_table_bytes.h>

#include <varifold/models/common/error_code.h>

namespace varifold {

namespace {

constexpr std::uint32_t kMost = 0x7fffffff;  // vertices and triangles

// Vertices in the low half, triangles in the high one; or this where they do not fit.
constexpr std::uint8_t kLong = 0xff;

template <class Step>
bool fits(const Step& step) {
  return step.vertices < 16 && step.triangles < 15;
}

}  // namespace

void LevelTableCoder::append(const LevelTable& table, std::vector<std::byte>& bytes) {
  const LevelTable::Step base = table.counts(0);
  append_little(bytes, table.finest_level());
  append_little(bytes, base.vertices);
  append_little(bytes, base.triangles);
  append_little(bytes, static_cast<std::uint32_t>(table.error_is_measured_ ? 1 : 0));
  std::vector<LevelTable::Step> longs;
  for (std::uint32_t k = 0; k < table.finest_level(); ++k) {
    const LevelTable::Step step = table.step(k);
    if (!fits(step)) longs.push_back(step);
    append_little(bytes, fits(step)
                             ? static_cast<std::uint8_t>(step.vertices | step.triangles << 4u)
                             : kLong);
  }
  append_little(bytes, static_cast<std::uint32_t>(longs.size()));
  for (const LevelTable::Step& step : longs) {
    append_little(bytes, step.vertices);
    append_little(bytes, step.triangles);
  }
  append_little(bytes, static_cast<std::uint32_t>(table.errors_.size()));
  for (const LevelTable::ErrorRun& run : table.errors_) {
    append_little(bytes, run.first_level);
    append_little(bytes, run.code);
  }
  // The base goes nowhere.
  append_array(bytes, table.targets().subspan(base.vertices));
}

Result<LevelTable> LevelTableCoder::take(SectionReader& section, std::uint64_t most_vertices) {
  LevelTable table;
  const auto levels = section.take<std::uint32_t>();
  LevelTable::Step base;
  base.vertices = section.take<std::uint32_t>();
  base.triangles = section.take<std::uint32_t>();
  table.end_ = table.groups_[0].counts = base;
  const auto measured = section.take<std::uint32_t>();
  if (measured > 1) return section.fault("unknown flags of the errors");
  table.error_is_measured_ = measured == 1;
  const auto codes = section.take_array<std::uint8_t>(levels);
  const std::uint32_t exceptions = section.take_count(8);
  if (!section.good()) return section.fault("the level table ends too early");

  std::uint64_t vertices = base.vertices, triangles = base.triangles;
  std::uint32_t used = 0;
  for (const std::uint8_t code : codes) {
    LevelTable::Step step{code & 15u, static_cast<std::uint32_t>(code >> 4u)};
    if (code == kLong) {
      if (used++ == exceptions) return section.fault("a step's counts are missing");
      step = {section.take<std::uint32_t>(), section.take<std::uint32_t>()};
      if (fits(step)) return section.fault("a step's counts are written the long way");
    }
    if (step.vertices == 0) return section.fault("a step without a vertex");
    vertices += step.vertices;
    triangles += step.triangles;
    if (vertices > most_vertices || triangles > kMost)
      return section.fault("the steps add up to too much");
    table.push_step(step);
  }
  if (used != exceptions) return section.fault("there are more exceptions than steps need");
  if (levels > 0 && base.vertices == 0) return section.fault("there is no vertex to split");

  if (vertices > most_vertices) return section.fault("the levels have too many vertices");
  const std::uint32_t runs = section.take_count(8);
  for (std::uint32_t i = 0; i < runs; ++i) {
    const LevelTable::ErrorRun run{section.take<std::uint32_t>(), section.take<std::uint32_t>()};
    const bool first = table.errors_.empty();
    if (run.first_level > levels || run.code >= kErrorCodes ||
        (first ? run.first_level != 0
               : run.first_level <= table.errors_.back().first_level ||
                     run.code >= table.errors_.back().code))
      return section.fault("the errors do not fall with the level");
    table.errors_.push_back(run);
  }
  const auto targets = section.take_array<std::uint32_t>(vertices - base.vertices);
  if (!section.good()) return section.fault("the level table ends too early");
  table.target_.assign(base.vertices, kNone);
  table.target_.insert(table.target_.end(), targets.begin(), targets.end());
  // Within a step no vertex may go to another of the same step.
  std::uint32_t live = base.vertices, v = live;
  for (std::uint32_t k = 0; k < levels; ++k) {
    const std::uint32_t end = live + table.step(k).vertices;
    for (; v < end; ++v)
      if (table.target_[v] >= live) return section.fault("a vertex goes to one that is not older");
    live = end;
  }
  return table;
}

}  // namespace varifold
