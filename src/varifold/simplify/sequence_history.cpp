#include <varifold/simplify/sequence_history.h>

#include <varifold/simplify/target_tree.h>
#include <utility>

namespace varifold {

namespace {

// A corner at full detail and the vertices that the coarsest level with its triangle has.
struct Corner {
  std::uint32_t slot = 0, vertices = 0;
};

// The corners at each vertex of full detail, ascending, in one row.
class CornerRows {
 public:
  explicit CornerRows(const DetailedMesh& detailed)
      : begin_(detailed.mesh.vertex_count() + 1, 0), corners_(detailed.mesh.indices.size()) {
    const std::vector<std::uint32_t>& indices = detailed.mesh.indices;
    const CollapseSequence& sequence = detailed.sequence;
    for (const std::uint32_t v : indices) ++begin_[v];
    for (std::uint32_t sum = 0; std::uint32_t & begin : begin_) begin = sum += begin;
    for (auto t = static_cast<std::uint32_t>(indices.size() / 3); t-- > 0;) {
      const std::uint32_t vertices = sequence.vertices[sequence.triangle_level[t]];
      for (std::uint32_t slot = 3 * t + 3; slot-- > 3 * t;)
        corners_[--begin_[indices[slot]]] = {slot, vertices};
    }
  }
  [[nodiscard]] std::span<const Corner> of(std::uint32_t vertex) const {
    return {corners_.data() + begin_[vertex], begin_[vertex + 1] - begin_[vertex]};
  }

 private:
  std::vector<std::uint32_t> begin_;
  std::vector<Corner> corners_;
};

}  // namespace

SequenceHistory::SequenceHistory(const DetailedMesh& detailed) {
  const CollapseSequence& sequence = detailed.sequence;
  first_vertex_ = sequence.vertices.empty() ? 0 : sequence.vertices[0];
  changed_begin_.assign(detailed.mesh.vertex_count() - first_vertex_ + 1, 0);
  corners_.resize(detailed.mesh.indices.size());
  find_added(sequence);
  if (sequence.step_count() == 0) {
    corners_ = detailed.mesh.indices;
    return;
  }

  // A corner goes up the targets as long as its triangle is there. Along the tree, corners that
  // come to a vertex one behind the other are one behind the other, and few lists are written at a
  // time.
  const CornerRows rows(detailed);
  places_ = places_in_tree(sequence);
  std::vector<std::uint32_t> order(places_.size());
  for (std::uint32_t v = 0; v < order.size(); ++v) order[places_[v]] = v;
  for (const std::uint32_t vertex : order)
    for (const Corner& corner : rows.of(vertex)) {
      std::uint32_t v = vertex;
      for (; v >= corner.vertices; v = sequence.target[v]) ++changed_begin_[v - first_vertex_ + 1];
      corners_[corner.slot] = v;
    }
  for (std::size_t i = 1; i < changed_begin_.size(); ++i)
    changed_begin_[i] += changed_begin_[i - 1];
  changed_.resize(changed_begin_.back());
  std::vector<std::uint32_t> end(changed_begin_.begin(), changed_begin_.end() - 1);
  for (const std::uint32_t vertex : order)
    for (const Corner& corner : rows.of(vertex))
      for (std::uint32_t v = vertex; v >= corner.vertices; v = sequence.target[v])
        changed_[end[v - first_vertex_]++] = corner.slot;
}

SequenceHistory::SequenceHistory(const CollapseSequence& sequence,
                                 std::vector<std::uint32_t> changed,
                                 std::vector<std::uint32_t> changed_begin,
                                 std::vector<std::uint32_t> first_corners)
    : first_vertex_(sequence.vertices.empty() ? 0 : sequence.vertices[0]),
      changed_(std::move(changed)),
      changed_begin_(std::move(changed_begin)),
      corners_(std::move(first_corners)) {
  find_added(sequence);
}

// Triangles by level: those of the base are level 0, the split from k adds those of k + 1.
void SequenceHistory::find_added(const CollapseSequence& sequence) {
  const std::uint32_t steps = sequence.step_count();
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
