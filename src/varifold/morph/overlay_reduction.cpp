#include <varifold/morph/overlay_reduction.h>
#include <varifold/morph/overlay_star.h>
#include <varifold/simplify/closest_on_triangle.h>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

namespace varifold {
namespace {

// Edges shorter than this part of the diagonal on both shapes are none.
constexpr float kNothing = 5e-7f;
// Parts of the tolerance that the passes allow one after the other.
constexpr std::array<float, 7> kPasses{0.01f, 0.1f, 0.3f, 0.6f, 1.0f, 1.0f, 1.0f};
constexpr float kLeastCosine = 0.2588f;  // of the turn of a triangle: 75 degrees
constexpr float kLeastShape = 2e-3f;     // below it is a needle, which may only get better
constexpr float kTrustedShape = 1e-3f;   // needles below this have no normal to speak of
// New edges are looked at in thirds. Between them and the old surface the gap grows up to where
// they cross an edge of that, and shrinks again: at one of the thirds it is at least this part.
// Squared.
constexpr float kBetween = 1.5f * 1.5f;
constexpr std::size_t kLargestStar = 40;
constexpr std::uint32_t kProgressEvery = 1u << 16;

float shape_of(const Vec3& normal, const Vec3& u, const Vec3& v) {
  const float longest = std::max({glm::dot(u, u), glm::dot(v, v), glm::dot(u - v, u - v)});
  return longest > 0 ? glm::length(normal) / longest : 0.0f;
}

// The square of the distance from the origin.
float distance2(const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 nearest = closest_on_triangle(a, b, c).position;
  return glm::dot(nearest, nearest);
}

// One of the two shapes and what its surface has gone through.
struct Shape {
  std::vector<Vec3> positions;  // per point
  std::vector<float> merged;    // per point: how far away what was merged into it may be
  std::vector<float> error;     // per triangle: how far it and what it stands for may be apart
  float tolerance = 0;
  float nothing = 0;  // an edge of this length has none
};

class OverlayReduction {
 public:
  OverlayReduction(const OverlayTriangles& overlay, const ReductionOptions& options)
      : stars_(overlay), options_(options), point_count_(overlay.point_count) {
    for (int s = 0; s < 2; ++s) {
      Shape& shape = shapes_[s];
      const auto& from = s == 0 ? overlay.mesh.positions : overlay.mesh.poses[0].positions;
      shape.positions.resize(point_count_);
      shape.merged.resize(point_count_, 0);
      shape.error.resize(overlay.mesh.triangle_count(), 0);
      Box box;
      for (std::size_t v = 0; v < from.size(); ++v) {
        shape.positions[overlay.point_of_vertex[v]] = from[v];
        box.add(from[v]);
      }
      shape.tolerance = static_cast<float>(options.tolerance) * box.diagonal();
      shape.nothing = kNothing * box.diagonal();
    }
  }

  ReductionReport run() {
    ReductionReport report;
    // A merge may make another one legal.
    for (std::uint32_t merged = 1; merged > 0; report.merged_points += merged) merged = merge_all();
    if (options_.tolerance <= 0) return report;
    std::uint32_t done = 0;
    for (const float part : kPasses) {
      const std::uint32_t before = stars_.live_count();
      for (std::uint32_t i = 0; i < point_count_; ++i, ++done) {
        if (done % kProgressEvery == 0 && options_.progress &&
            !options_.progress(static_cast<float>(done) /
                               (static_cast<float>(point_count_) * kPasses.size())))
          return report;
        // Crossings have the highest numbers, and are there for no shape's sake.
        reduce_at(point_count_ - 1 - i, part);
      }
      report.removed_points += before - stars_.live_count();
    }
    return report;
  }

  const OverlayStars& stars() const { return stars_; }

 private:
  std::uint32_t merge_all() {
    std::uint32_t merged = 0;
    for (std::uint32_t point = point_count_; point-- > 0;) {
      (void)stars_.gather(point);
      for (const std::uint32_t target : stars_.targets()) {
        if (!is_nothing(shapes_[0], point, target) || !is_nothing(shapes_[1], point, target) ||
            !stars_.can_collapse(point, target))
          continue;
        for (Shape& shape : shapes_) shape.merged[target] = merged_after(shape, point, target);
        stars_.collapse(point, target);
        ++merged;
        break;
      }
    }
    return merged;
  }

  static bool is_nothing(const Shape& shape, std::uint32_t p, std::uint32_t q) {
    const Vec3 way = shape.positions[p] - shape.positions[q];
    return glm::dot(way, way) <= shape.nothing * shape.nothing &&
           merged_after(shape, p, q) <= 2 * shape.nothing;
  }

  // How far what a point stands for is from it, after another one has gone onto it: many short
  // steps must not make a long one.
  static float merged_after(const Shape& shape, std::uint32_t point, std::uint32_t target) {
    return std::max(
        shape.merged[target],
        shape.merged[point] + glm::distance(shape.positions[point], shape.positions[target]));
  }

  void reduce_at(std::uint32_t point, float part) {
    const auto star = stars_.gather(point);
    const OverlayStars::Rim& rim = stars_.rim();
    if ((!rim && star.size() < 3) || star.empty() || star.size() > kLargestStar) return;
    for (int s = 0; s < 2; ++s) old_[s] = look_at(shapes_[s], point, star);
    std::uint32_t best = kNone;
    float best_shape = -1;
    std::array<float, 2> best_error{0, 0}, best_of_rim{0, 0};
    for (const std::uint32_t target : stars_.targets()) {
      std::array<float, 2> error{0, 0}, of_rim{0, 0};
      float shape = 1;
      bool is_legal = true;
      for (int s = 0; s < 2 && is_legal; ++s) {
        const float worst = worst_shape(s, point, target, star);
        is_legal = worst >= 0;
        shape = std::min(shape, worst);
        if (!is_legal || shape <= best_shape) break;
        if (rim) of_rim[s] = rim_error_after(s, point, rim);
        error[s] = std::max(of_rim[s], error_after(s, point, target, star, part));
        is_legal = error[s] <= part * shapes_[s].tolerance;
      }
      if (!is_legal || shape <= best_shape || !stars_.can_collapse(point, target)) continue;
      best = target, best_shape = shape, best_error = error, best_of_rim = of_rim;
    }
    if (best == kNone) return;
    for (int s = 0; s < 2; ++s) {
      for (const auto& spoke : star) shapes_[s].error[spoke.corner / 3] = best_error[s];
      if (rim)
        for (const std::uint32_t triangle : rim.triangles)
          shapes_[s].error[triangle] = best_of_rim[s];
    }
    // An ear leaves no triangle: what it has gone through belongs to the one behind it.
    const bool is_ear = rim && star.size() == 1;
    const std::uint32_t other = rim.points[rim.points[0] == best ? 1 : 0];
    stars_.collapse(point, best);
    if (!is_ear) return;
    for (const auto& spoke : stars_.gather(best))
      for (int s = 0; s < 2 && (spoke.a == other || spoke.b == other); ++s) {
        float& error = shapes_[s].error[spoke.corner / 3];
        error = std::max(error, best_error[s]);
      }
  }

  // What a star looks like before.
  struct OldStar {
    Vec3 normal{0};  // area-weighted, of all of it
    float worst_shape = 1;
  };
  using Star = std::span<const OverlayStars::Spoke>;

  static OldStar look_at(const Shape& shape, std::uint32_t point, Star star) {
    OldStar old;
    const Vec3& center = shape.positions[point];
    for (const auto& spoke : star) {
      const Vec3 u = shape.positions[spoke.a] - center, v = shape.positions[spoke.b] - center;
      const Vec3 normal = glm::cross(u, v);
      old.normal += normal;
      old.worst_shape = std::min(old.worst_shape, shape_of(normal, u, v));
    }
    return old;
  }

  // Of the triangles after the collapse; below 0 where one turns too far or is too bad.
  [[nodiscard]] float worst_shape(int s, std::uint32_t point, std::uint32_t target,
                                  Star star) const {
    const Shape& shape = shapes_[s];
    const float floor = std::min(kLeastShape, old_[s].worst_shape);
    const Vec3 &center = shape.positions[point], &apex = shape.positions[target];
    float worst = 1;
    for (const auto& spoke : star) {
      if (spoke.a == target || spoke.b == target) continue;
      const Vec3 &a = shape.positions[spoke.a], &b = shape.positions[spoke.b];
      const Vec3 u = a - apex, v = b - apex, normal = glm::cross(u, v);
      const float quality = shape_of(normal, u, v);
      if (!(quality >= floor)) return -1;
      worst = std::min(worst, quality);
      const Vec3 old_u = a - center, old_v = b - center, old = glm::cross(old_u, old_v);
      const bool has_normal = shape_of(old, old_u, old_v) > kTrustedShape;
      const Vec3& reference = has_normal ? old : old_[s].normal;
      const float cosine = has_normal ? kLeastCosine : 0.0f;
      if (quality > kTrustedShape &&
          !(glm::dot(normal, reference) > cosine * glm::length(normal) * glm::length(reference)))
        return -1;
    }
    return worst;
  }

  // The square of the distance from a point of the boundary to the edge that takes its place.
  [[nodiscard]] float to_new_rim(int s, std::uint32_t point, const OverlayStars::Rim& rim) const {
    const auto& positions = shapes_[s].positions;
    const Vec3 &p = positions[rim.points[0]], &q = positions[rim.points[1]];
    return distance2(p - positions[point], q - positions[point], q - positions[point]);
  }

  // How far the boundary may be from that of the input after its collapse along itself; the
  // triangles of the fan keep that.
  [[nodiscard]] float rim_error_after(int s, std::uint32_t point,
                                      const OverlayStars::Rim& rim) const {
    const std::vector<float>& error = shapes_[s].error;
    return std::max(error[rim.triangles[0]], error[rim.triangles[1]]) +
           std::sqrt(to_new_rim(s, point, rim));
  }

  // How far the surface around may be from the input after the collapse; infinite as soon as it is
  // too much. Judged where surfaces part most: at the point that goes, and along new edges.
  [[nodiscard]] float error_after(int s, std::uint32_t point, std::uint32_t target, Star star,
                                  float part) const {
    constexpr float kTooMuch = std::numeric_limits<float>::infinity();
    const Shape& shape = shapes_[s];
    float inherited = 0;
    for (const auto& spoke : star) inherited = std::max(inherited, shape.error[spoke.corner / 3]);

    const float left = part * shape.tolerance - inherited;
    if (left < 0) return kTooMuch;
    const Vec3 &center = shape.positions[point], &apex = shape.positions[target];
    float nearest = glm::dot(apex - center, apex - center);
    if (const OverlayStars::Rim& rim = stars_.rim())
      nearest = std::min(nearest, to_new_rim(s, point, rim));
    for (const auto& spoke : star)
      if (spoke.a != target && spoke.b != target)
        nearest = std::min(nearest, distance2(apex - center, shape.positions[spoke.a] - center,
                                              shape.positions[spoke.b] - center));
    float farthest = nearest;
    if (farthest > left * left) return kTooMuch;
    for (const auto& spoke : star) {
      // New edges are those to the points that were no neighbours of the target: each follows the
      // point that goes in one triangle, and precedes it in another without the target, too.
      if (spoke.a == target || is_beside(spoke.a, target, star)) continue;
      for (const float along : {1 / 3.0f, 2 / 3.0f}) {
        const Vec3 place = apex + along * (shape.positions[spoke.a] - apex);
        float gap = kTooMuch;
        for (const auto& other : star) {
          if (kBetween * gap <= farthest) break;
          gap = std::min(gap, distance2(center - place, shape.positions[other.a] - place,
                                        shape.positions[other.b] - place));
        }
        farthest = std::max(farthest, kBetween * gap);
        if (farthest > left * left) return kTooMuch;
      }
    }
    widen_by_old_edges(shape, center, target, star, left * left, farthest);
    return farthest > left * left ? kTooMuch : inherited + std::sqrt(farthest);
  }

  // Raises `farthest` to how far the edges that go are from the new star, squared; ends where that
  // is more than enough. On a sharp ridge new edges can be near both sides and cut it off between
  // its ends.
  static void widen_by_old_edges(const Shape& shape, const Vec3& center, std::uint32_t target,
                                 Star star, float enough, float& farthest) {
    const Vec3& apex = shape.positions[target];
    for (const auto& spoke : star) {
      if (spoke.a == target) continue;
      for (const float along : {1 / 3.0f, 2 / 3.0f}) {
        const Vec3 place = center + along * (shape.positions[spoke.a] - center);
        float gap = star.size() > 1 ? std::numeric_limits<float>::infinity() : 0.0f;
        for (const auto& other : star) {
          if (gap <= farthest) break;
          if (other.a != target && other.b != target)
            gap = std::min(gap, distance2(apex - place, shape.positions[other.a] - place,
                                          shape.positions[other.b] - place));
        }
        farthest = std::max(farthest, gap);
        if (farthest > enough) return;
      }
    }
  }

  // Whether a triangle of the star holds both.
  static bool is_beside(std::uint32_t a, std::uint32_t target, Star star) {
    for (const auto& spoke : star)
      if ((spoke.a == a && spoke.b == target) || (spoke.a == target && spoke.b == a)) return true;
    return false;
  }

  OverlayStars stars_;
  const ReductionOptions& options_;
  std::uint32_t point_count_;
  std::array<Shape, 2> shapes_;
  std::array<OldStar, 2> old_;
};

}  // namespace

ReductionReport reduce_overlay(OverlayTriangles& overlay, const ReductionOptions& options) {
  OverlayReduction reduction(overlay, options);
  const ReductionReport report = reduction.run();
  TriangleMesh& mesh = overlay.mesh;
  const std::vector<std::uint32_t> materials = triangle_materials(mesh);
  std::vector<std::uint32_t> vertices, triangles;
  reduction.stars().write(vertices, triangles);
  if (!mesh.ranges.empty()) {
    std::vector<std::uint32_t> left;
    left.reserve(triangles.size());
    for (const std::uint32_t triangle : triangles) left.push_back(materials[triangle]);
    mesh.indices = std::move(vertices);
    set_triangle_materials(mesh, left);
  } else {
    mesh.indices = std::move(vertices);
  }
  mesh = without_unused_vertices(mesh);
  overlay.point_of_vertex.clear();
  return report;
}

}  // namespace varifold
