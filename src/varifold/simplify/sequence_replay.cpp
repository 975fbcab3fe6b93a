#include <varifold/simplify/sequence_replay.h>

#include <algorithm>

namespace varifold {

SequenceReplay::SequenceReplay(const DetailedMesh& detailed)
    : sequence_(detailed.sequence),
      level_(detailed.sequence.step_count()),
      corners_(detailed.mesh.indices) {
  next_.assign(corners_.size(), kNone);
  first_.assign(detailed.mesh.vertex_count(), kNone);
  last_.assign(detailed.mesh.vertex_count(), kNone);
  for (auto slot = static_cast<std::uint32_t>(corners_.size()); slot-- > 0;) {
    const std::uint32_t v = corners_[slot];
    next_[slot] = first_[v];
    if (first_[v] == kNone) last_[v] = slot;
    first_[v] = slot;
  }
}

void SequenceReplay::collapse() {
  changed_.clear();
  changed_end_.clear();
  removed_.clear();
  const std::uint32_t begin = sequence_.vertices[level_ - 1];
  const std::uint32_t end = sequence_.vertices[level_];
  for (std::uint32_t v = begin; v < end; ++v) {
    move_vertex(v);
    changed_end_.push_back(static_cast<std::uint32_t>(changed_.size()));
  }
  std::sort(removed_.begin(), removed_.end());
  removed_.erase(std::unique(removed_.begin(), removed_.end()), removed_.end());
  --level_;
}

// Hands the slots of `vertex` to its target; those of triangles that vanish stay behind.
void SequenceReplay::move_vertex(std::uint32_t vertex) {
  const std::uint32_t target = sequence_.target[vertex];
  for (std::uint32_t slot = first_[vertex]; slot != kNone;) {
    const std::uint32_t next = next_[slot];
    const std::uint32_t level = sequence_.triangle_level[slot / 3];
    if (level == level_) removed_.push_back(slot / 3);
    if (level < level_) {
      changed_.push_back(slot);
      corners_[slot] = target;
      next_[slot] = kNone;
      if (first_[target] == kNone)
        first_[target] = slot;
      else
        next_[last_[target]] = slot;
      last_[target] = slot;
    }
    slot = next;
  }
}

std::span<const std::uint32_t> SequenceReplay::changed(std::uint32_t moved_index) const {
  const std::uint32_t begin = moved_index == 0 ? 0 : changed_end_[moved_index - 1];
  return {changed_.data() + begin, changed_end_[moved_index] - begin};
}

void SequenceReplay::slots_of(std::uint32_t vertex, std::vector<std::uint32_t>& slots) const {
  for (std::uint32_t slot = first_[vertex]; slot != kNone; slot = next_[slot])
    if (sequence_.triangle_level[slot / 3] <= level_) slots.push_back(slot);
}

}  // namespace varifold
