#include <varifold/base/angle.h>
#include <varifold/morph/disc_alignment.h>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

namespace varifold {
namespace {

constexpr std::uint32_t kRings = 16;  // of one area; and one at the border
constexpr std::uint32_t kAngles = 128;
constexpr double kBorderHeight = 1e-4;
constexpr std::uint64_t kSteps = std::uint64_t{1} << 40;  // of a full turn
// How much better a shape must fit when it is turned than as it stands.
constexpr double kTurnedFactor = 1.25;

using Table = std::vector<DVec3>;  // by rings, then by angles

// Where a shape is on the rings when it is turned about the axis by some steps.
class RingSampler {
 public:
  explicit RingSampler(const SphereMap& map) : map_(map), locator_(map.sphere) {
    const Table table = raw(0);
    for (const DVec3& place : table) middle_ += place / static_cast<double>(table.size());
    double spread = 0;
    for (const DVec3& place : table) spread += glm::dot(place - middle_, place - middle_);
    if (spread > 0) scale_ = std::sqrt(static_cast<double>(table.size()) / spread);
  }

  Table at(std::uint64_t turn) {
    Table table = raw(turn);
    for (DVec3& place : table) place = scale_ * (place - middle_);
    return table;
  }

 private:
  Table raw(std::uint64_t turn) {
    Table table;
    table.reserve(std::size_t{kRings + 1} * kAngles);
    for (std::uint32_t ring = 0; ring <= kRings; ++ring) {
      const double z = ring == 0 ? kBorderHeight : (ring - 0.5) / kRings;
      const double r = std::sqrt(1 - z * z);
      for (std::uint32_t i = 0; i < kAngles; ++i) {
        // What is turned by some steps has at an angle what it had before.
        const glm::dvec2 way = unit_circle(i * (kSteps / kAngles) + kSteps - turn % kSteps, kSteps);
        table.push_back(sample({r * way.x, r * way.y, z}));
      }
    }
    return table;
  }

  DVec3 sample(const DVec3& way) {
    const SpherePoint p = to_sphere_point(way);
    const std::uint32_t triangle = locator_.locate(p, last_);
    if (triangle == kNone) return DVec3(0);
    last_ = triangle;
    DVec3 sum(0);
    double weights = 0;
    const auto corner = [&](std::uint32_t k) { return map_.sphere.indices[3 * triangle + k % 3]; };
    for (std::uint32_t k = 0; k < 3; ++k) {
      const double weight =
          determinant(map_.sphere.points[corner(k + 1)], map_.sphere.points[corner(k + 2)], p);
      if (corner(k) < map_.positions.size()) sum += weight * DVec3(map_.positions[corner(k)]);
      weights += weight;
    }
    return weights > 0 ? sum / weights : DVec3(0);
  }

  const SphereMap& map_;
  SphereLocator locator_;
  std::uint32_t last_ = 0;
  DVec3 middle_{0};
  double scale_ = 1;
};

// The sum of squared distances when the second one is turned by some of the angles.
double gap_of(const Table& places, const Table& others, std::uint32_t shift) {
  double sum = 0;
  for (std::uint32_t ring = 0; ring <= kRings; ++ring)
    for (std::uint32_t i = 0; i < kAngles; ++i) {
      const DVec3 gap =
          places[ring * kAngles + i] - others[ring * kAngles + (i + kAngles - shift) % kAngles];
      sum += glm::dot(gap, gap);
    }
  return sum;
}

}  // namespace

double align_discs(const SphereMap& a, const SphereMap& b) {
  RingSampler sampler_a(a), sampler_b(b);
  const Table as_it_stands = sampler_a.at(0), others = sampler_b.at(0);
  Table places, turned(as_it_stands.size());
  double least = 0;
  std::uint64_t angle = 0;
  for (const Rotation& turn : axis_rotations()) {
    for (std::size_t i = 0; i < turned.size(); ++i) turned[i] = rotated(turn, as_it_stands[i]);
    for (std::uint32_t shift = 0; shift < kAngles; ++shift) {
      const double factor = turn == kNoRotation ? 1 : kTurnedFactor;
      const double sum = factor * gap_of(turned, others, shift);
      if (!places.empty() && sum >= least) continue;
      least = sum, places = turned;
      angle = shift * (kSteps / kAngles);
    }
  }
  least = gap_of(places, sampler_b.at(angle), 0);
  for (std::uint64_t step = kSteps / kAngles / 2; step > kSteps / 200'000; step /= 2)
    for (const std::uint64_t next : {angle + step, angle + kSteps - step}) {
      const double sum = gap_of(places, sampler_b.at(next), 0);
      if (sum < least) least = sum, angle = next % kSteps;
    }
  return static_cast<double>(angle) / static_cast<double>(kSteps);
}

double align_disc_features(const SphereMap& a, const SphereMap& b,
                           std::span<const FeaturePoint> features) {
  glm::dvec2 sum(0);
  for (const auto& [in_a, in_b] : features) {
    const DVec3 p = direction(a.sphere.points[in_a]), q = direction(b.sphere.points[in_b]);
    sum += glm::dvec2(p.x * q.x + p.y * q.y, p.y * q.x - p.x * q.y);
  }
  const double length = std::sqrt(glm::dot(sum, sum));
  if (length < 1e-9) return 0;
  const double turn = arc_cosine(sum.x / length) / (2 * std::numbers::pi);
  return sum.y >= 0 ? turn : 1 - turn;
}

}  // namespace varifold
