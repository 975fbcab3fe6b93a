#include <varifold/partition/corridor.h>

#include <varifold/partition/vertex_fans.h>
#include <algorithm>

namespace varifold {

namespace {

// What counts as shorter: more than the rounding of sums along a path.
constexpr float kShorter = 1 - 1e-5f;

// Squares of floats could run over.
float distance(const PatchedSurface& patched, std::uint32_t p, std::uint32_t q) {
  return static_cast<float>(
      glm::distance(DVec3(patched.surface.positions[p]), DVec3(patched.surface.positions[q])));
}

float length(const PatchedSurface& patched, const std::vector<std::uint32_t>& path) {
  float sum = 0;
  for (std::size_t i = 1; i < path.size(); ++i) sum += distance(patched, path[i - 1], path[i]);
  return sum;
}

}  // namespace

// Calls visit(neighbour, half-edge) for the edges at a point that have a triangle of the two
// patches on both sides, as far as the walk around it from `spoke` meets no other patch.
template <class Visit>
void Corridor::for_each_neighbor(const PatchedSurface& patched, std::uint32_t point,
                                 std::uint32_t spoke, const Visit& visit) const {
  const std::uint32_t start = spoke / 3;
  for (const std::uint32_t first : {spoke, other_spoke(patched.surface, spoke, point)})
    for (std::uint32_t h = first;;) {
      const std::uint32_t g = patched.links.across_in_material(h);
      if (g == kNone) break;
      const std::uint32_t patch = patched.patch(g / 3);
      if (patch != a_ && patch != b_) break;
      visit(other_end(patched.surface, g, point), g);
      if (g / 3 == start) return;  // all around
      h = other_spoke(patched.surface, g, point);
    }
}

void Corridor::add(PatchedSurface& patched, std::uint32_t point, std::uint32_t spoke) {
  if (node_at(patched, point) != kNone) return;
  const std::uint32_t use = patched.borders.use_of[point];
  if (use != PointUse::kInside && use != stretch_) return;
  patched.node_of[point] = static_cast<std::uint32_t>(nodes_.size());
  nodes_.push_back({point, spoke});
}

// The ends are no inner points: their fans are walked from a triangle beside the stretch.
void Corridor::find_end_spoke(const PatchedSurface& patched, std::uint32_t node,
                              std::uint32_t neighbor) {
  const std::uint32_t end = nodes_[node].point;
  for_each_neighbor(patched, neighbor, patched.borders.spokes[neighbor],
                    [&](std::uint32_t point, std::uint32_t h) {
                      if (point == end) nodes_[node].spoke = h;
                    });
}

void Corridor::collect(PatchedSurface& patched) {
  const std::vector<std::uint32_t>& path = patched.borders.stretches[stretch_].path;
  nodes_[0].point = path.front();
  nodes_[1].point = path.back();
  nodes_[0].in_old = 0;
  nodes_[1].in_old = static_cast<std::uint32_t>(path.size() - 1);
  find_end_spoke(patched, 0, path[1]);
  find_end_spoke(patched, 1, path[path.size() - 2]);
  for (std::uint32_t i = 1; i + 1 < path.size(); ++i) {
    add(patched, path[i], patched.borders.spokes[path[i]]);
    nodes_.back().in_old = i;
  }
  const std::size_t count = nodes_.size();
  for (std::size_t i = 0; i < count; ++i)
    for_each_neighbor(patched, nodes_[i].point, nodes_[i].spoke,
                      [&](std::uint32_t point, std::uint32_t h) { add(patched, point, h); });
  for (Node& node : nodes_) node.remaining = distance(patched, node.point, nodes_[1].point);
}

void Corridor::relax(std::uint32_t from, std::uint32_t to, float length) {
  Node& node = nodes_[to];
  const float reached = nodes_[from].distance + length;
  const bool is_known = node.parent != kNone || to == 0;
  if (node.is_settled || (is_known && reached >= node.distance)) return;
  if (reached + node.remaining >= kShorter * old_length_) return;  // no use
  node.distance = reached;
  node.parent = from;
  heap_.push_back({reached + node.remaining, to});
  std::push_heap(heap_.begin(), heap_.end(), [](const Entry& x, const Entry& y) {
    return x.key != y.key ? x.key > y.key : x.node > y.node;
  });
}

// A*; only what can still lead to a shorter path is looked at.
bool Corridor::search(const PatchedSurface& patched) {
  heap_.assign(1, {nodes_[0].remaining, 0});
  while (!heap_.empty()) {
    std::pop_heap(heap_.begin(), heap_.end(), [](const Entry& x, const Entry& y) {
      return x.key != y.key ? x.key > y.key : x.node > y.node;
    });
    const std::uint32_t at = heap_.back().node;
    heap_.pop_back();
    if (at == 1) return true;
    if (nodes_[at].is_settled) continue;
    nodes_[at].is_settled = true;
    const std::uint32_t point = nodes_[at].point;
    for_each_neighbor(patched, point, nodes_[at].spoke, [&](std::uint32_t neighbor, std::uint32_t) {
      const std::uint32_t to = node_at(patched, neighbor);
      if (to != kNone) relax(at, to, distance(patched, point, neighbor));
    });
  }
  return false;
}

bool Corridor::find_shorter(PatchedSurface& patched, std::uint32_t stretch) {
  const Stretch& old = patched.borders.stretches[stretch];
  stretch_ = stretch;
  nodes_.assign(2, {});
  if (old.path.size() < 3) return false;  // an edge is straight
  a_ = old.a;
  b_ = old.b;
  old_length_ = length(patched, old.path);
  collect(patched);
  if (nodes_[0].spoke == kNone || nodes_[1].spoke == kNone || !search(patched)) return false;
  path_.clear();
  for (std::uint32_t node = 1; node != kNone; node = nodes_[node].parent)
    path_.push_back(nodes_[node].point);
  std::reverse(path_.begin(), path_.end());
  for (std::uint32_t i = 0; i < path_.size(); ++i) nodes_[node_at(patched, path_[i])].in_new = i;
  return true;
}

void Corridor::clear(PatchedSurface& patched) {
  for (std::size_t i = 2; i < nodes_.size(); ++i) patched.node_of[nodes_[i].point] = kNone;
}

}  // namespace varifold
