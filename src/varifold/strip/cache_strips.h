// Strips for a small vertex cache.
#pragma once

#include <varifold/strip/fifo_cache.h>
#include <varifold/strip/free_triangles.h>
#include <varifold/strip/strip_paths.h>
#include <cstdint>
#include <span>
#include <vector>

namespace varifold {

/// Takes one strip after the other: of several that begin near the last ones, the one that costs
/// the fewest cache misses and indices a triangle.
class CacheStrips {
 public:
  /// Triangles with `taken` set get into no strip.
  CacheStrips(std::span<const std::uint32_t> indices, std::uint32_t vertex_count,
              std::uint32_t cache_size, StripPaths& paths, std::vector<std::uint8_t> taken);

  /// Links all strips, and returns in the order in which they are to be drawn, per strip, the
  /// half-edge by which it leaves its first triangle, any of its edges where that is the only one.
  [[nodiscard]] std::vector<std::uint32_t> run();

 private:
  // A strip of alternating turns that might be taken.
  struct Candidate {
    std::uint32_t exit = kNone;
    std::uint32_t first_turn = 1;
    std::uint32_t length = 0;
    float cost = 0;               // per triangle
    std::uint32_t joint = kNone;  // half-edge of its first triangle towards the last strip's end
  };
  // The end of the last strip.
  struct Tail {
    std::uint32_t triangle = kNone;
    std::uint32_t entry = kNone;  // by which half-edge the strip came; kNone for the first triangle
    std::uint32_t last_turn = kNoTurn;  // before that
  };
  struct Joint {
    std::uint32_t entry = kNone;
    int swaps = 0;
  };
  [[nodiscard]] Joint joint_before(std::uint32_t exit, std::uint32_t first_turn,
                                   std::uint32_t length) const;
  void take(std::uint32_t triangle);
  void commit(const Candidate& candidate);
  void gather_seeds();
  [[nodiscard]] std::uint32_t cached_corners(std::uint32_t triangle) const;
  void try_from(std::uint32_t triangle, Candidate& best);
  [[nodiscard]] Candidate simulate(std::uint32_t exit, std::uint32_t first_turn);
  [[nodiscard]] std::uint32_t trial_use(std::uint32_t vertex, std::uint32_t misses);

  std::span<const std::uint32_t> indices_;
  StripPaths& paths_;
  std::uint32_t cache_size_;
  std::uint32_t max_length_;
  FreeTriangles free_;
  FifoCache cache_;
  // Of the simulation that runs: per vertex which one brought it in last, and at which miss.
  std::vector<std::uint32_t> trial_, trial_miss_;
  std::vector<std::uint32_t> in_trial_;  // per triangle, the last simulation through it
  std::uint32_t trial_count_ = 0;
  std::vector<std::uint32_t> recent_;  // triangles of the last strips, the latest last
  std::vector<std::uint32_t> seeds_;
  Tail tail_;
  std::vector<std::uint32_t> order_;
};

}  // namespace varifold
