#include <varifold/partition/border_stretches.h>

#include <varifold/partition/vertex_fans.h>
#include <array>

namespace varifold {

namespace {

// The border edges at a point on a border.
struct BorderPoint {
  std::uint32_t point = 0;
  std::uint32_t degree = 0;
  bool is_fixed = false;
  std::array<std::uint32_t, 2> edges{};  // the first two

  [[nodiscard]] bool is_corner() const { return is_fixed || degree != 2; }
};

struct BorderGraph {
  std::vector<BorderPoint> points;
  std::vector<std::uint32_t> half_edges;           // one per border edge
  std::vector<std::array<std::uint32_t, 2>> ends;  // per edge, indices of `points`
};

// Lists border edges and their points; index_of, kInside or kFixed before, becomes the index of a
// point in the list.
BorderGraph border_graph(const SurfaceView& surface, const EdgeLinks& links,
                         std::span<const std::uint32_t> patch_of,
                         LargeVector<std::uint32_t>& index_of) {
  BorderGraph graph;
  const auto point_at = [&](std::uint32_t point) -> BorderPoint& {
    std::uint32_t& index = index_of[point];
    if (index >= PointUse::kFixed) {
      index = static_cast<std::uint32_t>(graph.points.size());
      graph.points.push_back({point});
    }
    return graph.points[index];
  };
  for (std::uint32_t h = 0; h < surface.corners.size(); ++h) {
    const std::uint32_t g = links.across_in_material(h);
    if (g != kNone && (g > h || patch_of[g / 3] == patch_of[h / 3])) continue;
    const std::uint32_t ends[2] = {surface.corners[h], surface.corners[next_in_triangle(h)]};
    if (g == kNone) {
      for (const std::uint32_t end : ends) point_at(end).is_fixed = true;
      continue;
    }
    const auto edge = static_cast<std::uint32_t>(graph.half_edges.size());
    graph.half_edges.push_back(h);
    for (const std::uint32_t end : ends) {
      BorderPoint& point = point_at(end);
      if (point.degree < 2) point.edges[point.degree] = edge;
      ++point.degree;
    }
    graph.ends.push_back({index_of[ends[0]], index_of[ends[1]]});
  }
  return graph;
}

}  // namespace

bool is_closed_fan(const SurfaceView& surface, const EdgeLinks& links, std::uint32_t spoke,
                   std::uint32_t triangles) {
  const std::uint32_t point = surface.corners[spoke];
  std::uint32_t count = 0;
  for (std::uint32_t h = spoke; count <= triangles;) {
    ++count;
    const std::uint32_t g = links.across(h);
    if (g == kNone) return false;
    if (g / 3 == spoke / 3) break;
    h = other_spoke(surface, g, point);
  }
  return count == triangles;
}

BorderStretches find_stretches(const SurfaceView& surface, const EdgeLinks& links,
                               std::span<const std::uint32_t> patch_of) {
  BorderStretches result;
  result.use_of.assign(surface.positions.size(), kNone);
  result.spokes.assign(surface.positions.size(), kNone);
  result.triangles_at.assign(surface.positions.size(), 0);
  for (std::uint32_t h = 0; h < surface.corners.size(); ++h) {
    const std::uint32_t point = surface.corners[h];
    // Of several patches: on a border, or else where fans of triangles touch.
    if (const std::uint32_t spoke = result.spokes[point];
        spoke != kNone && patch_of[spoke / 3] != patch_of[h / 3])
      result.use_of[point] = PointUse::kFixed;
    result.spokes[point] = h;
    ++result.triangles_at[point];
  }
  BorderGraph graph = border_graph(surface, links, patch_of, result.use_of);
  const auto is_sound = [&](std::uint32_t point) {
    return is_closed_fan(surface, links, result.spokes[point], result.triangles_at[point]);
  };
  for (BorderPoint& point : graph.points) {
    if (!point.is_corner() && !is_sound(point.point)) point.is_fixed = true;
    result.use_of[point.point] = PointUse::kFixed;
  }

  // Follow the border from every corner.
  std::vector<std::uint8_t> is_done(graph.half_edges.size());
  for (std::uint32_t first = 0; first < is_done.size(); ++first)
    for (const std::uint32_t corner : graph.ends[first]) {
      if (is_done[first] || !graph.points[corner].is_corner()) continue;
      const std::uint32_t h = graph.half_edges[first];
      Stretch stretch{patch_of[h / 3], patch_of[links.across(h) / 3], {}, {h, h}};
      stretch.path.push_back(graph.points[corner].point);
      std::uint32_t edge = first, at = corner;
      for (;;) {
        is_done[edge] = 1;
        at = graph.ends[edge][0] == at ? graph.ends[edge][1] : graph.ends[edge][0];
        const BorderPoint& point = graph.points[at];
        stretch.path.push_back(point.point);
        stretch.end_spokes[1] = graph.half_edges[edge];
        if (point.is_corner()) break;
        edge = point.edges[0] == edge ? point.edges[1] : point.edges[0];
      }
      if (stretch.path.size() < 3 || stretch.path.front() == stretch.path.back()) continue;
      const auto number = static_cast<std::uint32_t>(result.stretches.size());
      for (std::size_t i = 1; i + 1 < stretch.path.size(); ++i)
        result.use_of[stretch.path[i]] = number;
      result.stretches.push_back(std::move(stretch));
    }
  return result;
}

}  // namespace varifold
