#include <varifold/models/patch_tree/patch_tree.h>

#include <varifold/mesh/vertex_arrays.h>
#include <varifold/models/common/level_search.h>
#include <varifold/models/common/uniform_model.h>
#include <algorithm>
#include <utility>

namespace varifold {

static_assert(LeveledModel<PatchTree>);

namespace {

template <class T>
std::size_t bytes_of(const std::vector<T>& values) {
  return values.size() * sizeof(T);
}

}  // namespace

PatchTree::PatchTree(PatchTreeData data) : data_(std::move(data)) {
  const PatchTopology& t = data_.topology;
  level_errors_.assign(t.level_count(), 0);
  for (std::uint32_t level = 0; level < t.level_count(); ++level)
    for (std::uint32_t node = t.first_of_level[level]; node < t.first_of_level[level + 1]; ++node)
      level_errors_[level] = std::max(level_errors_[level], data_.bounds[node].error);
}

std::uint32_t PatchTree::level_of(std::uint32_t node) const {
  const std::vector<std::uint32_t>& first = data_.topology.first_of_level;
  return static_cast<std::uint32_t>(std::upper_bound(first.begin(), first.end(), node) -
                                    first.begin() - 1);
}

std::uint32_t PatchTree::vertex_count(std::uint32_t level) const {
  const PatchTopology& t = data_.topology;
  if (level >= t.level_count()) return 0;
  return data_.offsets[t.first_of_level[level + 1]].vertex -
         data_.offsets[t.first_of_level[level]].vertex;
}

std::uint32_t PatchTree::triangle_count(std::uint32_t level) const {
  const PatchTopology& t = data_.topology;
  if (level >= t.level_count()) return 0;
  return data_.offsets[t.first_of_level[level + 1]].triangle -
         data_.offsets[t.first_of_level[level]].triangle;
}

std::uint32_t PatchTree::level_for_triangles(std::uint32_t count) const {
  return last_level(finest_level(),
                    [&](std::uint32_t level) { return triangle_count(level) <= count; });
}

std::uint32_t PatchTree::level_for_vertices(std::uint32_t count) const {
  return last_level(finest_level(),
                    [&](std::uint32_t level) { return vertex_count(level) <= count; });
}

std::uint32_t PatchTree::level_for_error(float bound) const {
  std::uint32_t level = 0;
  while (level < finest_level() && !(error(level) <= bound)) ++level;
  return level;
}

std::uint32_t PatchTree::level_for_fraction(float fraction) const {
  if (fraction >= 1) return finest_level();
  const double least = vertex_count(0), most = vertex_count(finest_level());
  const double wanted = least + std::max(0.0f, fraction) * (most - least);
  return last_level(finest_level(),
                    [&](std::uint32_t level) { return vertex_count(level) <= wanted; });
}

std::size_t PatchTree::bytes() const {
  const PatchTopology& t = data_.topology;
  return bytes_of(t.first_of_level) + bytes_of(t.parent) + bytes_of(t.first_child) +
         bytes_of(t.first_neighbor) + bytes_of(t.neighbors) + bytes_of(data_.bounds) +
         bytes_of(data_.offsets) + vertex_bytes(data_.vertices) + bytes_of(data_.survivors) +
         bytes_of(data_.controllers) + bytes_of(data_.corners) + bytes_of(data_.ranges) +
         bytes_of(level_errors_);
}

}  // namespace varifold
