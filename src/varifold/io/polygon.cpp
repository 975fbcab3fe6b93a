// Based on: [Meisters1975] every simple polygon has two ears; Newell's method for the plane.
#include <varifold/io/polygon.h>

#include <varifold/io/import_check.h>
#include <cmath>

namespace varifold {
namespace {

/// Twice the vector area of the polygon, whatever its shape.
DVec3 newell_normal(std::span<const DVec3> corners) {
  DVec3 normal(0);
  for (std::size_t i = 0; i < corners.size(); ++i)
    normal += glm::cross(corners[i] - corners[0],
                         corners[i + 1 == corners.size() ? 0 : i + 1] - corners[0]);
  return normal;
}

struct Point {
  double x, y;
};

/// Twice the signed area of a triangle: positive when counter-clockwise.
double turn(const Point& a, const Point& b, const Point& c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

/// Drops the coordinate in which the normal is longest, keeping the polygon counter-clockwise.
std::vector<Point> project(std::span<const DVec3> corners, const DVec3& normal) {
  const DVec3 size = glm::abs(normal);
  const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
  const int u = (axis + 1) % 3;
  const int v = (axis + 2) % 3;
  const double sign = normal[axis] < 0 ? -1 : 1;
  std::vector<Point> points;
  points.reserve(corners.size());
  for (const DVec3& corner : corners) points.push_back({sign * corner[u], corner[v]});
  return points;
}

bool fan_is_good(std::span<const Point> points) {
  for (std::size_t i = 1; i + 1 < points.size(); ++i)
    if (!(turn(points[0], points[i], points[i + 1]) > 0)) return false;
  return true;
}

/// Cuts ears off a ring of points until a triangle is left.
class EarCutter {
 public:
  /// `budget` is the number of tests of a point against a triangle that may still be made.
  EarCutter(std::span<const Point> points, std::size_t& budget)
      : points_(points), budget_(&budget) {
    const auto count = static_cast<std::uint32_t>(points.size());
    for (std::uint32_t i = 0; i < count; ++i) {
      next_.push_back(i + 1 == count ? 0 : i + 1);
      previous_.push_back(i == 0 ? count - 1 : i - 1);
    }
  }

  /// Three corners per triangle; empty where no ear is left although corners are.
  std::vector<std::uint32_t> cut() {
    std::vector<std::uint32_t> triangles;
    std::size_t left = points_.size();
    std::size_t misses = 0;
    std::uint32_t ear = 0;
    while (left > 3) {
      if (!is_ear(ear)) {
        if (++misses > left || *budget_ == 0) return {};
        ear = next_[ear];
        continue;
      }
      triangles.insert(triangles.end(), {previous_[ear], ear, next_[ear]});
      next_[previous_[ear]] = next_[ear];
      previous_[next_[ear]] = previous_[ear];
      // Skipping a corner spreads the cuts around the ring, which avoids needles.
      ear = next_[next_[ear]];
      --left;
      misses = 0;
    }
    triangles.insert(triangles.end(), {previous_[ear], ear, next_[ear]});
    return triangles;
  }

 private:
  [[nodiscard]] bool is_ear(std::uint32_t corner) {
    const Point& a = points_[previous_[corner]];
    const Point& b = points_[corner];
    const Point& c = points_[next_[corner]];
    if (!(turn(a, b, c) > 0)) return false;
    for (std::uint32_t i = next_[next_[corner]]; i != previous_[corner]; i = next_[i]) {
      if (*budget_ == 0 || blocks(a, b, c, points_[i])) return false;
      --*budget_;
    }
    return true;
  }
  /// Whether p lies in the triangle; its corners themselves, met again by a polygon that touches
  /// itself, do not block.
  static bool blocks(const Point& a, const Point& b, const Point& c, const Point& p) {
    if (turn(a, b, p) < 0 || turn(b, c, p) < 0 || turn(c, a, p) < 0) return false;
    const auto same = [&](const Point& q) { return p.x == q.x && p.y == q.y; };
    return !same(a) && !same(b) && !same(c);
  }

  std::span<const Point> points_;
  std::size_t* budget_;
  std::vector<std::uint32_t> next_;
  std::vector<std::uint32_t> previous_;
};

}  // namespace

void PolygonCollector::add(std::span<const std::uint32_t> corners) {
  const std::size_t first = mesh_->indices.size();
  for (std::size_t i = 1; i + 1 < corners.size(); ++i)
    mesh_->indices.insert(mesh_->indices.end(), {corners[0], corners[i], corners[i + 1]});
  if (corners.size() > 3) fans_.push_back({first, static_cast<std::uint32_t>(corners.size() - 2)});
}

void PolygonCollector::cut_concave() {
  std::vector<std::uint32_t> ids;
  std::vector<DVec3> corners;
  // Enough for any polygon of some thousands of corners, yet no file can make this take minutes.
  std::size_t budget = (std::size_t{1} << 26) + 64 * mesh_->indices.size();
  for (const Fan& fan : fans_) {
    // A fan tells its polygon: the hub, the first rim corner, then one corner per triangle.
    std::uint32_t* const triangles = mesh_->indices.data() + fan.first_index;
    ids = {triangles[0], triangles[1]};
    for (std::uint32_t t = 0; t < fan.triangles; ++t) ids.push_back(triangles[3 * t + 2]);
    corners.clear();
    for (const std::uint32_t id : ids) corners.emplace_back(mesh_->positions[id]);

    const std::vector<Point> points = project(corners, newell_normal(corners));
    if (fan_is_good(points)) continue;
    const std::vector<std::uint32_t> cut = EarCutter(points, budget).cut();
    if (cut.empty()) ++uncut_;
    for (std::size_t i = 0; i < cut.size(); ++i) triangles[i] = ids[cut[i]];
  }
}

void PolygonCollector::warn(ImportedMesh& imported) const {
  warn_count(imported, fans_.size(), "polygons with more than 3 corners were cut into triangles");
  warn_count(imported, uncut_,
             "of these polygons cross themselves or are too intricate, and were cut as fans");
  warn_count(imported, dropped_, "polygons with fewer than 3 corners were dropped");
}

}  // namespace varifold
