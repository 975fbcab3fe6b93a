// The strips of the base, from which all others grow.
#include <varifold/strip/adjacency.h>
#include <varifold/strip/sequence_strips.h>
#include <varifold/strip/stripify.h>
#include <algorithm>
#include <array>

namespace varifold {

namespace {

using Corners = std::array<std::uint32_t, 3>;

Corners least_first(Corners corners) {
  std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()), corners.end());
  return corners;
}

// The base as a mesh of its own; `triangles` are those of it in the full mesh.
TriangleMesh base_mesh(const DetailedMesh& detailed, const std::vector<std::uint32_t>& corners,
                       std::vector<std::uint32_t>& triangles) {
  TriangleMesh base;
  const std::uint32_t vertices =
      detailed.sequence.vertices.empty() ? 0 : detailed.sequence.vertices[0];
  base.positions.assign(detailed.mesh.positions.begin(),
                        detailed.mesh.positions.begin() + vertices);
  base.materials = detailed.mesh.materials;
  const auto append = [&](std::uint32_t first, std::uint32_t count) {
    for (std::uint32_t t = first; t < first + count; ++t) {
      if (detailed.sequence.triangle_level[t] != 0) continue;
      triangles.push_back(t);
      const std::uint32_t* const first_corner = &corners[3 * std::size_t{t}];
      base.indices.insert(base.indices.end(), first_corner, first_corner + 3);
    }
  };
  if (detailed.mesh.ranges.empty()) append(0, detailed.mesh.triangle_count());
  for (const MaterialRange& range : detailed.mesh.ranges) {
    const std::uint32_t before = base.triangle_count();
    append(range.first_triangle, range.triangle_count);
    base.ranges.push_back({range.material, before, base.triangle_count() - before});
  }
  return base;
}

}  // namespace

void SequenceStrips::load_base(const DetailedMesh& detailed) {
  std::vector<std::uint32_t> triangles;
  const TriangleMesh base = base_mesh(detailed, corners_, triangles);
  const std::vector<std::uint32_t> across = edge_adjacency(base);
  for (std::uint32_t h = 0; h < across.size(); ++h)
    if (across[h] != kNone) neighbor_[3 * triangles[h / 3] + h % 3] = triangles[across[h] / 3];
  load_strips(base, triangles);
}

// As many strips in a block as it holds.
void SequenceStrips::load_strips(const TriangleMesh& base,
                                 const std::vector<std::uint32_t>& triangles) {
  struct Known {
    Corners corners;
    std::uint32_t triangle;
  };
  std::vector<Known> known;
  known.reserve(triangles.size());
  for (const std::uint32_t t : triangles) {
    const std::uint32_t* const corner = corners_of(t);
    known.push_back({least_first({corner[0], corner[1], corner[2]}), t});
  }
  const auto less = [](const Known& a, const Known& b) { return a.corners < b.corners; };
  std::stable_sort(known.begin(), known.end(), less);
  const auto take = [&](const Corners& corners) {
    auto found = std::lower_bound(known.begin(), known.end(), Known{least_first(corners), 0}, less);
    // Where a triangle stands twice, so do its strips.
    while (block_of_[found->triangle] != kNone) ++found;
    return found->triangle;
  };

  StripifyOptions options;
  options.max_indices = kMaxSlots - 4;  // a split may add so many before it must cut
  const TriangleStrips strips = stripify(base, options);
  for (std::uint32_t s = 0; s < strips.count(); ++s) {
    const auto strip = strips.strip(s);
    std::uint32_t& b = last_block_[strips.range[s]];
    if (b == kNone || blocks_[b].count + 1 + strip.size() > kMaxSlots) {
      b = block_count();
      new_block(strips.range[s]);
    }
    Block& block = blocks_[b];
    std::fill_n(block.triangle + block.count, kMaxSlots - block.count, kNone);
    if (block.count > 0) block.slots[block.count++] = kStripRestart;
    for (std::size_t i = 0; i + 2 < strip.size(); ++i)
      if (const Corners corners = strip_triangle(strip, i); !is_degenerate(corners))
        set_triangle(b, block.count + static_cast<std::uint32_t>(i), take(corners));
    std::copy(strip.begin(), strip.end(), block.slots + block.count);
    block.count += static_cast<std::uint32_t>(strip.size());
    block.most = block.count;
  }
}

}  // namespace varifold
