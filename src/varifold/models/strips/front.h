// Which steps of a framework are to be split and which collapsed, so that what is asked for is
// there and every collapse has what it depends on.
#pragma once

#include <varifold/models/common/front_model.h>
#include <varifold/models/strips/strip_framework.h>
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace varifold {

/// The urgency of every step, raised to that of the steps that depend on it being split. A step is
/// split exactly when this is above the tolerance: of all sets of collapses that keep the
/// dependencies, that is the one that leaves nothing asked for out and is the greatest.
/// 8 bytes a step; allocates in the constructor only.
class StepUrgencies {
 public:
  StepUrgencies() = default;
  explicit StepUrgencies(const StripFramework& model)
      : asked_(model.finest_level()), raised_(model.finest_level()) {}

  /// `urgency(step, first_vertex)` is called once for each step, from the finest to the coarsest.
  /// O(steps + dependencies).
  template <class Urgency>
  void ask(const StripFramework& model, const Urgency& urgency);

  [[nodiscard]] float asked(std::uint32_t step) const { return asked_[step]; }
  [[nodiscard]] float raised(std::uint32_t step) const { return raised_[step]; }
  /// The least tolerance, not below that of the options, that has at most so many triangles. Three
  /// passes over the steps.
  [[nodiscard]] float tolerance(const StripFramework& model, const AdaptOptions& options) const;

  [[nodiscard]] std::size_t bytes() const { return 2 * asked_.size() * sizeof(float); }

 private:
  std::vector<float> asked_, raised_;
};

template <class Urgency>
void StepUrgencies::ask(const StripFramework& model, const Urgency& urgency) {
  const std::uint32_t* dependency = model.data().dependencies.data();
  std::uint32_t vertex = model.attributes().vertex_count();
  for (std::uint32_t k = model.finest_level(); k-- > 0;) {
    vertex -= model.levels().step(k).vertices;
    const float own = urgency(k, vertex);
    float greatest = own > 0 ? own : 0;  // not a number: nothing is asked
    asked_[k] = greatest;
    for (;; ++dependency) {
      const std::uint32_t finer = *dependency & ~StripFrameworkData::kLastDependency;
      if (*dependency != kNone) greatest = std::max(greatest, raised_[finer]);
      if ((*dependency & StripFrameworkData::kLastDependency) != 0) break;
    }
    ++dependency;
    raised_[k] = greatest;
  }
}

}  // namespace varifold
