#include <varifold/simplify/sequence_history.h>

#include <varifold/simplify/sequence_replay.h>
#include <algorithm>

namespace varifold {

SequenceHistory::SequenceHistory(const DetailedMesh& detailed) {
  const CollapseSequence& sequence = detailed.sequence;
  const std::uint32_t steps = sequence.step_count();
  first_vertex_ = sequence.vertices.empty() ? 0 : sequence.vertices[0];
  changed_begin_.assign(detailed.mesh.vertex_count() - first_vertex_ + 1, 0);
  SequenceReplay replay(detailed);
  // The replay walks down; everything is appended in that order and turned round at the end.
  for (std::uint32_t k = steps; k-- > 0;) {
    replay.collapse();
    for (std::uint32_t i = sequence.vertices[k + 1] - sequence.vertices[k]; i-- > 0;) {
      const auto slots = replay.changed(i);
      changed_.insert(changed_.end(), slots.rbegin(), slots.rend());
      changed_begin_[sequence.vertices[k] + i - first_vertex_] =
          static_cast<std::uint32_t>(changed_.size());
    }
  }
  std::reverse(changed_.begin(), changed_.end());
  const auto all = static_cast<std::uint32_t>(changed_.size());
  for (std::uint32_t& begin : changed_begin_) begin = all - begin;
  corners_ = replay.corners();

  // Triangles by level: those of the base are level 0, the split from k adds those of k + 1.
  added_begin_.assign(steps + 1, 0);
  for (const std::uint32_t level : sequence.triangle_level)
    if (level > 0) ++added_begin_[level];
  for (std::uint32_t k = 1; k <= steps; ++k) added_begin_[k] += added_begin_[k - 1];
  added_.resize(added_begin_[steps]);
  std::vector<std::uint32_t> cursor(added_begin_.begin(), added_begin_.end());
  for (std::uint32_t t = 0; t < sequence.triangle_level.size(); ++t)
    if (sequence.triangle_level[t] > 0) added_[cursor[sequence.triangle_level[t] - 1]++] = t;
}

}  // namespace varifold
