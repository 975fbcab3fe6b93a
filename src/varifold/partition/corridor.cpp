#include <varifold/partition/corridor.h>

#include <varifold/partition/vertex_fans.h>
#include <algorithm>

namespace varifold {

namespace {

// What counts as shorter: more than the rounding of sums along a path.
constexpr float kShorter = 1 - 1e-5f;

float distance(const PatchedSurface& patched, std::uint32_t p, std::uint32_t q) {
  return glm::distance(patched.surface.positions[p], patched.surface.positions[q]);
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

// Enters the points of the stretch.
void Corridor::add_path(PatchedSurface& patched) {
  const Stretch& old = patched.borders.stretches[stretch_];
  const auto last = static_cast<std::uint32_t>(old.path.size() - 1);
  nodes_[0] = {old.path.front(), old.end_spokes[0]};
  nodes_[1] = {old.path.back(), old.end_spokes[1]};
  nodes_[0].in_old = 0;
  nodes_[1].in_old = last;
  for (std::uint32_t i = 1; i < last; ++i) {
    const std::uint32_t point = old.path[i];
    patched.node_of[point] = static_cast<std::uint32_t>(nodes_.size());
    Node& node = nodes_.emplace_back();
    node.point = point;
    node.spoke = patched.borders.spokes[point];
    node.in_old = i;
    node.remaining = distance(patched, point, nodes_[1].point);
  }
}

// Whether a shorter path may lead through a point.
bool Corridor::is_promising(const PatchedSurface& patched, std::uint32_t point) const {
  return distance(patched, nodes_[0].point, point) + distance(patched, point, nodes_[1].point) <
         kShorter * old_length_;
}

// The node of a point; kNone where no shorter path may lead there.
std::uint32_t Corridor::reach(PatchedSurface& patched, std::uint32_t point, std::uint32_t spoke) {
  const std::uint32_t known = node_at(patched, point);
  const std::uint32_t use = patched.borders.use_of[point];
  if (known != kNone || use == PointUse::kFixed || !is_promising(patched, point)) return known;
  if (use != PointUse::kInside) {
    is_blocked_ = true;
    return kNone;
  }
  const auto number = static_cast<std::uint32_t>(nodes_.size());
  patched.node_of[point] = number;
  Node& node = nodes_.emplace_back();
  node.point = point;
  node.spoke = spoke;
  node.remaining = distance(patched, point, nodes_[1].point);
  return number;
}

void Corridor::relax(std::uint32_t from, std::uint32_t to, float length, std::uint32_t via) {
  Node& node = nodes_[to];
  const float reached = nodes_[from].distance + length;
  const bool is_known = node.parent != kNone || to == 0;
  if (node.is_settled || (is_known && reached >= node.distance)) return;
  if (reached + node.remaining >= kShorter * old_length_) return;  // no use
  node.distance = reached;
  node.parent = from;
  node.via = via;
  heap_.push_back({reached + node.remaining, to});
  std::push_heap(heap_.begin(), heap_.end(), [](const Entry& x, const Entry& y) {
    return x.key != y.key ? x.key > y.key : x.node > y.node;
  });
}

// A*; only what can still lead to a shorter path is looked at.
bool Corridor::search(PatchedSurface& patched) {
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
    for_each_neighbor(patched, point, nodes_[at].spoke,
                      [&](std::uint32_t neighbor, std::uint32_t h) {
                        const std::uint32_t to = reach(patched, neighbor, h);
                        if (to == kNone || nodes_[to].is_settled) return;
                        relax(at, to, distance(patched, point, neighbor), h);
                      });
  }
  return false;
}

// At an end of the stretch other patches begin; what is there may become part of the two.
void Corridor::look_beyond(const PatchedSurface& patched, std::uint32_t end) {
  const std::uint32_t point = nodes_[end].point, spoke = nodes_[end].spoke;
  for (const std::uint32_t first : {spoke, other_spoke(patched.surface, spoke, point)})
    for (std::uint32_t h = first; !is_blocked_;) {
      const std::uint32_t g = patched.links.across_in_material(h);
      if (g == kNone || g / 3 == spoke / 3) break;
      const std::uint32_t neighbor = other_end(patched.surface, h, point);
      const std::uint32_t patch = patched.patch(g / 3), before = patched.patch(h / 3);
      const bool is_inside = (patch == a_ || patch == b_) && (before == a_ || before == b_);
      is_blocked_ = !is_inside && is_promising(patched, neighbor);
      h = other_spoke(patched.surface, g, point);
    }
}

bool Corridor::find_shorter(PatchedSurface& patched, std::uint32_t stretch) {
  const Stretch& old = patched.borders.stretches[stretch];
  nodes_.assign(2, {});
  is_blocked_ = false;
  if (old.path.size() < 3) return false;  // an edge is straight
  stretch_ = stretch;
  a_ = old.a;
  b_ = old.b;
  old_length_ = length(patched, old.path);
  if (distance(patched, old.path.front(), old.path.back()) >= kShorter * old_length_) return false;
  add_path(patched);
  if (!search(patched)) {
    for (const std::uint32_t end : {0u, 1u}) look_beyond(patched, end);
    return false;
  }
  path_.clear();
  for (std::uint32_t node = 1; node != kNone; node = nodes_[node].parent)
    path_.push_back(nodes_[node].point);
  std::reverse(path_.begin(), path_.end());
  for (std::uint32_t i = 0; i < path_.size(); ++i) nodes_[node_at(patched, path_[i])].in_new = i;
  end_spokes_ = {nodes_[node_at(patched, path_[1])].via, nodes_[1].via};
  return true;
}

void Corridor::clear(PatchedSurface& patched) {
  for (std::size_t i = 2; i < nodes_.size(); ++i) patched.node_of[nodes_[i].point] = kNone;
}

}  // namespace varifold
