#include <varifold/base/parallel.h>
#include <varifold/morph/feature_warp.h>
#include <varifold/morph/separate_maps.h>
#include <varifold/morph/sphere_embedding.h>
#include <atomic>
#include <utility>

namespace varifold {
namespace {

using Points = std::array<std::vector<SpherePoint>, 2>;

Result<Points> embed_both(const std::array<SurfaceView, 2>& surfaces,
                          const CorrespondenceOptions& options) {
  std::array<Result<std::vector<SpherePoint>>, 2> found;
  // The callback belongs to the caller's thread, which maps the first surface.
  std::atomic<bool> is_cancelled = false;
  SphereEmbeddingOptions quiet, loud;
  quiet.progress = [&](float) { return !is_cancelled; };
  loud.progress = [&](float done) {
    if (options.progress && !options.progress(done)) is_cancelled = true;
    return !is_cancelled;
  };
  const auto embed_one = [&](std::size_t s, const SphereEmbeddingOptions& embedding) {
    found[s] = embed_on_sphere(surfaces[s].indices, surfaces[s].positions, embedding);
  };
  parallel_both(
      options.threads, [&] { embed_one(0, loud); }, [&] { embed_one(1, quiet); });
  Points points;
  for (std::size_t s = 0; s < 2; ++s) {
    if (!found[s])
      return fail_in(s == 0 ? "first mesh" : "second mesh", std::move(found[s].error()));
    points[s] = std::move(*found[s]);
  }
  return points;
}

// A rotation rounds, which may fold the smallest triangles; another, almost equal one may not.
Result<void> turn(const std::array<SurfaceView, 2>& surfaces,
                  std::span<const FeaturePoint> features, Points& points) {
  const auto sphere_of = [&](std::size_t s) {
    return SphereTriangulation({surfaces[s].indices.begin(), surfaces[s].indices.end()}, points[s]);
  };
  const SphereTriangulation a = sphere_of(0), b = sphere_of(1);
  const SphereMap map_a{a, surfaces[0].positions}, map_b{b, surfaces[1].positions};
  Rotation rotation =
      features.empty() ? align_shapes(map_a, map_b).sphere : align_features(map_a, map_b, features);
  for (int attempt = 0; attempt < 20; ++attempt) {
    points[1] = rotated_points(b.points, rotation);
    if (count_flipped_on_sphere(b.indices, points[1]) == 0) return {};
    const double angle = 1e-9 * (attempt + 1);
    for (DVec3& row : rotation) row = DVec3(row.x - angle * row.y, row.y + angle * row.x, row.z);
  }
  return fail(ErrorKind::kFailed, "second mesh: triangles are too small to be turned");
}

}  // namespace

Result<Correspondence> map_separately(const std::array<SurfaceView, 2>& surfaces,
                                      const CorrespondenceOptions& options) {
  auto points = embed_both(surfaces, options);
  if (!points) return tl::unexpected(std::move(points.error()));
  if (auto turned = turn(surfaces, options.features, *points); !turned)
    return tl::unexpected(std::move(turned.error()));
  Correspondence result;
  if (!options.features.empty()) {
    std::vector<Pin> pins;
    pins.reserve(options.features.size());
    for (const auto& [in_a, in_b] : options.features) pins.push_back({in_b, (*points)[0][in_a]});
    const MutableSphereMap map{surfaces[1].indices, surfaces[1].positions, (*points)[1]};
    result.feature_distance = drag_to_goals(map, pins).farthest;
  }
  result.points = std::move(*points);
  return result;
}

}  // namespace varifold
