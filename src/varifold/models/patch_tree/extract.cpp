#include <varifold/models/patch_tree/extract.h>

#include <varifold/mesh/vertex_arrays.h>
#include <varifold/mesh/weld.h>
#include <algorithm>

namespace varifold {

namespace {

// Merges vertices that are equal in everything, and drops triangles that have no area by that.
class Merger {
 public:
  explicit Merger(TriangleMesh& mesh) : mesh_(mesh), weld_(weld_points(mesh)) {}

  void merge() {
    find_equal();
    std::vector<std::uint32_t> materials = triangle_materials(mesh_);
    std::size_t kept = 0;
    for (std::size_t t = 0; t < mesh_.triangle_count(); ++t) {
      const std::uint32_t* v = &mesh_.indices[3 * t];
      const std::uint32_t a = v[0], b = v[1], c = v[2];
      const auto place = [&](std::uint32_t vertex) { return weld_.class_of[vertex]; };
      if (place(a) == place(b) || place(b) == place(c) || place(c) == place(a)) continue;
      materials[kept] = materials[t];
      const std::uint32_t corners[3] = {a, b, c};
      for (std::size_t k = 0; k < 3; ++k) mesh_.indices[3 * kept + k] = same_[corners[k]];
      ++kept;
    }
    mesh_.indices.resize(3 * kept);
    materials.resize(kept);
    if (!mesh_.ranges.empty()) set_triangle_materials(mesh_, materials);
    mesh_ = without_unused_vertices(mesh_);
  }

 private:
  // same_[v]: the first vertex that equals v.
  void find_equal() {
    std::vector<std::uint32_t> first(weld_.class_count, kNone), next(mesh_.vertex_count(), kNone);
    same_.resize(mesh_.vertex_count());
    for (std::uint32_t v = 0; v < mesh_.vertex_count(); ++v) {
      std::uint32_t* link = &first[weld_.class_of[v]];
      while (*link != kNone && !equal_attributes(mesh_, *link, v)) link = &next[*link];
      if (*link == kNone) *link = v;
      same_[v] = *link;
    }
  }

  TriangleMesh& mesh_;
  WeldMap weld_;
  std::vector<std::uint32_t> same_;
};

// Copies vertices of the tree, each once.
class VertexCopies {
 public:
  VertexCopies(const TriangleMesh& from, TriangleMesh& to)
      : from_(from), to_(to), copy_of_(from.vertex_count(), kNone) {
    copy_pose_names(from, to);
  }
  std::uint32_t operator()(std::uint32_t v) {
    if (copy_of_[v] != kNone) return copy_of_[v];
    copy_of_[v] = to_.vertex_count();
    for_each_vertex_array(from_, to_, [&](const auto& values, auto& copies) {
      if (!values.empty()) copies.push_back(values[v]);
    });
    return copy_of_[v];
  }

 private:
  const TriangleMesh& from_;
  TriangleMesh& to_;
  std::vector<std::uint32_t> copy_of_;
};

}  // namespace

bool is_legal(const PatchTopology& topology, SplitFlags is_split) {
  for (std::uint32_t node = 0; node < topology.node_count(); ++node) {
    if (!is_split[node]) continue;
    const std::uint32_t parent = topology.parent[node];
    if (topology.is_leaf(node) || (parent != kNone && !is_split[parent])) return false;
    for (const std::uint32_t neighbor : topology.neighbors_of(node))
      if (parent != kNone && !is_split[topology.parent[neighbor]]) return false;
  }
  return true;
}

std::uint32_t coarse_neighbors(const PatchTopology& topology, SplitFlags is_split,
                               std::uint32_t node) {
  std::uint32_t mask = 0;
  const auto neighbors = topology.neighbors_of(node);
  const std::size_t count = std::min<std::size_t>(neighbors.size(), kMaxControllers);
  for (std::size_t i = 0; i < count; ++i)
    if (!is_split[neighbors[i]]) mask |= 1u << i;
  return mask;
}

std::uint32_t collapsed_triangles(const PatchTreeData& tree, std::uint32_t node,
                                  std::uint32_t mask) {
  if (mask == 0) return 0;
  const PatchOffsets& at = tree.offsets[node];
  std::size_t first = at.triangle;
  std::uint32_t count = 0;
  for (std::uint32_t r = at.range; r < tree.offsets[node + 1].range; ++r) {
    const PatchRange& range = tree.ranges[r];
    for (std::size_t t = first + range.constant_triangles; t < first + range.triangle_count; ++t) {
      std::uint32_t drawn[3];
      for (std::size_t k = 0; k < 3; ++k)
        drawn[k] = drawn_vertex(tree, node, at.vertex + tree.corners[3 * t + k], mask);
      count += is_collapsed(tree, drawn) ? 1 : 0;
    }
    first += range.triangle_count;
  }
  return count;
}

TriangleMesh extract_front(const PatchTree& tree, SplitFlags is_split, bool switches) {
  const PatchTreeData& data = tree.data();
  TriangleMesh mesh;
  mesh.materials = data.vertices.materials;
  mesh.images = data.vertices.images;
  VertexCopies copy(data.vertices, mesh);
  std::vector<std::uint32_t> materials;
  for (std::uint32_t node = 0; node < tree.node_count(); ++node) {
    if (!is_in_front(data.topology, is_split, node)) continue;
    const std::uint32_t parent = data.topology.parent[node];
    const std::uint32_t mask =
        parent == kNone || !switches ? 0 : coarse_neighbors(data.topology, is_split, parent);
    const PatchOffsets& at = data.offsets[node];
    for (std::size_t i = 3 * std::size_t{at.triangle};
         i < 3 * std::size_t{data.offsets[node + 1].triangle}; ++i)
      mesh.indices.push_back(copy(drawn_vertex(data, node, at.vertex + data.corners[i], mask)));
    for (std::uint32_t r = at.range; r < data.offsets[node + 1].range; ++r)
      materials.insert(materials.end(), data.ranges[r].triangle_count, data.ranges[r].material);
  }
  if (!mesh.materials.empty()) set_triangle_materials(mesh, materials);
  Merger(mesh).merge();
  return mesh;
}

}  // namespace varifold
