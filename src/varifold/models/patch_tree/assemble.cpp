#include <varifold/models/patch_tree/assemble.h>

#include <varifold/base/parallel.h>
#include <varifold/mesh/blended_normals.h>
#include <varifold/mesh/vertex_arrays.h>
#include <algorithm>
#include <cmath>

namespace varifold {

namespace {

// Rounding must not leave a child outside.
constexpr float kRounding = 1 + 1e-5f;

template <class T>
void append(std::vector<T>& to, const std::vector<T>& from) {
  to.insert(to.end(), from.begin(), from.end());
}

class Assembler {
 public:
  Assembler(const TriangleMesh& mesh, std::span<const Pose> samples, const WorkingSurface& surface,
            std::vector<AssembledLevel>& levels, int threads)
      : mesh_(mesh),
        samples_(samples),
        surface_(surface),
        levels_(levels),
        threads_(threads),
        sampled_(samples.size()) {}

  PatchTreeData assemble() {
    tree_.vertices.materials = mesh_.materials;
    tree_.vertices.images = mesh_.images;
    number_nodes();
    make_room();
    tree_.offsets.emplace_back();
    for (std::size_t l = levels_.size(); l-- > 0;) {
      add_blocks(l);
      levels_[l].blocks = {};
    }
    find_shapes();
    find_bounds();
    return std::move(tree_);
  }

 private:
  [[nodiscard]] std::uint32_t first_node(std::size_t level) const {
    return tree_.topology.first_of_level[levels_.size() - 1 - level];
  }
  void number_nodes();
  void make_room();
  void link_level(std::size_t level);
  void add_neighbors(std::size_t level);
  void add_blocks(std::size_t level);
  void add_vertices(const LevelBlocks& blocks, std::size_t first);
  void find_shapes();
  void find_bounds();
  void bound_leaf(std::uint32_t node);
  void bound_parent(std::uint32_t node);
  void add_normals(std::uint32_t node, std::vector<Vec3>& normals) const;

  const TriangleMesh& mesh_;
  std::span<const Pose> samples_;
  const WorkingSurface& surface_;
  std::vector<AssembledLevel>& levels_;
  int threads_;
  PatchTreeData tree_;
  std::vector<std::vector<Vec3>> sampled_;     // the places of all vertices in each sample
  std::vector<std::span<const Vec3>> shapes_;  // in all shapes
  // Per level and patch of it: the neighbours that move vertices of its children, ascending.
  std::vector<std::vector<std::vector<std::uint32_t>>> movers_;
};

void Assembler::number_nodes() {
  PatchTopology& t = tree_.topology;
  t.first_of_level.push_back(0);
  for (std::size_t l = levels_.size(); l-- > 0;)
    t.first_of_level.push_back(t.first_of_level.back() + levels_[l].blocks.patch_count());
  movers_.resize(levels_.size());
  for (std::size_t l = 0; l < levels_.size(); ++l)
    movers_[l].resize(levels_[l].blocks.patch_count());
  // The children of the nodes of a level are all nodes of the next, in order.
  t.first_neighbor.push_back(0);
  for (std::size_t l = levels_.size(); l-- > 0;) link_level(l);
  t.first_child.push_back(t.node_count());
}

void Assembler::make_room() {
  PatchOffsets sum;
  for (const AssembledLevel& level : levels_) {
    const PatchOffsets& end = level.blocks.offsets.back();
    sum = {sum.vertex + end.vertex, sum.triangle + end.triangle, sum.controller + end.controller,
           sum.range + end.range};
  }
  tree_.offsets.reserve(tree_.topology.node_count() + 1);
  tree_.survivors.reserve(sum.vertex);
  tree_.corners.reserve(3 * std::size_t{sum.triangle});
  tree_.controllers.reserve(sum.controller);
  tree_.ranges.reserve(sum.range);
  TriangleMesh& vertices = tree_.vertices;
  copy_pose_names(mesh_, vertices);
  for_each_vertex_array(mesh_, vertices, [&](const auto& from, auto& to) {
    if (!from.empty()) to.resize(sum.vertex);
  });
  for (auto& places : sampled_) places.resize(sum.vertex);
}

void Assembler::link_level(std::size_t level) {
  PatchTopology& t = tree_.topology;
  const std::uint32_t patches = levels_[level].blocks.patch_count();
  const std::vector<std::uint32_t>& parent = levels_[level].parent;
  for (std::uint32_t p = 0; p < patches; ++p)
    t.parent.push_back(parent.empty() ? kNone : first_node(level + 1) + parent[p]);
  if (level == 0) {
    t.first_child.insert(t.first_child.end(), patches, t.first_of_level.back());
  } else {
    const std::vector<std::uint32_t> first = first_children(levels_[level - 1], patches);
    for (std::uint32_t p = 0; p < patches; ++p)
      t.first_child.push_back(first_node(level - 1) + first[p]);
  }
  add_neighbors(level);
}

void Assembler::add_neighbors(std::size_t level) {
  PatchTopology& t = tree_.topology;
  const std::uint32_t first = first_node(level);
  auto& movers = movers_[level];
  if (level > 0) {
    const AssembledLevel& finer = levels_[level - 1];
    for (std::uint32_t c = 0; c < finer.blocks.patch_count(); ++c)
      for (std::uint32_t i = finer.blocks.offsets[c].controller;
           i < finer.blocks.offsets[c + 1].controller; ++i)
        movers[finer.parent[c]].push_back(finer.blocks.controllers[i]);
  }
  for (std::uint32_t p = 0; p < movers.size(); ++p) {
    std::sort(movers[p].begin(), movers[p].end());
    movers[p].erase(std::unique(movers[p].begin(), movers[p].end()), movers[p].end());
    for (const std::uint32_t n : movers[p]) t.neighbors.push_back(first + n);
    for (const std::uint32_t n : levels_[level].neighbors.of(p))
      if (!std::binary_search(movers[p].begin(), movers[p].end(), n))
        t.neighbors.push_back(first + n);
    t.first_neighbor.push_back(static_cast<std::uint32_t>(t.neighbors.size()));
  }
}

void Assembler::add_blocks(std::size_t level) {
  LevelBlocks& blocks = levels_[level].blocks;
  const PatchOffsets base = tree_.offsets.back();
  for (std::size_t p = 1; p < blocks.offsets.size(); ++p) {
    const PatchOffsets& end = blocks.offsets[p];
    tree_.offsets.push_back({base.vertex + end.vertex, base.triangle + end.triangle,
                             base.controller + end.controller, base.range + end.range});
  }
  for (std::uint32_t p = 0; p < blocks.patch_count(); ++p)
    for (std::uint32_t i = blocks.offsets[p].controller; i < blocks.offsets[p + 1].controller;
         ++i) {
      const auto& movers = movers_[level + 1][levels_[level].parent[p]];
      const auto at = std::lower_bound(movers.begin(), movers.end(), blocks.controllers[i]);
      tree_.controllers.push_back(static_cast<std::uint8_t>(at - movers.begin()));
    }
  if (levels_[level].parent.empty()) {  // roots: their own numbers
    blocks.parent_vertex.resize(blocks.wedges.size());
    for (std::uint32_t p = 0; p < blocks.patch_count(); ++p)
      for (std::uint32_t v = blocks.offsets[p].vertex; v < blocks.offsets[p + 1].vertex; ++v)
        blocks.parent_vertex[v] = static_cast<std::uint16_t>(v - blocks.offsets[p].vertex);
  }
  append(tree_.survivors, blocks.parent_vertex);
  append(tree_.corners, blocks.corners);
  append(tree_.ranges, blocks.ranges);
  add_vertices(blocks, base.vertex);
}

void Assembler::add_vertices(const LevelBlocks& blocks, std::size_t first) {
  TriangleMesh& out = tree_.vertices;
  const std::vector<std::uint32_t>& vertex_of =
      surface_.wedge.vertex_of.empty() ? surface_.first_vertex_of_point : surface_.wedge.vertex_of;
  parallel_for(threads_, blocks.wedges.size(), 16384, [&](std::size_t begin, std::size_t end) {
    const auto gather = [&](const auto& from, auto& to) {
      if (from.empty()) return;
      for (std::size_t i = begin; i < end; ++i) to[first + i] = from[vertex_of[blocks.wedges[i]]];
    };
    for_each_vertex_array(mesh_, out, gather);
    for (std::size_t s = 0; s < sampled_.size(); ++s) gather(samples_[s].positions, sampled_[s]);
  });
}

void Assembler::find_shapes() {
  shapes_.emplace_back(tree_.vertices.positions);
  for (const Pose& pose : tree_.vertices.poses) shapes_.emplace_back(pose.positions);
  for (const auto& places : sampled_) shapes_.emplace_back(places);
}

// Leaves first: what is known of children bounds their parent.
void Assembler::find_bounds() {
  tree_.bounds.resize(tree_.topology.node_count());
  for (std::size_t level = 0; level < levels_.size(); ++level)
    parallel_for(threads_, levels_[level].neighbors.first.size() - 1, 16,
                 [&](std::size_t begin, std::size_t end) {
                   for (auto p = static_cast<std::uint32_t>(begin); p < end; ++p) {
                     if (level == 0)
                       bound_leaf(first_node(level) + p);
                     else
                       bound_parent(first_node(level) + p);
                   }
                 });
  // Errors: each level's own, and no less than those below.
  const float scale = static_cast<float>(1 / surface_.scale);
  for (std::size_t level = 1; level < levels_.size(); ++level)
    for (std::uint32_t p = 0; p < levels_[level].neighbors.first.size() - 1; ++p) {
      const std::uint32_t node = first_node(level) + p;
      PatchBounds& bounds = tree_.bounds[node];
      bounds.error = levels_[level - 1].error_of_parent[p] * scale;
      bounds.mean_squared = levels_[level - 1].mean_squared_of_parent[p] * scale * scale;
      for (std::uint32_t c = tree_.topology.first_child[node];
           c < tree_.topology.first_child[node + 1]; ++c) {
        bounds.error = std::max(bounds.error, tree_.bounds[c].error);
        bounds.mean_squared = std::max(bounds.mean_squared, tree_.bounds[c].mean_squared);
      }
    }
}

void Assembler::add_normals(std::uint32_t node, std::vector<Vec3>& normals) const {
  const PatchOffsets& at = tree_.offsets[node];
  for (std::size_t t = at.triangle; t < tree_.offsets[node + 1].triangle; ++t) {
    const std::uint16_t* c = &tree_.corners[3 * t];
    blended_normals(shapes_, {at.vertex + c[0], at.vertex + c[1], at.vertex + c[2]}, normals);
  }
}

void Assembler::bound_leaf(std::uint32_t node) {
  PatchBounds& bounds = tree_.bounds[node];
  const std::uint32_t first = tree_.offsets[node].vertex, last = tree_.offsets[node + 1].vertex;
  Box box;
  for (const auto& places : shapes_)
    for (std::uint32_t v = first; v < last; ++v) box.add(places[v]);
  bounds.ball = {box.center(), 0};
  for (const auto& places : shapes_)
    for (std::uint32_t v = first; v < last; ++v)
      bounds.ball.radius =
          std::max(bounds.ball.radius, glm::length(places[v] - bounds.ball.center));
  bounds.ball.radius *= kRounding;
  std::vector<Vec3> normals;
  add_normals(node, normals);
  bounds.cone = cone_around(normals);
}

// The vertices of a patch are vertices of its children.
void Assembler::bound_parent(std::uint32_t node) {
  const PatchTopology& t = tree_.topology;
  PatchBounds& bounds = tree_.bounds[node];
  Box box;
  Vec3 axis(0);
  for (std::uint32_t c = t.first_child[node]; c < t.first_child[node + 1]; ++c) {
    const PatchBounds& child = tree_.bounds[c];
    box.add(child.ball.center - Vec3(child.ball.radius));
    box.add(child.ball.center + Vec3(child.ball.radius));
    axis += child.cone.axis;
  }
  bounds.ball = {box.center(), 0};
  std::vector<Vec3> normals;
  add_normals(node, normals);
  NormalCone cone = cone_around(normals);
  cone.axis = normalize_or_zero(axis);
  for (const Vec3& n : normals)
    if (n != Vec3(0)) cone.cosine = std::min(cone.cosine, glm::dot(n, cone.axis) - 1e-6f);
  for (std::uint32_t c = t.first_child[node]; c < t.first_child[node + 1]; ++c) {
    const PatchBounds& child = tree_.bounds[c];
    bounds.ball.radius =
        std::max(bounds.ball.radius,
                 (glm::length(child.ball.center - bounds.ball.center) + child.ball.radius));
    const float turn = std::clamp(glm::dot(child.cone.axis, cone.axis), -1.0f, 1.0f);
    const float sine = std::sqrt(1 - turn * turn);
    const bool wide = sine * child.cone.cosine + turn * child.cone.sine < 0;
    cone.cosine =
        wide ? -1
             : std::min(cone.cosine, turn * child.cone.cosine - sine * child.cone.sine - 1e-6f);
  }
  bounds.ball.radius *= kRounding;
  if (cone.axis == Vec3(0) || cone.cosine <= -1) cone = NormalCone();
  cone.sine = std::sqrt(std::max(0.0f, 1 - cone.cosine * cone.cosine));
  bounds.cone = cone;
}

}  // namespace

std::vector<std::uint32_t> first_children(const AssembledLevel& level, std::uint32_t parent_count) {
  std::vector<std::uint32_t> first(parent_count + 1, 0);
  for (const std::uint32_t parent : level.parent) ++first[parent + 1];
  for (std::size_t i = 1; i < first.size(); ++i) first[i] += first[i - 1];
  return first;
}

PatchTreeData assemble(const TriangleMesh& mesh, std::span<const Pose> samples,
                       const WorkingSurface& surface, std::vector<AssembledLevel> levels,
                       int threads) {
  return Assembler(mesh, samples, surface, levels, threads).assemble();
}

PatchTreeData empty_tree(const TriangleMesh& mesh) {
  PatchTreeData tree;
  copy_pose_names(mesh, tree.vertices);
  tree.vertices.materials = mesh.materials;
  tree.vertices.images = mesh.images;
  tree.topology.first_of_level = {0};
  tree.topology.first_child = {0};
  tree.topology.first_neighbor = {0};
  tree.offsets.emplace_back();
  return tree;
}

}  // namespace varifold
