#include <varifold/models/vdpm/instance.h>

#include <algorithm>
#include <utility>

namespace varifold {

ViewDependentInstance::ViewDependentInstance(std::shared_ptr<const ViewDependentMesh> model)
    : model_(std::move(model)), surface_(*model_), front_(*model_), morphs_(*model_) {}

void ViewDependentInstance::go_to_level(std::uint32_t level) {
  const std::uint32_t finest = model_->finest_level();
  level = std::min(level, finest);
  morphs_.finish(surface_);
  is_new_ = false;
  const bool from_front = level_ == kNone;  // any step may have to change
  const std::uint32_t first = from_front ? 0 : std::min(level, level_);
  const std::uint32_t end = from_front ? finest : std::max(level, level_);
  surface_.reserve(model_->vertex_count(level), model_->triangle_count(level));
  // Collapses from fine to coarse and splits from coarse to fine keep the rule.
  for (std::uint32_t k = end; k-- > std::max(first, level);)
    if (surface_.is_split(k)) surface_.collapse(k);
  for (std::uint32_t k = first; k < std::min(end, level); ++k)
    if (!surface_.is_split(k)) surface_.split(k);
  level_ = level;
  front_is_stale_ = true;
}

FrontStatistics ViewDependentInstance::adapt(const RefineCriteria& criteria,
                                             const AdaptOptions& options,
                                             const FrontLimits& limits) {
  if (front_is_stale_) front_.set_level(level_);
  front_is_stale_ = false;
  level_ = kNone;
  const bool has_morphs = limits.morph_frames > 1 || morphs_.moving_vertices() > 0;
  FrontGeomorphs* const morphs = has_morphs ? &morphs_ : nullptr;
  if (has_morphs) morphs_.begin_frame(surface_, front_.last_view(), is_new_);
  is_new_ = false;
  AdaptOptions budget = options;
  budget.max_triangles = std::max(options.max_triangles, model_->triangle_count(0));
  FrontStatistics statistics = options.max_triangles == kNone
                                   ? front_.adapt(surface_, criteria, options, limits, morphs)
                                   : fit_budget(criteria, budget, limits, morphs);
  if (has_morphs) {
    morphs_.advance(surface_, limits.morph_frames, budget.max_triangles);
    statistics.vertices = surface_.vertex_count();
    statistics.triangles = surface_.triangle_count();
  }
  return statistics;
}

FrontStatistics ViewDependentInstance::fit_budget(const RefineCriteria& criteria,
                                                  const AdaptOptions& budget,
                                                  const FrontLimits& limits,
                                                  FrontGeomorphs* morphs) {
  FrontStatistics sum;
  FrontStatistics last = search_.fit(budget, limits.unused_budget, [&](float tolerance) {
    const FrontStatistics now =
        front_.adapt(surface_, criteria, {tolerance, budget.max_triangles}, limits, morphs);
    sum.splits += now.splits;
    sum.collapses += now.collapses;
    sum.forced_splits += now.forced_splits;
    sum.tests += now.tests;
    return now;
  });
  last.splits = sum.splits;
  last.collapses = sum.collapses;
  last.forced_splits = sum.forced_splits;
  last.tests = sum.tests;
  return last;
}

DrawList ViewDependentInstance::draw_strips(StripJoin join) {
  const DrawList triangles = surface_.draw_list();
  // Triangles that come or turn are marked; those that only go change the count.
  const bool is_same = !strips_are_old_ && join == strips_.join() &&
                       triangles.changed_indices.empty() &&
                       triangles_in_strips_ == surface_.triangle_count();
  strips_are_old_ = false;
  triangles_in_strips_ = surface_.triangle_count();
  return is_same ? strips_.again(triangles) : strips_.build(triangles, join);
}

std::vector<std::uint32_t> ViewDependentInstance::vertices_of_slots() const {
  const ActiveVertices& active = surface_.vertices();
  std::vector<std::uint32_t> vertices(active.slots(), kNone);
  for (std::uint32_t v = 0; v < model_->attributes().vertex_count(); ++v)
    if (active.is_active(v)) vertices[active.slot(v)] = v;
  return vertices;
}

}  // namespace varifold
