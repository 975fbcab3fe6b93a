// Private to this folder: levels of a mesh with poses, in each pose and between them.
#pragma once

#include <varifold/measure/check_parts.h>
#include <varifold/measure/full_level.h>
#include <varifold/mesh/triangle_mesh.h>
#include <cstdint>
#include <vector>

namespace varifold::check {

/// Weights of poses: each alone, then seeded blends of all, >= 0 with a sum of at most 1.
[[nodiscard]] std::vector<std::vector<float>> checked_weights(std::size_t poses);

/// Compares levels with the full one in every pose, and their errors also in blends.
class ShapeChecker {
 public:
  ShapeChecker() = default;
  /// `full` is the full level; without poses nothing is ever found.
  ShapeChecker(const TriangleMesh& full, const ModelPoints& points, int threads);

  [[nodiscard]] bool empty() const { return weights_.empty(); }

  /// Orientation and topology in each pose: as FullLevel::check_surface().
  void check_surface(const TriangleMesh& mesh, const WeldMap& weld, PlaceFaults& faults,
                     std::uint32_t place) const;
  /// error_exceeded: a vertex of the full mesh that is farther than `error` in some blend.
  void check_distance(const TriangleMesh& mesh, double error, PlaceFaults& faults,
                      std::uint32_t place) const;

 private:
  std::vector<std::vector<float>> weights_;
  std::vector<FullLevel> poses_;       // of each pose alone
  std::vector<TriangleMesh> blended_;  // of all weights
  int threads_ = 0;
};

}  // namespace varifold::check
