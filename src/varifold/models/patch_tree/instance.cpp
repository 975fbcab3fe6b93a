#include <varifold/models/patch_tree/instance.h>

#include <varifold/models/common/uniform_model.h>
#include <varifold/models/patch_tree/extract.h>
#include <algorithm>
#include <utility>

namespace varifold {

static_assert(LeveledInstance<PatchTreeInstance, PatchTree>);
static_assert(FrontInstance<PatchTreeInstance>);

PatchTreeInstance::PatchTreeInstance(std::shared_ptr<const PatchTree> model)
    : model_(std::move(model)), front_(model_), slots_(model_) {}

void PatchTreeInstance::go_to_level(std::uint32_t level) {
  level_ = std::min(level, model_->finest_level());
  front_.go_to_level(level_);
  slots_.mark(front_.draws().changed_slots());
}

FrontStatistics PatchTreeInstance::adapt(const RefineCriteria& criteria,
                                         const AdaptOptions& options) {
  PatchFrontOptions all;
  all.limits = options;
  return adapt(criteria, all, false).statistics;
}

PatchFrontResult PatchTreeInstance::adapt(const RefineCriteria& criteria,
                                          const PatchFrontOptions& options, bool from_roots) {
  level_ = kNone;
  const PatchFrontResult result =
      from_roots ? front_.adapt_split_only(criteria, options) : front_.adapt(criteria, options);
  slots_.mark(front_.draws().changed_slots());
  return result;
}

// Nodes are split in the order of their errors, each with what it requires. Whatever front has only
// smaller errors than the node that did not fit has split that node, and so is over the budget.
PatchFrontResult PatchTreeInstance::go_to_triangles(std::uint32_t max_triangles) {
  if (model_->triangle_count(model_->finest_level()) <= max_triangles) {
    go_to_level(model_->finest_level());  // nodes without an error, too
    PatchFrontResult result;
    result.statistics.vertices = vertex_count();
    result.statistics.triangles = triangle_count();
    return result;
  }
  PatchFrontOptions options;
  options.limits = {0, max_triangles};
  options.measure = PatchMeasure::kError;
  return adapt(RefineCriteria(), options, true);
}

void PatchTreeInstance::set_switches(bool switches) { switches_ = switches; }

std::uint32_t PatchTreeInstance::collapsed_triangles() const {
  std::uint32_t count = 0;
  if (switches_)
    for (const PatchDraw& draw : front_.draws().draws())
      count += varifold::collapsed_triangles(model_->data(), draw.node, draw.mask);
  return count;
}

std::vector<std::uint8_t> PatchTreeInstance::split_flags() const {
  std::vector<std::uint8_t> flags(model_->node_count(), 0);
  for (std::uint32_t node = 0; node < front_.tables().inner_count(); ++node)
    flags[node] = front_.nodes().is_split(node) ? 1 : 0;
  return flags;
}

TriangleMesh PatchTreeInstance::extract() const {
  return extract_front(*model_, split_flags(), switches_);
}

}  // namespace varifold
