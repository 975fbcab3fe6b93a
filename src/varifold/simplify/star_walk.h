// The stars of all steps of a sequence, one by one from the full level down.
#pragma once

#include <varifold/simplify/collapse_sequence.h>
#include <varifold/simplify/sequence_history.h>
#include <varifold/simplify/sequence_replay.h>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace varifold {

/// The collapses of a sequence done once more, as SequenceReplay does them and to the same lists;
/// where no vertex is moved, along its history: without lists of slots, and what comes next is
/// known early. Slots are those of SequenceReplay. 12 bytes a triangle, and where vertices move
/// those of SequenceReplay.
class StarWalk {
 public:
  /// Both must live on. Without a history, and where vertices move, it is a replay.
  StarWalk(const DetailedMesh& detailed, const SequenceHistory* history);

  [[nodiscard]] std::uint32_t level() const { return replay_ ? replay_->level() : level_; }
  /// The index buffer, see SequenceReplay.
  [[nodiscard]] const std::vector<std::uint32_t>& corners() const {
    return replay_ ? replay_->corners() : corners_;
  }
  /// Appends the slots of the vertices that the next collapse removes.
  void removed_slots(std::vector<std::uint32_t>& slots) const;
  /// Appends the slots of a vertex. Along a history all that is needed for it is made at the first
  /// call: 4 bytes a slot and 12 a vertex.
  void slots_of(std::uint32_t vertex, std::vector<std::uint32_t>& slots);
  /// One collapse, to level() - 1.
  void collapse();
  /// The slots that the last collapse handed to targets.
  [[nodiscard]] std::span<const std::uint32_t> changed() const {
    return replay_ ? replay_->changed() : changed_;
  }
  /// f(slot) for slots that the collapse after so many others will hand on, where they are known.
  template <class F>
  void for_each_later(std::uint32_t collapses, const F& f) const {
    if (replay_ || level_ <= collapses) return;
    for (const std::uint32_t slot : changed_by(level_ - 1 - collapses)) f(slot);
  }

 private:
  // Who came to each vertex, in the order of their coming, and its slots of the full level.
  struct Arrivals {
    explicit Arrivals(const DetailedMesh& detailed);
    std::vector<std::uint32_t> first_slot, slots, first_vertex, vertices;
  };
  [[nodiscard]] std::span<const std::uint32_t> changed_by(std::uint32_t step) const;
  [[nodiscard]] std::uint64_t place_of(std::uint32_t slot) const;
  void removed_slots(std::uint32_t vertex, std::vector<std::uint32_t>& slots) const;

  const DetailedMesh& detailed_;
  std::optional<SequenceReplay> replay_;
  const SequenceHistory* history_;
  std::uint32_t level_;
  std::vector<std::uint32_t> corners_;
  std::span<const std::uint32_t> changed_;
  std::optional<Arrivals> arrivals_;
};

}  // namespace varifold
