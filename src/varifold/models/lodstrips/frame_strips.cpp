#include <varifold/models/lodstrips/frame_strips.h>

#include <varifold/mesh/vertex_arrays.h>
#include <varifold/mesh/weld.h>
#include <varifold/models/common/extract_level.h>
#include <varifold/models/common/strip_filter.h>
#include <varifold/models/lodstrips/strip_bytes.h>
#include <varifold/view/draw_vertices.h>
#include <algorithm>
#include <limits>
#include <utility>

namespace varifold {

namespace {

// The greatest, or the least, of what each sequence says.
template <class Ask>
auto greatest(const FrameStripsData& data, const Ask& ask) {
  auto result = decltype(ask(data.sequences[0].levels)){};
  for (const FrameSequence& sequence : data.sequences)
    result = std::max(result, ask(sequence.levels));
  return result;
}

template <class Ask>
std::uint32_t least(const FrameStripsData& data, const Ask& ask) {
  std::uint32_t result = data.sequences.empty() ? 0 : kNone;
  for (const FrameSequence& sequence : data.sequences)
    result = std::min(result, ask(sequence.levels));
  return result;
}

}  // namespace

FrameStrips::FrameStrips(FrameStripsData data) : data_(std::move(data)) {
  data_.mesh.indices = {};
  if (!may_have_seams(data_.mesh)) return;
  // Without any seam every vertex is a point of its own, and nothing need be looked up.
  WeldMap weld = weld_points(data_.mesh);
  if (weld.class_count < data_.mesh.vertex_count()) point_of_ = std::move(weld.class_of);
}

std::uint32_t FrameStrips::frame_for(std::span<const float> weights) const {
  const auto weight = [](const auto& all, std::size_t i) { return i < all.size() ? all[i] : 0.0f; };
  std::uint32_t best = 0;
  double least = std::numeric_limits<double>::infinity();
  for (std::uint32_t frame = 0; frame < frame_count(); ++frame) {
    const std::vector<float>& own = data_.frames[frame].weights;
    double sum = 0;
    for (std::size_t i = 0; i < std::max(own.size(), weights.size()); ++i) {
      const double way = double{weight(own, i)} - double{weight(weights, i)};
      sum += way * way;
    }
    if (!(sum < least)) continue;
    least = sum;
    best = frame;
  }
  return best;
}

std::uint32_t FrameStrips::finest_level() const {
  return least(data_, [](const LevelTable& levels) { return levels.finest_level(); });
}
std::uint32_t FrameStrips::vertex_count(std::uint32_t level) const {
  return greatest(data_, [=](const LevelTable& levels) { return levels.vertex_count(level); });
}
std::uint32_t FrameStrips::triangle_count(std::uint32_t level) const {
  return greatest(data_, [=](const LevelTable& levels) { return levels.triangle_count(level); });
}
float FrameStrips::error(std::uint32_t level) const {
  return greatest(data_, [=](const LevelTable& levels) { return levels.error(level); });
}
bool FrameStrips::error_is_measured() const {
  return std::all_of(data_.sequences.begin(), data_.sequences.end(),
                     [](const FrameSequence& s) { return s.levels.error_is_measured(); });
}
std::uint32_t FrameStrips::level_for_triangles(std::uint32_t count) const {
  return least(data_, [=](const LevelTable& levels) { return levels.level_for_triangles(count); });
}
std::uint32_t FrameStrips::level_for_vertices(std::uint32_t count) const {
  return least(data_, [=](const LevelTable& levels) { return levels.level_for_vertices(count); });
}
std::uint32_t FrameStrips::level_for_error(float bound) const {
  return greatest(data_, [=](const LevelTable& levels) { return levels.level_for_error(bound); });
}
std::uint32_t FrameStrips::level_for_fraction(float fraction) const {
  return least(data_,
               [=](const LevelTable& levels) { return levels.level_for_fraction(fraction); });
}

std::size_t FrameStrips::sequence_bytes() const {
  std::size_t sum = 0;
  for (const FrameSequence& sequence : data_.sequences)
    sum += sequence.levels.bytes() + sequence.vertex.size() * sizeof(std::uint32_t);
  return sum;
}

std::size_t FrameStrips::bytes() const {
  std::size_t sum = vertex_bytes(data_.mesh) + strip_bytes(data_.strips) + sequence_bytes() +
                    point_of_.size() * sizeof(std::uint32_t);
  for (const StripFrame& frame : data_.frames)
    sum += sizeof frame + frame.weights.size() * sizeof(float);
  return sum;
}

FrameStripsInstance::FrameStripsInstance(std::shared_ptr<const FrameStrips> model)
    : model_(std::move(model)), shown_(model_->attributes().vertex_count()) {
  const TriangleStrips& strips = model_->data().strips;
  // With seams an index may begin a piece: a restart, a repetition and what the last piece has,
  // too.
  indices_.resize((model_->point_of().empty() ? 1 : 5) * strips.indices.size() + strips.count());
  std::size_t longest = 0;
  for (std::uint32_t s = 0; s < strips.count(); ++s)
    longest = std::max(longest, strips.strip(s).size());
  present_.resize(longest);
  piece_.reserve(longest + 1);
  ranges_.reserve(std::max<std::size_t>(1, model_->attributes().ranges.size()));
}

std::uint32_t FrameStripsInstance::vertex_count() const {
  return model_->sequence_of(frame_).levels.vertex_count(level_);
}
std::uint32_t FrameStripsInstance::triangle_count() const {
  return model_->sequence_of(frame_).levels.triangle_count(level_);
}

void FrameStripsInstance::go_to_level(std::uint32_t level) {
  level = std::min(level, model_->finest_level());
  is_stale_ = is_stale_ || level != level_;
  level_ = level;
}

void FrameStripsInstance::go_to_frame(std::uint32_t frame) {
  const std::vector<StripFrame>& frames = model_->data().frames;
  is_stale_ = is_stale_ || frames[frame].sequence != frames[frame_].sequence;
  frame_ = frame;
}

// In the order of the sequence a vertex comes after the one that it goes to.
void FrameStripsInstance::find_shown() {
  const FrameSequence& sequence = model_->sequence_of(frame_);
  const std::span<const std::uint32_t> targets = sequence.levels.targets();
  const std::uint32_t live = sequence.levels.vertex_count(level_);
  for (std::uint32_t i = 0; i < live; ++i) shown_[sequence.vertex[i]] = sequence.vertex[i];
  for (std::uint32_t i = live; i < sequence.vertex.size(); ++i)
    shown_[sequence.vertex[i]] = shown_[sequence.vertex[targets[i]]];
}

// Appends a strip to the present range, without its degenerate triangles.
void FrameStripsInstance::append(std::span<const std::uint32_t> strip) {
  DrawRange& range = ranges_.back();
  std::uint32_t end = range.first_index + range.index_count;
  // Behind a strip of the same range stands a restart.
  const bool follows = range.index_count > 0;
  const std::uint32_t length = filter_strip(strip, indices_.data() + end + (follows ? 1 : 0));
  if (length == 0) return;
  if (follows) indices_[end++] = kStripRestart;
  range.index_count = end + length - range.first_index;
}

// Where corners at one point have different vertices, the triangle is none, too: the strip is cut
// there. A piece that begins with a turned triangle repeats its first index.
void FrameStripsInstance::append_pieces(std::size_t size) {
  const std::vector<std::uint32_t>& point_of = model_->point_of();
  const auto is_sliver = [&](std::size_t i) {
    for (const auto& [a, b] : {std::pair{i, i + 1}, std::pair{i + 1, i + 2}, std::pair{i, i + 2}})
      if (present_[a] != present_[b] && point_of[present_[a]] == point_of[present_[b]]) return true;
    return false;
  };
  std::size_t first = 0;
  const auto end_piece = [&](std::size_t end) {
    if (end < first + 3) return;
    if (first % 2 == 0) return append({present_.data() + first, end - first});
    piece_.assign(1, present_[first]);
    piece_.insert(piece_.end(), present_.begin() + static_cast<std::ptrdiff_t>(first),
                  present_.begin() + static_cast<std::ptrdiff_t>(end));
    append(piece_);
  };
  for (std::size_t i = 0; i + 2 < size; ++i) {
    if (!is_sliver(i)) continue;
    end_piece(i + 2);
    first = i + 1;
  }
  end_piece(size);
}

void FrameStripsInstance::fill() {
  const TriangleStrips& strips = model_->data().strips;
  const std::vector<MaterialRange>& materials = model_->attributes().ranges;
  ranges_.clear();
  const auto drop_empty = [&] {
    if (!ranges_.empty() && ranges_.back().index_count == 0) ranges_.pop_back();
  };
  const auto end = [&] {
    return ranges_.empty() ? 0 : ranges_.back().first_index + ranges_.back().index_count;
  };
  for (std::uint32_t s = 0; s < strips.count(); ++s) {
    const std::uint32_t material = materials.empty() ? 0 : materials[strips.range[s]].material;
    if (ranges_.empty() || ranges_.back().material != material) {
      drop_empty();
      ranges_.push_back({end(), 0, Primitive::kStrips, material});
    }
    const std::span<const std::uint32_t> strip = strips.strip(s);
    for (std::size_t i = 0; i < strip.size(); ++i) present_[i] = shown_[strip[i]];
    if (model_->point_of().empty())
      append({present_.data(), strip.size()});
    else
      append_pieces(strip.size());
  }
  drop_empty();
  changed_ = {0, end()};
}

DrawList FrameStripsInstance::draw_list() {
  DrawList list = draw_vertices(model_->attributes());
  if (is_stale_) {
    find_shown();
    fill();
    list.changed_indices = {&changed_, 1};
    is_stale_ = false;
  }
  list.indices = {indices_.data(), changed_.count};
  list.ranges = ranges_;
  const std::uint32_t finest = model_->finest_level();
  list.level = finest > 0 ? static_cast<float>(level_) / static_cast<float>(finest) : 1;
  return list;
}

// The vertices of the level in the order of its sequence.
TriangleMesh FrameStripsInstance::extract() const {
  FrameStripsInstance copy(model_);
  copy.go_to_frame(frame_);
  copy.go_to_level(level_);
  const DrawList list = copy.draw_list();
  const FrameSequence& sequence = model_->sequence_of(frame_);
  const std::vector<std::uint32_t> kept(sequence.vertex.begin(),
                                        sequence.vertex.begin() + vertex_count());
  std::vector<std::uint32_t> number(model_->attributes().vertex_count(), kNone);
  for (std::uint32_t i = 0; i < kept.size(); ++i) number[kept[i]] = i;

  const TriangleMesh& full = model_->attributes();
  TriangleMesh shown = extract_level(full, full.vertex_count(), list);
  for (std::uint32_t& v : shown.indices) v = number[v];
  TriangleMesh mesh = gather_vertices(full, kept);
  mesh.indices = std::move(shown.indices);
  mesh.ranges = std::move(shown.ranges);
  mesh.materials = full.materials;
  mesh.images = full.images;
  return mesh;
}

std::size_t FrameStripsInstance::bytes() const {
  return (shown_.size() + indices_.capacity() + present_.size() + piece_.capacity()) *
             sizeof(std::uint32_t) +
         ranges_.capacity() * sizeof(DrawRange);
}

}  // namespace varifold
