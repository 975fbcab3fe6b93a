#include <varifold/models/pm/progressive_mesh.h>

#include <varifold/mesh/vertex_arrays.h>
#include <varifold/models/common/level_search.h>
#include <algorithm>
#include <cmath>

namespace varifold {

ProgressiveMesh::ProgressiveMesh(ProgressiveMeshData data) : data_(std::move(data)) {
  checkpoints_.reserve(data_.splits.size() / kCheckpoint + 1);
  Counts counts{data_.base_vertices, data_.base_triangles, 0};
  for (std::size_t i = 0; i <= data_.splits.size(); ++i) {
    if (i % kCheckpoint == 0) checkpoints_.push_back(counts);
    if (i == data_.splits.size()) break;
    counts.vertices += data_.splits[i].vertices;
    counts.triangles += data_.splits[i].triangles;
    counts.slots += data_.splits[i].slots;
  }
}

ProgressiveMesh::Counts ProgressiveMesh::counts(std::uint32_t level) const {
  if (checkpoints_.empty()) return {0, 0, 0};
  Counts counts = checkpoints_[level / kCheckpoint];
  for (std::uint32_t i = level - level % kCheckpoint; i < level; ++i) {
    counts.vertices += data_.splits[i].vertices;
    counts.triangles += data_.splits[i].triangles;
    counts.slots += data_.splits[i].slots;
  }
  return counts;
}

std::uint32_t ProgressiveMesh::vertex_count(std::uint32_t level) const {
  return counts(level).vertices;
}

std::uint32_t ProgressiveMesh::triangle_count(std::uint32_t level) const {
  return counts(level).triangles;
}

std::uint32_t ProgressiveMesh::level_for_triangles(std::uint32_t count) const {
  return last_level(finest_level(), [&](std::uint32_t k) { return triangle_count(k) <= count; });
}

std::uint32_t ProgressiveMesh::level_for_vertices(std::uint32_t count) const {
  return last_level(finest_level(), [&](std::uint32_t k) { return vertex_count(k) <= count; });
}

std::uint32_t ProgressiveMesh::level_for_error(float bound) const {
  const auto first = std::partition_point(data_.error.begin(), data_.error.end(),
                                          [&](float e) { return e > bound; });
  return std::min(static_cast<std::uint32_t>(first - data_.error.begin()), finest_level());
}

std::uint32_t ProgressiveMesh::level_for_fraction(float fraction) const {
  const double base = data_.base_vertices;
  const double all = data_.mesh.vertex_count();
  const double clamped = std::clamp(static_cast<double>(fraction), 0.0, 1.0);
  return level_for_vertices(static_cast<std::uint32_t>(std::floor(base + clamped * (all - base))));
}

std::uint32_t ProgressiveMesh::ancestor(std::uint32_t vertex, std::uint32_t level) const {
  const std::uint32_t live = vertex_count(level);
  while (vertex >= live) vertex = data_.target[vertex];
  return vertex;
}

std::size_t ProgressiveMesh::bytes() const {
  const auto words = data_.slots.size() + data_.target.size() + data_.triangle_level.size() +
                     data_.first_placed.size() + data_.placed_vertex.size() + data_.finer.size();
  return vertex_bytes(data_.mesh) + vertex_bytes(data_.placed) +
         data_.mesh.indices.size() * sizeof(std::uint32_t) +
         data_.splits.size() * sizeof(VertexSplit) + data_.error.size() * sizeof(float) +
         words * sizeof(std::uint32_t) + checkpoints_.size() * sizeof(Counts);
}

}  // namespace varifold
