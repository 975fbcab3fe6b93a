#include <varifold/base/parallel.h>
#include <varifold/simplify/classify.h>

#include <algorithm>
#include <array>

namespace varifold {

namespace {

// A step moves all wedges of a point and removes all faces of an edge; records count them in bytes.
constexpr std::uint32_t kMaxWedges = 255;
constexpr std::size_t kMaxIrregularRing = 1024;

using Two = std::array<std::uint32_t, 2>;

bool differ_across(const WorkingSurface& surface, const Two& ends, const Two& faces) {
  const WedgeTables& wedge = surface.wedge;
  if (!wedge.material_of.empty() && wedge.material_of[faces[0]] != wedge.material_of[faces[1]])
    return true;
  for (const std::uint32_t end : ends)
    if (wedge.group_of[wedge.at_corner(faces[0], end)] !=
        wedge.group_of[wedge.at_corner(faces[1], end)])
      return true;
  return false;
}

// How the two faces of an edge differ, if it has two.
void add_differences(const WorkingSurface& surface, const Two& ends, const Two& faces,
                     EdgeUse& use) {
  if (use.leaving != 1 || use.arriving != 1) return;
  if (!surface.region_of.empty())
    use.region = surface.region_of[faces[0]] != surface.region_of[faces[1]];
  if (surface.wedge.has_seams()) use.seam = differ_across(surface, ends, faces);
}

struct FeatureEdges {
  int count = 0;
  EdgeUse first, second;

  void add(const EdgeUse& use) {
    if (count == 0) first = use;
    if (count == 1) second = use;
    ++count;
  }
};

FeatureEdges find_features(WorkingSurface& surface, std::uint32_t point) {
  FeatureEdges features;
  const auto ring = surface.ring_span(point);
  if (!(surface.points[point].flags & PointState::kIrregular)) {
    for (std::size_t i = 0; i < ring.size(); ++i)
      if (const EdgeUse use = edge_use_at(surface, point, i); use.is_feature()) features.add(use);
    return features;
  }
  std::vector<std::uint32_t> seen;
  for (const RingEntry& entry : ring) {
    if (std::find(seen.begin(), seen.end(), entry.neighbor) != seen.end()) continue;
    seen.push_back(entry.neighbor);
    const EdgeUse use = edge_use(surface, point, entry.neighbor);
    if (use.is_feature()) features.add(use);
  }
  return features;
}

// Each fan must lead from the one feature neighbour to the other: then the sheets form a book, and
// the point may slide along its spine.
bool is_book(WorkingSurface& surface, std::uint32_t point) {
  const auto ring = surface.ring_span(point);
  std::uint32_t ends[2] = {kNone, kNone};
  for (std::size_t i = 0; i < ring.size(); ++i) {
    if (ring[i].face != kNone) continue;
    const std::uint32_t last = ring[i].neighbor;
    std::size_t first_at = i;
    do first_at = first_at == 0 ? ring.size() - 1 : first_at - 1;
    while (ring[first_at].face != kNone && first_at != i);
    const std::uint32_t first = ring[(first_at + 1) % ring.size()].neighbor;
    if (first == last) return false;
    if (ends[0] == kNone) ends[0] = first, ends[1] = last;
    if (std::minmax(first, last) != std::minmax(ends[0], ends[1])) return false;
  }
  return true;
}

bool meets_regions(const WorkingSurface& surface, std::span<const RingEntry> ring) {
  if (surface.region_of.empty()) return false;
  std::uint32_t region = kNone;
  for (const RingEntry& entry : ring) {
    if (entry.face == kNone) continue;
    if (region != kNone && surface.region_of[entry.face] != region) return true;
    region = surface.region_of[entry.face];
  }
  return false;
}

std::size_t count_regions(const WorkingSurface& surface, std::span<const RingEntry> ring) {
  std::vector<std::uint32_t> regions;
  for (const RingEntry& entry : ring)
    if (entry.face != kNone) regions.push_back(surface.region_of[entry.face]);
  std::sort(regions.begin(), regions.end());
  return static_cast<std::size_t>(std::unique(regions.begin(), regions.end()) - regions.begin());
}

VertexKind kind_of(WorkingSurface& surface, std::uint32_t point) {
  const auto ring = surface.ring_span(point);
  const WedgeTables& wedge = surface.wedge;
  if (ring.empty()) return VertexKind::kLocked;
  if (wedge.has_seams() && wedge.count_of(point) > kMaxWedges) return VertexKind::kLocked;

  std::size_t gaps = 0;
  for (const RingEntry& entry : ring) gaps += entry.face == kNone;
  const bool divided = meets_regions(surface, ring);
  if (gaps == 0 && !wedge.has_seams() && !divided) return VertexKind::kManifold;
  if (gaps > 1) surface.points[point].flags |= PointState::kIrregular;
  if (gaps > 1 && ring.size() > kMaxIrregularRing) return VertexKind::kLocked;
  if (((gaps == 1 && !wedge.has_seams()) || divided) && ring.size() > kMaxIrregularRing)
    return VertexKind::kCorner;

  const FeatureEdges features = find_features(surface, point);
  if (features.count == 0) return gaps == 0 ? VertexKind::kManifold : VertexKind::kLocked;
  const bool alike = features.count == 2 && features.first.faces() == features.second.faces() &&
                     features.first.seam == features.second.seam &&
                     features.first.region == features.second.region;
  if (!alike) return gaps <= 1 ? VertexKind::kCorner : VertexKind::kLocked;
  if (gaps == 0) return VertexKind::kSeam;
  if (!is_book(surface, point) || features.first.faces() != gaps) return VertexKind::kLocked;
  if (divided && count_regions(surface, ring) > 2) return VertexKind::kLocked;
  return gaps == 1 ? VertexKind::kBorder : VertexKind::kNonManifold;
}

}  // namespace

EdgeUse edge_use(WorkingSurface& surface, std::uint32_t point, std::uint32_t neighbor) {
  EdgeUse use;
  const auto ring = surface.ring_span(point);
  std::uint32_t leaving_face = kNone, arriving_face = kNone;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    if (ring[i].face == kNone) continue;
    if (ring[i].neighbor == neighbor) {
      ++use.leaving;
      leaving_face = ring[i].face;
    }
    if (ring[i + 1 == ring.size() ? 0 : i + 1].neighbor == neighbor) {
      ++use.arriving;
      arriving_face = ring[i].face;
    }
  }
  add_differences(surface, {point, neighbor}, {leaving_face, arriving_face}, use);
  return use;
}

// In a single fan each neighbour stands once.
EdgeUse edge_use_at(WorkingSurface& surface, std::uint32_t point, std::size_t place) {
  const auto ring = surface.ring_span(point);
  const std::uint32_t neighbor = ring[place].neighbor;
  if (surface.points[point].flags & PointState::kIrregular)
    return edge_use(surface, point, neighbor);
  const std::uint32_t leaving_face = ring[place].face;
  const std::uint32_t arriving_face = ring[place == 0 ? ring.size() - 1 : place - 1].face;
  EdgeUse use;
  use.leaving = leaving_face != kNone;
  use.arriving = arriving_face != kNone;
  add_differences(surface, {point, neighbor}, {leaving_face, arriving_face}, use);
  return use;
}

void classify_points(WorkingSurface& surface, int threads) {
  parallel_for(threads, surface.point_count(), 4096, [&](std::size_t begin, std::size_t end) {
    for (auto p = static_cast<std::uint32_t>(begin); p < end; ++p)
      surface.points[p].kind = kind_of(surface, p);
  });
}

void reclassify_points(WorkingSurface& surface, std::span<const std::uint32_t> live, int threads) {
  parallel_for(threads, live.size(), 4096, [&](std::size_t begin, std::size_t end) {
    for (const std::uint32_t p : live.subspan(begin, end - begin))
      if (surface.points[p].kind != VertexKind::kManifold)
        surface.points[p].kind = kind_of(surface, p);
  });
}

}  // namespace varifold
