#include <varifold/models/vdpm/front_question.h>

#include <varifold/models/vdpm/region_batch.h>
#include <varifold/models/vdpm/step_regions.h>
#include <varifold/view/usable_view.h>
#include <algorithm>
#include <cmath>

namespace varifold {

namespace {

// Whether a view asks yes-or-no questions only, whose answers have slack.
bool is_graded(const ViewCriterion& view) {
  const auto is_switch = [](float weight) { return weight == 0 || weight == 1; };
  return !is_switch(view.outside_weight) || !is_switch(view.back_weight) ||
         view.silhouette_weight != 1 || view.light.has_value();
}

bool same_place(const std::optional<Sphere>& a, const std::optional<Sphere>& b) {
  if (a.has_value() != b.has_value()) return false;
  return !a || (a->center == b->center && a->radius == b->radius);
}
bool same_place(const std::optional<Plane>& a, const std::optional<Plane>& b) {
  if (a.has_value() != b.has_value()) return false;
  return !a || (a->normal == b->normal && a->offset == b->offset);
}

// Asks `test(batch, answer)` for steps[i], eight at a time. What is left over in the last
// batch is asked again for nothing.
template <class Test>
void ask_in_batches(const ViewDependentMesh& model, std::span<const std::uint32_t> steps,
                    std::span<const float> keep, const Test& test, FrontAnswers& answers) {
  constexpr std::size_t kLanes = RegionBatch::kSize;
  RegionBatch batch;
  batch.keeps = !keep.empty();
  AnswerBatch answer;
  for (std::size_t begin = 0; begin < steps.size(); begin += kLanes) {
    const std::size_t lanes = std::min(kLanes, steps.size() - begin);
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      const std::size_t i = begin + std::min(lane, lanes - 1);
      const std::uint32_t step = steps[i];
      batch.bounds[lane] = &model.packed_bounds(step);
      batch.centers[lane] = &model.center(step);
      if (!keep.empty()) batch.keep[lane] = keep[i];
    }
    test(batch, answer);
    for (std::size_t lane = 0; lane < lanes; ++lane) {
      answers.asked[begin + lane] = static_cast<std::uint8_t>(answer.asked >> lane & 1u);
      answers.keys[begin + lane] = answer.keys[lane];
    }
  }
}

// The same one by one, by `ask(bounds, center, i)`.
template <class Ask>
void ask_singly(const ViewDependentMesh& model, const Odometers& odometers,
                std::span<const std::uint32_t> steps, const Ask& ask, FrontAnswers& answers) {
  for (std::size_t i = 0; i < steps.size(); ++i) {
    const std::uint32_t step = steps[i];
    const ViewAnswer answer = ask(model.bounds(step), model.center(step), i);
    answers.asked[i] = answer.asked ? 1 : 0;
    answers.keys[i] = odometers.key(answer.mover, answer.slack);
  }
}

}  // namespace

void FrontQuestion::set(const RefineCriteria& criteria, float tolerance, float mesh,
                        Odometers& odometers) {
  boxes_.assign(criteria.boxes.begin(), criteria.boxes.end());
  criteria_ = criteria;
  criteria_.boxes = boxes_;
  if (criteria_.view && !is_usable(*criteria_.view)) criteria_.view.reset();
  tolerance_ = tolerance;
  place_error_ = tolerance < RefineCriteria::kFullDetail
                     ? -1
                     : mesh * kLeastGiven * (tolerance / RefineCriteria::kFullDetail);
  is_graded_ = criteria_.view && is_graded(*criteria_.view);
  if (criteria_.view) {
    const float near_distance = criteria_.view->scale.near_distance();
    view_ =
        ViewQuery(*criteria_.view, tolerance, odometers.reach(criteria_.view->eye, near_distance));
  }
}

bool FrontQuestion::differs_in_kind(const RefineCriteria& criteria, float tolerance) const {
  if (std::max(tolerance, tolerance_) >= RefineCriteria::kFullDetail && tolerance != tolerance_)
    return true;
  const bool sees = criteria.view && is_usable(*criteria.view);
  if (is_graded_ || sees != criteria_.view.has_value()) return true;
  if (sees) {
    const ViewCriterion &a = *criteria.view, &b = *criteria_.view;
    if (is_graded(a) || a.outside_weight != b.outside_weight || a.back_weight != b.back_weight ||
        a.deviation != b.deviation)
      return true;
  }
  return !same_place(criteria.sphere, criteria_.sphere) ||
         !same_place(criteria.plane, criteria_.plane) ||
         !std::equal(criteria.boxes.begin(), criteria.boxes.end(), boxes_.begin(), boxes_.end()) ||
         criteria.predicate != criteria_.predicate ||
         criteria.predicate_version != criteria_.predicate_version;
}

ViewAnswer FrontQuestion::ask(const ViewRegion& region, float keep) const {
  const Sphere ball{region.center, region.radius};
  const float error = std::max(region.mu, region.delta);
  if (error > place_error_ && criteria_.is_placed_on(ball, error))
    return {true, Mover::kNothing, 0};
  if (!criteria_.view) return {false, Mover::kNothing, 0};
  if (is_graded_)
    return {criteria_.view->urgency({ball, region.cone, error}) > tolerance_ * (1 - keep),
            Mover::kAll, 0};
  return view_.test(region, keep);
}

ViewAnswer FrontQuestion::own(const StepBounds& bounds, const Vec3& center, float keep) const {
  return ask(own_region(bounds, center), keep);
}

ViewAnswer FrontQuestion::nested(const StepBounds& bounds, const Vec3& center) const {
  const ViewRegion region = nested_region(bounds, center);
  if (!is_graded_) return ask(region, 0);
  const float error = region.mu;
  const Sphere ball{region.center, region.radius};
  const bool placed = error > place_error_ && criteria_.is_placed_on(ball, error);
  return {placed || criteria_.view->bound(ball, error) > tolerance_, Mover::kAll, 0};
}

bool FrontQuestion::is_plain() const {
  return criteria_.view && !is_graded_ && !criteria_.sphere && !criteria_.plane && boxes_.empty() &&
         criteria_.predicate == nullptr;
}

void FrontQuestion::own(const ViewDependentMesh& model, const Odometers& odometers,
                        std::span<const std::uint32_t> steps, std::span<const float> keep,
                        FrontAnswers& answers) const {
  answers.resize(steps.size());
  if (is_plain()) {
    const auto test = [&](const RegionBatch& batch, AnswerBatch& answer) {
      test_own_regions(view_, odometers, batch, answer);
    };
    ask_in_batches(model, steps, keep, test, answers);
  } else {
    const auto ask_one = [&](const StepBounds& bounds, const Vec3& center, std::size_t i) {
      return own(bounds, center, keep.empty() ? 0.0f : keep[i]);
    };
    ask_singly(model, odometers, steps, ask_one, answers);
  }
}

void FrontQuestion::nested(const ViewDependentMesh& model, const Odometers& odometers,
                           std::span<const std::uint32_t> steps, FrontAnswers& answers) const {
  answers.resize(steps.size());
  if (is_plain()) {
    const auto test = [&](const RegionBatch& batch, AnswerBatch& answer) {
      test_nested_regions(view_, odometers, batch, answer);
    };
    ask_in_batches(model, steps, {}, test, answers);
  } else {
    const auto ask_one = [&](const StepBounds& bounds, const Vec3& center, std::size_t) {
      return nested(bounds, center);
    };
    ask_singly(model, odometers, steps, ask_one, answers);
  }
}

}  // namespace varifold
