// Private to this folder: how the fronts of a model of any kind are checked.
#pragma once

#include <varifold/measure/check_model.h>
#include <varifold/measure/front_parts.h>
#include <varifold/measure/full_level.h>
#include <varifold/measure/seeded_front.h>
#include <varifold/measure/shape_checker.h>
#include <varifold/mesh/weld.h>
#include <varifold/models/common/front_model.h>
#include <varifold/models/common/uniform_model.h>
#include <algorithm>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace varifold {

/// Models that keep lists of what has to be done before what can tell whether these are complete.
template <class Model>
concept HasDependencies = requires(const Model& model) {
  { steps_lacking_dependencies(model) } -> std::same_as<std::vector<std::uint32_t>>;
};

/// Models that say of every step how far it is off at most.
template <class Instance>
concept HasStepErrors = requires(const Instance& instance) {
  { instance.is_split(0u) } -> std::same_as<bool>;
  { instance.model().bounds(0u).mu_length() } -> std::same_as<float>;
  { instance.model().bounds(0u).delta_length() } -> std::same_as<float>;
};

/// The greatest of all steps that are collapsed. O(steps).
template <HasStepErrors Instance>
double front_error(const Instance& instance) {
  float error = 0;
  for (std::uint32_t step = 0; step < instance.model().step_count(); ++step) {
    if (instance.is_split(step)) continue;
    const auto bounds = instance.model().bounds(step);
    error = std::max({error, bounds.mu_length(), bounds.delta_length()});
  }
  return error;
}

template <FrontInstance Instance>
class FrontChecker {
 public:
  using Model = CheckedModel<Instance>;

  /// All must outlive this. The full level must exist.
  FrontChecker(std::shared_ptr<const Model> model, const ModelCheckOptions& options,
               const check::ModelPoints& points, const check::FullLevel& full,
               const check::ShapeChecker& shapes)
      : model_(std::move(model)),
        options_(options),
        points_(points),
        full_(full),
        shapes_(shapes),
        walker_(model_) {}

  /// False where go_on(fronts done) is.
  template <class GoOn>
  [[nodiscard]] bool run(const GoOn& go_on) {
    if (options_.fronts == 0 || full_.mesh().indices.empty()) return true;
    load_levels();
    for (std::uint32_t number = 0; number < options_.fronts; ++number) {
      if (!go_on(number)) return false;
      check_front(number);
      ++fronts_checked_;
    }
    return true;
  }
  [[nodiscard]] std::uint32_t fronts_checked() const { return fronts_checked_; }

  void append_faults(std::vector<Fault>& faults) {
    faults_.append_to(faults);
    pose_faults_.append_to(faults);
    if constexpr (HasDependencies<Model>) {
      const std::vector<std::uint32_t> steps = steps_lacking_dependencies(*model_);
      check::PlaceFaults lacking("step");
      for (const std::uint32_t step : steps) lacking.add("missing_dependency", step);
      lacking.append_to(faults);
    }
  }

 private:
  [[nodiscard]] TriangleMesh drawn(Instance& instance) const {
    return check::drawn_mesh(model_->attributes(), instance.draw_list());
  }

  // The two levels that are fronts, too.
  void load_levels() {
    Instance instance(model_);
    instance.go_to_level(0);
    base_triangles_ = check::sorted(check::placed_triangles(drawn(instance)));
    instance.go_to_level(model_->finest_level());
    full_drawn_ = drawn(instance);
    full_placed_ = check::placed_triangles(full_drawn_);
    full_triangles_ = check::sorted(full_placed_);
  }

  void check_front(std::uint32_t number) {
    const check::SeededFront front =
        check::seeded_front(full_drawn_, model_->triangle_count(0), number);
    const auto expect = [&](bool holds, const char* kind) {
      if (!holds) faults_.add(kind, number, front.name);
    };
    // By way of the front before, of a level now and then, and from the beginning.
    if (number % 8 == 7) walker_.go_to_level(model_->finest_level() / 2);
    const FrontStatistics led = walker_.adapt(front.criteria, front.options);
    Instance fresh(model_);
    const FrontStatistics told = fresh.adapt(front.criteria, front.options);
    for (Instance* instance : {&walker_, &fresh}) {
      const DrawList list = instance->draw_list();
      if (!check::indices_exist(list, static_cast<std::uint32_t>(list.positions.size())))
        return faults_.add("wrong_corner", number, front.name);
    }
    const TriangleMesh mesh = drawn(fresh);
    const auto triangles = check::sorted(check::placed_triangles(mesh));
    const auto is_same = [&](const TriangleMesh& other) {
      return triangles == check::sorted(check::placed_triangles(other));
    };
    expect(is_same(drawn(walker_)) && is_same(fresh.extract()), "not_identical");
    if (number < 3)
      expect(triangles == (number == 1 ? base_triangles_ : full_triangles_), "not_identical");
    const std::uint32_t count = mesh.triangle_count();
    expect(told.triangles == count && led.triangles == count, "wrong_count");
    expect(count <= std::max(front.options.max_triangles, model_->triangle_count(0)),
           "over_budget");
    expect(check::has_all_asked_for(front, full_drawn_, full_placed_, triangles), "too_coarse");
    check_shape(mesh, check::draws_attributes(model_->attributes(), fresh.draw_list()), number);
    check_in_shapes(fresh, number);
  }

  // Of each sort of fronts one or two: there may be many poses.
  void check_in_shapes(const Instance& instance, std::uint32_t number) {
    if (shapes_.empty() || number < 3 || number % kFrontsPerShapes != 0) return;
    const TriangleMesh mesh = instance.extract();
    shapes_.check_surface(mesh, weld_points(mesh), pose_faults_, number);
    if constexpr (HasStepErrors<Instance>)
      shapes_.check_distance(mesh, front_error(instance) + model_->error(model_->finest_level()),
                             pose_faults_, number);
  }

  void check_shape(const TriangleMesh& mesh, bool has_numbers_of_model, std::uint32_t number) {
    if (has_numbers_of_model)
      full_.check_corners(mesh, check::ancestors_in_front(points_, mesh), points_.point_of, faults_,
                          number);
    const WeldMap weld = has_numbers_of_model ? points_.all() : weld_points(mesh);
    full_.check_surface(mesh, weld, faults_, number);
    const std::uint32_t zero_area = full_.may_have_zero_area() ? 0 : check::count_zero_area(mesh);
    if (zero_area > 0) faults_.add("zero_area", number, std::to_string(zero_area) + " triangles");
  }

  // No multiple of the number of sorts.
  static constexpr std::uint32_t kFrontsPerShapes = 5;

  std::shared_ptr<const Model> model_;
  const ModelCheckOptions& options_;
  const check::ModelPoints& points_;
  const check::FullLevel& full_;
  const check::ShapeChecker& shapes_;
  Instance walker_;
  TriangleMesh full_drawn_;
  std::vector<check::PlacedTriangle> full_placed_, full_triangles_, base_triangles_;
  check::PlaceFaults faults_{"front", "front_"};
  check::PlaceFaults pose_faults_{"front", "pose_front_"};
  std::uint32_t fronts_checked_ = 0;
};

}  // namespace varifold
