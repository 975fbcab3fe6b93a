#include <varifold/simplify/ring_merge.h>

#include <varifold/simplify/classify.h>
#include <algorithm>
#include <limits>

namespace varifold {

namespace {

// Rings up to this size are spliced on the stack.
constexpr std::size_t kMaxSplice = 64;

}  // namespace

void RingMerger::merge(std::uint32_t from, std::uint32_t onto,
                       std::vector<std::uint32_t>& removed_faces) {
  if (surface_.wedge.has_seams()) move_wedges(from);
  const auto ring = surface_.ring_span(from);
  scratch_.ring.assign(ring.begin(), ring.end());
  if (is_regular_edge(from, onto))
    merge_regular(from, onto, removed_faces);
  else
    merge_irregular(from, onto, removed_faces);
  surface_.release_ring(from);
}

bool RingMerger::is_regular_edge(std::uint32_t from, std::uint32_t onto) {
  const PointState& state = surface_.points[from];
  if (state.kind != VertexKind::kManifold && state.kind != VertexKind::kSeam) return false;
  if ((state.flags | surface_.points[onto].flags) & PointState::kIrregular) return false;
  if (scratch_.ring.size() > kMaxSplice || surface_.points[onto].ring_size > kMaxSplice)
    return false;
  for (const RingEntry& entry : scratch_.ring)
    if (surface_.points[entry.neighbor].flags & PointState::kIrregular) return false;
  return true;
}

void RingMerger::rename_neighbor(std::uint32_t point, std::uint32_t from, std::uint32_t onto) {
  for (RingEntry& entry : surface_.ring_span(point))
    if (entry.neighbor == from) entry.neighbor = onto;
}

// In a plain ring a neighbour occurs once, and here it does.
void RingMerger::rename_in_plain_ring(std::uint32_t point, std::uint32_t from, std::uint32_t onto) {
  RingEntry* entry = surface_.ring(point);
  while (entry->neighbor != from) ++entry;
  entry->neighbor = onto;
}

// Takes the entry of `from` out of a ring. With it goes its face, or, if that is kept, the face of
// the entry before it.
void RingMerger::drop_neighbor(std::uint32_t point, std::uint32_t from, bool keep_its_face) {
  const auto entries = surface_.ring_span(point);
  std::size_t i = 0;
  while (entries[i].neighbor != from) ++i;
  if (keep_its_face) entries[i == 0 ? entries.size() - 1 : i - 1].face = entries[i].face;
  for (std::size_t k = i + 1; k < entries.size(); ++k) entries[k - 1] = entries[k];
  if (entries.size() <= RingLine::kCapacity) {
    --surface_.points[point].ring_size;
    return;
  }
  scratch_.ordered.assign(entries.begin(), entries.end() - 1);
  surface_.set_ring(point, scratch_.ordered);
}

// Both rings are plain: splice the ring of `from` into the place that it had in that of `onto`.
//
//        x1 -- a              ring of from:  onto a x1 ... xm b
//       /  \  /  \            ring of onto:  ... a from b ...   becomes   ... a x1 ... xm b ...
//    ..    from -- onto
//       \  /  \  /
//        xm -- b
void RingMerger::merge_regular(std::uint32_t from, std::uint32_t onto,
                               std::vector<std::uint32_t>& removed) {
  const auto& ring = scratch_.ring;
  const std::size_t size = ring.size();
  std::size_t at = 0;
  while (ring[at].neighbor != onto) ++at;
  const auto ring_at = [&](std::size_t i) { return ring[at + i < size ? at + i : at + i - size]; };
  const RingEntry a = ring_at(1);
  const RingEntry b = ring_at(size - 1);
  removed.push_back(ring_at(0).face);
  removed.push_back(b.face);

  // Write the new ring of `onto`, beginning at a.
  RingEntry merged[2 * kMaxSplice];
  std::size_t count = 0;
  for (std::size_t i = 1; i + 1 < size; ++i) merged[count++] = ring_at(i);
  const auto old = surface_.ring_span(onto);
  std::size_t old_from = 0;
  while (old[old_from].neighbor != from) ++old_from;
  for (std::size_t i = 1; i + 1 < old.size(); ++i) {
    const std::size_t k = old_from + i;
    merged[count++] = old[k < old.size() ? k : k - old.size()];
  }
  surface_.set_ring(onto, {merged, count});

  for (std::size_t i = 2; i + 1 < size; ++i) rename_in_plain_ring(ring_at(i).neighbor, from, onto);
  drop_neighbor(a.neighbor, from, false);
  drop_neighbor(b.neighbor, from, true);
}

// Anything else: gather the link edges of both points, leave out the dead faces, and order anew.
void RingMerger::merge_irregular(std::uint32_t from, std::uint32_t onto,
                                 std::vector<std::uint32_t>& removed) {
  auto& dead = scratch_.dead_faces;
  dead.clear();
  scratch_.edges.clear();
  scratch_.apexes.clear();
  link_edges(scratch_.ring, scratch_.edges);
  std::erase_if(scratch_.edges, [&](const LinkEdge& edge) {
    if (edge.from != onto && edge.to != onto) return false;
    dead.push_back(edge.face);
    scratch_.apexes.push_back(edge.from == onto ? edge.to : edge.from);
    return true;
  });
  const auto is_dead = [&](const LinkEdge& edge) {
    return std::find(dead.begin(), dead.end(), edge.face) != dead.end();
  };
  link_edges(surface_.ring_span(onto), scratch_.edges);
  std::erase_if(scratch_.edges, is_dead);
  order_ring(scratch_.edges, scratch_.ordered);
  surface_.set_ring(onto, scratch_.ordered);

  for (const std::uint32_t apex : scratch_.apexes) {
    scratch_.apex_edges.clear();
    link_edges(surface_.ring_span(apex), scratch_.apex_edges);
    std::erase_if(scratch_.apex_edges, is_dead);
    for (LinkEdge& edge : scratch_.apex_edges) {
      if (edge.from == from) edge.from = onto;
      if (edge.to == from) edge.to = onto;
    }
    order_ring(scratch_.apex_edges, scratch_.ordered);
    surface_.set_ring(apex, scratch_.ordered);
  }
  for (const RingEntry& entry : scratch_.ring)
    if (entry.neighbor != onto) rename_neighbor(entry.neighbor, from, onto);
  std::sort(dead.begin(), dead.end());
  removed.insert(removed.end(), dead.begin(), dead.end());
}

// Which side of the charts leads where: pairs of wedge groups, in moved_from and moved_onto. False
// where a side leads to two places, or to none.
bool RingMerger::sides_along(std::uint32_t from, std::uint32_t onto) {
  const WedgeTables& wedge = surface_.wedge;
  auto& from_groups = scratch_.moved_from;
  auto& onto_groups = scratch_.moved_onto;
  from_groups.clear();
  onto_groups.clear();
  const auto ring = surface_.ring_span(from);
  const auto group_at = [&](const RingEntry& entry, std::uint32_t point) {
    return wedge.group_of[wedge.at_corner(entry.face, point)];
  };
  const auto next_of = [&](std::size_t i) {
    return ring[i + 1 == ring.size() ? 0 : i + 1].neighbor;
  };
  for (std::size_t i = 0; i < ring.size(); ++i) {
    if (ring[i].face == kNone || (ring[i].neighbor != onto && next_of(i) != onto)) continue;
    const std::uint32_t group = group_at(ring[i], from);
    const std::uint32_t onto_group = group_at(ring[i], onto);
    const auto known = std::find(from_groups.begin(), from_groups.end(), group);
    if (known == from_groups.end()) {
      from_groups.push_back(group);
      onto_groups.push_back(onto_group);
    } else if (onto_groups[known - from_groups.begin()] != onto_group) {
      return false;
    }
  }
  for (const RingEntry& entry : ring)
    if (entry.face != kNone && std::find(from_groups.begin(), from_groups.end(),
                                         group_at(entry, from)) == from_groups.end())
      return false;
  return true;
}

bool RingMerger::match_wedges(const AttributeField* attributes, std::uint32_t from,
                              std::uint32_t onto) {
  const WedgeTables& wedge = surface_.wedge;
  const std::uint32_t from_first = wedge.first_of(from), from_count = wedge.count_of(from);
  const std::uint32_t onto_first = wedge.first_of(onto), onto_count = wedge.count_of(onto);
  if (from_count == 1 && onto_count == 1) {
    scratch_.moved_from.assign(1, from_first);
    scratch_.moved_onto.assign(1, onto_first);
    return true;
  }
  if (!sides_along(from, onto)) return false;
  const std::vector<std::uint32_t> from_groups = scratch_.moved_from;
  const std::vector<std::uint32_t> onto_groups = scratch_.moved_onto;

  scratch_.moved_from.resize(from_count);
  scratch_.moved_onto.assign(from_count, kNone);
  for (std::uint32_t i = 0; i < from_count; ++i) {
    const std::uint32_t moved = scratch_.moved_from[i] = from_first + i;
    const auto side = std::find(from_groups.begin(), from_groups.end(), wedge.group_of[moved]);
    float nearest = std::numeric_limits<float>::infinity();
    for (std::uint32_t candidate = onto_first; candidate < onto_first + onto_count; ++candidate) {
      // A wedge that no face uses any more may go anywhere.
      if (side != from_groups.end() &&
          wedge.group_of[candidate] != onto_groups[side - from_groups.begin()])
        continue;
      const float distance = attributes ? attributes->distance_squared(moved, candidate) : 0.0f;
      if (!(distance < nearest)) continue;
      nearest = distance;
      scratch_.moved_onto[i] = candidate;
    }
    if (scratch_.moved_onto[i] == kNone) return false;
  }
  return true;
}

void RingMerger::move_wedges(std::uint32_t from) {
  WedgeTables& wedge = surface_.wedge;
  const auto& moved_from = scratch_.moved_from;
  for (std::size_t i = 0; i < moved_from.size(); ++i)
    wedge.target[moved_from[i]] = scratch_.moved_onto[i];
  for (const RingEntry& entry : surface_.ring_span(from)) {
    if (entry.face == kNone) continue;
    std::uint32_t* corner = &wedge.corners[3 * std::size_t{entry.face}];
    for (int k = 0; k < 3; ++k)
      if (wedge.point_of[corner[k]] == from) corner[k] = wedge.target[corner[k]];
  }
}

}  // namespace varifold
