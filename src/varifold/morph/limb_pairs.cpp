#include <varifold/morph/limb_pairs.h>
#include <algorithm>
#include <cmath>
#include <utility>

namespace varifold {
namespace {

// What squared distances between places count beside squared logarithms of distances along the
// surface.
constexpr double kPlaces = 0.5;
// Only the first so many features are combined.
constexpr std::size_t kMostFeatures = 10;

struct Scored {
  double cost = 0;
  LimbPairs pairs;
};

std::vector<LimbPairs> cheapest(std::vector<Scored>& found, std::size_t count) {
  std::stable_sort(found.begin(), found.end(),
                   [](const Scored& p, const Scored& q) { return p.cost < q.cost; });
  std::vector<LimbPairs> result;
  for (std::size_t i = 0; i < std::min(count, found.size()); ++i) result.push_back(found[i].pairs);
  return result;
}

// Places about their middle, of unit spread.
std::vector<DVec3> centered(const SurfaceView& surface, const Extremities& limbs,
                            const Rotation& turn) {
  DVec3 middle(0);
  double spread = 0;
  for (const Vec3& p : surface.positions) middle += DVec3(p);
  middle /= static_cast<double>(surface.positions.size());
  for (const Vec3& p : surface.positions) spread += glm::dot(DVec3(p) - middle, DVec3(p) - middle);
  const double scale =
      spread > 0 ? std::sqrt(static_cast<double>(surface.positions.size()) / spread) : 1.0;
  std::vector<DVec3> result;
  for (const std::uint32_t vertex : limbs.vertices)
    result.push_back(rotated(turn, scale * (DVec3(surface.positions[vertex]) - middle)));
  return result;
}

// Calls back with every four of `count` numbers, ascending.
template <class Call>
void for_fours(std::size_t count, const Call& call) {
  for (std::size_t a = 0; a < count; ++a)
    for (std::size_t b = a + 1; b < count; ++b)
      for (std::size_t c = b + 1; c < count; ++c)
        for (std::size_t d = c + 1; d < count; ++d) call(std::array<std::size_t, 4>{a, b, c, d});
}

}  // namespace

std::vector<LimbPairs> pair_limbs(const std::array<SurfaceView, 2>& surfaces,
                                  const std::array<Extremities, 2>& limbs,
                                  const Rotation& turn_of_b, std::size_t count) {
  const std::vector<DVec3> on_a = centered(surfaces[0], limbs[0], kNoRotation);
  const std::vector<DVec3> on_b = centered(surfaces[1], limbs[1], turn_of_b);
  std::vector<Scored> found;
  for_fours(on_a.size(), [&](const std::array<std::size_t, 4>& in_a) {
    for_fours(on_b.size(), [&](std::array<std::size_t, 4> in_b) {
      do {
        Scored way;
        for (std::size_t i = 0; i < 4; ++i) {
          const DVec3 gap = on_a[in_a[i]] - on_b[in_b[i]];
          way.cost += kPlaces * glm::dot(gap, gap);
          for (std::size_t j = 0; j < i; ++j) {
            const double ratio = std::log((limbs[0].distance(in_a[i], in_a[j]) + 1e-3) /
                                          (limbs[1].distance(in_b[i], in_b[j]) + 1e-3));
            way.cost += ratio * ratio;
          }
          way.pairs[i] = {limbs[0].vertices[in_a[i]], limbs[1].vertices[in_b[i]]};
        }
        found.push_back(way);
      } while (std::next_permutation(in_b.begin(), in_b.end()));
    });
  });
  return cheapest(found, count);
}

std::vector<LimbPairs> widest_fours(const std::array<SurfaceView, 2>& surfaces,
                                    std::span<const FeaturePoint> features, std::size_t count) {
  std::vector<Scored> found;
  for_fours(std::min(features.size(), kMostFeatures), [&](const std::array<std::size_t, 4>& four) {
    Scored way;
    for (std::size_t i = 0; i < 4; ++i) {
      way.pairs[i] = features[four[i]];
      for (std::size_t j = 0; j < i; ++j)
        for (int s = 0; s < 2; ++s) {
          const auto place = [&](const FeaturePoint& pair) {
            return DVec3(surfaces[s].positions[s == 0 ? pair.first : pair.second]);
          };
          way.cost -= std::log(glm::distance(place(way.pairs[i]), place(way.pairs[j])) + 1e-30);
        }
    }
    found.push_back(way);
  });
  return cheapest(found, count);
}

}  // namespace varifold
