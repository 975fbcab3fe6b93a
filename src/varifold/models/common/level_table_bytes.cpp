#include <varifold/models/common/level_table_bytes.h>

#include <varifold/models/common/error_code.h>

namespace varifold {

void LevelTableCoder::append(const LevelTable& table, std::vector<std::byte>& bytes) {
  append_little(bytes, table.finest_level());
  append_little(bytes, table.base_.vertices);
  append_little(bytes, table.base_.triangles);
  append_little(bytes, static_cast<std::uint32_t>(table.error_is_measured_ ? 1 : 0));
  append_array<std::uint8_t>(bytes, table.steps_);
  append_little(bytes, static_cast<std::uint32_t>(table.exceptions_.size()));
  for (const LevelTable::Exception& e : table.exceptions_) {
    append_little(bytes, e.vertices);
    append_little(bytes, e.triangles);
  }
  append_little(bytes, static_cast<std::uint32_t>(table.errors_.size()));
  for (const LevelTable::ErrorRun& run : table.errors_) {
    append_little(bytes, run.first_level);
    append_little(bytes, run.code);
  }
  // The base goes nowhere.
  append_array(bytes, table.targets().subspan(table.base_.vertices));
}

Result<LevelTable> LevelTableCoder::take(SectionReader& section, std::uint32_t most_vertices) {
  LevelTable table;
  const auto levels = section.take<std::uint32_t>();
  table.base_.vertices = section.take<std::uint32_t>();
  table.base_.triangles = section.take<std::uint32_t>();
  const auto measured = section.take<std::uint32_t>();
  if (measured > 1) return section.fault("unknown flags of the errors");
  table.error_is_measured_ = measured == 1;
  const auto codes = section.take_array<std::uint8_t>(levels);
  const std::uint32_t exceptions = section.take_count(8);
  if (!section.good()) return section.fault("the level table ends too early");

  std::uint64_t vertices = table.base_.vertices, triangles = table.base_.triangles;
  if (vertices > most_vertices) return section.fault("there are more vertices than the mesh has");
  std::uint32_t used = 0;
  for (const std::uint8_t code : codes) {
    LevelTable::Step step{code & 15u, static_cast<std::uint32_t>(code >> 4u)};
    if (code == LevelTable::kException) {
      if (used++ == exceptions) return section.fault("a step's counts are missing");
      step = {section.take<std::uint32_t>(), section.take<std::uint32_t>()};
      if (step.vertices < 16 && step.triangles < 15)
        return section.fault("a step's counts are written the long way");
    }
    if (step.vertices == 0) return section.fault("a step without a vertex");
    vertices += step.vertices;
    triangles += step.triangles;
    if (vertices > most_vertices || triangles > kMost)
      return section.fault("the steps add up to too much");
    table.push_step(step);
  }
  if (used != exceptions) return section.fault("there are more exceptions than steps need");
  if (levels > 0 && table.base_.vertices == 0) return section.fault("there is no vertex to split");

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
  const auto targets = section.take_array<std::uint32_t>(vertices - table.base_.vertices);
  if (!section.good()) return section.fault("the level table ends too early");
  table.target_.assign(table.base_.vertices, kNone);
  table.target_.insert(table.target_.end(), targets.begin(), targets.end());
  table.finish();
  // Within a step no vertex may go to another of the same step.
  std::uint32_t live = table.base_.vertices, v = live;
  for (std::uint32_t k = 0; k < levels; ++k) {
    const std::uint32_t end = live + table.step(k).vertices;
    for (; v < end; ++v)
      if (table.target_[v] >= live) return section.fault("a vertex goes to one that is not older");
    live = end;
  }
  return table;
}

}  // namespace varifold
