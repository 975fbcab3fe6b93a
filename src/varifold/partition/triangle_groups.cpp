#include <varifold/partition/triangle_groups.h>

#include <varifold/base/disjoint_sets.h>
#include <algorithm>
#include <utility>

namespace varifold {

namespace {

// Sets of chains of non-manifold edges, with a bound of the triangles around each.
class ChainSets {
 public:
  ChainSets(const SurfaceView& surface, const EdgeLinks& links)
      : chain_at_(surface.positions.size(), kNone) {
    for (const std::uint32_t h : links.nonmanifold())
      for (const std::uint32_t half_edge : {h, next_in_triangle(h)})
        if (std::uint32_t& chain = chain_at_[surface.corners[half_edge]]; chain == kNone)
          chain = count_++;
    sets_.reset(count_);
    for (const std::uint32_t h : links.nonmanifold())
      sets_.unite(chain_at_[surface.corners[h]], chain_at_[surface.corners[next_in_triangle(h)]]);
    sizes_.assign(count_, 0);
    for (std::uint32_t t = 0; t < surface.triangle_count(); ++t)
      for_each_chain(surface, t, [&](std::uint32_t chain) { ++sizes_[chain]; });
  }

  // Calls visit with the chains at the corners of the triangle, each once.
  template <class Visit>
  void for_each_chain(const SurfaceView& surface, std::uint32_t triangle, const Visit& visit) {
    std::uint32_t seen[3] = {kNone, kNone, kNone};
    for (std::uint32_t i = 0; i < 3; ++i) {
      const std::uint32_t point = chain_at_[surface.corners[3 * triangle + i]];
      if (point == kNone) continue;
      const std::uint32_t chain = sets_.find(point);
      if (chain == seen[0] || chain == seen[1]) continue;
      seen[i] = chain;
      visit(chain);
    }
  }

  void unite(std::uint32_t a, std::uint32_t b, std::uint32_t max_triangles) {
    a = sets_.find(a);
    b = sets_.find(b);
    if (a == b || sizes_[a] + sizes_[b] > max_triangles) return;
    const std::uint32_t both = sizes_[a] + sizes_[b];
    sets_.unite(a, b);
    sizes_[sets_.find(a)] = both;
  }
  [[nodiscard]] std::uint32_t size(std::uint32_t chain) const { return sizes_[chain]; }

 private:
  std::vector<std::uint32_t> chain_at_;  // per point: the number of a point on a chain, or kNone
  DisjointSets sets_{0};
  std::vector<std::uint32_t> sizes_;  // at representatives
  std::uint32_t count_ = 0;
};

}  // namespace

TriangleGroups glue_nonmanifold_stars(const SurfaceView& surface, const EdgeLinks& links,
                                      std::uint32_t max_triangles) {
  TriangleGroups groups;
  if (links.nonmanifold().empty()) return groups;

  // Join chains that a triangle touches at once.
  ChainSets chains(surface, links);
  const std::uint32_t n = surface.triangle_count();
  for (std::uint32_t t = 0; t < n; ++t) {
    std::uint32_t first = kNone;
    chains.for_each_chain(surface, t, [&](std::uint32_t chain) {
      if (first == kNone)
        first = chain;
      else
        chains.unite(first, chain, max_triangles);
    });
  }

  // Every triangle goes to the first chain that it touches.
  groups.group_of.assign(n, kNone);
  std::vector<std::pair<std::uint64_t, std::uint32_t>> keyed;  // (chain, material), triangle
  for (std::uint32_t t = 0; t < n; ++t) {
    std::uint32_t first = kNone;
    chains.for_each_chain(surface, t, [&](std::uint32_t chain) {
      if (first == kNone && chains.size(chain) <= max_triangles) first = chain;
    });
    if (first != kNone) keyed.emplace_back(std::uint64_t{first} << 32 | surface.material_of(t), t);
  }
  std::sort(keyed.begin(), keyed.end());
  for (std::size_t i = 0; i < keyed.size(); ++i) {
    if (i > 0 && keyed[i].first != keyed[i - 1].first) ++groups.count;
    groups.group_of[keyed[i].second] = groups.count;
  }
  if (!keyed.empty()) ++groups.count;
  return groups;
}

}  // namespace varifold
