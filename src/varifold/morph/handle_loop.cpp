#include <varifold/base/disjoint_sets.h>
#include <varifold/morph/handle_loop.h>
#include <algorithm>

namespace varifold {
namespace {

constexpr int kRounds = 4;
constexpr std::size_t kMostRoots = 64;  // of one round

class LoopFinder {
 public:
  explicit LoopFinder(const SphereTriangulation& surface)
      : surface_(surface),
        half_from_(surface.points.size(), kNone),
        to_parent_(surface.points.size()),
        depth_(surface.points.size()) {
    for (std::uint32_t h = 0; h < surface.indices.size(); ++h) half_from_[surface.from(h)] = h;
  }

  // The shortest of the ways through `root`, and maybe others, that a tree and a cotree leave.
  std::vector<std::uint32_t> loop_at(std::uint32_t root) {
    grow_tree(root);
    // Triangles across edges that are not of the tree hang together; edges left after that close
    // ways that do not part the surface.
    DisjointSets cotree(surface_.indices.size() / 3);
    std::uint32_t best = kNone, shortest = kNone;
    for (std::uint32_t edge = 0; edge < surface_.edge_count(); ++edge) {
      const std::uint32_t h = surface_.edge_half[edge];
      if (is_tree_edge(h) || cotree.unite(h / 3, surface_.opposite[h] / 3)) continue;
      const std::uint32_t length = depth_[surface_.from(h)] + depth_[surface_.to(h)];
      if (best == kNone || length < shortest) best = h, shortest = length;
    }
    return best == kNone ? std::vector<std::uint32_t>() : closed_by(best);
  }

 private:
  void grow_tree(std::uint32_t root) {
    std::fill(to_parent_.begin(), to_parent_.end(), kNone);
    std::fill(depth_.begin(), depth_.end(), kNone);
    std::vector<std::uint32_t> queue{root};
    depth_[root] = 0;
    for (std::size_t i = 0; i < queue.size(); ++i) {
      const std::uint32_t first = half_from_[queue[i]];
      std::uint32_t h = first;
      do {
        const std::uint32_t next = surface_.to(h);
        if (depth_[next] == kNone) {
          depth_[next] = depth_[queue[i]] + 1;
          to_parent_[next] = surface_.opposite[h];
          queue.push_back(next);
        }
        h = next_half_edge(surface_.opposite[h]);
      } while (h != first);
    }
  }

  [[nodiscard]] bool is_tree_edge(std::uint32_t h) const {
    return to_parent_[surface_.from(h)] == h || to_parent_[surface_.to(h)] == surface_.opposite[h];
  }

  // The edge and the ways from its ends up to where they meet.
  [[nodiscard]] std::vector<std::uint32_t> closed_by(std::uint32_t half_edge) const {
    std::vector<std::uint32_t> loop{half_edge};
    std::uint32_t u = surface_.from(half_edge), v = surface_.to(half_edge);
    while (u != v) {
      std::uint32_t& lower = depth_[u] > depth_[v] ? u : v;
      loop.push_back(to_parent_[lower]);
      lower = surface_.to(to_parent_[lower]);
    }
    return loop;
  }

  const SphereTriangulation& surface_;
  std::vector<std::uint32_t> half_from_;  // per vertex
  std::vector<std::uint32_t> to_parent_, depth_;
};

}  // namespace

std::vector<std::uint32_t> find_handle_loop(const SphereTriangulation& surface) {
  if (surface.indices.empty()) return {};
  LoopFinder finder(surface);
  std::vector<std::uint32_t> best = finder.loop_at(surface.indices[0]);
  for (int round = 0; round < kRounds && !best.empty(); ++round) {
    const std::vector<std::uint32_t> roots = best;
    const std::size_t stride = (roots.size() + kMostRoots - 1) / kMostRoots;
    for (std::size_t i = 0; i < roots.size(); i += stride) {
      std::vector<std::uint32_t> loop = finder.loop_at(surface.from(roots[i]));
      if (loop.size() < best.size()) best = std::move(loop);
    }
    if (best.size() == roots.size()) break;
  }
  return best;
}

}  // namespace varifold
