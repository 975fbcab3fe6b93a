#include <tests/models/patch_tree/synthetic_tree.h>

#include <varifold/base/random.h>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

namespace varifold::test {

namespace {

using Neighbors = std::vector<std::vector<std::uint32_t>>;

void make_symmetric(Neighbors& neighbors) {
  for (std::uint32_t i = 0; i < neighbors.size(); ++i)
    for (const std::uint32_t j : std::vector<std::uint32_t>(neighbors[i]))
      neighbors[j].push_back(i);
  for (auto& list : neighbors) {
    std::sort(list.begin(), list.end());
    list.erase(std::unique(list.begin(), list.end()), list.end());
  }
}

// Groups of patches are neighbours where some of their members are.
Neighbors lifted(const Neighbors& fine, const std::vector<std::uint32_t>& group_of,
                 std::uint32_t groups) {
  Neighbors coarse(groups);
  for (std::uint32_t i = 0; i < fine.size(); ++i)
    for (const std::uint32_t j : fine[i])
      if (group_of[i] != group_of[j]) coarse[group_of[i]].push_back(group_of[j]);
  make_symmetric(coarse);
  return coarse;
}

std::uint32_t count_groups(const std::vector<std::uint32_t>& group_of) {
  return *std::max_element(group_of.begin(), group_of.end()) + 1;
}

// The patches of all levels in the order of a tree.
struct Levels {
  std::vector<Neighbors> neighbors;               // per level from the leaves on
  std::vector<std::vector<std::uint32_t>> order;  // per level: its patches as the tree has them
  std::vector<std::vector<std::uint32_t>> place;  // the inverse
};

Levels order_levels(const LeafPatches& leaves, const Grouping& grouping) {
  Levels levels;
  levels.neighbors.push_back(leaves.neighbors);
  for (const auto& group_of : grouping)
    levels.neighbors.push_back(lifted(levels.neighbors.back(), group_of, count_groups(group_of)));
  const std::size_t count = levels.neighbors.size();
  levels.order.resize(count);
  levels.place.resize(count);
  for (std::size_t h = count; h-- > 0;) {
    auto& order = levels.order[h];
    order.resize(levels.neighbors[h].size());
    std::iota(order.begin(), order.end(), 0u);
    if (h + 1 < count)
      std::stable_sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
        return levels.place[h + 1][grouping[h][a]] < levels.place[h + 1][grouping[h][b]];
      });
    levels.place[h].resize(order.size());
    for (std::uint32_t i = 0; i < order.size(); ++i) levels.place[h][order[i]] = i;
  }
  return levels;
}

void add_topology(const Levels& levels, const Grouping& grouping, PatchTopology& t) {
  const std::size_t count = levels.order.size();
  t.first_of_level = {0};
  for (std::size_t h = count; h-- > 0;)
    t.first_of_level.push_back(t.first_of_level.back() +
                               static_cast<std::uint32_t>(levels.order[h].size()));
  t.first_neighbor = {0};
  for (std::size_t h = count; h-- > 0;) {
    const std::uint32_t first = t.first_of_level[count - 1 - h];
    for (const std::uint32_t patch : levels.order[h]) {
      t.parent.push_back(h + 1 == count ? kNone
                                        : t.first_of_level[count - 2 - h] +
                                              levels.place[h + 1][grouping[h][patch]]);
      for (const std::uint32_t other : levels.neighbors[h][patch])
        t.neighbors.push_back(first + levels.place[h][other]);
      t.first_neighbor.push_back(static_cast<std::uint32_t>(t.neighbors.size()));
    }
  }
  t.first_child.assign(t.node_count() + 1, t.node_count());
  for (std::uint32_t node = t.node_count(); node-- > 0;)
    if (t.parent[node] != kNone) t.first_child[t.parent[node]] = node;
}

// Bounds and triangles of a node of its children's.
void add_inner_node(PatchTreeData& data, std::vector<std::uint32_t>& triangles, std::uint32_t node,
                    Random& random, float error) {
  const std::uint32_t first = data.topology.first_child[node],
                      end = data.topology.first_child[node + 1];
  PatchBounds& bounds = data.bounds[node];
  Vec3 center(0), axis(0);
  std::uint32_t sum = 0;
  for (std::uint32_t child = first; child < end; ++child) {
    center += data.bounds[child].ball.center;
    axis += data.bounds[child].cone.axis;
    sum += triangles[child];
  }
  triangles[node] = end - first == 1 ? sum : std::min(sum, sum / 2 + random.below(1 + sum / 16));
  bounds.ball = {center / static_cast<float>(end - first), 0};
  bounds.cone = {normalize_or_zero(axis), 1, 0};
  bounds.error = error * static_cast<float>(0.5 + 1.5 * random.uniform());
  bounds.mean_squared = bounds.error * bounds.error * static_cast<float>(0.3 * random.uniform());
  double widest = 0;
  for (std::uint32_t child = first; child < end; ++child) {
    const PatchBounds& below = data.bounds[child];
    bounds.ball.radius =
        std::max(bounds.ball.radius,
                 glm::length(below.ball.center - bounds.ball.center) + below.ball.radius);
    bounds.error = std::max(bounds.error, below.error);
    bounds.mean_squared = std::max(bounds.mean_squared, below.mean_squared);
    const double between =
        std::acos(std::clamp(glm::dot(below.cone.axis, bounds.cone.axis), -1.0f, 1.0f));
    widest = std::max(widest, between + std::acos(static_cast<double>(below.cone.cosine)));
  }
  widest = std::min(widest, 3.14159);
  bounds.cone.cosine = static_cast<float>(std::cos(widest));
  bounds.cone.sine = static_cast<float>(std::sin(widest));
}

// The k nearest of each point; all points for small numbers.
Neighbors nearest(const std::vector<Vec3>& points, std::uint32_t k) {
  // Points by cells of a grid of some three points each.
  const auto cells = static_cast<std::int32_t>(
      std::max(1.0, std::floor(std::sqrt(static_cast<double>(points.size()) / 16))));
  const auto cell_of = [&](float x) {
    return std::clamp(static_cast<std::int32_t>((x + 1) * 0.5f * static_cast<float>(cells)), 0,
                      cells - 1);
  };
  std::vector<std::vector<std::uint32_t>> grid(static_cast<std::size_t>(cells) * cells * cells);
  const auto at = [&](std::int32_t x, std::int32_t y, std::int32_t z) -> auto& {
    return grid[(static_cast<std::size_t>(z) * cells + y) * cells + x];
  };
  for (std::uint32_t i = 0; i < points.size(); ++i)
    at(cell_of(points[i].x), cell_of(points[i].y), cell_of(points[i].z)).push_back(i);
  Neighbors neighbors(points.size());
  std::vector<std::pair<float, std::uint32_t>> found;
  for (std::uint32_t i = 0; i < points.size(); ++i) {
    for (std::int32_t reach = 1; found.clear(), true; ++reach) {
      const auto low = [&](float x) { return std::max(0, cell_of(x) - reach); };
      const auto high = [&](float x) { return std::min(cells - 1, cell_of(x) + reach); };
      for (std::int32_t z = low(points[i].z); z <= high(points[i].z); ++z)
        for (std::int32_t y = low(points[i].y); y <= high(points[i].y); ++y)
          for (std::int32_t x = low(points[i].x); x <= high(points[i].x); ++x)
            for (const std::uint32_t j : at(x, y, z))
              if (j != i) found.emplace_back(glm::length(points[j] - points[i]), j);
      if (found.size() >= 2 * k || reach >= cells) break;
    }
    std::sort(found.begin(), found.end());
    for (std::size_t n = 0; n < std::min<std::size_t>(k, found.size()); ++n)
      neighbors[i].push_back(found[n].second);
  }
  return neighbors;
}

// Points on the unit sphere by the golden angle, with their five or so nearest.
LeafPatches sphere_patches(std::uint32_t count, std::uint32_t k) {
  LeafPatches leaves;
  for (std::uint32_t i = 0; i < count; ++i) {
    const double z = 1 - (2.0 * i + 1) / count, r = std::sqrt(1 - z * z);
    const double angle = 2.399963229728653 * i;
    leaves.centers.emplace_back(r * std::cos(angle), r * std::sin(angle), z);
  }
  leaves.normals = leaves.centers;
  leaves.radius = static_cast<float>(2.6 / std::sqrt(static_cast<double>(count)));
  leaves.neighbors = nearest(leaves.centers, k);
  make_symmetric(leaves.neighbors);
  return leaves;
}

// Pairs of neighbours, the ones with fewest free neighbours first come first; who finds none stays
// alone, or joins a pair where that is all there is.
std::vector<std::uint32_t> paired(const Neighbors& neighbors) {
  const auto count = static_cast<std::uint32_t>(neighbors.size());
  std::vector<std::uint32_t> group_of(count, kNone);
  std::uint32_t groups = 0;
  for (std::uint32_t i = 0; i < count; ++i) {
    if (group_of[i] != kNone) continue;
    std::uint32_t mate = kNone;
    std::size_t least = count;
    for (const std::uint32_t j : neighbors[i]) {
      if (group_of[j] != kNone) continue;
      std::size_t free = 0;
      for (const std::uint32_t n : neighbors[j]) free += group_of[n] == kNone ? 1 : 0;
      if (free < least) mate = j, least = free;
    }
    if (mate == kNone && !neighbors[i].empty() && groups > 0) {
      group_of[i] = group_of[neighbors[i][0]];
      continue;
    }
    group_of[i] = groups;
    if (mate != kNone) group_of[mate] = groups;
    ++groups;
  }
  return group_of;
}

// Groups that grow around random patches, one to many to a group.
std::vector<std::uint32_t> random_groups(const Neighbors& neighbors, Random& random) {
  const auto count = static_cast<std::uint32_t>(neighbors.size());
  std::vector<std::uint32_t> group_of(count, kNone);
  std::uint32_t groups = 0;
  for (std::uint32_t i = 0; i < count; ++i) {
    if (group_of[i] != kNone) continue;
    const std::uint32_t wanted = random.below(8) == 0 ? 12 : 1 + random.below(4);
    std::vector<std::uint32_t> members{i};
    group_of[i] = groups;
    for (std::size_t m = 0; m < members.size() && members.size() < wanted; ++m)
      for (const std::uint32_t j : neighbors[members[m]])
        if (group_of[j] == kNone && members.size() < wanted) {
          group_of[j] = groups;
          members.push_back(j);
        }
    ++groups;
  }
  return group_of;
}

}  // namespace

PatchTree make_tree(const LeafPatches& leaves, const Grouping& grouping,
                    const SyntheticOptions& options) {
  const Levels levels = order_levels(leaves, grouping);
  PatchTreeData data;
  add_topology(levels, grouping, data.topology);
  const PatchTopology& t = data.topology;
  data.bounds.resize(t.node_count());
  std::vector<std::uint32_t> triangles(t.node_count());
  Random random(options.seed);
  const std::uint32_t level_count = t.level_count();
  for (std::uint32_t h = 0; h < level_count; ++h) {
    const std::uint32_t level = level_count - 1 - h;
    const float error = options.error * std::ldexp(1.0f, static_cast<int>(h) - 1);
    for (std::uint32_t node = t.first_of_level[level]; node < t.first_of_level[level + 1]; ++node) {
      if (h > 0) {
        add_inner_node(data, triangles, node, random, error);
        continue;
      }
      const std::uint32_t leaf = levels.order[0][node - t.first_of_level[level]];
      data.bounds[node].ball = {leaves.centers[leaf], leaves.radius};
      data.bounds[node].cone = {leaves.normals[leaf], std::cos(0.1f), std::sin(0.1f)};
      const std::uint32_t spread = options.leaf_triangles / 8;
      triangles[node] = options.leaf_triangles - spread + random.below(2 * spread + 1);
    }
  }
  for (PatchBounds& bounds : data.bounds) {
    if (options.nests || bounds.error == 0) continue;
    bounds.ball.radius *= static_cast<float>(2 * random.uniform());
    bounds.error *= static_cast<float>(2 * random.uniform());
    bounds.mean_squared *= static_cast<float>(2 * random.uniform());
    bounds.cone.axis = -bounds.cone.axis;
  }
  data.offsets.resize(t.node_count() + 1);
  for (std::uint32_t node = 0; node < t.node_count(); ++node) {
    data.offsets[node + 1].triangle = data.offsets[node].triangle + triangles[node];
    data.offsets[node + 1].vertex = data.offsets[node].vertex + triangles[node] / 2 + 9;
  }
  return PatchTree(std::move(data));
}

PatchTree planet_tree(std::uint32_t leaves, const SyntheticOptions& options) {
  const LeafPatches patches = sphere_patches(leaves, 6);
  Grouping grouping;
  for (Neighbors neighbors = patches.neighbors; neighbors.size() > 1;) {
    grouping.push_back(paired(neighbors));
    neighbors = lifted(neighbors, grouping.back(), count_groups(grouping.back()));
  }
  return make_tree(patches, grouping, options);
}

PatchTree torus_tree(std::uint32_t a, std::uint32_t b, const SyntheticOptions& options) {
  LeafPatches leaves;
  const std::uint32_t columns = 1u << a, rows = 1u << b;
  constexpr double kTurn = 6.283185307179586;
  for (std::uint32_t j = 0; j < rows; ++j) {
    for (std::uint32_t i = 0; i < columns; ++i) {
      const double u = kTurn * i / columns, v = kTurn * j / rows;
      const Vec3 normal(std::cos(u) * std::cos(v), std::sin(u) * std::cos(v), std::sin(v));
      leaves.normals.push_back(normal);
      leaves.centers.push_back(Vec3(std::cos(u), std::sin(u), 0) + 0.4f * normal);
      auto& around = leaves.neighbors.emplace_back();
      for (std::uint32_t dj = 0; dj < 3; ++dj)
        for (std::uint32_t di = 0; di < 3; ++di) {
          const std::uint32_t other =
              (j + dj + rows - 1) % rows * columns + (i + di + columns - 1) % columns;
          if (other != j * columns + i) around.push_back(other);
        }
    }
  }
  make_symmetric(leaves.neighbors);
  leaves.radius = static_cast<float>(kTurn * std::max(1.4 / columns, 0.4 / rows));
  Grouping grouping;
  for (std::uint32_t w = columns, h = rows; w * h > 1;) {
    const bool across = w >= h;
    auto& group_of = grouping.emplace_back();
    for (std::uint32_t j = 0; j < h; ++j)
      for (std::uint32_t i = 0; i < w; ++i)
        group_of.push_back(across ? j * (w / 2) + i / 2 : j / 2 * w + i);
    (across ? w : h) /= 2;
  }
  return make_tree(leaves, grouping, options);
}

PatchTree irregular_tree(std::uint64_t seed) {
  Random random(seed);
  LeafPatches leaves = sphere_patches(2 + random.below(300), 3 + random.below(4));
  if (random.below(3) == 0) {  // cut in two
    for (std::uint32_t i = 0; i < leaves.centers.size(); ++i)
      std::erase_if(leaves.neighbors[i], [&](std::uint32_t j) {
        return (leaves.centers[i].x > 0) != (leaves.centers[j].x > 0);
      });
  }
  const std::uint32_t roots = 1 + random.below(6);
  Grouping grouping;
  for (Neighbors neighbors = leaves.neighbors; neighbors.size() > roots && grouping.size() < 14;) {
    auto& group_of = grouping.emplace_back(neighbors.size());
    std::iota(group_of.begin(), group_of.end(), 0u);
    if (random.below(5) != 0) group_of = random_groups(neighbors, random);
    neighbors = lifted(neighbors, group_of, count_groups(group_of));
  }
  SyntheticOptions options;
  options.seed = seed;
  options.leaf_triangles = 8 + random.below(100);
  options.error = 0.002f;
  options.nests = seed % 4 != 0;
  return make_tree(leaves, grouping, options);
}

const std::vector<NamedTree>& small_trees() {
  static const std::vector<NamedTree> trees = [] {
    std::vector<NamedTree> all;
    const auto add = [&](std::string name, PatchTree tree) {
      all.push_back({std::move(name), std::make_shared<const PatchTree>(std::move(tree))});
    };
    SyntheticOptions options;
    options.error = 0.002f;
    add("nothing", PatchTree());
    add("one leaf", planet_tree(1, options));
    add("two roots", make_tree(sphere_patches(2, 1), {}, options));
    add("chain",
        make_tree(sphere_patches(1, 1), {{0}, {0}, {0}, {0}, {0}, {0}, {0}, {0}}, options));
    add("two chains", make_tree(sphere_patches(2, 1), {{0, 1}, {0, 1}, {1, 0}}, options));
    add("star", make_tree(sphere_patches(100, 5), {std::vector<std::uint32_t>(100, 0)}, options));
    add("planet of 64", planet_tree(64, options));
    add("planet of 300", planet_tree(300, options));
    add("torus of 256", torus_tree(4, 4, options));
    for (std::uint64_t seed = 1; seed <= 24; ++seed)
      add("irregular " + std::to_string(seed), irregular_tree(seed));
    return all;
  }();
  return trees;
}

}  // namespace varifold::test
