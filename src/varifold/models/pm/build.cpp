#include <varifold/models/pm/build.h>

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

// The same mesh with the corner of greatest number, the newest, first in each triangle.
void rotate_newest_first(TriangleMesh& mesh) {
  for (std::size_t t = 0; t + 2 < mesh.indices.size(); t += 3) {
    const auto corner = mesh.indices.begin() + static_cast<std::ptrdiff_t>(t);
    std::rotate(corner, std::max_element(corner, corner + 3), corner + 3);
  }
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
  data.error = sequence.error;
  data.error_is_measured = sequence.error_is_measured;
  if (detailed.mesh.ranges.size() > 1) data.triangle_level = sequence.triangle_level;

  DetailedMesh rotated{detailed.mesh, sequence, {}, {}};
  rotate_newest_first(rotated.mesh);
  SequenceReplay replay(rotated);
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
  data.mesh = std::move(rotated.mesh);
  data.mesh.indices = replay.corners();
  link_placements(sequence, data);
  return ProgressiveMesh(std::move(data));
}

}  // namespace varifold
