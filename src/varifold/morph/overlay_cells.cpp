#include <varifold/morph/overlay.h>
#include <cassert>

namespace varifold {
namespace {

// One of the two maps: every half-edge is cut into darts by the crossings on it.
struct DartRows {
  const SphereTriangulation& map;
  std::vector<std::uint32_t> first;  ///< per half-edge its first dart

  DartRows(const SphereTriangulation& triangulation,
           const std::vector<std::uint32_t>& first_on_edge, std::uint32_t first_dart)
      : map(triangulation) {
    first.reserve(map.indices.size() + 1);
    first.push_back(first_dart);
    for (std::uint32_t h = 0; h < map.indices.size(); ++h) {
      const std::uint32_t edge = map.edge_of[h];
      first.push_back(first.back() + first_on_edge[edge + 1] - first_on_edge[edge] + 1);
    }
  }
  // The dart of a half-edge that begins at the crossing `place` of its edge.
  [[nodiscard]] std::uint32_t dart_after(std::uint32_t half_edge, std::uint32_t place) const {
    return map.is_first(half_edge) ? first[half_edge] + place + 1
                                   : first[half_edge + 1] - 1 - place;
  }
};

class CellTracer {
 public:
  CellTracer(const SphereTriangulation& a, const SphereTriangulation& b, const Crossings& crossings)
      : a_(a),
        b_(b),
        crossings_(crossings),
        darts_a_(a, crossings.first_on_a, 0),
        darts_b_(b, crossings.first_on_b, darts_a_.first.back()),
        next_(darts_b_.first.back()),
        end_(darts_b_.first.back()),
        owner_(darts_b_.first.back()) {}

  OverlayCells run() {
    link_along(darts_a_, 0);
    link_along(darts_b_, static_cast<std::uint32_t>(a_.points.size()));
    for (std::uint32_t x = 0; x < crossings_.crossings.size(); ++x) link_crossing(x);
    std::vector<bool> is_traced(next_.size(), false);
    if (crossings_.shared.of_discs()) join_discs(is_traced);
    OverlayCells cells;
    cells.first_node.push_back(0);
    for (std::uint32_t dart = 0; dart < next_.size(); ++dart)
      if (!is_traced[dart]) trace(dart, is_traced, cells);
    return cells;
  }

 private:
  // Ends that are vertices: on to the next half-edge of the triangle.
  void link_along(const DartRows& rows, std::uint32_t first_vertex) {
    for (std::uint32_t h = 0; h < rows.map.indices.size(); ++h) {
      for (std::uint32_t dart = rows.first[h]; dart < rows.first[h + 1]; ++dart) owner_[dart] = h;
      const std::uint32_t last = rows.first[h + 1] - 1;
      next_[last] = rows.first[next_half_edge(h)];
      end_[last] = first_vertex + rows.map.to(h);
    }
  }

  // Ends that are crossings: on to the half-edge of the other map that goes to the left.
  void link_crossing(std::uint32_t x) {
    const Crossing& crossing = crossings_.crossings[x];
    const std::uint32_t half_a = a_.edge_half[crossing.edge_a];
    const std::uint32_t half_b = b_.edge_half[crossing.edge_b];
    const std::uint32_t twin_a = a_.opposite[half_a], twin_b = b_.opposite[half_b];
    const std::uint32_t left_of_b = crossing.is_a_from_right ? half_a : twin_a;
    const std::uint32_t right_of_b = crossing.is_a_from_right ? twin_a : half_a;
    const std::uint32_t node = static_cast<std::uint32_t>(a_.points.size() + b_.points.size()) + x;
    const auto link = [&](const DartRows& in, std::uint32_t half_in, std::uint32_t place_in,
                          const DartRows& out, std::uint32_t half_out, std::uint32_t place_out) {
      const std::uint32_t dart = in.dart_after(half_in, place_in) - 1;
      next_[dart] = out.dart_after(half_out, place_out);
      end_[dart] = node;
    };
    const std::uint32_t in_a = crossing.place_a, in_b = crossing.place_b;
    link(darts_b_, half_b, in_b, darts_a_, left_of_b, in_a);
    link(darts_b_, twin_b, in_b, darts_a_, right_of_b, in_a);
    link(darts_a_, left_of_b, in_a, darts_b_, twin_b, in_b);
    link(darts_a_, right_of_b, in_a, darts_b_, half_b, in_b);
  }

  // Half-edges of the triangles that close a disc below have no cells.
  static bool is_below(const SphereTriangulation& map, std::uint32_t half_edge) {
    const std::uint32_t first = half_edge / 3 * 3;
    return map.points[map.indices[first]].z < 0 || map.points[map.indices[first + 1]].z < 0 ||
           map.points[map.indices[first + 2]].z < 0;
  }

  // The half-edges from every vertex of a boundary into the disc, counter-clockwise; with those
  // along the boundary at both ends.
  static std::vector<std::uint32_t> spokes_from(const SphereTriangulation& map,
                                                std::uint32_t half_edge) {
    std::vector<std::uint32_t> spokes{half_edge};
    while (!is_below(map, spokes.back()))
      spokes.push_back(map.opposite[next_half_edge(next_half_edge(spokes.back()))]);
    return spokes;
  }

  // Boundaries of both are one: that of a stays. Around its vertices the spokes of both are in one
  // order.
  void join_discs(std::vector<bool>& is_traced) {
    const std::vector<std::uint32_t>& in_a = crossings_.shared.in_a;
    std::vector<std::uint32_t> first_spoke_b(b_.points.size(), kNone);
    const auto skip = [&](const DartRows& rows, std::uint32_t half_edge) {
      for (std::uint32_t d = rows.first[half_edge]; d < rows.first[half_edge + 1]; ++d)
        is_traced[d] = true;
    };
    for (std::uint32_t h = 0; h < b_.indices.size(); ++h) {
      const std::uint32_t last = darts_b_.first[h + 1] - 1;
      if (in_a[b_.to(h)] != kNone) end_[last] = in_a[b_.to(h)];
      if (is_below(b_, h) || is_below(b_, b_.opposite[h])) skip(darts_b_, h);
      if (!is_below(b_, h) && is_below(b_, b_.opposite[h])) first_spoke_b[b_.from(h)] = h;
    }
    for (std::uint32_t h = 0; h < a_.indices.size(); ++h) {
      if (is_below(a_, h)) skip(darts_a_, h);
      if (!is_below(a_, h) && is_below(a_, a_.opposite[h]))
        link_around(h, first_spoke_b[crossings_.shared.in_b[a_.from(h)]]);
    }
  }

  // Around a vertex of the boundary: what comes along a spoke goes on along the one before it.
  void link_around(std::uint32_t first_a, std::uint32_t first_b) {
    const std::vector<std::uint32_t> of_a = spokes_from(a_, first_a),
                                     of_b = spokes_from(b_, first_b);
    const SpherePoint& center = a_.points[a_.from(first_a)];
    std::uint32_t before = darts_a_.first[first_a];
    std::size_t next_a = 1, next_b = 1;
    while (next_a < of_a.size()) {
      const bool is_b =
          next_b + 1 < of_b.size() &&
          orientation(center, b_.points[b_.to(of_b[next_b])], a_.points[a_.to(of_a[next_a])]) > 0;
      const DartRows& rows = is_b ? darts_b_ : darts_a_;
      const std::uint32_t spoke = is_b ? of_b[next_b++] : of_a[next_a++];
      next_[rows.first[rows.map.opposite[spoke] + 1] - 1] = before;
      before = rows.first[spoke];
    }
  }

  void trace(std::uint32_t first, std::vector<bool>& is_traced, OverlayCells& cells) const {
    std::uint32_t triangle_a = kNone, triangle_b = kNone;
    const auto vertices_a = static_cast<std::uint32_t>(a_.points.size());
    const auto vertices = vertices_a + static_cast<std::uint32_t>(b_.points.size());
    std::uint32_t dart = first;
    do {
      is_traced[dart] = true;
      (dart < darts_a_.first.back() ? triangle_a : triangle_b) = owner_[dart] / 3;
      cells.nodes.push_back(end_[dart]);
      dart = next_[dart];
    } while (dart != first);
    // A cell without edges of one map lies within one of its triangles, with all its vertices; of
    // these one at least is not shared.
    for (std::size_t i = cells.first_node.back();
         i < cells.nodes.size() && (triangle_a == kNone || triangle_b == kNone); ++i) {
      const std::uint32_t node = cells.nodes[i];
      if (triangle_a == kNone && node >= vertices_a && node < vertices)
        triangle_a = crossings_.triangle_in_a[node - vertices_a];
      if (triangle_b == kNone && node < vertices_a && !is_shared(node))
        triangle_b = crossings_.triangle_in_b[node];
    }
    assert(triangle_a != kNone && triangle_b != kNone);
    cells.triangle_a.push_back(triangle_a);
    cells.triangle_b.push_back(triangle_b);
    cells.first_node.push_back(static_cast<std::uint32_t>(cells.nodes.size()));
  }

  [[nodiscard]] bool is_shared(std::uint32_t vertex_of_a) const {
    return crossings_.shared.of_discs() && crossings_.shared.in_b[vertex_of_a] != kNone;
  }

  const SphereTriangulation &a_, &b_;
  const Crossings& crossings_;
  DartRows darts_a_, darts_b_;
  std::vector<std::uint32_t> next_, end_, owner_;
};

}  // namespace

OverlayCells trace_cells(const SphereTriangulation& a, const SphereTriangulation& b,
                         const Crossings& crossings) {
  return CellTracer(a, b, crossings).run();
}

}  // namespace varifold
