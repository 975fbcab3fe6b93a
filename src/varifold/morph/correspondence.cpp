// Based on: [SchreinerAsirvathamPraunHoppe2004] for maps by the distortion between both surfaces.
// Differs: where features are not given, some ways to begin are tried on coarse surfaces.
#include <varifold/base/parallel.h>
#include <varifold/morph/correspondence.h>
#include <varifold/morph/limb_pairs.h>
#include <varifold/morph/sphere_embedding.h>
#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <utility>

namespace varifold {
namespace {

constexpr std::uint32_t kCoarse = 1000;
constexpr std::uint32_t kLeastOfMap = 60;
constexpr std::uint32_t kLateFeatures = 200;
constexpr std::size_t kLimbs = 6;
constexpr std::size_t kWays = 12;
// All ways are compared at this size, and the best at that of the coarse surfaces.
constexpr std::uint32_t kScreened = 250;
constexpr std::size_t kBestWays = 3;
// Bits of distortion that one unit of squared distance between places that meet counts as; shapes
// have unit spread.
constexpr double kBitsOfDistance = 2;
constexpr double kApart = 100;  // what a pair of features that does not meet costs, per radian

constexpr double kNever = std::numeric_limits<double>::infinity();

using Points = std::array<std::vector<SpherePoint>, 2>;
using Features = std::vector<FeaturePoint>;

std::uint32_t vertex_of(const FeaturePoint& pair, int s) {
  return s == 0 ? pair.first : pair.second;
}

// A way to begin, and what came of it.
struct Way {
  LimbPairs base{};  // where has_base
  bool has_base = false;
  double cost = kNever;
  double distortion = 0;
  std::unique_ptr<PairGrowth> pair;  // as far as it has grown
};

class CorrespondenceFinder {
 public:
  CorrespondenceFinder(const std::array<SurfaceView, 2>& surfaces,
                       const CorrespondenceOptions& options)
      : surfaces_(surfaces), options_(options), full_(surfaces) {}

  Result<Correspondence> run() {
    make_coarse();
    if (!proceed(0.1f)) return cancelled();
    if (auto mapped = map_each_alone(); !mapped) return tl::unexpected(std::move(mapped.error()));
    std::vector<Way> ways = ways_to_begin();
    if (!proceed(0.15f)) return cancelled();
    for_all(ways, [&](Way& way) { begin(way); });
    keep_best(ways, kBestWays);
    if (!proceed(0.25f)) return cancelled();
    for_all(ways, [&](Way& way) { go_on(way, PairGrowth::kAll); });
    keep_best(ways, 1);
    if (ways.empty()) return fail(ErrorKind::kFailed, "the surfaces find no map onto one sphere");
    return refine(ways[0]);
  }

 private:
  [[nodiscard]] bool proceed(float done) const {
    return !options_.progress || options_.progress(done);
  }
  static tl::unexpected<Error> cancelled() {
    return fail(ErrorKind::kCancelled, "cancelled while surfaces were laid onto the sphere");
  }

  void make_coarse() {
    for (int s = 0; s < 2; ++s) {
      limbs_[s] = find_extremities(surfaces_[s], kLimbs);
      std::vector<Hold> holds(surfaces_[s].positions.size(), Hold::kFree);
      for (const std::uint32_t vertex : limbs_[s].vertices) holds[vertex] = Hold::kAlways;
      for (const FeaturePoint& pair : options_.features) holds[vertex_of(pair, s)] = Hold::kAlways;
      full_.coarsen(s, {.least = kCoarse, .holds = holds});
      coarse_[s] = full_.coarse(s);
      for (std::uint32_t& vertex : limbs_[s].vertices) vertex = coarse_number(s, vertex);
    }
    for (const auto& [in_a, in_b] : options_.features)
      features_.emplace_back(coarse_number(0, in_a), coarse_number(1, in_b));
  }

  [[nodiscard]] std::uint32_t coarse_number(int s, std::uint32_t vertex) const {
    const auto& vertices = coarse_[s].vertices;
    return static_cast<std::uint32_t>(std::lower_bound(vertices.begin(), vertices.end(), vertex) -
                                      vertices.begin());
  }

  // The maps of the coarse surfaces each for itself, turned towards each other.
  Result<void> map_each_alone() {
    for (int s = 0; s < 2; ++s) {
      auto found = embed_on_sphere(coarse_[s].indices, coarse_[s].positions);
      if (!found) return tl::unexpected(std::move(found.error()));
      alone_[s] = std::move(*found);
    }
    const SphereTriangulation a(coarse_[0].indices, alone_[0]), b(coarse_[1].indices, alone_[1]);
    const SphereMap map_a{a, coarse_[0].positions}, map_b{b, coarse_[1].positions};
    const ShapeAlignment found = align_shapes(map_a, map_b);
    turn_of_b_ = found.shape;
    alone_[1] = rotated_points(
        alone_[1], features_.empty() ? found.sphere : align_features(map_a, map_b, features_));
    return {};
  }

  [[nodiscard]] std::vector<Way> ways_to_begin() const {
    std::vector<Way> ways;
    const std::array<SurfaceView, 2> views{coarse_[0].view(), coarse_[1].view()};
    const std::vector<LimbPairs> bases = features_.size() >= 4
                                             ? widest_fours(views, features_, kWays)
                                             : pair_limbs(views, limbs_, turn_of_b_, kWays);
    for (const LimbPairs& base : bases) ways.push_back({.base = base, .has_base = true});
    ways.push_back({});
    return ways;
  }

  template <class Body>
  void for_all(std::vector<Way>& ways, const Body& body) const {
    parallel_for(options_.threads, ways.size(), 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) body(ways[i]);
    });
  }

  // The cheapest, in their order; of equal ones those that were tried first.
  static void keep_best(std::vector<Way>& ways, std::size_t count) {
    std::stable_sort(ways.begin(), ways.end(),
                     [](const Way& p, const Way& q) { return p.cost < q.cost; });
    while (ways.size() > count || (!ways.empty() && ways.back().cost == kNever)) ways.pop_back();
  }

  void begin(Way& way) const {
    way.pair = std::make_unique<PairGrowth>(
        std::array<SurfaceView, 2>{coarse_[0].view(), coarse_[1].view()});
    if (way.has_base ? begin_with_base(*way.pair, way.base) : begin_with_maps(*way.pair))
      go_on(way, kScreened);
  }

  void go_on(Way& way, std::uint32_t most) const {
    way.cost = kNever;
    PairGrowth& pair = *way.pair;
    if (!pair.grow(features_, most)) return;
    way.distortion = pair.distortion();
    way.cost = way.distortion;
    if (most == PairGrowth::kAll)
      way.cost += kApart * distance_of_features(pair.points(0), pair.points(1));
    if (features_.size() < 4) way.cost += kBitsOfDistance * mean_distance(pair.meetings());
  }

  [[nodiscard]] std::vector<Hold> holds_of_features(int s) const {
    std::vector<Hold> holds(coarse_[s].positions.size(), Hold::kFree);
    for (const FeaturePoint& feature : features_) holds[vertex_of(feature, s)] = Hold::kLate;
    return holds;
  }

  // False where the surfaces go round their four vertices in different orders.
  bool begin_with_base(PairGrowth& pair, const LimbPairs& base) const {
    for (int s = 0; s < 2; ++s) {
      std::vector<Hold> holds = holds_of_features(s);
      for (const FeaturePoint& limb : base) {
        holds[vertex_of(limb, s)] = Hold::kAlways;
        pair.hold(s, vertex_of(limb, s));
      }
      pair.coarsen(s, {.least = 4, .holds = holds, .late = kLateFeatures});
    }
    const double r = std::sqrt(8.0) / 3, x = -0.5 * r, y = std::sqrt(0.75) * r;
    for (const double side : {1, -1}) {
      const std::array<DVec3, 4> corners{DVec3(0, 0, 1), DVec3(r, 0, -1.0 / 3),
                                         DVec3(x, side * y, -1.0 / 3),
                                         DVec3(x, -side * y, -1.0 / 3)};
      for (int s = 0; s < 2; ++s)
        for (std::size_t i = 0; i < 4; ++i)
          pair.put(s, vertex_of(base[i], s), to_sphere_point(corners[i]));
      if (pair.is_positive()) return true;
    }
    return false;
  }

  bool begin_with_maps(PairGrowth& pair) const {
    for (int s = 0; s < 2; ++s) {
      const std::vector<Hold> holds = holds_of_features(s);
      for (std::uint32_t v = 0; v < alone_[s].size(); ++v) pair.put(s, v, alone_[s][v]);
      pair.coarsen(
          s, {.least = kLeastOfMap, .holds = holds, .late = kLateFeatures, .points = alone_[s]});
    }
    return pair.is_positive();
  }

  [[nodiscard]] double distance_of_features(std::span<const SpherePoint> a,
                                            std::span<const SpherePoint> b) const {
    double farthest = 0;
    for (const auto& [in_a, in_b] : features_)
      if (a[in_a] != b[in_b])
        farthest = std::max(farthest, glm::distance(direction(a[in_a]), direction(b[in_b])));
    return farthest;
  }

  // Squared, with both shapes about their middles, of unit spread, and the second one turned.
  [[nodiscard]] double mean_distance(std::vector<Meeting> meetings) const {
    DVec3 middle_a(0), middle_b(0);
    double weights = 0, spread_a = 0, spread_b = 0, sum = 0;
    for (Meeting& m : meetings) {
      m.on_b = rotated(turn_of_b_, m.on_b);
      middle_a += m.weight * m.on_a, middle_b += m.weight * m.on_b, weights += m.weight;
    }
    middle_a /= weights, middle_b /= weights;
    for (Meeting& m : meetings) {
      m.on_a -= middle_a, m.on_b -= middle_b;
      spread_a += m.weight * glm::dot(m.on_a, m.on_a);
      spread_b += m.weight * glm::dot(m.on_b, m.on_b);
    }
    const double scale_a = std::sqrt(weights / spread_a), scale_b = std::sqrt(weights / spread_b);
    for (const Meeting& m : meetings) {
      const DVec3 gap = scale_a * m.on_a - scale_b * m.on_b;
      sum += m.weight * glm::dot(gap, gap);
    }
    return sum / weights;
  }

  Result<Correspondence> refine(const Way& way) {
    for (int s = 0; s < 2; ++s)
      for (std::uint32_t v = 0; v < coarse_[s].vertices.size(); ++v)
        full_.put(s, coarse_[s].vertices[v], way.pair->points(s)[v]);
    Correspondence result;
    result.distortion = way.distortion;
    result.feature_distance = distance_of_features(way.pair->points(0), way.pair->points(1));
    bool is_cancelled = false;
    const auto progress = [&](float done) {
      is_cancelled = !proceed(0.3f + 0.7f * done);
      return !is_cancelled;
    };
    const bool has_grown = full_.grow(options_.features, PairGrowth::kAll, progress);
    if (is_cancelled) return cancelled();
    if (!has_grown)
      return fail(ErrorKind::kFailed,
                  "a vertex finds no place on the sphere: triangles are too small");
    for (int s = 0; s < 2; ++s)
      result.points[s].assign(full_.points(s).begin(), full_.points(s).end());
    return result;
  }

  const std::array<SurfaceView, 2>& surfaces_;
  const CorrespondenceOptions& options_;
  PairGrowth full_;
  std::array<Extremities, 2> limbs_;  // of the coarse surfaces
  std::array<CoarseSurface, 2> coarse_;
  Features features_;  // the same
  Points alone_;
  Rotation turn_of_b_ = kNoRotation;
};

}  // namespace

Result<Correspondence> find_correspondence(const std::array<SurfaceView, 2>& surfaces,
                                           const CorrespondenceOptions& options) {
  return CorrespondenceFinder(surfaces, options).run();
}

}  // namespace varifold
