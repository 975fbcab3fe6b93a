#include <tests/models/patch_tree/front_oracle.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace varifold::test {

namespace {

// Of nodes with children, in any order: all that must be split where `split` is.
void close(const PatchTopology& t, SplitFlags& split) {
  for (bool changed = true; changed;) {
    changed = false;
    const auto require = [&](std::uint32_t node) {
      if (node == kNone || split[node]) return;
      split[node] = true;
      changed = true;
    };
    for (std::uint32_t node = t.node_count(); node-- > 0;) {
      if (!split[node]) continue;
      require(t.parent[node]);
      for (const std::uint32_t neighbor : t.neighbors_of(node)) require(t.parent[neighbor]);
    }
  }
}

std::uint64_t triangles_of_split(const PatchTree& tree, const SplitFlags& split) {
  return triangles_of(tree, oracle_draws(tree, split));
}

std::vector<std::uint32_t> by_priority(const PatchTopology& t, const std::vector<float>& priorities,
                                       float tolerance) {
  std::vector<std::uint32_t> nodes;
  for (std::uint32_t node = 0; node < t.node_count(); ++node)
    if (!t.is_leaf(node) && priorities[node] > tolerance) nodes.push_back(node);
  std::stable_sort(nodes.begin(), nodes.end(),
                   [&](std::uint32_t a, std::uint32_t b) { return priorities[a] > priorities[b]; });
  return nodes;
}

float own_priority(const RefineCriteria& criteria, PatchMeasure measure, const PatchBounds& b) {
  if (measure == PatchMeasure::kPixels) return criteria.urgency({b.ball, b.cone, b.error});
  if (criteria.is_placed_on(b.ball, b.error)) return 1.5f * RefineCriteria::kFullDetail;
  if (measure == PatchMeasure::kError) return b.error;
  if (!criteria.view) return 0;
  const ViewCriterion& view = *criteria.view;
  if (view.outside_weight == 0 && classify(view.frustum, b.ball) == Containment::kOutside) return 0;
  if (view.back_weight == 0 && is_back_facing(b.cone, b.ball, view.eye)) return 0;
  const float gap = distance_to(b.ball, view.eye);
  return b.mean_squared > 0 ? b.mean_squared / (gap * gap) : 0;
}

}  // namespace

std::vector<float> oracle_priorities(const PatchTree& tree, const RefineCriteria& criteria,
                                     PatchMeasure measure) {
  const PatchTopology& t = tree.topology();
  std::vector<float> priorities(t.node_count(), 0);
  for (std::uint32_t node = 0; node < t.node_count(); ++node) {
    if (t.is_leaf(node)) continue;
    float& p = priorities[node];
    p = own_priority(criteria, measure, tree.data().bounds[node]);
    if (t.parent[node] != kNone) p = std::min(p, priorities[t.parent[node]]);
  }
  return priorities;
}

OracleFront oracle_front(const PatchTree& tree, const std::vector<float>& priorities,
                         const OracleStop& stop) {
  const PatchTopology& t = tree.topology();
  OracleFront front;
  front.split.assign(t.node_count(), false);
  SplitFlags wanted = front.split;
  for (const std::uint32_t node : by_priority(t, priorities, stop.tolerance)) {
    SplitFlags next = front.split;
    next[node] = true;
    close(t, next);
    if (stop.is_resident) {
      bool possible = true;
      for (std::uint32_t n = 0; n < t.node_count(); ++n)
        possible &= !next[n] || stop.is_resident(n);
      if (!possible) continue;
    }
    if (triangles_of_split(tree, next) > stop.triangles ||
        static_cast<std::uint64_t>(std::count(next.begin(), next.end(), true)) > stop.splits) {
      // What is there already costs nothing.
      if (next != front.split) {
        front.is_stopped = true;
        front.stopped_at = priorities[node];
        break;
      }
    }
    front.split = std::move(next);
    wanted[node] = true;
  }
  for (std::uint32_t n = 0; n < t.node_count(); ++n)
    front.forced += front.split[n] && !wanted[n] ? 1 : 0;
  return front;
}

SplitFlags oracle_threshold(const PatchTree& tree, const std::vector<float>& priorities,
                            float tolerance) {
  SplitFlags split(tree.node_count(), false);
  for (std::uint32_t node = 0; node < tree.node_count(); ++node)
    split[node] = priorities[node] > tolerance;
  close(tree.topology(), split);
  return split;
}

std::vector<PatchDraw> oracle_draws(const PatchTree& tree, const SplitFlags& split) {
  const PatchTopology& t = tree.topology();
  std::vector<PatchDraw> draws;
  for (std::uint32_t node = 0; node < t.node_count(); ++node) {
    const std::uint32_t parent = t.parent[node];
    if (split[node] || (parent != kNone && !split[parent])) continue;
    PatchDraw draw{node, 0};
    if (parent != kNone) {
      const auto neighbors = t.neighbors_of(parent);
      for (std::uint32_t i = 0; i < neighbors.size() && i < kMaxControllers; ++i)
        if (!split[neighbors[i]]) draw.mask |= 1u << i;
    }
    draws.push_back(draw);
  }
  return draws;
}

std::uint64_t triangles_of(const PatchTree& tree, const std::vector<PatchDraw>& draws) {
  std::uint64_t sum = 0;
  for (const PatchDraw& draw : draws) sum += tree.triangle_count_of(draw.node);
  return sum;
}

SplitFlags flags_of(const PatchFront& front) {
  SplitFlags split(front.tables().topology().node_count(), false);
  for (std::uint32_t node = 0; node < front.tables().inner_count(); ++node)
    split[node] = front.nodes().is_split(node);
  return split;
}

std::vector<PatchDraw> sorted_draws(const PatchFront& front) {
  std::vector<PatchDraw> draws(front.draws().draws().begin(), front.draws().draws().end());
  std::sort(draws.begin(), draws.end(),
            [](const PatchDraw& a, const PatchDraw& b) { return a.node < b.node; });
  return draws;
}

std::string faults_of(const PatchFront& front, const std::vector<float>& priorities) {
  const PatchTree& tree = front.tables().tree();
  const PatchTopology& t = tree.topology();
  const SplitFlags split = flags_of(front);
  std::vector<std::uint32_t> dependants(t.node_count(), 0);
  for (std::uint32_t node = 0; node < front.tables().inner_count(); ++node) {
    if (!split[node]) continue;
    SplitFlags required(t.node_count(), false);
    if (t.parent[node] != kNone) required[t.parent[node]] = true;
    for (const std::uint32_t neighbor : t.neighbors_of(node))
      if (t.parent[neighbor] != kNone) required[t.parent[neighbor]] = true;
    for (std::uint32_t r = 0; r < t.node_count(); ++r) {
      if (!required[r]) continue;
      if (!split[r]) return "node " + std::to_string(node) + " lacks " + std::to_string(r);
      ++dependants[r];
    }
  }
  for (std::uint32_t node = 0; node < front.tables().inner_count(); ++node) {
    if (front.nodes().dependants(node) != dependants[node])
      return "dependants of " + std::to_string(node);
    const bool exists = t.parent[node] == kNone || split[t.parent[node]];
    if (exists && front.nodes().priority(node) != priorities[node])
      return "priority of " + std::to_string(node);
  }
  const std::vector<PatchDraw> draws = oracle_draws(tree, split);
  if (sorted_draws(front) != draws) return "draws";
  for (std::uint32_t slot = 0; slot < front.draws().draws().size(); ++slot)
    if (front.draws().slot_of(front.draws().draws()[slot].node) != slot)
      return "slot " + std::to_string(slot);
  if (triangles_of(tree, draws) != front.nodes().triangles()) return "triangles of the set";
  if (triangles_of(tree, draws) != front.draws().triangles()) return "triangles of the draws";
  std::uint64_t vertices = 0;
  for (const PatchDraw& draw : draws) vertices += tree.vertex_count_of(draw.node);
  if (vertices != front.draws().vertices()) return "vertices";
  return "";
}

Camera random_camera(Random& random) {
  const auto direction = [&] {
    for (;;) {
      const Vec3 v(2 * random.uniform() - 1, 2 * random.uniform() - 1, 2 * random.uniform() - 1);
      if (glm::length(v) > 0.1f && glm::length(v) < 1) return v / glm::length(v);
    }
  };
  Camera camera;
  const float distances[] = {0.3f, 0.9f, 1.02f, 1.2f, 2, 4, 20};
  camera.eye = direction() * distances[random.below(7)];
  camera.target = direction() * static_cast<float>(random.uniform());
  camera.up = direction();
  camera.fovy_degrees = static_cast<float>(10 + 80 * random.uniform());
  camera.near_distance = 0.01f;
  camera.far_distance = random.below(4) == 0 ? 1.0f : 100.0f;
  return camera;
}

}  // namespace varifold::test
