#include <varifold/measure/shape_checker.h>

#include <varifold/base/parallel.h>
#include <varifold/base/random.h>
#include <varifold/measure/surface_distance.h>
#include <varifold/mesh/pose_blend.h>
#include <algorithm>
#include <atomic>

namespace varifold::check {

namespace {

constexpr int kBlends = 4;

bool is_exceeded(const TriangleMesh& level, const TriangleMesh& full, double bound, int threads) {
  const SurfaceDistance surface(level);
  // Even a point on a triangle is a few bits of a float away from it.
  double reach = 0;
  for (const Vec3& p : full.positions) reach = std::max<double>(reach, glm::length(p));
  const double limit = bound * (1 + 1e-5) + 4e-7 * reach;
  std::atomic<bool> exceeded{false};
  parallel_for(threads, full.positions.size(), 4096, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end && !exceeded; ++v)
      if (surface.distance(DVec3(full.positions[v])) > limit) exceeded = true;
  });
  return exceeded;
}

}  // namespace

std::vector<std::vector<float>> checked_weights(std::size_t poses) {
  std::vector<std::vector<float>> all;
  for (std::size_t i = 0; i < poses; ++i) {
    all.emplace_back(poses, 0.0f);
    all.back()[i] = 1;
  }
  Random random(poses);
  for (int i = 0; i < kBlends && poses > 0; ++i) {
    std::vector<float>& weights = all.emplace_back(poses, 0.0f);
    auto sum = static_cast<float>(random.uniform());  // of the shape at rest
    for (float& weight : weights) sum += weight = static_cast<float>(random.uniform());
    for (float& weight : weights) weight /= sum;
  }
  return all;
}

ShapeChecker::ShapeChecker(const TriangleMesh& full, const ModelPoints& points, int threads)
    : weights_(checked_weights(full.poses.size())), threads_(threads) {
  for (const auto& weights : weights_) blended_.push_back(blended_mesh(full, weights));
  for (std::size_t i = 0; i < full.poses.size(); ++i)
    poses_.emplace_back(blended_[i], std::vector<CanonicalTriangle>{}, points, 0.0, threads);
}

void ShapeChecker::check_surface(const TriangleMesh& mesh, const WeldMap& weld, PlaceFaults& faults,
                                 std::uint32_t place) const {
  for (std::size_t i = 0; i < poses_.size(); ++i)
    poses_[i].check_surface(blended_mesh(mesh, weights_[i]), weld, faults, place);
}

void ShapeChecker::check_distance(const TriangleMesh& mesh, double error, PlaceFaults& faults,
                                  std::uint32_t place) const {
  for (std::size_t i = 0; i < weights_.size(); ++i)
    if (is_exceeded(blended_mesh(mesh, weights_[i]), blended_[i], error, threads_))
      faults.add("error_exceeded", place);
}

}  // namespace varifold::check
