// What follows from the dependencies of steps.
#pragma once

#include <varifold/base/math.h>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace varifold {

/// Marks steps that a step depends on through others. Looks at a bounded number of steps for each,
/// so that it takes O(steps) in all; who builds a model leaves out what this finds, and who reads
/// one finds it again. 16 B a step, and 4 for each dependency beyond the third.
class DependencyWalk {
 public:
  explicit DependencyWalk(std::uint32_t steps) : nodes_(steps), stack_(kEffort) {}

  /// What a step depends on, ascending, all greater. Copied; to be set before a walk comes there.
  void set(std::uint32_t step, std::span<const std::uint32_t> dependencies) {
    auto& steps = nodes_[step].dependencies;
    const auto count = static_cast<std::uint32_t>(dependencies.size());
    if (count > 0 && count <= kInline) {
      for (std::uint32_t i = 0; i < count; ++i) steps[i] = dependencies[i];
      return;
    }
    steps = {kNone, static_cast<std::uint32_t>(long_lists_.size()), count};
    long_lists_.insert(long_lists_.end(), dependencies.begin(), dependencies.end());
  }

  /// Starts anew for another step; no step may come twice.
  void begin(std::uint32_t step) {
    step_ = step;
    effort_ = kEffort;
    open_ = 0;
  }
  /// A step that is looked for: when all of these are marked, walks end early. Each once.
  void want(std::uint32_t step) {
    nodes_[step].mark = step_ | kWanted;
    ++open_;
  }
  /// One that was wanted no longer is; it is not marked.
  void give_up_one() { --open_; }
  [[nodiscard]] bool wants_more() const { return open_ > 0; }
  [[nodiscard]] bool is_marked(std::uint32_t step) const { return nodes_[step].mark == step_; }

  /// Marks what `from` depends on, no step beyond `last`.
  void follow(std::uint32_t from, std::uint32_t last) {
    // Whether a step is marked already nobody can foretell, so it decides on no jump.
    const std::uint32_t step = step_;
    std::int64_t effort = effort_;
    stack_[0] = from;
    for (std::size_t waiting = 1; waiting > 0 && effort > 0;) {
      const auto dependencies = of(nodes_[stack_[--waiting]]);
      if (waiting + dependencies.size() > stack_.size())
        stack_.resize(2 * (waiting + dependencies.size()));
      std::uint32_t* const stack = stack_.data();
      for (const std::uint32_t next : dependencies) {
        if (next > last) break;
        std::uint32_t& mark = nodes_[next].mark;
        if (mark == (step | kWanted) && --open_ == 0) {
          mark = step;
          return;
        }
        const bool is_new = mark != step;
        mark = step;
        stack[waiting] = next;
        waiting += is_new ? 1 : 0;
        effort -= is_new ? 1 : 0;
      }
    }
    effort_ = effort;
  }

 private:
  static constexpr std::int64_t kEffort = 512;
  static constexpr std::uint32_t kInline = 3;
  static constexpr std::uint32_t kWanted = 0x80000000;  // beside the number of a step
  // A line of the cache has the mark of a step and, nearly always, its dependencies.
  struct Node {
    std::uint32_t mark = kNone;
    // One to three steps, kNone behind them; or kNone, the begin and the size of a long list.
    std::array<std::uint32_t, kInline> dependencies{kNone, kNone, kNone};
  };

  [[nodiscard]] std::span<const std::uint32_t> of(const Node& node) const {
    const auto [first, second, third] = node.dependencies;
    if (first == kNone) return {long_lists_.data() + second, third};
    return {node.dependencies.data(), std::size_t{1} + (second != kNone) + (third != kNone)};
  }

  std::vector<Node> nodes_;
  std::vector<std::uint32_t> long_lists_, stack_;
  std::int64_t effort_ = 0;  // negative where the last step had many
  std::uint32_t step_ = kNone, open_ = 0;
};

}  // namespace varifold
