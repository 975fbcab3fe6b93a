// Strips grown one after the other from triangles that have few neighbours left.
#pragma once

#include <varifold/base/random.h>
#include <varifold/strip/free_triangles.h>
#include <varifold/strip/strip_paths.h>
#include <varifold/strip/stripify.h>
#include <cstdint>
#include <vector>

namespace varifold {

/// Grows strips in both directions until every triangle is in one. A triangle is free while it is
/// in none.
class StripGrowth {
 public:
  /// Triangles with `taken` set are in strips already, or in none ever.
  StripGrowth(StripPaths& paths, std::vector<std::uint8_t> taken, const StripifyOptions& options);

  void run();

 private:
  void grow(std::uint32_t start);
  void extend(std::uint32_t exit, std::uint32_t last_turn);
  [[nodiscard]] std::uint32_t free_behind(std::uint32_t half_edge) const {
    return free_.neighbors(paths_.across(half_edge) / 3);
  }
  [[nodiscard]] std::uint32_t first_exit(std::uint32_t start);
  [[nodiscard]] std::uint32_t choose(std::uint32_t entry, std::uint32_t last_turn);
  [[nodiscard]] std::uint32_t break_tie(std::uint32_t entry, std::uint32_t last_turn);
  [[nodiscard]] std::uint32_t least_behind(std::uint32_t half_edge) const;
  [[nodiscard]] std::uint32_t straight_length(std::uint32_t exit);

  StripPaths& paths_;
  StripHeuristic heuristic_;
  Random random_;
  bool left_next_ = false;  // kAlternate
  FreeTriangles free_;
  std::vector<std::uint32_t> trial_;  // per triangle, the last trial through it
  std::uint32_t trial_count_ = 0;
};

}  // namespace varifold
