// Based on: [CignoniRocchiniScopigno1998] (Metro), sampling by area, both directions.
// Differs: stratified samples; closest points by a bounding volume hierarchy instead of a grid.
#include <embree3/rtcore.h>

#include <varifold/base/parallel.h>
#include <varifold/base/random.h>
#include <varifold/measure/closest_point.h>
#include <varifold/measure/surface_distance.h>
#include <varifold/mesh/normals.h>
#include <algorithm>
#include <cmath>
#include <limits>
#include <new>
#include <vector>

namespace varifold {

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// What a query carries through the tree. Lengths in units of the tree.
struct Search {
  DVec3 point{0};     ///< in units of the tree
  double margin = 0;  ///< by how much the floats of the tree may be off near the point
  double best_square = kInfinity;
  DVec3 best{0};
  std::uint32_t triangle = kNone;
};

/// The float at or below x, and at or above: boxes must not lose a triangle by rounding.
float round_down(double x) {
  const auto f = static_cast<float>(x);
  return f > x ? std::nextafter(f, -std::numeric_limits<float>::infinity()) : f;
}
float round_up(double x) {
  const auto f = static_cast<float>(x);
  return f < x ? std::nextafter(f, std::numeric_limits<float>::infinity()) : f;
}

}  // namespace

/// Embree's tree over boxes in coordinates scaled to the unit cube, so that neither huge nor tiny
/// models nor those far from the origin trouble its floats; triangles are judged in double.
struct SurfaceDistance::Tree {
  explicit Tree(const TriangleMesh& mesh) {
    Box box;
    for (const std::uint32_t v : mesh.indices) box.add(mesh.positions[v]);
    if (box.empty()) return;
    const DVec3 lower(box.lower), upper(box.upper);
    const DVec3 size = upper - lower;
    center = 0.5 * (lower + upper);
    scale = std::max({size.x, size.y, size.z});
    if (!(scale > 0)) scale = 1;
    corners.reserve(mesh.indices.size());
    for (const std::uint32_t v : mesh.indices) corners.push_back(inside(DVec3(mesh.positions[v])));
    build();
  }
  ~Tree() {
    if (scene != nullptr) rtcReleaseScene(scene);
    if (device != nullptr) rtcReleaseDevice(device);
  }
  Tree(const Tree&) = delete;
  Tree& operator=(const Tree&) = delete;

  [[nodiscard]] DVec3 inside(const DVec3& p) const { return (p - center) / scale; }
  [[nodiscard]] DVec3 outside(const DVec3& p) const { return p * scale + center; }

  void build() {
    device = rtcNewDevice(nullptr);
    if (device == nullptr) throw std::bad_alloc();
    scene = rtcNewScene(device);
    rtcSetSceneBuildQuality(scene, RTC_BUILD_QUALITY_MEDIUM);
    rtcSetSceneFlags(scene, RTC_SCENE_FLAG_ROBUST);
    RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_USER);
    rtcSetGeometryUserPrimitiveCount(geometry, static_cast<unsigned>(corners.size() / 3));
    rtcSetGeometryUserData(geometry, this);
    rtcSetGeometryBoundsFunction(geometry, bound, nullptr);
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene, geometry);
    rtcReleaseGeometry(geometry);
    rtcCommitScene(scene);
    if (rtcGetDeviceError(device) != RTC_ERROR_NONE) throw std::bad_alloc();
  }

  static void bound(const RTCBoundsFunctionArguments* arguments) {
    const Tree& tree = *static_cast<const Tree*>(arguments->geometryUserPtr);
    const DVec3* t = &tree.corners[3 * std::size_t{arguments->primID}];
    RTCBounds& out = *arguments->bounds_o;
    out.lower_x = round_down(std::min({t[0].x, t[1].x, t[2].x}));
    out.lower_y = round_down(std::min({t[0].y, t[1].y, t[2].y}));
    out.lower_z = round_down(std::min({t[0].z, t[1].z, t[2].z}));
    out.upper_x = round_up(std::max({t[0].x, t[1].x, t[2].x}));
    out.upper_y = round_up(std::max({t[0].y, t[1].y, t[2].y}));
    out.upper_z = round_up(std::max({t[0].z, t[1].z, t[2].z}));
  }

  /// The tree's visit to a triangle; returns whether it came closer.
  static bool visit(RTCPointQueryFunctionArguments* arguments) {
    auto& [search, tree] = *static_cast<std::pair<Search, const Tree*>*>(arguments->userPtr);
    const DVec3* t = &tree->corners[3 * std::size_t{arguments->primID}];
    const DVec3 q = closest_on_triangle(search.point, t[0], t[1], t[2]);
    const double square = glm::dot(q - search.point, q - search.point);
    // Of equals the first: with the margin all of them are visited, in whatever order.
    const bool is_better = square < search.best_square ||
                           (square == search.best_square && arguments->primID < search.triangle);
    if (!is_better) return false;
    search.best_square = square;
    search.best = q;
    search.triangle = arguments->primID;
    const double radius = std::sqrt(square) * (1 + 1e-6) + search.margin;
    if (!(radius < arguments->query->radius)) return false;
    arguments->query->radius = round_up(radius);
    return true;
  }

  RTCDevice device = nullptr;
  RTCScene scene = nullptr;
  DVec3 center{0};
  double scale = 1;
  std::vector<DVec3> corners;  ///< three per triangle, in units of the tree
};

SurfaceDistance::SurfaceDistance(const TriangleMesh& mesh) : tree_(new Tree(mesh)) {}
SurfaceDistance::~SurfaceDistance() = default;
SurfaceDistance::SurfaceDistance(SurfaceDistance&&) noexcept = default;
SurfaceDistance& SurfaceDistance::operator=(SurfaceDistance&&) noexcept = default;

bool SurfaceDistance::empty() const { return tree_->scene == nullptr; }

ClosestPoint SurfaceDistance::closest(const DVec3& p) const {
  if (empty()) return {p, kInfinity, kNone};
  std::pair<Search, const Tree*> state{{}, tree_.get()};
  Search& search = state.first;
  search.point = tree_->inside(p);

  RTCPointQuery query{};
  query.x = static_cast<float>(search.point.x);
  query.y = static_cast<float>(search.point.y);
  query.z = static_cast<float>(search.point.z);
  query.radius = std::numeric_limits<float>::infinity();
  // The tree measures from the rounded point, and rounds when it does.
  const double reach =
      std::max({std::abs(search.point.x), std::abs(search.point.y), std::abs(search.point.z)});
  search.margin = 5e-7 * (reach + 1);

  RTCPointQueryContext context;
  rtcInitPointQueryContext(&context);
  rtcPointQuery(tree_->scene, &query, &context, Tree::visit, &state);
  return {tree_->outside(search.best), std::sqrt(search.best_square) * tree_->scale,
          search.triangle};
}

namespace {

constexpr std::size_t kGrain = 2048;

/// Chooses points on a mesh, evenly over its area.
class Sampler {
 public:
  Sampler(const TriangleMesh& mesh, const DistanceOptions& options)
      : mesh_(mesh), options_(options), area_up_to_(mesh.triangle_count()) {
    double sum = 0;
    for (std::uint32_t t = 0; t < mesh.triangle_count(); ++t)
      area_up_to_[t] = sum += triangle_area(mesh, t);
    if (sum > 0 && sum < kInfinity) return;
    for (std::uint32_t t = 0; t < mesh.triangle_count(); ++t) area_up_to_[t] = t + 1.0;
  }

  /// The sample of a stratum: each has the same share of the area.
  [[nodiscard]] DVec3 sample(std::size_t stratum) const {
    // A generator of its own makes each sample independent of the cut into pieces.
    Random random(options_.seed * 0x9e3779b97f4a7c15u + stratum * 0xbf58476d1ce4e5b9u);
    const double at = (static_cast<double>(stratum) + random.uniform()) / options_.samples;
    const auto found =
        std::upper_bound(area_up_to_.begin(), area_up_to_.end(), at * area_up_to_.back());
    const std::size_t t = std::min<std::size_t>(
        static_cast<std::size_t>(found - area_up_to_.begin()), area_up_to_.size() - 1);
    const double root = std::sqrt(random.uniform()), v = random.uniform();
    const std::uint32_t* index = &mesh_.indices[3 * t];
    return (1 - root) * DVec3(mesh_.positions[index[0]]) +
           root * (1 - v) * DVec3(mesh_.positions[index[1]]) +
           root * v * DVec3(mesh_.positions[index[2]]);
  }

 private:
  const TriangleMesh& mesh_;
  const DistanceOptions& options_;
  std::vector<double> area_up_to_;
};

struct Sums {
  double squares = 0;
  double maximum = 0;
};

/// Adds up fn(0) .. fn(count - 1) in pieces, in the same order for any number of threads.
template <class Distance>
Sums add_distances(int threads, std::size_t count, const Distance& distance) {
  std::vector<Sums> pieces((count + kGrain - 1) / kGrain);
  parallel_for(threads, count, kGrain, [&](std::size_t begin, std::size_t end) {
    Sums& sums = pieces[begin / kGrain];
    for (std::size_t i = begin; i < end; ++i) {
      const double d = distance(i);
      sums.squares += d * d;
      sums.maximum = std::max(sums.maximum, d);
    }
  });
  Sums total;
  for (const Sums& piece : pieces) {
    total.squares += piece.squares;
    total.maximum = std::max(total.maximum, piece.maximum);
  }
  return total;
}

}  // namespace

OneSidedDistance sampled_distance(const TriangleMesh& from, const SurfaceDistance& to,
                                  const DistanceOptions& options) {
  if (from.indices.empty() || options.samples == 0) return {};
  if (to.empty()) return {kInfinity, kInfinity, options.samples};
  const Sampler sampler(from, options);
  const Sums sums = add_distances(options.threads, options.samples,
                                  [&](std::size_t i) { return to.distance(sampler.sample(i)); });
  OneSidedDistance result{std::sqrt(sums.squares / options.samples), sums.maximum, options.samples};
  if (options.vertices) {
    std::vector<std::uint32_t> used = from.indices;
    std::sort(used.begin(), used.end());
    used.erase(std::unique(used.begin(), used.end()), used.end());
    const Sums at_vertices = add_distances(options.threads, used.size(), [&](std::size_t i) {
      return to.distance(DVec3(from.positions[used[i]]));
    });
    result.maximum = std::max(result.maximum, at_vertices.maximum);
  }
  return result;
}

SurfaceDistanceReport surface_distance(const TriangleMesh& a, const TriangleMesh& b,
                                       const DistanceOptions& options) {
  const OneSidedDistance a_to_b = sampled_distance(a, SurfaceDistance(b), options);
  const OneSidedDistance b_to_a = sampled_distance(b, SurfaceDistance(a), options);
  SurfaceDistanceReport report;
  report.rms_a_to_b = a_to_b.rms;
  report.rms_b_to_a = b_to_a.rms;
  report.rms = std::max(a_to_b.rms, b_to_a.rms);
  report.max_a_to_b = a_to_b.maximum;
  report.max_b_to_a = b_to_a.maximum;
  report.hausdorff = std::max(a_to_b.maximum, b_to_a.maximum);
  report.samples = std::max(a_to_b.samples, b_to_a.samples);
  const Box box = bounds(b);
  if (!box.empty()) report.diagonal = glm::length(DVec3(box.upper) - DVec3(box.lower));
  return report;
}

}  // namespace varifold
