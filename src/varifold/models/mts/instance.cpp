#include <varifold/models/mts/instance.h>

#include <varifold/models/common/extract_level.h>
#include <varifold/models/common/uniform_model.h>
#include <varifold/view/draw_vertices.h>
#include <algorithm>

namespace varifold {

static_assert(UniformInstance<MultiresolutionStripsInstance, MultiresolutionStrips>);

MultiresolutionStripsInstance::MultiresolutionStripsInstance(
    std::shared_ptr<const MultiresolutionStrips> model)
    : model_(std::move(model)) {
  const MultiresolutionStripsData& data = model_->data();
  indices_.assign(data.strips.back().first_index, kStripRestart);
  const std::uint32_t strips = model_->strip_count();
  lengths_.assign(strips, 0);
  lowest_.assign(strips, 0);
  above_.assign(strips, 0);
  ranges_.reserve(strips);
  changed_.reset(indices_.size());
  for (std::uint32_t s = 0; s < strips; ++s) walk(s);
}

void MultiresolutionStripsInstance::go_to_level(std::uint32_t level) {
  level_ = std::min(level, model_->finest_level());
  const std::uint32_t strips = model_->strip_count();
  constexpr std::uint32_t kGroup = 32;  // looked at together; most strips of a small step stay
  for (std::uint32_t begin = 0; begin < strips; begin += kGroup) {
    const std::uint32_t end = std::min(strips, begin + kGroup);
    std::uint32_t changes = 0;
    for (std::uint32_t s = begin; s < end; ++s)
      changes |= static_cast<std::uint32_t>(level_ - lowest_[s] > above_[s]);
    if (changes == 0) continue;
    for (std::uint32_t s = begin; s < end; ++s)
      if (level_ - lowest_[s] > above_[s]) walk(s);
  }
}

void MultiresolutionStripsInstance::walk(std::uint32_t strip) {
  const MultiresolutionStripsData& data = model_->data();
  const MultiresolutionStripsData::Strip& here = data.strips[strip];
  const MultiresolutionStripsData::Strip& next = data.strips[strip + 1];

  // Find the state of the level, and the levels of that state.
  const auto* changes = data.changes.data() + here.first_change;
  const std::uint32_t change_count = next.first_change - here.first_change;
  const auto state = static_cast<std::uint32_t>(
      std::partition_point(changes, changes + change_count,
                           [&](std::uint32_t level) { return level >= level_; }) -
      changes);
  const std::uint32_t highest = state == 0 ? model_->finest_level() : changes[state - 1];
  lowest_[strip] = state == change_count ? 0 : changes[state] + 1;
  above_[strip] = highest - lowest_[strip];

  // Follow the arcs of that state.
  const auto* vertex = data.node_vertex.data() + here.first_node;
  const auto* first_arc = data.node_arc.data() + here.first_node;
  const auto* arcs = data.arcs.data() + here.first_arc;
  const std::uint32_t end = next.first_node - here.first_node;
  const std::uint32_t room = next.first_index - here.first_index - 1;
  std::uint32_t* out = indices_.data() + here.first_index;
  std::uint32_t length = 0;
  for (std::uint32_t node = 0; length < room;) {
    const auto* arc = arcs + first_arc[node];
    while (arc->last < state) ++arc;
    node = arc->to;
    if (node == end) break;
    out[length++] = vertex[node];
  }
  const std::uint32_t before = lengths_[strip];
  for (std::uint32_t i = length; i < before; ++i) out[i] = kStripRestart;
  lengths_[strip] = length;
  changed_.mark(here.first_index, std::max(length, before));
}

void MultiresolutionStripsInstance::append_ranges(std::vector<DrawRange>& ranges) const {
  const MultiresolutionStripsData& data = model_->data();
  const std::uint32_t finest = model_->finest_level();
  const float fraction = finest > 0 ? static_cast<float>(level_) / static_cast<float>(finest) : 1;
  for (std::size_t r = 0; r + 1 < data.first_strip.size(); ++r) {
    const std::uint32_t material = data.mesh.ranges.empty() ? 0 : data.mesh.ranges[r].material;
    std::uint32_t end = kNone;  // of the range before, of the same material
    for (std::uint32_t s = data.first_strip[r]; s < data.first_strip[r + 1]; ++s) {
      if (lengths_[s] == 0) continue;
      const std::uint32_t first = data.strips[s].first_index;
      // One restart between two strips: they are drawn together.
      if (end == kNone || first - end > 1)
        ranges.push_back({first, 0, Primitive::kStrips, material, fraction});
      end = first + lengths_[s];
      ranges.back().index_count = end - ranges.back().first_index;
    }
  }
}

DrawList MultiresolutionStripsInstance::draw_list() {
  ranges_.clear();
  append_ranges(ranges_);
  DrawList list = draw_vertices(model_->attributes());
  list.indices = indices_;
  list.ranges = ranges_;
  list.changed_indices = changed_.take();
  return list;
}

std::size_t MultiresolutionStripsInstance::bytes() const {
  return (indices_.size() + lengths_.size() + lowest_.size() + above_.size()) *
             sizeof(std::uint32_t) +
         ranges_.capacity() * sizeof(DrawRange) + changed_.bytes();
}

TriangleMesh MultiresolutionStripsInstance::extract() const {
  std::vector<DrawRange> ranges;
  append_ranges(ranges);
  const TriangleMesh& mesh = model_->attributes();
  DrawList list = draw_vertices(mesh);
  list.indices = indices_;
  list.ranges = ranges;
  return extract_level(mesh, vertex_count(), list);
}

}  // namespace varifold
