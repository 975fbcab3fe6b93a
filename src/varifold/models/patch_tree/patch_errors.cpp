#include <varifold/models/patch_tree/patch_errors.h>

#include <varifold/base/parallel.h>
#include <varifold/models/patch_tree/mean_value_map.h>
#include <algorithm>

namespace varifold {

void add_errors(AssembledLevel& level, const LevelErrors& errors, const WorkingSurface& surface,
                int threads) {
  const LevelBlocks& blocks = level.blocks;
  const std::uint32_t parents = level.parent.back() + 1;
  const std::vector<std::uint32_t> first_child = first_children(level, parents);
  const auto point_of = [&](std::uint32_t wedge) {
    return surface.wedge.has_seams() ? surface.wedge.point_of[wedge] : wedge;
  };
  level.error_of_parent.assign(parents, 0);
  level.mean_squared_of_parent.assign(parents, 0);
  parallel_for(threads, parents, 1, [&](std::size_t parent, std::size_t) {
    const std::uint32_t first = blocks.offsets[first_child[parent]].vertex;
    const std::uint32_t last = blocks.offsets[first_child[parent + 1]].vertex;
    double sum = 0;
    float greatest = 0;
    for (std::uint32_t v = first; v < last; ++v) {
      sum += errors.squared_step(point_of(blocks.wedges[v]));
      greatest = std::max(greatest, errors.greatest(point_of(blocks.survivors[v])));
    }
    level.error_of_parent[parent] = greatest;
    level.mean_squared_of_parent[parent] = static_cast<float>(sum / std::max(1u, last - first));
  });
}

void add_mean_value_errors(AssembledLevel& level, const LevelErrors& errors,
                           const WorkingSurface& surface, int threads) {
  const LevelBlocks& blocks = level.blocks;
  const std::uint32_t parents = level.parent.back() + 1;
  const std::vector<std::uint32_t> first_child = first_children(level, parents);
  const auto point_of = [&](std::uint32_t wedge) {
    return surface.wedge.has_seams() ? surface.wedge.point_of[wedge] : wedge;
  };
  parallel_for(threads, parents, 1, [&](std::size_t parent, std::size_t) {
    // The points of all children, each once.
    std::vector<std::uint32_t> points;
    for (std::uint32_t v = blocks.offsets[first_child[parent]].vertex;
         v < blocks.offsets[first_child[parent + 1]].vertex; ++v)
      points.push_back(point_of(blocks.wedges[v]));
    std::sort(points.begin(), points.end());
    points.erase(std::unique(points.begin(), points.end()), points.end());
    std::vector<Vec3> positions;
    positions.reserve(points.size());
    for (const std::uint32_t p : points) positions.push_back(surface.points[p].position);
    const auto local = [&](std::uint32_t point) {
      return static_cast<std::uint32_t>(std::lower_bound(points.begin(), points.end(), point) -
                                        points.begin());
    };
    std::vector<std::uint32_t> corners;
    std::vector<std::uint8_t> is_locked(points.size(), 0);
    for (std::uint32_t c = first_child[parent]; c < first_child[parent + 1]; ++c) {
      const PatchOffsets &at = blocks.offsets[c], &end = blocks.offsets[c + 1];
      for (std::uint32_t i = 3 * at.triangle; i < 3 * end.triangle; ++i)
        corners.push_back(local(point_of(blocks.wedges[at.vertex + blocks.corners[i]])));
      for (std::uint32_t v = at.vertex; v < end.vertex; ++v)
        if (point_of(blocks.survivors[v]) == point_of(blocks.wedges[v]))
          is_locked[local(point_of(blocks.wedges[v]))] = 1;
    }
    std::vector<float> squared(points.size());
    map_by_mean_values({corners, positions, is_locked}, squared);
    double sum = 0;
    std::uint32_t count = 0;
    for (std::uint32_t v = blocks.offsets[first_child[parent]].vertex;
         v < blocks.offsets[first_child[parent + 1]].vertex; ++v, ++count) {
      const std::uint32_t point = point_of(blocks.wedges[v]);
      const float mapped = squared[local(point)];
      sum += mapped >= 0 ? mapped : errors.squared_step(point);
    }
    level.mean_squared_of_parent[parent] = static_cast<float>(sum / std::max(1u, count));
  });
}

}  // namespace varifold
