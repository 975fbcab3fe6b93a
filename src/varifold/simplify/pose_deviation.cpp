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

namespace {

TrianglePoint nearest_point(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
  return closest_on_triangle(a - p, b - p, c - p);
}

}  // namespace

std::size_t NearestInShapes::find(std::span<const Vec3> at) {
  std::size_t best = 0;
  float least = std::numeric_limits<float>::infinity();
  for (std::size_t number = 0; number < triangles_->size(); ++number) {
    const CornerPlaces corners = places(number);
    float greatest = 0;
    for (std::size_t i = 0; i < at.size() && greatest < least; ++i) {
      const Vec3 way = nearest_point(at[i], corners.a[i], corners.b[i], corners.c[i]).position;
      greatest = std::max(greatest, glm::dot(way, way));
    }
    if (!(greatest < least)) continue;
    least = greatest;
    best = number;
  }
  found_ = places(best);
  for (std::size_t i = 0; i < at.size(); ++i) {
    const TrianglePoint nearest = nearest_point(at[i], found_.a[i], found_.b[i], found_.c[i]);
    weights_[i] = {nearest.along_b, nearest.along_c};
  }
  return best;
}

float NearestInShapes::greatest_way(std::span<const Vec3> at) const {
  float greatest = 0;
  for_each_way(at, [&](const Vec3& way) { greatest = std::max(greatest, glm::dot(way, way)); });
  return std::sqrt(greatest);
}

}  // namespace varifold
