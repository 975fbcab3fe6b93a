// Based on: [GueziecTaubinLazarusHorn2001] for parting a mesh along its crowded edges.
// Differs: there all of their triangles are parted, here the smoothest pairs stay together.
#include <varifold/morph/half_edge_matching.h>
#include <varifold/morph/sphere_triangulation.h>
#include <algorithm>
#include <array>
#include <tuple>
#include <utility>

namespace varifold {
namespace {

struct SortedTriangle {
  std::array<std::uint32_t, 3> classes;
  std::uint32_t triangle;
  bool is_even;
  bool operator<(const SortedTriangle& other) const {
    return std::tie(classes, triangle) < std::tie(other.classes, other.triangle);
  }
};

struct EdgeEnd {
  std::uint32_t low, high, half_edge;
  bool operator<(const EdgeEnd& other) const {
    return std::tie(low, high, half_edge) < std::tie(other.low, other.high, other.half_edge);
  }
};

}  // namespace

std::vector<std::uint32_t> distinct_triangles(std::span<const std::uint32_t> indices,
                                              const WeldMap& weld) {
  std::vector<SortedTriangle> sorted;
  sorted.reserve(indices.size() / 3);
  for (std::uint32_t t = 0; t < indices.size() / 3; ++t) {
    std::array<std::uint32_t, 3> c{};
    for (std::uint32_t k = 0; k < 3; ++k) c[k] = weld.class_of[indices[3 * std::size_t{t} + k]];
    if (c[0] == c[1] || c[1] == c[2] || c[2] == c[0]) continue;
    std::rotate(c.begin(), std::min_element(c.begin(), c.end()), c.end());
    const bool is_even = c[1] < c[2];
    if (!is_even) std::swap(c[1], c[2]);
    sorted.push_back({c, t, is_even});
  }
  std::sort(sorted.begin(), sorted.end());
  std::vector<std::uint32_t> kept;
  for (std::size_t i = 0, end = 0; i < sorted.size(); i = end) {
    bool has_side[2] = {false, false};
    for (end = i; end < sorted.size() && sorted[end].classes == sorted[i].classes; ++end) {
      bool& has = has_side[sorted[end].is_even ? 1 : 0];
      if (!has) kept.push_back(sorted[end].triangle);
      has = true;
    }
  }
  std::sort(kept.begin(), kept.end());
  return kept;
}

std::vector<std::uint32_t> match_half_edges(
    std::span<const std::uint32_t> classes,
    const std::function<Vec3(std::uint32_t triangle)>& normal_of, std::uint32_t& crowded_edges) {
  std::vector<EdgeEnd> ends;
  ends.reserve(classes.size());
  for (std::uint32_t h = 0; h < classes.size(); ++h) {
    const std::uint32_t from = classes[h], to = classes[next_half_edge(h)];
    ends.push_back({std::min(from, to), std::max(from, to), h});
  }
  std::sort(ends.begin(), ends.end());
  std::vector<std::uint32_t> opposite(classes.size(), kNone);
  struct Pair {
    double bend;
    std::uint32_t g, h;
  };
  std::vector<Pair> pairs;
  crowded_edges = 0;
  for (std::size_t first = 0, end = 0; first < ends.size(); first = end) {
    for (end = first; end < ends.size() && ends[end].low == ends[first].low &&
                      ends[end].high == ends[first].high;)
      ++end;
    const bool is_crowded = end - first > 2;
    crowded_edges += is_crowded;
    pairs.clear();
    for (std::size_t i = first; i < end; ++i)
      for (std::size_t j = i + 1; j < end; ++j) {
        const std::uint32_t g = ends[i].half_edge, h = ends[j].half_edge;
        if (classes[g] == classes[h]) continue;  // both run the same way
        pairs.push_back({is_crowded ? glm::dot(normal_of(g / 3), normal_of(h / 3)) : 1.0, g, h});
      }
    std::stable_sort(pairs.begin(), pairs.end(),
                     [](const Pair& p, const Pair& q) { return p.bend > q.bend; });
    for (const auto& [bend, g, h] : pairs)
      if (opposite[g] == kNone && opposite[h] == kNone) opposite[g] = h, opposite[h] = g;
  }
  return opposite;
}

}  // namespace varifold
