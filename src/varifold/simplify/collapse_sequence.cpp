#include <varifold/simplify/collapse_sequence.h>

#include <varifold/mesh/vertex_arrays.h>
#include <algorithm>

namespace varifold {

std::vector<std::uint32_t> CollapseSequence::ancestors(std::uint32_t level) const {
  std::vector<std::uint32_t> result(target.size());
  const std::uint32_t live = vertices[level];
  for (std::uint32_t v = 0; v < result.size(); ++v) result[v] = v < live ? v : result[target[v]];
  return result;
}

std::vector<std::span<const Vec3>> DetailedMesh::shapes() const {
  std::vector<std::span<const Vec3>> result{mesh.positions};
  for (const Pose& pose : mesh.poses) result.emplace_back(pose.positions);
  for (const Pose& sample : samples) result.emplace_back(sample.positions);
  return result;
}

namespace {

std::uint32_t last_at_most(const std::vector<std::uint32_t>& ascending, std::uint32_t bound) {
  const auto end = std::upper_bound(ascending.begin(), ascending.end(), bound);
  return end == ascending.begin() ? 0 : static_cast<std::uint32_t>(end - ascending.begin() - 1);
}

template <class T>
void copy_attribute(const std::vector<T>& from, std::uint32_t index, std::vector<T>& to,
                    std::uint32_t vertex) {
  if (!from.empty()) to[vertex] = from[index];
}

}  // namespace

std::uint32_t CollapseSequence::level_for_triangles(std::uint32_t count) const {
  return last_at_most(triangles, count);
}

std::uint32_t CollapseSequence::level_for_vertices(std::uint32_t count) const {
  return last_at_most(vertices, count);
}

std::uint32_t CollapseSequence::level_for_error(float bound) const {
  const auto found =
      std::partition_point(error.begin(), error.end(), [&](float e) { return e > bound; });
  return std::min(static_cast<std::uint32_t>(found - error.begin()), step_count());
}

void apply_placement(const CollapseSequence& sequence, std::uint32_t level, TriangleMesh& mesh) {
  if (!sequence.moves_vertices()) return;
  for (std::uint32_t k = sequence.step_count(); k-- > level;) {
    for (std::uint32_t j = sequence.first_placed[k]; j < sequence.first_placed[k + 1]; ++j) {
      const std::uint32_t v = sequence.placed_vertex[j];
      copy_attribute(sequence.placed.positions, j, mesh.positions, v);
      copy_attribute(sequence.placed.normals, j, mesh.normals, v);
      copy_attribute(sequence.placed.texcoords, j, mesh.texcoords, v);
      copy_attribute(sequence.placed.colors, j, mesh.colors, v);
    }
  }
}

TriangleMesh mesh_at_level(const DetailedMesh& detailed, std::uint32_t level) {
  const CollapseSequence& sequence = detailed.sequence;
  const TriangleMesh& full = detailed.mesh;
  const std::vector<std::uint32_t> ancestors = sequence.ancestors(level);

  TriangleMesh mesh = full;
  mesh.indices.clear();
  mesh.ranges.clear();
  std::vector<MaterialRange> ranges = full.ranges;
  if (ranges.empty()) ranges.push_back({0, 0, full.triangle_count()});
  for (const MaterialRange& range : ranges) {
    MaterialRange kept{range.material, mesh.triangle_count(), 0};
    for (std::uint32_t t = range.first_triangle; t < range.first_triangle + range.triangle_count;
         ++t) {
      if (sequence.triangle_level[t] > level) break;
      for (int k = 0; k < 3; ++k)
        mesh.indices.push_back(ancestors[full.indices[3 * std::size_t{t} + k]]);
      ++kept.triangle_count;
    }
    if (!full.ranges.empty() && kept.triangle_count > 0) mesh.ranges.push_back(kept);
  }

  apply_placement(sequence, level, mesh);
  cut_vertices(mesh, sequence.vertices[level]);
  return mesh;
}

void cut_below(std::uint32_t level, CollapseSequence& sequence) {
  if (level == 0) return;
  const std::uint32_t base = sequence.vertices[level];
  std::fill_n(sequence.target.begin(), base, kNone);
  const auto drop = [&](auto& values) { values.erase(values.begin(), values.begin() + level); };
  drop(sequence.vertices);
  drop(sequence.triangles);
  drop(sequence.error);
  if (sequence.moves_vertices()) {
    drop(sequence.first_placed);
    const std::uint32_t unused = sequence.first_placed.front();
    for (std::uint32_t& first : sequence.first_placed) first -= unused;
    const auto drop_unused = [&](auto& values) {
      if (!values.empty()) values.erase(values.begin(), values.begin() + unused);
    };
    drop_unused(sequence.placed_vertex);
    for_each_vertex_array(sequence.placed, drop_unused);
  }
  for (std::uint32_t& l : sequence.triangle_level) l = l > level ? l - level : 0;
}

}  // namespace varifold
