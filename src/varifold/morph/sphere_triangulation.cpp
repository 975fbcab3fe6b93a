// Based on: [DevillersPionTeillaud2002], the walk that asks the edges of a triangle in random
// order.
#include <varifold/base/random.h>
#include <varifold/morph/sphere_triangulation.h>
#include <algorithm>
#include <utility>

namespace varifold {
namespace {

// Half-edges of both triangles of each edge side by side.
std::vector<std::uint32_t> opposites(const std::vector<std::uint32_t>& indices,
                                     std::uint32_t vertex_count) {
  const auto count = static_cast<std::uint32_t>(indices.size());
  // Rows by the lower end: rows are short, so each is searched.
  std::vector<std::uint32_t> offsets(vertex_count + 1, 0), row(count), opposite(count, kNone);
  const auto ends = [&](std::uint32_t h) {
    return std::minmax(indices[h], indices[next_half_edge(h)]);
  };
  for (std::uint32_t h = 0; h < count; ++h) ++offsets[ends(h).first + 1];
  for (std::uint32_t v = 0; v < vertex_count; ++v) offsets[v + 1] += offsets[v];
  std::vector<std::uint32_t> filled(offsets.begin(), offsets.end() - 1);
  for (std::uint32_t h = 0; h < count; ++h) row[filled[ends(h).first]++] = h;
  for (std::uint32_t v = 0; v < vertex_count; ++v)
    for (std::uint32_t i = offsets[v]; i < offsets[v + 1]; ++i)
      for (std::uint32_t j = i + 1; j < offsets[v + 1]; ++j)
        if (ends(row[i]).second == ends(row[j]).second)
          opposite[row[i]] = row[j], opposite[row[j]] = row[i];
  return opposite;
}

}  // namespace

SphereTriangulation::SphereTriangulation(std::vector<std::uint32_t> triangle_indices,
                                         std::vector<SpherePoint> vertex_points)
    : indices(std::move(triangle_indices)),
      points(std::move(vertex_points)),
      opposite(opposites(indices, static_cast<std::uint32_t>(points.size()))),
      edge_of(indices.size()) {
  edge_half.reserve(indices.size() / 2);
  for (std::uint32_t h = 0; h < indices.size(); ++h) {
    if (opposite[h] < h) {
      edge_of[h] = edge_of[opposite[h]];
    } else {
      edge_of[h] = edge_count();
      edge_half.push_back(h);
    }
  }
}

SphereLocator::SphereLocator(const SphereTriangulation& triangulation) : sphere_(triangulation) {}

std::uint32_t SphereLocator::locate(const SpherePoint& point, std::uint32_t start) const {
  Random random(start);
  std::uint32_t triangle = start, entry = kNone;
  const std::size_t most_steps = sphere_.indices.size() + 64;
  for (std::size_t step = 0; step < most_steps; ++step) {
    const std::uint32_t shift = random.below(3);
    std::uint32_t exit = kNone;
    for (std::uint32_t k = 0; k < 3 && exit == kNone; ++k) {
      const std::uint32_t h = 3 * triangle + (k + shift) % 3;
      if (h == entry) continue;
      const SpherePoint &u = sphere_.points[sphere_.from(h)], &v = sphere_.points[sphere_.to(h)];
      if (orientation(u, v, point) < 0) exit = h;
    }
    if (exit == kNone && entry != kNone) {
      // Behind the edge that it came through lies the antipode of where it wants to be.
      const SpherePoint &u = sphere_.points[sphere_.from(entry)],
                        &v = sphere_.points[sphere_.to(entry)];
      if (orientation(u, v, point) < 0) exit = entry;
    }
    if (exit == kNone) return triangle;
    entry = sphere_.opposite[exit];
    triangle = entry / 3;
  }
  for (triangle = 0; triangle < sphere_.indices.size() / 3; ++triangle) {
    bool is_inside = true;
    for (std::uint32_t h = 3 * triangle; h < 3 * triangle + 3; ++h)
      is_inside = is_inside && orientation(sphere_.points[sphere_.from(h)],
                                           sphere_.points[sphere_.to(h)], point) >= 0;
    if (is_inside) return triangle;
  }
  return kNone;
}

std::vector<std::uint32_t> locate_vertices(const SphereTriangulation& others,
                                           const SphereTriangulation& within) {
  const SphereLocator locator(within);
  std::vector<std::uint32_t> place(others.points.size(), kNone), queue;
  if (others.indices.empty()) return place;
  const auto visit = [&](std::uint32_t vertex, std::uint32_t start) {
    if (place[vertex] != kNone) return;
    place[vertex] = locator.locate(others.points[vertex], start);
  };
  // Breadth first over the triangles.
  std::vector<bool> is_seen(others.indices.size() / 3, false);
  queue.push_back(0);
  is_seen[0] = true;
  visit(others.indices[0], 0);
  for (std::size_t i = 0; i < queue.size(); ++i) {
    const std::uint32_t first = 3 * queue[i];
    std::uint32_t start = 0;
    for (std::uint32_t h = first; h < first + 3; ++h)
      if (place[others.indices[h]] != kNone) start = place[others.indices[h]];
    for (std::uint32_t h = first; h < first + 3; ++h) visit(others.indices[h], start);
    for (std::uint32_t h = first; h < first + 3; ++h) {
      const std::uint32_t neighbour = others.opposite[h] / 3;
      if (is_seen[neighbour]) continue;
      is_seen[neighbour] = true;
      queue.push_back(neighbour);
    }
  }
  return place;
}

}  // namespace varifold
