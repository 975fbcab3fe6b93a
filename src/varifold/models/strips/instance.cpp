#include <varifold/models/strips/instance.h>

#include <varifold/models/common/extract_level.h>
#include <varifold/models/strips/strip_pieces.h>
#include <varifold/view/draw_vertices.h>
#include <algorithm>
#include <cassert>
#include <utility>

namespace varifold {

StripFrameworkInstance::StripFrameworkInstance(std::shared_ptr<const StripFramework> model)
    : model_(std::move(model)),
      slots_(model_->slot_count()),
      split_(model_->finest_level(), 0),
      urgencies_(*model_),
      pages_(*model_) {
  vertex_count_ = model_->vertex_count(0);
  triangle_count_ = model_->triangle_count(0);
  all_vertices_ = {0, model_->attributes().vertex_count()};
  for (std::uint32_t v = 0; v < vertex_count_; ++v) write(v, v);
}

// The records of a vertex: they name it, or once it has collapsed, its target.
void StripFrameworkInstance::write(std::uint32_t vertex, std::uint32_t value) {
  for (const std::uint32_t slot : model_->records(vertex)) {
    slots_[slot] = value;
    pages_.touch(slot);
  }
}

// Steps [first, end) become what `is_split` says. Splits go up and collapses down, so that each
// finds the strips as its own undoing leaves them.
template <class IsSplit>
void StripFrameworkInstance::change(std::uint32_t first, std::uint32_t end, const IsSplit& is_split,
                                    FrontStatistics& statistics) {
  const LevelTable& levels = model_->levels();
  std::uint32_t vertex = levels.vertex_count(first);
  for (std::uint32_t k = first; k < end; ++k) {
    const LevelTable::Step step = levels.step(k);
    const bool wanted = is_split(k);
    if (wanted && split_[k] == 0) {
      for (std::uint32_t i = 0; i < step.vertices; ++i) write(vertex + i, vertex + i);
      split_[k] = 1;
      vertex_count_ += step.vertices;
      triangle_count_ += step.triangles;
      ++statistics.splits;
    }
    vertex += step.vertices;
  }
  for (std::uint32_t k = end; k-- > first;) {
    const LevelTable::Step step = levels.step(k);
    vertex -= step.vertices;
    const bool wanted = is_split(k);
    if (wanted || split_[k] == 0) continue;
    for (std::uint32_t i = 0; i < step.vertices; ++i) write(vertex + i, levels.target(vertex + i));
    split_[k] = 0;
    vertex_count_ -= step.vertices;
    triangle_count_ -= step.triangles;
    ++statistics.collapses;
  }
}

void StripFrameworkInstance::go_to_level(std::uint32_t level) {
  const std::uint32_t finest = model_->finest_level();
  level = std::min(level, finest);
  const bool between = level_ != kNone;  // else any step may have to change
  FrontStatistics statistics;
  change(
      between ? std::min(level, level_) : 0, between ? std::max(level, level_) : finest,
      [&](std::uint32_t k) { return k < level; }, statistics);
  level_ = level;
}

FrontStatistics StripFrameworkInstance::adapt(const RefineCriteria& criteria,
                                              const AdaptOptions& options) {
  // What does not exceed the tolerance is never split for its own sake, so how urgent it is does
  // not matter.
  urgencies_.ask(*model_, [&](std::uint32_t step, std::uint32_t vertex) {
    return criteria.urgency(model_->ball(step, vertex), model_->step_error(step), options.tolerance,
                            [&] { return model_->cone(step); });
  });
  return settle(options);
}

FrontStatistics StripFrameworkInstance::settle(const AdaptOptions& options) {
  FrontStatistics statistics;
  const float tolerance = urgencies_.tolerance(*model_, options);
  const std::uint32_t finest = model_->finest_level();
  change(
      0, finest, [&](std::uint32_t k) { return urgencies_.raised(k) > tolerance; }, statistics);

  // The front of a level has its coarser steps split and no other.
  std::uint32_t level = 0, splits = 0;
  for (std::uint32_t k = 0; k < finest; ++k) {
    splits += split_[k];
    level = split_[k] != 0 ? k + 1 : level;
    statistics.forced_splits += split_[k] != 0 && urgencies_.asked(k) <= tolerance ? 1 : 0;
  }
  level_ = splits == level ? level : kNone;
  statistics.vertices = vertex_count_;
  statistics.triangles = triangle_count_;
  statistics.tolerance = tolerance;
  return statistics;
}

DrawList StripFrameworkInstance::draw_list() {
  pages_.refresh(slots_);
  const TriangleMesh& mesh = model_->attributes();
  const std::uint32_t base = model_->vertex_count(0);
  const std::uint32_t more = mesh.vertex_count() - base;
  const float fraction =
      more > 0 ? static_cast<float>(vertex_count_ - base) / static_cast<float>(more) : 1;
  DrawList list = draw_vertices(mesh);
  list.indices = pages_.indices();
  list.ranges = pages_.ranges(fraction);
  list.changed_indices = pages_.changed();
  if (vertices_are_new_ && all_vertices_.count > 0) list.changed_vertices = {&all_vertices_, 1};
  vertices_are_new_ = false;
  return list;
}

std::size_t StripFrameworkInstance::bytes() const {
  return slots_.size() * sizeof(std::uint32_t) + split_.size() + urgencies_.bytes() +
         pages_.bytes();
}

TriangleMesh StripFrameworkInstance::extract() const {
  const TriangleMesh& mesh = model_->attributes();
  std::vector<DrawRange> ranges;
  std::vector<std::uint32_t> indices;
  ranges.reserve(model_->strip_count());
  indices.reserve(slots_.size());
  const auto first = model_->first_slots();
  for (std::uint32_t s = 0; s < model_->strip_count(); ++s) {
    const std::uint32_t material =
        mesh.ranges.empty() ? 0 : mesh.ranges[model_->strip_ranges()[s]].material;
    for_each_piece(slots_, first[s], first[s + 1], model_->slivers_of(s), mesh.positions,
                   [&](const StripPiece& piece) {
                     const auto begin = static_cast<std::uint32_t>(indices.size());
                     if (piece.is_odd) indices.push_back(slots_[piece.begin]);
                     indices.insert(indices.end(), slots_.begin() + piece.begin,
                                    slots_.begin() + piece.end);
                     const auto count = static_cast<std::uint32_t>(indices.size()) - begin;
                     ranges.push_back({begin, count, Primitive::kStrips, material});
                   });
  }
  DrawList list = draw_vertices(mesh);
  list.indices = indices;
  list.ranges = ranges;
  if (level_ != kNone) return extract_level(mesh, vertex_count_, list);
  return without_unused_vertices(extract_level(mesh, mesh.vertex_count(), list));
}

}  // namespace varifold
