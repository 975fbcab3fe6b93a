#include <varifold/simplify/rings.h>

#include <algorithm>

namespace varifold {

namespace {

// Finds, for each edge, the one edge that follows it head to tail; kNone where there is none or a
// choice. Sorting makes it O(k log k) whatever the valence.
struct Chains {
  std::vector<std::uint32_t> next, previous;

  explicit Chains(std::vector<LinkEdge>& edges) {
    std::sort(edges.begin(), edges.end(), [](const LinkEdge& a, const LinkEdge& b) {
      return a.from != b.from ? a.from < b.from : a.face < b.face;
    });
    const auto count = static_cast<std::uint32_t>(edges.size());
    std::vector<std::uint32_t> by_to(count);
    for (std::uint32_t i = 0; i < count; ++i) by_to[i] = i;
    std::sort(by_to.begin(), by_to.end(), [&](std::uint32_t a, std::uint32_t b) {
      return edges[a].to != edges[b].to ? edges[a].to < edges[b].to : a < b;
    });
    next.assign(count, kNone);
    previous.assign(count, kNone);
    std::uint32_t out = 0;
    for (std::uint32_t in = 0; in < count;) {
      const std::uint32_t vertex = edges[by_to[in]].to;
      std::uint32_t in_end = in;
      while (in_end < count && edges[by_to[in_end]].to == vertex) ++in_end;
      while (out < count && edges[out].from < vertex) ++out;
      std::uint32_t out_end = out;
      while (out_end < count && edges[out_end].from == vertex) ++out_end;
      if (in_end - in == 1 && out_end - out == 1) {
        next[by_to[in]] = out;
        previous[out] = by_to[in];
      }
      in = in_end;
    }
  }
};

}  // namespace

bool order_ring(std::vector<LinkEdge>& edges, std::vector<RingEntry>& ring) {
  ring.clear();
  const Chains chains(edges);
  std::vector<bool> done(edges.size(), false);

  // Open fans first: they start at an edge that nothing precedes.
  for (std::uint32_t start = 0; start < edges.size(); ++start) {
    if (chains.previous[start] != kNone) continue;
    std::uint32_t last = start;
    for (std::uint32_t i = start; i != kNone; i = chains.next[i]) {
      ring.push_back({edges[i].from, edges[i].face});
      done[i] = true;
      last = i;
    }
    ring.push_back({edges[last].to, kNone});
  }

  // What is left are closed fans.
  bool single = ring.empty();
  bool any = false;
  for (std::uint32_t start = 0; start < edges.size(); ++start) {
    if (done[start]) continue;
    if (any && single) {  // a second closed fan: both need their gaps
      ring.push_back({ring.front().neighbor, kNone});
      single = false;
    }
    any = true;
    for (std::uint32_t i = start; !done[i]; i = chains.next[i]) {
      ring.push_back({edges[i].from, edges[i].face});
      done[i] = true;
    }
    if (!single) ring.push_back({edges[start].from, kNone});
  }
  return single && any;
}

void link_edges(std::span<const RingEntry> ring, std::vector<LinkEdge>& edges) {
  for (std::size_t i = 0; i < ring.size(); ++i)
    if (ring[i].face != kNone)
      edges.push_back({ring[i].neighbor, ring[(i + 1) % ring.size()].neighbor, ring[i].face});
}

}  // namespace varifold
