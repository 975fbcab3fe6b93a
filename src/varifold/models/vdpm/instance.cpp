#include <varifold/models/vdpm/instance.h>

#include <algorithm>
#include <utility>

namespace varifold {

ViewDependentInstance::ViewDependentInstance(std::shared_ptr<const ViewDependentMesh> model)
    : model_(std::move(model)), surface_(*model_) {}

void ViewDependentInstance::go_to_level(std::uint32_t level) {
  const std::uint32_t finest = model_->finest_level();
  level = std::min(level, finest);
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
}

}  // namespace varifold
