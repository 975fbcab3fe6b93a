// Based on: [KentCarlsonParent1992] for the overlay of two maps onto the sphere by walking along
// edges. Differs: exact signs of whole-numbered directions. Nothing is ever compared along an edge:
// the
//   order of crossings along the edges of a comes from walking those over b.
#include <varifold/base/parallel.h>
#include <varifold/morph/overlay.h>
#include <algorithm>
#include <atomic>
#include <utility>

namespace varifold {
namespace {

constexpr std::size_t kEdgesAtOnce = 1024;

// A way over a map along a great circle.
struct Way {
  SpherePoint start, end;
  std::uint32_t triangle = kNone;     // that the start lies in, if it is no vertex
  std::uint32_t first_spoke = kNone;  // a half-edge from the start, if it is a vertex
  std::uint32_t last_vertex = kNone;  // the end, if it is one
};

bool is_inside(const SphereTriangulation& map, std::uint32_t triangle, const SpherePoint& point) {
  for (std::uint32_t h = 3 * triangle; h < 3 * triangle + 3; ++h)
    if (orientation(map.points[map.from(h)], map.points[map.to(h)], point) <= 0) return false;
  return true;
}

// The half-edge by which a way leaves the first triangle: its beginning is on the right, its end on
// the left. kNone where the way goes through a vertex, or along an edge, at first.
template <class Side>
std::uint32_t first_exit(const SphereTriangulation& map, const Way& way, const Side& side) {
  if (way.first_spoke == kNone) {
    for (std::uint32_t h = 3 * way.triangle; h < 3 * way.triangle + 3; ++h)
      if (side(map.from(h)) < 0 && side(map.to(h)) > 0) return h;
    return kNone;
  }
  // Around a vertex of the boundary; the end lies above the equator, so not in the fan below.
  std::uint32_t spoke = way.first_spoke;
  do {
    const std::uint32_t across = next_half_edge(spoke);
    if (map.points[map.from(across)].z >= 0 && map.points[map.to(across)].z >= 0 &&
        side(map.from(across)) < 0 && side(map.to(across)) > 0)
      return across;
    spoke = map.opposite[next_half_edge(across)];
  } while (spoke != way.first_spoke);
  return kNone;
}

// Gives the half-edges that a way leaves triangles by; false where a sign is zero that matters. On
// the boundary of a disc there may be vertices exactly across from the start or the end, on every
// way from there: in a triangle with such a one, ways begin or end.
template <class Visit>
bool walk(const SphereTriangulation& map, const Way& way, const Visit& visit) {
  const SpherePoint& end = way.end;
  const auto side = [&](std::uint32_t vertex) {
    return orientation(way.start, end, map.points[vertex]);
  };
  if (way.first_spoke == kNone) {
    if (!is_inside(map, way.triangle, way.start)) return false;
    for (std::uint32_t h = 3 * way.triangle; h < 3 * way.triangle + 3; ++h)
      if (map.from(h) == way.last_vertex) return true;
  }
  std::uint32_t exit = first_exit(map, way, side);
  if (exit == kNone) return way.first_spoke == kNone && is_inside(map, way.triangle, end);
  for (std::size_t step = 0; step < map.indices.size(); ++step) {
    const int inside = orientation(map.points[map.from(exit)], map.points[map.to(exit)], end);
    if (inside == 0) return false;
    if (inside > 0) return true;
    visit(exit);
    const std::uint32_t entry = map.opposite[exit], ahead = next_half_edge(entry);
    if (map.to(ahead) == way.last_vertex) return true;
    const int apex = side(map.to(ahead));
    if (apex == 0) return is_inside(map, entry / 3, end);
    // The entry runs from left to right, seen along the way.
    exit = apex > 0 ? ahead : next_half_edge(ahead);
  }
  return false;
}

// For every edge of `edges`, the half-edges of `map` that it leaves triangles by.
struct Walks {
  std::vector<std::uint32_t> first, half_edges;
  bool is_exact = true;
  bool is_complete = true;  // false: there are too many
};

// Where vertices of one map lie on the other one.
struct Places {
  const std::vector<std::uint32_t>& triangle;
  const std::vector<std::uint32_t>& vertex;  // for those that both share; empty without such

  [[nodiscard]] std::uint32_t vertex_of(std::uint32_t point) const {
    return vertex.empty() ? kNone : vertex[point];
  }
};

// So many crossings are more than any two maps have that are not mostly needles across each other.
std::size_t most_crossings(const SphereTriangulation& a, const SphereTriangulation& b) {
  constexpr std::size_t kAnyway = 1'000'000, kPerTriangle = 32;
  return kAnyway + kPerTriangle * (a.indices.size() + b.indices.size()) / 3;
}

Walks walk_all(const SphereTriangulation& edges, const SphereTriangulation& map,
               const Places& places, int threads) {
  std::vector<std::uint32_t> spoke_of;  // per vertex of the map, a half-edge that begins there
  if (!places.vertex.empty()) {
    spoke_of.resize(map.points.size());
    for (std::uint32_t h = 0; h < map.indices.size(); ++h) spoke_of[map.from(h)] = h;
  }
  const std::size_t pieces = (edges.edge_count() + kEdgesAtOnce - 1) / kEdgesAtOnce;
  std::vector<std::vector<std::uint32_t>> found(pieces);
  Walks walks;
  walks.first.resize(edges.edge_count() + 1, 0);
  std::atomic<bool> is_exact = true;
  std::atomic<std::size_t> total = 0;
  const std::size_t most = most_crossings(edges, map);
  parallel_for(threads, pieces, 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t piece = begin; piece < end; ++piece) {
      const std::size_t last =
          std::min<std::size_t>((piece + 1) * kEdgesAtOnce, edges.edge_count());
      for (std::size_t e = piece * kEdgesAtOnce; e < last && total <= most; ++e) {
        const std::uint32_t h = edges.edge_half[e], from = edges.from(h), to = edges.to(h);
        const std::size_t before = found[piece].size();
        const std::uint32_t shared = places.vertex_of(from);
        Way way{edges.points[from], edges.points[to], kNone, kNone, places.vertex_of(to)};
        (shared == kNone ? way.triangle : way.first_spoke) =
            shared == kNone ? places.triangle[from] : spoke_of[shared];
        if (shared != kNone && way.last_vertex != kNone) continue;  // of the boundary or the fan
        if ((shared == kNone && way.triangle == kNone) ||
            !walk(map, way, [&](std::uint32_t exit) { found[piece].push_back(exit); }))
          is_exact = false;
        walks.first[e + 1] = static_cast<std::uint32_t>(found[piece].size() - before);
        total += walks.first[e + 1];
      }
    }
  });
  walks.is_complete = total <= most;
  if (!walks.is_complete) return walks;
  for (std::size_t e = 0; e < edges.edge_count(); ++e) walks.first[e + 1] += walks.first[e];
  for (const auto& piece : found)
    walks.half_edges.insert(walks.half_edges.end(), piece.begin(), piece.end());
  walks.is_exact = is_exact;
  return walks;
}

// Puts the crossings that the walks along b have found in the order of the walks along a.
bool order_along_a(const Walks& along_a, const SphereTriangulation& b, Crossings& result) {
  if (along_a.half_edges.size() != result.crossings.size()) return false;
  result.first_on_a = along_a.first;
  result.on_a.resize(result.crossings.size());
  std::vector<std::uint32_t> filled(along_a.first.begin(), along_a.first.end() - 1);
  // Rows of crossings per edge of a, by edges of b, for they come in that order.
  for (std::uint32_t x = 0; x < result.crossings.size(); ++x) {
    const std::uint32_t edge = result.crossings[x].edge_a;
    if (filled[edge] == along_a.first[edge + 1]) return false;
    result.on_a[filled[edge]++] = x;
  }
  const auto edge_b_of = [&](std::uint32_t x) { return result.crossings[x].edge_b; };
  std::vector<std::uint32_t> row;
  for (std::uint32_t edge = 0; edge + 1 < along_a.first.size(); ++edge) {
    const std::uint32_t first = along_a.first[edge], last = along_a.first[edge + 1];
    row.assign(result.on_a.begin() + first, result.on_a.begin() + last);
    for (std::uint32_t i = first; i < last; ++i) {
      const std::uint32_t wanted = b.edge_of[along_a.half_edges[i]];
      const auto found = std::lower_bound(
          row.begin(), row.end(), wanted,
          [&](std::uint32_t x, std::uint32_t edge_b) { return edge_b_of(x) < edge_b; });
      if (found == row.end() || edge_b_of(*found) != wanted) return false;
      result.on_a[i] = *found;
      result.crossings[*found].place_a = i - first;
    }
  }
  return true;
}

}  // namespace

std::optional<Crossings> find_crossings(const SphereTriangulation& a, const SphereTriangulation& b,
                                        int threads, SharedPoints shared) {
  Crossings result;
  result.shared = std::move(shared);
  parallel_both(
      threads, [&] { result.triangle_in_b = locate_vertices(a, b); },
      [&] { result.triangle_in_a = locate_vertices(b, a); });
  const Walks along_b = walk_all(b, a, {result.triangle_in_a, result.shared.in_a}, threads);
  if (!along_b.is_complete) {
    result.is_complete = false;
    return result;
  }
  const Walks along_a = walk_all(a, b, {result.triangle_in_b, result.shared.in_b}, threads);
  if (!along_a.is_exact || !along_b.is_exact) return std::nullopt;
  result.first_on_b = along_b.first;
  result.crossings.resize(along_b.half_edges.size());
  for (std::uint32_t edge = 0; edge < b.edge_count(); ++edge)
    for (std::uint32_t i = along_b.first[edge]; i < along_b.first[edge + 1]; ++i) {
      const std::uint32_t exit = along_b.half_edges[i];
      result.crossings[i] = {a.edge_of[exit], edge, 0, i - along_b.first[edge], a.is_first(exit)};
    }
  if (!order_along_a(along_a, b, result)) return std::nullopt;
  return result;
}

}  // namespace varifold
