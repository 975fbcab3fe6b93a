// Based on: [Alexa2000] for aligning two maps onto the sphere by a rotation first.
// Differs: without features, the shapes themselves are compared, over a sample of all rotations.
#include <varifold/base/angle.h>
#include <varifold/base/random.h>
#include <varifold/morph/alignment.h>
#include <algorithm>
#include <cmath>

namespace varifold {
namespace {

constexpr std::uint32_t kRotationSamples = 6000;
constexpr std::size_t kRefined = 6;
constexpr std::uint32_t kDirections = 700;
constexpr std::uint32_t kCubeSide = 48;
// How much better a shape must fit when it is turned than as it stands.
constexpr double kTurnedFactor = 1.25;

struct Quaternion {
  double w = 1, x = 0, y = 0, z = 0;
};

Quaternion product(const Quaternion& p, const Quaternion& q) {
  return {
      p.w * q.w - p.x * q.x - p.y * q.y - p.z * q.z, p.w * q.x + p.x * q.w + p.y * q.z - p.z * q.y,
      p.w * q.y - p.x * q.z + p.y * q.w + p.z * q.x, p.w * q.z + p.x * q.y - p.y * q.x + p.z * q.w};
}

Quaternion normalized(const Quaternion& q) {
  const double scale = 1 / std::sqrt(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z);
  return {q.w * scale, q.x * scale, q.y * scale, q.z * scale};
}

Rotation matrix(const Quaternion& q) {
  return {DVec3(1 - 2 * (q.y * q.y + q.z * q.z), 2 * (q.x * q.y - q.w * q.z),
                2 * (q.x * q.z + q.w * q.y)),
          DVec3(2 * (q.x * q.y + q.w * q.z), 1 - 2 * (q.x * q.x + q.z * q.z),
                2 * (q.y * q.z - q.w * q.x)),
          DVec3(2 * (q.x * q.z - q.w * q.y), 2 * (q.y * q.z + q.w * q.x),
                1 - 2 * (q.x * q.x + q.y * q.y))};
}

// Uniform: four numbers from a ball, normalised.
Quaternion random_quaternion(Random& random) {
  for (;;) {
    const Quaternion q{2 * random.uniform() - 1, 2 * random.uniform() - 1, 2 * random.uniform() - 1,
                       2 * random.uniform() - 1};
    const double square = q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z;
    if (square > 0.01 && square < 1) return normalized(q);
  }
}

struct Found {
  double cost = 0;
  Quaternion rotation;
};

// Small turns about the axes, smaller and smaller.
template <class Cost>
Found refined(Found best, const Cost& cost) {
  for (double angle = 0.2; angle > 0.002; angle *= 0.6) {
    for (int way = 0; way < 6; ++way) {
      const double half = way % 2 == 0 ? 0.5 * angle : -0.5 * angle;
      Quaternion turn{1, 0, 0, 0};
      (way < 2 ? turn.x : way < 4 ? turn.y : turn.z) = half;
      const Quaternion next = normalized(product(normalized(turn), best.rotation));
      const double at_next = cost(matrix(next));
      if (at_next < best.cost) best = {at_next, next};
    }
  }
  return best;
}

template <class Cost>
Found least(const Cost& cost) {
  std::vector<Found> found;
  Random random(7);
  for (std::uint32_t i = 0; i < kRotationSamples; ++i) {
    const Quaternion q = i == 0 ? Quaternion{} : random_quaternion(random);
    found.push_back({cost(matrix(q)), q});
  }
  const auto is_less = [](const Found& p, const Found& q) { return p.cost < q.cost; };
  std::stable_sort(found.begin(), found.end(), is_less);
  Found best = refined(found[0], cost);
  for (std::size_t i = 1; i < kRefined; ++i) {
    const Found other = refined(found[i], cost);
    if (other.cost < best.cost) best = other;
  }
  return best;
}

// Where a shape is at a direction: positions with their middle at 0 and unit spread.
class ShapeSampler {
 public:
  explicit ShapeSampler(const SphereMap& map) : map_(map), locator_(map.sphere) {
    double area = 0, spread = 0;
    const auto& indices = map.sphere.indices;
    for (int pass = 0; pass < 2; ++pass) {
      for (std::size_t t = 0; t < indices.size(); t += 3) {
        const DVec3 a = place(indices[t]), b = place(indices[t + 1]), c = place(indices[t + 2]);
        const double weight = glm::length(glm::cross(b - a, c - a));
        const DVec3 middle = (a + b + c) / 3.0;
        if (pass == 0)
          area += weight, middle_ += weight * middle;
        else
          spread += weight * glm::dot(middle - middle_, middle - middle_);
      }
      if (pass == 0 && area > 0) middle_ /= area;
    }
    if (spread > 0) scale_ = std::sqrt(area / spread);
  }

  // Faster when successive directions are near each other.
  DVec3 at(const DVec3& way) {
    const SpherePoint p = to_sphere_point(way);
    const std::uint32_t t = locator_.locate(p, last_);
    if (t == kNone) return DVec3(0);
    last_ = t;
    DVec3 sum(0);
    double weights = 0;
    for (std::uint32_t k = 0; k < 3; ++k) {
      const auto corner = [&](std::uint32_t i) { return map_.sphere.indices[3 * t + i % 3]; };
      const double weight =
          determinant(map_.sphere.points[corner(k + 1)], map_.sphere.points[corner(k + 2)], p);
      sum += weight * place(corner(k));
      weights += weight;
    }
    return scale_ * (sum / weights - middle_);
  }

 private:
  [[nodiscard]] DVec3 place(std::uint32_t vertex) const { return DVec3(map_.positions[vertex]); }

  const SphereMap& map_;
  SphereLocator locator_;
  std::uint32_t last_ = 0;
  DVec3 middle_{0};
  double scale_ = 1;
};

// A shape by the texels of a cube around the sphere.
class CubeTable {
 public:
  explicit CubeTable(const SphereMap& map) : texels_(std::size_t{6} * kCubeSide * kCubeSide) {
    ShapeSampler sampler(map);
    for (std::uint32_t i = 0; i < texels_.size(); ++i) {
      const std::uint32_t face = i / (kCubeSide * kCubeSide);
      const auto coordinate = [](std::uint32_t texel) { return (2.0 * texel + 1) / kCubeSide - 1; };
      DVec3 way(face < 3 ? 1.0 : -1.0);
      const int axis = static_cast<int>(face % 3);
      way[(axis + 1) % 3] = coordinate(i / kCubeSide % kCubeSide);
      way[(axis + 2) % 3] = coordinate(i % kCubeSide);
      texels_[i] = sampler.at(way);
    }
  }

  [[nodiscard]] const DVec3& at(const DVec3& way) const {
    const DVec3 size(std::abs(way.x), std::abs(way.y), std::abs(way.z));
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    const std::uint32_t face = static_cast<std::uint32_t>(axis) + (way[axis] > 0 ? 0 : 3);
    const auto texel = [&](int other) {
      const double x = 0.5 * (way[other] / size[axis] + 1) * kCubeSide;
      return std::min(static_cast<std::uint32_t>(std::max(x, 0.0)), kCubeSide - 1);
    };
    return texels_[(face * kCubeSide + texel((axis + 1) % 3)) * kCubeSide + texel((axis + 2) % 3)];
  }

 private:
  std::vector<DVec3> texels_;
};

Rotation transposed(const Rotation& r) {
  return {DVec3(r[0].x, r[1].x, r[2].x), DVec3(r[0].y, r[1].y, r[2].y),
          DVec3(r[0].z, r[1].z, r[2].z)};
}

std::vector<DVec3> sampled(const SphereMap& map, const std::vector<DVec3>& ways) {
  ShapeSampler sampler(map);
  std::vector<DVec3> places;
  places.reserve(ways.size());
  for (const DVec3& way : ways) places.push_back(sampler.at(way));
  return places;
}

// The sum of the squared distances to the nearest of the others.
double one_sided(const std::vector<DVec3>& places, const std::vector<DVec3>& others) {
  double sum = 0;
  for (const DVec3& place : places) {
    double nearest = 1e300;
    for (const DVec3& other : others) {
      const DVec3 gap = place - other;
      nearest = std::min(nearest, glm::dot(gap, gap));
    }
    sum += nearest;
  }
  return sum;
}

// How the first shape is to be turned to lie on the second one.
Rotation best_turn(const std::vector<DVec3>& places, const std::vector<DVec3>& others) {
  Rotation best = kNoRotation;
  double least_sum = one_sided(places, others) + one_sided(others, places);
  std::vector<DVec3> turned(places.size());
  for (const Rotation& turn : axis_rotations()) {
    for (std::size_t i = 0; i < places.size(); ++i) turned[i] = rotated(turn, places[i]);
    const double sum = kTurnedFactor * (one_sided(turned, others) + one_sided(others, turned));
    if (sum < least_sum) least_sum = sum, best = turn;
  }
  return best;
}

}  // namespace

std::vector<Rotation> axis_rotations() {
  std::vector<Rotation> result;
  const std::array<std::array<int, 3>, 6> orders{
      {{0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {0, 2, 1}, {2, 1, 0}, {1, 0, 2}}};
  for (std::size_t order = 0; order < orders.size(); ++order)
    for (int signs = 0; signs < 8; ++signs) {
      const bool is_even = (signs == 0 || signs == 3 || signs == 5 || signs == 6);
      if (is_even != (order < 3)) continue;
      Rotation rotation{DVec3(0), DVec3(0), DVec3(0)};
      for (int row = 0; row < 3; ++row)
        rotation[row][orders[order][row]] = (signs >> row & 1) != 0 ? -1 : 1;
      result.push_back(rotation);
    }
  return result;
}

Rotation align_features(const SphereMap& a, const SphereMap& b,
                        std::span<const FeaturePoint> features) {
  const auto cost = [&](const Rotation& rotation) {
    double sum = 0;
    for (const FeaturePoint& pair : features) {
      const DVec3 way = direction(a.sphere.points[pair.first]) -
                        rotated(rotation, direction(b.sphere.points[pair.second]));
      sum += glm::dot(way, way);
    }
    return sum;
  };
  return matrix(least(cost).rotation);
}

ShapeAlignment align_shapes(const SphereMap& a, const SphereMap& b) {
  std::vector<DVec3> ways;
  for (std::uint32_t i = 0; i < kDirections; ++i) {  // a spiral of equal areas
    const double z = 1 - (2.0 * i + 1) / kDirections, r = std::sqrt(1 - z * z);
    const glm::dvec2 turn = unit_circle(std::uint64_t{i} * 377 % 610, 610);  // by golden sections
    ways.emplace_back(r * turn.x, r * turn.y, z);
  }
  std::vector<DVec3> places = sampled(a, ways);
  const Rotation turn = best_turn(places, sampled(b, ways));
  for (DVec3& place : places) place = rotated(turn, place);
  const CubeTable table(b);
  const auto cost = [&](const Rotation& rotation) {
    const Rotation back = transposed(rotation);
    double sum = 0;
    for (std::size_t i = 0; i < ways.size(); ++i) {
      const DVec3 gap = places[i] - table.at(rotated(back, ways[i]));
      sum += glm::dot(gap, gap);
    }
    return sum;
  };
  return {matrix(least(cost).rotation), transposed(turn)};
}

Rotation best_axis_turn(std::span<const Vec3> places, std::span<const Vec3> others) {
  const auto middle = [](std::span<const Vec3> points) {
    DVec3 sum(0);
    for (const Vec3& p : points) sum += DVec3(p);
    return sum / static_cast<double>(std::max<std::size_t>(points.size(), 1));
  };
  const DVec3 middle_a = middle(places), middle_b = middle(others);
  // Closest where the sum of products is greatest; the products of all axes give that of any turn.
  std::array<DVec3, 3> products{DVec3(0), DVec3(0), DVec3(0)};
  for (std::size_t i = 0; i < places.size(); ++i)
    for (int row = 0; row < 3; ++row)
      products[row] +=
          (static_cast<double>(places[i][row]) - middle_a[row]) * (DVec3(others[i]) - middle_b);
  const auto closeness = [&](const Rotation& turn) {
    return glm::dot(turn[0], products[0]) + glm::dot(turn[1], products[1]) +
           glm::dot(turn[2], products[2]);
  };
  Rotation best = kNoRotation;
  double greatest = closeness(best) + 0.05 * std::abs(closeness(best));
  for (const Rotation& turn : axis_rotations())
    if (closeness(turn) > greatest) greatest = closeness(turn), best = turn;
  return best;
}

std::vector<SpherePoint> rotated_points(std::span<const SpherePoint> points,
                                        const Rotation& rotation) {
  std::vector<SpherePoint> result;
  result.reserve(points.size());
  for (const SpherePoint& p : points)
    result.push_back(to_sphere_point(rotated(rotation, direction(p))));
  return result;
}

}  // namespace varifold
