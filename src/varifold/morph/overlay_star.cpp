// Based on: [DeyEdelsbrunnerGuhaNekhayev1999], the link condition for a closed surface.
#include <varifold/morph/overlay_star.h>
#include <algorithm>
#include <array>
#include <iterator>

namespace varifold {
namespace {

std::uint32_t next_corner_of(std::uint32_t corner) {
  return corner % 3 == 2 ? corner - 2 : corner + 1;
}

}  // namespace

OverlayStars::OverlayStars(const OverlayTriangles& overlay)
    : corner_vertex_(overlay.mesh.indices),
      first_corner_(overlay.point_count, kNone),
      next_corner_(overlay.mesh.indices.size()),
      mark_(overlay.point_count, 0),
      pole_(overlay.pole),
      first_of_fan_(overlay.mesh.triangle_count() - overlay.fan_triangles) {
  if (overlay.mesh.ranges.size() > 1) material_of_ = triangle_materials(overlay.mesh);
  // The boundary is the border of a material below.
  if (overlay.fan_triangles > 0) {
    material_of_.resize(first_of_fan_, 0);
    material_of_.resize(overlay.mesh.triangle_count(), kNone);
  }
  corner_point_.reserve(corner_vertex_.size());
  for (const std::uint32_t vertex : corner_vertex_)
    corner_point_.push_back(overlay.point_of_vertex[vertex]);
  for (auto corner = static_cast<std::uint32_t>(corner_point_.size()); corner-- > 0;) {
    std::uint32_t& first = first_corner_[corner_point_[corner]];
    if (first == kNone) ++live_points_;
    next_corner_[corner] = first;
    first = corner;
  }
}

std::span<const OverlayStars::Spoke> OverlayStars::gather(std::uint32_t point) {
  star_.clear();
  targets_.clear();
  rim_ = {};
  if (point == pole_) return {};
  // Triangles that are gone leave the list on the way.
  std::uint32_t* link = &first_corner_[point];
  while (*link != kNone) {
    const std::uint32_t corner = *link;
    if (corner_point_[corner] == kNone) {
      *link = next_corner_[corner];
      continue;
    }
    const std::uint32_t a = next_corner_of(corner), b = next_corner_of(a);
    star_.push_back({corner, corner_point_[a], corner_point_[b]});
    link = &next_corner_[corner];
  }
  // The fan comes last.
  std::ptrdiff_t surface = std::ssize(star_);
  for (std::ptrdiff_t i = 0; pole_ != kNone && i < surface;) {
    const Spoke& spoke = star_[static_cast<std::size_t>(i)];
    if (spoke.a != pole_ && spoke.b != pole_) {
      ++i;
      continue;
    }
    const std::size_t side = spoke.b == pole_ ? 0 : 1;
    rim_.points[side] = side == 0 ? spoke.a : spoke.b;
    rim_.triangles[side] = spoke.corner / 3;
    std::rotate(star_.begin() + i, star_.begin() + i + 1, star_.begin() + surface--);
  }
  if (rim_)
    targets_.assign(rim_.points.begin(), rim_.points.end());
  else
    for (const Spoke& spoke : star_) targets_.push_back(spoke.a);
  return {star_.data(), static_cast<std::size_t>(surface)};
}

std::uint32_t OverlayStars::count_common(std::uint32_t point, std::uint32_t target) {
  ++stamp_;
  for (std::uint32_t corner = first_corner_[target]; corner != kNone;
       corner = next_corner_[corner]) {
    if (corner_point_[corner] == kNone) continue;
    // Every neighbour follows the target in one triangle.
    mark_[corner_point_[next_corner_of(corner)]] = stamp_;
  }
  mark_[point] = 0;
  std::uint32_t common = 0;
  for (const Spoke& spoke : star_) common += mark_[spoke.a] == stamp_;
  return common;
}

std::uint32_t OverlayStars::vertex_at(const Spoke& spoke, std::uint32_t point) const {
  const std::uint32_t a = next_corner_of(spoke.corner);
  return corner_vertex_[spoke.a == point ? a : next_corner_of(a)];
}

std::uint32_t OverlayStars::vertex_after(std::uint32_t vertex, std::uint32_t target) const {
  for (const Spoke& spoke : star_)
    if ((spoke.a == target || spoke.b == target) && corner_vertex_[spoke.corner] == vertex)
      return vertex_at(spoke, target);
  return kNone;
}

bool OverlayStars::materials_agree(std::uint32_t target) const {
  if (material_of_.empty()) return true;
  std::array<std::uint32_t, 2> beside{kNone, kNone};
  for (const Spoke& spoke : star_)
    if (spoke.a == target || spoke.b == target)
      beside[spoke.a == target ? 0 : 1] = material_of_[spoke.corner / 3];
  std::array<std::uint32_t, 2> around = beside;
  for (const Spoke& spoke : star_) {
    const std::uint32_t material = material_of_[spoke.corner / 3];
    if (material != beside[0] && material != beside[1]) return false;
    if (material != around[0]) around[1] = material;
  }
  return around[0] == around[1] || beside[0] != beside[1];
}

bool OverlayStars::can_collapse(std::uint32_t point, std::uint32_t target) {
  if (live_points_ <= 4 || count_common(point, target) != 2 || !materials_agree(target))
    return false;
  for (const Spoke& spoke : star_) {
    if (spoke.a == target || spoke.b == target) {
      // One vertex must not go two ways.
      const std::uint32_t vertex = corner_vertex_[spoke.corner];
      if (vertex_after(vertex, target) != vertex_at(spoke, target)) return false;
    } else if (vertex_after(corner_vertex_[spoke.corner], target) == kNone) {
      return false;
    }
  }
  return true;
}

void OverlayStars::collapse(std::uint32_t point, std::uint32_t target) {
  // All are looked up before any is changed: the star tells by its corners where vertices go.
  moved_.clear();
  for (const Spoke& spoke : star_)
    if (spoke.a != target && spoke.b != target)
      moved_.emplace_back(spoke.corner, vertex_after(corner_vertex_[spoke.corner], target));
  for (const auto& [corner, vertex] : moved_) {
    corner_point_[corner] = target;
    corner_vertex_[corner] = vertex;
  }
  for (const Spoke& spoke : star_) {
    if (corner_point_[spoke.corner] == target) continue;
    const std::uint32_t first = spoke.corner / 3 * 3;
    for (std::uint32_t k = 0; k < 3; ++k) corner_point_[first + k] = kNone;
  }
  // The list of the point, with what is gone at its end, goes before that of the target.
  if (!moved_.empty()) {
    std::uint32_t tail = first_corner_[point];
    while (next_corner_[tail] != kNone) tail = next_corner_[tail];
    next_corner_[tail] = first_corner_[target];
    first_corner_[target] = first_corner_[point];
  }
  first_corner_[point] = kNone;
  --live_points_;
}

void OverlayStars::write(std::vector<std::uint32_t>& vertices,
                         std::vector<std::uint32_t>& triangles) const {
  vertices.clear();
  triangles.clear();
  for (std::uint32_t corner = 0; corner < 3 * first_of_fan_; corner += 3) {
    if (corner_point_[corner] == kNone) continue;
    vertices.insert(vertices.end(), corner_vertex_.begin() + corner,
                    corner_vertex_.begin() + corner + 3);
    triangles.push_back(corner / 3);
  }
}

}  // namespace varifold
