#include <varifold/simplify/pose_deviation.h>

#include <varifold/simplify/closest_on_triangle.h>
#include <algorithm>
#include <cmath>
#include <limits>

namespace varifold {

ShapeTable::ShapeTable(const DetailedMesh& detailed) {
  const std::vector<std::span<const Vec3>> shapes = detailed.shapes();
  count_ = shapes.size();
  places_.reserve(count_ * detailed.mesh.vertex_count());
  for (std::uint32_t v = 0; v < detailed.mesh.vertex_count(); ++v)
    for (const auto& shape : shapes) places_.push_back(shape[v]);
}

NearestInShapes::CornerPlaces NearestInShapes::places(std::size_t number) const {
  const std::uint32_t* v = &corners_[3 * std::size_t{(*triangles_)[number].triangle}];
  return {shapes_.of(v[0]), shapes_.of(v[1]), shapes_.of(v[2])};
}

// Squared; not below `enough`, from where on the triangle does not matter.
float NearestInShapes::greatest_distance(std::span<const Vec3> at, const CornerPlaces& corners,
                                         float enough) const {
  float greatest = 0;
  for (std::size_t i = 0; i < at.size() && greatest < enough; ++i) {
    const Vec3 p = at[i];
    const Vec3 way =
        closest_on_triangle(corners.a[i] - p, corners.b[i] - p, corners.c[i] - p).position;
    greatest = std::max(greatest, glm::dot(way, way));
  }
  return greatest;
}

float NearestInShapes::bound_of(std::span<const Vec3> at, const CornerPlaces& corners) {
  const std::size_t count = at.size();
  for (std::size_t i = 0; i < count; ++i) {
    const Vec3 p = at[i];
    const TrianglePoint nearest =
        closest_on_triangle(corners.a[i] - p, corners.b[i] - p, corners.c[i] - p);
    weights_[i] = {nearest.along_b, nearest.along_c};
  }
  float greatest = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const Vec3 a = corners.a[i], ab = corners.b[i] - a, ac = corners.c[i] - a, p = at[i];
    for (std::size_t j = 0; j <= i; ++j) {
      const Vec3 aj = corners.a[j], abj = corners.b[j] - aj, acj = corners.c[j] - aj;
      const Vec3 way = a - p + weights_[j].x * ab + weights_[j].y * ac + (aj - at[j]) +
                       weights_[i].x * abj + weights_[i].y * acj;
      greatest = std::max(greatest, glm::dot(way, way));
    }
  }
  return 0.5f * std::sqrt(greatest);
}

std::size_t NearestInShapes::find(std::uint32_t vertex) {
  const std::span<const Vec3> at = shapes_.of(vertex);
  std::size_t best = 0;
  float least = std::numeric_limits<float>::infinity();
  for (std::size_t i = 0; i < triangles_->size(); ++i) {
    const float distance = greatest_distance(at, places(i), least);
    if (!(distance < least)) continue;
    least = distance;
    best = i;
  }
  bound_ = bound_of(at, places(best));
  return best;
}

}  // namespace varifold
