// What a frame asks of the steps of a view-dependent mesh.
//
// Based on: [Hoppe1997] section 4.
// Differs: a step is asked by its own region; what nests is only the bound that says whether any
//   step below it may be asked (step_bounds.h). Regions of the user ask beside the view.
#pragma once

#include <varifold/models/vdpm/odometers.h>
#include <varifold/models/vdpm/step_bounds.h>
#include <varifold/models/vdpm/view_dependent_mesh.h>
#include <varifold/models/vdpm/view_query.h>
#include <varifold/view/criteria.h>
#include <cstdint>
#include <span>
#include <vector>

namespace varifold {

/// A RefineCriteria and a tolerance, made ready for many tests.
class FrontQuestion {
 public:
  static constexpr float kLeastGiven = 0x1p-26f;

  FrontQuestion() = default;
  /// Takes over `criteria`; a view whose camera is not usable asks for nothing. Allocates where
  /// there are more boxes than ever before. `mesh` is the radius of the mesh: tolerances from
  /// RefineCriteria::kFullDetail on let places of full detail have errors, too, kLeastGiven of the
  /// radius at kFullDetail and growing with the tolerance.
  void set(const RefineCriteria& criteria, float tolerance, float mesh, Odometers& odometers);

  /// Whether the answers may differ from those to `criteria` by more than the odometers can tell.
  [[nodiscard]] bool differs_in_kind(const RefineCriteria& criteria, float tolerance) const;
  [[nodiscard]] const ViewQuery& view() const { return view_; }

  /// Whether the view or a region asks for a step; for any step below it in the watch tree.
  [[nodiscard]] ViewAnswer own(const StepBounds& bounds, const Vec3& center, float keep) const;
  [[nodiscard]] ViewAnswer nested(const StepBounds& bounds, const Vec3& center) const;

  /// The same for many steps of a model, eight at a time; answers[i] is that for steps[chosen[i]].
  /// `keep` has an entry for each.
  void own(const ViewDependentMesh& model, std::span<const std::uint32_t> steps,
           std::span<const std::uint32_t> chosen, std::span<const float> keep,
           std::vector<ViewAnswer>& answers) const;
  void nested(const ViewDependentMesh& model, std::span<const std::uint32_t> steps,
              std::span<const std::uint32_t> chosen, std::vector<ViewAnswer>& answers) const;

 private:
  template <class Single, class Set>
  void answer(const ViewDependentMesh& model, std::span<const std::uint32_t> steps,
              std::span<const std::uint32_t> chosen, const Single& single, const Set& set,
              std::vector<ViewAnswer>& answers) const;
  // Whether the view alone asks, and for yes or no.
  [[nodiscard]] bool is_plain() const;
  [[nodiscard]] DeviationMeasure deviation() const {
    return criteria_.view ? criteria_.view->deviation : DeviationMeasure::kSeen;
  }
  [[nodiscard]] ViewAnswer ask(const ViewRegion& region, float keep) const;

  RefineCriteria criteria_;
  std::vector<BoxCriterion> boxes_;
  ViewQuery view_;
  bool is_graded_ = false;  // weights between 0 and 1, silhouettes, light: no slack
  float tolerance_ = 0;
  float place_error_ = -1;  // what places let pass
};

}  // namespace varifold
