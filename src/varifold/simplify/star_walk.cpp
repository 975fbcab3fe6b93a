#include <varifold/simplify/star_walk.h>

#include <algorithm>
#include <array>

namespace varifold {

StarWalk::StarWalk(const DetailedMesh& detailed, const SequenceHistory* history)
    : detailed_(detailed), history_(history), level_(detailed.sequence.step_count()) {
  if (history == nullptr || detailed.sequence.moves_vertices())
    replay_.emplace(detailed);
  else
    corners_ = detailed.mesh.indices;
}

// Those of the vertices of a step lie one behind the other.
std::span<const std::uint32_t> StarWalk::changed_by(std::uint32_t step) const {
  const CollapseSequence& sequence = detailed_.sequence;
  const auto first = history_->changed(sequence.vertices[step]);
  const auto last = history_->changed(sequence.vertices[step + 1] - 1);
  return {first.data(), last.data() + last.size()};
}

void StarWalk::removed_slots(std::vector<std::uint32_t>& slots) const {
  const CollapseSequence& sequence = detailed_.sequence;
  const std::uint32_t step = level() - 1;
  for (std::uint32_t v = sequence.vertices[step]; v < sequence.vertices[step + 1]; ++v)
    if (replay_)
      replay_->slots_of(v, slots);
    else
      removed_slots(v, slots);
}

// Slots of a vertex are in the order of this.
std::uint64_t StarWalk::place_of(std::uint32_t slot) const {
  return std::uint64_t{history_->place_in_tree(detailed_.mesh.indices[slot])} << 32u | slot;
}

// Those that go on to the target, and among these the ones that vanish.
void StarWalk::removed_slots(std::uint32_t vertex, std::vector<std::uint32_t>& slots) const {
  const std::size_t begin = slots.size();
  const auto changed = history_->changed(vertex);
  slots.insert(slots.end(), changed.begin(), changed.end());
  for (const std::uint32_t triangle : history_->added(level_ - 1))
    for (std::uint32_t slot = 3 * triangle; slot < 3 * triangle + 3; ++slot) {
      if (history_->first_corners()[slot] != vertex) continue;
      const std::uint64_t place = place_of(slot);
      std::size_t at = slots.size();
      slots.push_back(slot);
      for (; at > begin && place_of(slots[at - 1]) > place; --at) slots[at] = slots[at - 1];
      slots[at] = slot;
    }
}

void StarWalk::collapse() {
  if (replay_) return replay_->collapse();
  const CollapseSequence& sequence = detailed_.sequence;
  --level_;
  changed_ = changed_by(level_);
  for (std::uint32_t v = sequence.vertices[level_]; v < sequence.vertices[level_ + 1]; ++v)
    for (const std::uint32_t slot : history_->changed(v)) corners_[slot] = sequence.target[v];
}

StarWalk::Arrivals::Arrivals(const DetailedMesh& detailed)
    : first_slot(detailed.mesh.vertex_count() + 1, 0),
      slots(detailed.mesh.indices.size()),
      first_vertex(detailed.mesh.vertex_count() + 1, 0),
      vertices(detailed.mesh.vertex_count()) {
  const CollapseSequence& sequence = detailed.sequence;
  const std::vector<std::uint32_t>& indices = detailed.mesh.indices;
  // Entries are counted and then set backwards, from where each row ends.
  for (const std::uint32_t v : indices) ++first_slot[v];
  for (const std::uint32_t t : sequence.target)
    if (t != kNone) ++first_vertex[t];
  for (std::vector<std::uint32_t>* first : {&first_slot, &first_vertex})
    for (std::uint32_t sum = 0; std::uint32_t & begin : *first) begin = sum += begin;
  for (auto slot = static_cast<std::uint32_t>(indices.size()); slot-- > 0;)
    slots[--first_slot[indices[slot]]] = slot;
  for (std::uint32_t k = 0; k < sequence.step_count(); ++k)
    for (std::uint32_t v = sequence.vertices[k + 1]; v-- > sequence.vertices[k];)
      vertices[--first_vertex[sequence.target[v]]] = v;
}

void StarWalk::slots_of(std::uint32_t vertex, std::vector<std::uint32_t>& slots) {
  if (replay_) return replay_->slots_of(vertex, slots);
  if (!arrivals_) arrivals_.emplace(detailed_);
  const CollapseSequence& sequence = detailed_.sequence;
  const auto add = [&](std::uint32_t slot) {
    if (sequence.triangle_level[slot / 3] <= level_) slots.push_back(slot);
  };
  for (std::uint32_t i = arrivals_->first_slot[vertex]; i < arrivals_->first_slot[vertex + 1]; ++i)
    add(arrivals_->slots[i]);
  const std::uint32_t first = arrivals_->first_vertex[vertex];
  for (std::uint32_t i = first; i < arrivals_->first_vertex[vertex + 1]; ++i) {
    const std::uint32_t from = arrivals_->vertices[i];
    if (from < sequence.vertices[level_]) break;  // still there, and so are those behind it
    for (const std::uint32_t slot : history_->changed(from)) add(slot);
  }
}

}  // namespace varifold
