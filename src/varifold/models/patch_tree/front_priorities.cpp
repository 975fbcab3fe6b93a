#include <varifold/models/patch_tree/front_priorities.h>

#include <varifold/models/patch_tree/front_bits.h>
#include <varifold/view/usable_view.h>
#include <algorithm>
#include <cmath>
#include <limits>

namespace varifold {

namespace {

// Weights that leave a priority as it is or make it 0, and no light.
bool is_plain(const ViewCriterion& view) {
  const auto is_switch = [](float weight) { return weight == 0 || weight == 1; };
  return is_switch(view.outside_weight) && is_switch(view.back_weight) &&
         view.silhouette_weight == 1 && !view.light;
}

front_lanes::Numbers numbers_of(const ViewCriterion& view) {
  front_lanes::Numbers numbers;
  numbers.eye_x = view.eye.x;
  numbers.eye_y = view.eye.y;
  numbers.eye_z = view.eye.z;
  numbers.focal = view.scale.focal_pixels();
  numbers.near_distance = view.scale.near_distance();
  for (std::size_t i = 0; i < view.frustum.planes.size(); ++i) {
    const Plane& plane = view.frustum.planes[i];
    numbers.planes[i] = {plane.normal.x, plane.normal.y, plane.normal.z, plane.offset};
  }
  return numbers;
}

// The paper's priority of what a view sees.
float mean_squared_priority(const ViewCriterion& view, const PatchBounds& bounds) {
  if (view.outside_weight == 0 && classify(view.frustum, bounds.ball) == Containment::kOutside)
    return 0;
  if (view.back_weight == 0 && is_back_facing(bounds.cone, bounds.ball, view.eye)) return 0;
  const float gap = distance_to(bounds.ball, view.eye);
  return bounds.mean_squared / (gap * gap);
}

}  // namespace

bool FrontPriorities::set(const RefineCriteria& criteria, PatchMeasure measure) {
  const bool has_places =
      criteria.sphere || criteria.plane || !criteria.boxes.empty() || criteria.predicate != nullptr;
  const bool sees = criteria.view && is_usable(*criteria.view);
  const bool plain =
      sees && !has_places && measure != PatchMeasure::kError && is_plain(*criteria.view);
  std::uint8_t parts = measure == PatchMeasure::kMeanSquared ? front_lanes::kMeanSquares : 0;
  front_lanes::Numbers numbers;
  if (plain) {
    numbers = numbers_of(*criteria.view);
    if (criteria.view->outside_weight == 0) parts |= front_lanes::kCulls;
    if (criteria.view->back_weight == 0) parts |= front_lanes::kTurns;
  }
  const bool same = is_set_ && plain && is_plain_ && parts == parts_ && numbers == numbers_;
  if (same) return false;
  is_set_ = true;
  is_plain_ = plain;
  parts_ = parts;
  functions_ = front_lanes::functions_of(parts);
  numbers_ = numbers;
  measure_ = measure;
  boxes_.assign(criteria.boxes.begin(), criteria.boxes.end());
  criteria_ = criteria;
  criteria_.boxes = boxes_;
  if (!sees) criteria_.view.reset();
  return true;
}

float FrontPriorities::evaluate_singly(const PatchBounds& bounds, float limit) const {
  float own = 0;
  if (measure_ == PatchMeasure::kPixels) {
    own = criteria_.urgency({bounds.ball, bounds.cone, bounds.error});
  } else if (criteria_.is_placed_on(bounds.ball, bounds.error)) {
    own = 1.5f * RefineCriteria::kFullDetail;
  } else if (measure_ == PatchMeasure::kError) {
    own = std::min(bounds.error, RefineCriteria::kFullDetail);
  } else if (criteria_.view) {
    own = mean_squared_priority(*criteria_.view, bounds);
  }
  own = own > 0 ? own : 0;
  return limit < own ? limit : own;
}

void FrontPriorities::evaluate(const front_lanes::Nodes& nodes) const {
  const FrontTables& tables = nodes.tables;
  nodes.priorities[tables.no_parent()] = std::numeric_limits<float>::infinity();
  if (is_plain_) {
    functions_.evaluate(numbers_, nodes);
    return;
  }
  front_bits::for_each(nodes.words, [&](std::uint32_t word) {
    front_bits::for_each_of_word(nodes.exists[word], word, [&](std::uint32_t node) {
      const float limit = nodes.priorities[tables.lanes().parent[node]];
      nodes.priorities[node] = evaluate_singly(tables.tree().data().bounds[node], limit);
    });
  });
}

void FrontPriorities::evaluate_children(const FrontTables& tables, std::uint32_t first,
                                        std::uint32_t count, float limit,
                                        std::span<float> priorities) const {
  if (is_plain_) {
    functions_.evaluate_run(numbers_, tables, {first, count, limit, priorities});
    return;
  }
  for (std::uint32_t node = first; node < first + count; ++node)
    priorities[node] = evaluate_singly(tables.tree().data().bounds[node], limit);
}

}  // namespace varifold
