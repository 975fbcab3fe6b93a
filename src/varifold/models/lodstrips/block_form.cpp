#include <varifold/models/lodstrips/block_form.h>

#include <varifold/models/lodstrips/block_check.h>
#include <algorithm>
#include <numeric>

namespace varifold {

std::size_t BlockForm::bytes() const {
  return (first.size() + range.size() + base_slots.size() + long_steps.size()) *
             sizeof(std::uint32_t) +
         base_counts.size() + step_bytes.size() + records.size();
}

std::uint32_t BlockForm::size_of_long_step(std::uint32_t level) const {
  std::size_t low = 0, high = long_steps.size() / 2;
  while (high - low > 1) {
    const std::size_t middle = (low + high) / 2;
    (long_steps[2 * middle] <= level ? low : high) = middle;
  }
  return long_steps[2 * low + 1];
}

void BlockForm::append_bytes(std::vector<std::byte>& bytes) const {
  append_little(bytes, buffer_size);
  append_little(bytes, static_cast<std::uint32_t>(first.size()));
  append_array<std::uint32_t>(bytes, first);
  append_little(bytes, static_cast<std::uint32_t>(range.empty() ? 0 : 1));
  append_array<std::uint32_t>(bytes, range);
  append_little(bytes, static_cast<std::uint32_t>(base_counts.size()));
  append_array<std::uint8_t>(bytes, base_counts);
  append_array<std::uint32_t>(bytes, base_slots);
  append_array<std::uint8_t>(bytes, step_bytes);
  append_little(bytes, static_cast<std::uint32_t>(long_steps.size()));
  append_array<std::uint32_t>(bytes, long_steps);
  append_little(bytes, word_bytes);
  append_little(bytes, static_cast<std::uint64_t>(records.size() - kPadding));
  append_array(bytes, std::span<const std::uint8_t>(records).first(records.size() - kPadding));
}

Result<BlockForm> BlockForm::take(SectionReader& section, const LevelTable& levels,
                                  std::uint32_t material_range_count) {
  BlockForm form;
  form.buffer_size = section.take<std::uint32_t>();
  const std::uint32_t block_count = section.take_count(sizeof(std::uint32_t));
  form.first = section.take_array<std::uint32_t>(block_count);
  const bool has_ranges = section.take<std::uint32_t>() != 0;
  if (has_ranges) form.range = section.take_array<std::uint32_t>(block_count);
  form.base_counts = section.take_array<std::uint8_t>(section.take_count(1));
  const std::uint64_t base_slots =
      std::accumulate(form.base_counts.begin(), form.base_counts.end(), std::uint64_t{0});
  form.base_slots = section.take_array<std::uint32_t>(base_slots);
  form.step_bytes = section.take_array<std::uint8_t>(levels.finest_level());
  form.long_steps = section.take_array<std::uint32_t>(section.take_count(sizeof(std::uint32_t)));
  form.word_bytes = section.take<std::uint32_t>();
  form.records = section.take_array<std::uint8_t>(section.take<std::uint64_t>());
  if (!section.good()) return section.fault("the blocks end too early");
  form.records.insert(form.records.end(), kPadding, 0);

  if (has_ranges != (material_range_count > 1)) return section.fault("the materials do not match");
  for (const std::uint32_t r : form.range)
    if (r >= material_range_count) return section.fault("a block has no material");
  // No block is larger, and each has slots at some level.
  if (form.buffer_size > std::uint64_t{kMaxSlots} * block_count)
    return section.fault("the buffer is larger than its blocks");
  if (const char* fault = check_block_form(form, levels)) return section.fault(fault);
  return form;
}

}  // namespace varifold
