// Prints how far fronts of view-dependent meshes are from what their tolerance says: the tables of
// docs/algorithms/view_dependent_mesh.md.
#include <benchmarks/bench_meshes.h>
#include <benchmarks/views_of_mesh.h>
#include <varifold/models/vdpm/build.h>
#include <varifold/models/vdpm/instance.h>
#include <varifold/simplify/simplify.h>
#include <algorithm>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

namespace varifold::bench {
namespace {

constexpr float kTolerance = 1;  // pixels
constexpr int kViews = 200, kHausdorffViews = 40;
constexpr std::uint32_t kVisible = 5000, kTries = 400'000;  // samples a view

// Pixels of the way from a point to the nearest of a surface: its length, as if it lay across the
// ray from the eye, and what is seen of it.
struct Deviation {
  double length = 0, seen = 0;

  void widen(const Deviation& other) {
    length = std::max(length, other.length);
    seen = std::max(seen, other.seen);
  }
};

Deviation deviation(const DVec3& point, const SurfaceDistance& surface, const PixelScale& scale) {
  const ClosestPoint closest = surface.closest(point);
  const DVec3 way = closest.point - point;
  const DVec3 ray = glm::normalize(point - DVec3(scale.eye()));
  const DVec3 across = way - glm::dot(way, ray) * ray;
  const double pixels = scale.pixels_of(1, Vec3(point));
  return {closest.distance * pixels, glm::length(across) * pixels};
}

void print_parts(const char* measure, std::vector<double>& pixels) {
  std::sort(pixels.begin(), pixels.end());
  const auto within =
      std::upper_bound(pixels.begin(), pixels.end(), double{kTolerance}) - pixels.begin();
  const auto count = static_cast<double>(pixels.size());
  const auto at = [&](double part) { return pixels[static_cast<std::size_t>(part * (count - 1))]; };
  std::printf("    %s: within %g px %.4f %%; median %.3f, 99 %% %.3f, 99.9 %% %.3f, max %.3f\n",
              measure, kTolerance, 100 * static_cast<double>(within) / count, at(0.5), at(0.99),
              at(0.999), pixels.back());
}

// Visible samples, all criteria on.
void print_visible(const Original& original, ViewDependentInstance& instance,
                   DeviationMeasure measure) {
  std::vector<double> lengths, seen;
  double triangles = 0;
  int views = 0;
  Random random(1);
  for (int i = 0; i < kViews; ++i) {
    RefineCriteria criteria;
    ViewCriterion& view =
        criteria.view.emplace(random_view(original.sampler, original.box, random));
    view.deviation = measure;
    triangles += instance.adapt(criteria, {kTolerance}).triangles;
    const SurfaceDistance front(instance.extract());
    const std::size_t before = seen.size();
    for (std::uint32_t n = 0; n < kTries && seen.size() - before < kVisible; ++n) {
      const Sampler::Sample sample = original.sampler.next(random);
      if (!original.shows(sample, view)) continue;
      const Deviation d = deviation(sample.point, front, view.scale);
      lengths.push_back(d.length);
      seen.push_back(d.seen);
    }
    views += seen.size() > before;
  }
  std::printf("  %d views, %zu visible samples, %.0f triangles\n", views, seen.size(),
              triangles / kViews);
  print_parts("length", lengths);
  print_parts("seen  ", seen);
}

// Of samples and corners.
Deviation greatest(const TriangleMesh& mesh, const Sampler& from, const SurfaceDistance& to,
                   const PixelScale& scale, Random& random) {
  Deviation most;
  for (int n = 0; n < 50'000; ++n) most.widen(deviation(from.next(random).point, to, scale));
  for (const Vec3& p : mesh.positions) most.widen(deviation(DVec3(p), to, scale));
  return most;
}

// All of both surfaces, frustum and orientation off.
void print_hausdorff(const Original& original, ViewDependentInstance& instance,
                     DeviationMeasure measure) {
  std::vector<double> lengths[2], seen[2];
  double triangles = 0;
  Random random(2);
  const TriangleMesh used = without_unused_vertices(original.mesh);
  for (int i = 0; i < kHausdorffViews; ++i) {
    RefineCriteria criteria;
    ViewCriterion& view =
        criteria.view.emplace(random_view(original.sampler, original.box, random));
    view.outside_weight = view.back_weight = 1;
    view.deviation = measure;
    triangles += instance.adapt(criteria, {kTolerance}).triangles;
    const TriangleMesh mesh = without_unused_vertices(instance.extract());
    const Deviation ways[2] = {
        greatest(used, original.sampler, SurfaceDistance(mesh), view.scale, random),
        greatest(mesh, Sampler(mesh), original.surface, view.scale, random)};
    for (int way = 0; way < 2; ++way) {
      lengths[way].push_back(ways[way].length);
      seen[way].push_back(ways[way].seen);
    }
  }
  std::printf("  no culling, %.0f triangles; greatest of a view in px, median and max:\n",
              triangles / kHausdorffViews);
  for (int way = 0; way < 2; ++way) {
    for (std::vector<double>* pixels : {&lengths[way], &seen[way]})
      std::sort(pixels->begin(), pixels->end());
    std::printf("    %s: length %.3f, %.3f; seen %.3f, %.3f\n",
                way == 0 ? "original to front" : "front to original",
                lengths[way][lengths[way].size() / 2], lengths[way].back(),
                seen[way][seen[way].size() / 2], seen[way].back());
  }
}

void print_mesh(const std::string& name) {
  const TriangleMesh mesh = without_attributes(bench::mesh(name));
  const Original original{mesh};
  for (const Placement placement : {Placement::kKept, Placement::kOptimal}) {
    const DetailedMesh detailed =
        simplify(mesh, {.placement = placement, .measure_error = false})->detailed;
    ViewDependentInstance instance(
        std::make_shared<const ViewDependentMesh>(build_view_dependent_mesh(detailed)));
    for (const DeviationMeasure measure : {DeviationMeasure::kSeen, DeviationMeasure::kLength}) {
      std::printf("%s, %s, deviations %s\n", name.c_str(),
                  placement == Placement::kKept ? "kept" : "optimal",
                  measure == DeviationMeasure::kSeen ? "as seen" : "as lengths");
      print_visible(original, instance, measure);
      print_hausdorff(original, instance, measure);
      std::fflush(stdout);
    }
  }
}

}  // namespace
}  // namespace varifold::bench

int main() {
  using namespace varifold;
  for (const std::string& name : bench::present({"bunny.ply", "igea.ply", "armadillo.ply"}))
    bench::print_mesh(name);
}
