#include <varifold/models/pm/build.h>

#include <varifold/models/common/error_code.h>
#include <varifold/models/pm/slot_order.h>
#include <varifold/simplify/sequence_replay.h>
#include <algorithm>

namespace varifold {

namespace {

constexpr std::uint32_t kLastSlot = ProgressiveMeshData::kLastSlot;
constexpr std::uint32_t kNoSlot = ProgressiveMeshData::kNoSlot;

// What one collapse changed, appended so that the whole array can be turned round at the end.
void append_slots(const SequenceReplay& replay, std::uint32_t moved,
                  std::vector<std::uint32_t>& slots) {
  if (moved == 1 && replay.changed().empty()) return;  // an ear went: nothing else changed
  for (std::uint32_t i = 0; i < moved; ++i) {
    const auto changed = replay.changed(i);
    if (changed.empty())
      slots.push_back(kNoSlot);
    else
      slots.insert(slots.end(), changed.begin(), changed.end());
    slots.back() |= kLastSlot;
  }
}

// finer[j]: the record that set the same vertex at the next finer level that set it.
void link_placements(const CollapseSequence& sequence, ProgressiveMeshData& data) {
  if (!sequence.moves_vertices()) return;
  data.first_placed = sequence.first_placed;
  data.placed_vertex = sequence.placed_vertex;
  data.placed = sequence.placed;
  data.finer.assign(data.placed_vertex.size(), kNone);
  std::vector<std::uint32_t> latest(data.mesh.vertex_count(), kNone);
  for (std::uint32_t level = sequence.step_count(); level-- > 0;) {
    for (std::uint32_t j = data.first_placed[level]; j < data.first_placed[level + 1]; ++j) {
      data.finer[j] = latest[data.placed_vertex[j]];
      latest[data.placed_vertex[j]] = j;
    }
  }
}

// Turns every triangle so that the corner of greatest number, the newest when the triangle appears,
// comes first. `corners` are those of each triangle when it appears.
void rotate_newest_first(std::vector<std::uint32_t>& corners, std::vector<std::uint32_t>& slots) {
  std::vector<std::uint8_t> newest(corners.size() / 3);
  for (std::size_t t = 0; t < newest.size(); ++t) {
    const auto first = corners.begin() + static_cast<std::ptrdiff_t>(3 * t);
    const auto greatest = std::max_element(first, first + 3);
    newest[t] = static_cast<std::uint8_t>(greatest - first);
    std::rotate(first, greatest, first + 3);
  }
  for (std::uint32_t& entry : slots) {
    const std::uint32_t slot = entry & ~kLastSlot;
    if (slot == kNoSlot) continue;
    const std::uint32_t corner = (slot % 3 + 3 - newest[slot / 3]) % 3;
    entry = (entry & kLastSlot) | (slot - slot % 3 + corner);
  }
}

// Rounded up to their stored form, and never rising with the level.
std::vector<float> stored_errors(const std::vector<float>& errors) {
  std::vector<float> stored(errors.size());
  std::uint32_t greatest = 0;
  for (std::size_t level = errors.size(); level-- > 0;) {
    greatest = std::max(greatest, error_code(errors[level]));
    stored[level] = error_of_code(greatest);
  }
  return stored;
}

}  // namespace

ProgressiveMesh build_progressive_mesh(const DetailedMesh& detailed) {
  const CollapseSequence& sequence = detailed.sequence;
  const std::uint32_t steps = sequence.step_count();
  ProgressiveMeshData data;
  data.base_vertices = sequence.vertices.empty() ? 0 : sequence.vertices[0];
  data.base_triangles = sequence.triangles.empty() ? 0 : sequence.triangles[0];
  data.splits.resize(steps);
  data.target = sequence.target;
  data.error = stored_errors(sequence.error);
  data.error_is_measured = sequence.error_is_measured;
  if (detailed.mesh.ranges.size() > 1) data.triangle_level = sequence.triangle_level;

  SequenceReplay replay(detailed);
  std::vector<std::uint32_t> step_slots;
  std::vector<std::uint32_t> backwards;
  backwards.reserve(3 * std::size_t{detailed.mesh.triangle_count()});
  for (std::uint32_t k = steps; k-- > 0;) {
    replay.collapse();
    const std::uint32_t moved = sequence.vertices[k + 1] - sequence.vertices[k];
    step_slots.clear();
    append_slots(replay, moved, step_slots);
    backwards.insert(backwards.end(), step_slots.rbegin(), step_slots.rend());
    data.splits[k] = {static_cast<std::uint16_t>(step_slots.size()),
                      static_cast<std::uint8_t>(moved),
                      static_cast<std::uint8_t>(sequence.triangles[k + 1] - sequence.triangles[k])};
  }
  data.slots.assign(backwards.rbegin(), backwards.rend());
  data.mesh = detailed.mesh;
  data.mesh.indices = replay.corners();
  rotate_newest_first(data.mesh.indices, data.slots);
  sort_slots(data.slots);
  link_placements(sequence, data);
  return ProgressiveMesh(std::move(data));
}

}  // namespace varifold
