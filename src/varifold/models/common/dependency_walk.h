// What follows from the dependencies of steps.
#pragma once

#include <varifold/base/math.h>
#include <cstdint>
#include <vector>

namespace varifold {

/// Marks steps that a step depends on through others. Looks at a bounded number of steps for each,
/// so that it takes O(steps) in all; who builds a model leaves out what this finds, and who reads
/// one finds it again.
class DependencyWalk {
 public:
  explicit DependencyWalk(std::uint32_t steps) : mark_(steps, kNone) {}

  /// Starts anew for another step; no step may come twice.
  void begin(std::uint32_t step) {
    step_ = step;
    effort_ = kEffort;
  }
  [[nodiscard]] bool is_marked(std::uint32_t step) const { return mark_[step] == step_; }
  /// Marks what `from` depends on, no step beyond `last`. of(step): its dependencies, ascending.
  template <class Of>
  void follow(std::uint32_t from, std::uint32_t last, const Of& of) {
    stack_.assign(1, from);
    while (!stack_.empty() && effort_ > 0) {
      const std::uint32_t at = stack_.back();
      stack_.pop_back();
      for (const std::uint32_t next : of(at)) {
        if (next > last) break;
        if (is_marked(next)) continue;
        mark_[next] = step_;
        stack_.push_back(next);
        if (effort_ > 0) --effort_;
      }
    }
  }

 private:
  static constexpr std::uint32_t kEffort = 512;
  std::vector<std::uint32_t> mark_, stack_;
  std::uint32_t step_ = kNone, effort_ = 0;
};

}  // namespace varifold
