#include <varifold/partition/small_regions.h>

#include <varifold/base/disjoint_sets.h>
#include <algorithm>
#include <tuple>

namespace varifold {

namespace {

constexpr float kCells = 2097151.0f;  // steps an axis

std::uint64_t spread_bits(std::uint64_t x) {
  x = (x | x << 32) & 0x001f00000000ffffu;
  x = (x | x << 16) & 0x001f0000ff0000ffu;
  x = (x | x << 8) & 0x100f00f00f00f00fu;
  x = (x | x << 4) & 0x10c30c30c30c30c3u;
  return (x | x << 2) & 0x1249249249249249u;
}

struct Region {
  std::uint32_t representative = 0, triangles = 0, material = 0, group = 0;
  std::uint64_t key = 0;
  Box box;
};

DisjointSets find_regions(const SurfaceView& surface, const EdgeLinks& links,
                          const TriangleGroups& glued) {
  const std::uint32_t n = surface.triangle_count();
  DisjointSets sets(n);
  for (std::uint32_t h = 0; h < 3 * n; ++h)
    if (const std::uint32_t g = links.across_in_material(h); g < h) sets.unite(h / 3, g / 3);
  if (glued.count == 0) return sets;
  std::vector<std::uint32_t> first_of(glued.count, kNone);
  for (std::uint32_t t = 0; t < n; ++t) {
    if (glued.of(t) == kNone) continue;
    if (std::uint32_t& first = first_of[glued.of(t)]; first == kNone)
      first = t;
    else
      sets.unite(first, t);
  }
  return sets;
}

// Packs the regions, in the order of their material and their place, into groups.
std::uint32_t pack(std::vector<Region>& regions, std::uint32_t triangles_per_patch) {
  Box box;
  for (const Region& region : regions) box.add(region.box.center());
  for (Region& region : regions) region.key = morton_code(region.box.center(), box);
  std::sort(regions.begin(), regions.end(), [](const Region& a, const Region& b) {
    return std::tie(a.material, a.key, a.representative) <
           std::tie(b.material, b.key, b.representative);
  });
  std::uint32_t group = 0, size = 0;
  for (std::size_t i = 0; i < regions.size(); ++i) {
    if (i > 0 && (regions[i].material != regions[i - 1].material ||
                  size + regions[i].triangles > triangles_per_patch)) {
      ++group;
      size = 0;
    }
    size += regions[i].triangles;
    regions[i].group = group;
  }
  return regions.empty() ? 0 : group + 1;
}

}  // namespace

std::uint64_t morton_code(const Vec3& point, const Box& box) {
  if (box.empty()) return 0;
  const Vec3 extent = box.upper - box.lower;
  const float longest = std::max({extent.x, extent.y, extent.z});
  const float scale = longest > 0 ? kCells / longest : 0.0f;
  const Vec3 cell = (point - box.lower) * scale;
  const auto digit = [](float x) {
    return spread_bits(static_cast<std::uint64_t>(x > 0 ? std::min(x, kCells) : 0.0f));
  };
  return digit(cell.x) | digit(cell.y) << 1 | digit(cell.z) << 2;
}

TriangleGroups group_small_regions(const SurfaceView& surface, const EdgeLinks& links,
                                   const TriangleGroups& glued, std::uint32_t triangles_per_patch) {
  const std::uint32_t n = surface.triangle_count();
  DisjointSets sets = find_regions(surface, links, glued);
  TriangleGroups groups;
  std::vector<std::uint32_t> sizes(n, 0);  // at representatives; then the number of the region
  for (std::uint32_t t = 0; t < n; ++t) ++sizes[sets.find(t)];

  // List what is small.
  std::vector<Region> regions;
  for (std::uint32_t t = 0; t < n; ++t) {
    if (sets.find(t) != t) continue;  // a representative is the first of its set
    const std::uint32_t size = sizes[t];
    sizes[t] = kNone;
    if (std::uint64_t{2} * size >= triangles_per_patch) continue;
    sizes[t] = static_cast<std::uint32_t>(regions.size());
    regions.push_back({t, size, surface.material_of(t), 0, 0, {}});
  }
  if (regions.empty()) return groups;
  groups.group_of.assign(n, kNone);
  for (std::uint32_t t = 0; t < n; ++t) {
    const std::uint32_t region = groups.group_of[t] = sizes[sets.find(t)];
    if (region == kNone) continue;
    for (std::uint32_t i = 0; i < 3; ++i)
      regions[region].box.add(surface.positions[surface.corners[3 * t + i]]);
  }

  // Pack, and number the groups as they come.
  const std::uint32_t count = pack(regions, triangles_per_patch);
  std::vector<std::uint32_t> group_of_region(regions.size()), number(count, kNone);
  std::sort(regions.begin(), regions.end(),
            [](const Region& a, const Region& b) { return a.representative < b.representative; });
  for (std::size_t r = 0; r < regions.size(); ++r) group_of_region[r] = regions[r].group;
  for (std::uint32_t& entry : groups.group_of) {
    if (entry == kNone) continue;
    std::uint32_t& as = number[group_of_region[entry]];
    if (as == kNone) as = groups.count++;
    entry = as;
  }
  return groups;
}

}  // namespace varifold
