// Based on: [GarlandHeckbert1997] (quadric error), [Hoppe1996] (edge collapse).
// Differs: half-edge collapses, one candidate a vertex, cost Q_from(p_onto) * area^-0.6, so that a
//   collapse changes the candidates of its target and of those that pointed to the vanished vertex
//   only; candidates are found anew when they come up, not when they change; legality is tested
//   when a candidate comes up, since few fail.
#include <varifold/simplify/collapser.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <varifold/simplify/classify.h>

namespace varifold {

namespace {

// x^exponent to about 5 %, monotone, and the same bits everywhere: linear between powers of two.
float rough_power(float x, float exponent) {
  constexpr float kOne = 127.0f * (1 << 23);
  const auto bits = static_cast<float>(std::bit_cast<std::int32_t>(x));
  return std::bit_cast<float>(static_cast<std::int32_t>(kOne + exponent * (bits - kOne)));
}

}  // namespace

// Within the round a point stays with the cell that drains it; later it is due in its own cell.
void Collapser::requeue(Cell& cell, std::uint32_t point, std::uint32_t bucket) {
  if (!home_cells || bucket < cell.limit) return cell.queue.push(point, bucket);
  for (Cell& home : *home_cells)
    if (point < home.end) return home.queue.push(point, bucket);
}

bool Collapser::leaves_cell(const Cell& cell, std::uint32_t point) {
  for (const RingEntry& entry : surface_.ring_span(point))
    if (entry.neighbor < cell.begin || entry.neighbor >= cell.end) return true;
  return false;
}

float Collapser::cost_onto(std::uint32_t point, std::uint32_t onto) {
  const PointState& state = surface_.points[point];
  const Vec3 d = surface_.points[onto].position - state.position;
  float error = state.quadric.at(d);
  if (attributes_ && !attributes_->empty()) {
    const WedgeTables& wedge = surface_.wedge;
    const auto from_wedges = wedge.of_point(point);
    const auto onto_wedges = wedge.of_point(onto);
    if (from_wedges.size() == 1 && onto_wedges.size() == 1) {
      error += attributes_->coupling(from_wedges[0], onto_wedges[0], d);
    } else {
      // The wedges that meet along the edge; the others are matched when it collapses.
      const auto ring = surface_.ring_span(point);
      std::uint32_t previous = kNone;
      for (std::size_t i = 0; i < ring.size(); ++i) {
        const std::uint32_t next = ring[i + 1 == ring.size() ? 0 : i + 1].neighbor;
        if (ring[i].face == kNone || (ring[i].neighbor != onto && next != onto)) continue;
        const std::uint32_t w = corner_wedge(surface_, ring[i].face, point);
        if (w != previous)
          error += attributes_->coupling(w, corner_wedge(surface_, ring[i].face, onto), d);
        previous = w;
      }
    }
  }
  return std::max(error, 0.0f);
}

Collapser::Candidate Collapser::best_candidate(std::uint32_t point) {
  const PointState& state = surface_.points[point];
  Candidate best{std::numeric_limits<float>::infinity(), kNone};
  const CollapseAlong along = kCollapseAlong[static_cast<int>(state.kind)];
  if (along == CollapseAlong::kNothing) return best;
  for (const RingEntry& entry : surface_.ring_span(point)) {
    if (along == CollapseAlong::kFeatureEdge &&
        !edge_use(surface_, point, entry.neighbor).is_feature())
      continue;
    const float cost = cost_onto(point, entry.neighbor);
    if (cost < best.cost) best = {cost, entry.neighbor};
  }
  best.cost *= rough_power(state.weight, options_.area_exponent);
  return best;
}

Refusal Collapser::refusal_of(Cell& scratch, std::uint32_t point) {
  const Candidate best = best_candidate(point);
  if (best.target == kNone) return Refusal::kFixed;
  return test(scratch, point, best.target);
}

void Collapser::queue_all(Cell& cell) {
  for (std::uint32_t point = cell.begin; point < cell.end; ++point) {
    const Candidate best = best_candidate(point);
    surface_.points[point].target = best.target;
    if (best.target == kNone)
      surface_.points[point].flags |= PointState::kBlocked;
    else
      cell.queue.push(point, BucketQueue::bucket_of(best.cost));
  }
}

void Collapser::drain(Cell& cell, std::uint32_t limit, bool confined) {
  cell.limit = limit;
  const auto prefetch = [&](std::uint32_t point) {
    __builtin_prefetch(&surface_.points[point]);
    __builtin_prefetch(&surface_.lines[point]);
  };
  while (true) {
    const std::uint32_t point = cell.queue.pop(limit, prefetch);
    if (point == kNone) return;
    PointState& state = surface_.points[point];
    if (state.flags & (PointState::kDead | PointState::kBlocked)) continue;
    if (confined && leaves_cell(cell, point)) {
      cell.deferred.push_back(point);
      continue;
    }
    if (state.flags & PointState::kDirty) {
      const Candidate best = best_candidate(point);
      state.flags &= ~PointState::kDirty;
      state.target = best.target;
      if (best.target == kNone) {
        state.flags |= PointState::kBlocked;
        continue;
      }
      const std::uint32_t bucket = BucketQueue::bucket_of(best.cost);
      if (bucket > cell.queue.current()) {
        requeue(cell, point, bucket);
        continue;
      }
    }
    if (test(cell, point, state.target) == Refusal::kLegal)
      collapse(cell, point, state.target);
    else
      try_others(cell, point);
  }
}

void Collapser::try_others(Cell& cell, std::uint32_t point) {
  PointState& state = surface_.points[point];
  Candidate candidates[64];
  int count = 0;
  for (const RingEntry& entry : surface_.ring_span(point)) {
    if (count == 64) break;
    if (entry.neighbor == state.target) continue;
    candidates[count++] = {cost_onto(point, entry.neighbor), entry.neighbor};
  }
  std::sort(candidates, candidates + count, [](const Candidate& a, const Candidate& b) {
    return a.cost != b.cost ? a.cost < b.cost : a.target < b.target;
  });
  const float factor = rough_power(state.weight, options_.area_exponent);
  for (int i = 0; i < count; ++i) {
    if (test(cell, point, candidates[i].target) != Refusal::kLegal) continue;
    state.target = candidates[i].target;
    const std::uint32_t bucket = BucketQueue::bucket_of(candidates[i].cost * factor);
    if (bucket > cell.queue.current())
      requeue(cell, point, bucket);
    else
      collapse(cell, point, state.target);
    return;
  }
  state.flags |= PointState::kBlocked;
}

Refusal Collapser::test(Cell& cell, std::uint32_t from, std::uint32_t onto) {
  const Refusal refusal = test_collapse(surface_, from, onto, options_.legality);
  if (refusal != Refusal::kLegal || surface_.wedge.corners.empty()) return refusal;
  return match_wedges(cell, from, onto) ? Refusal::kLegal : Refusal::kSeam;
}

bool Collapser::is_regular_edge(std::uint32_t from, std::uint32_t onto) {
  const PointState& state = surface_.points[from];
  if (state.kind != VertexKind::kManifold && state.kind != VertexKind::kSeam) return false;
  if ((state.flags | surface_.points[onto].flags) & PointState::kIrregular) return false;
  const auto ring = surface_.ring_span(from);
  if (ring.size() > 64 || surface_.points[onto].ring_size > 64) return false;
  for (const RingEntry& entry : ring)
    if (surface_.points[entry.neighbor].flags & PointState::kIrregular) return false;
  return true;
}

void Collapser::collapse(Cell& cell, std::uint32_t from, std::uint32_t onto) {
  const std::size_t first_removed = cell.removed_faces.size();
  if (!surface_.wedge.corners.empty()) move_wedges(cell, from);

  const auto ring = surface_.ring_span(from);
  cell.ring.assign(ring.begin(), ring.end());
  if (is_regular_edge(from, onto))
    merge_regular(cell, from, onto);
  else
    merge_irregular(cell, from, onto);

  merge_state(cell, from, onto);
  surface_.release_ring(from);
  surface_.points[from].flags |= PointState::kDead;
  for (const RingEntry& entry : cell.ring) touch(cell, entry.neighbor, from);
  surface_.points[onto].flags |= PointState::kDirty;

  const PointState& state = surface_.points[onto];
  const float error = state.weight > 0 ? std::sqrt(state.quadric.c / state.weight) : 0.0f;
  cell.log.push_back({from, onto, error, static_cast<std::uint16_t>(cell.queue.current()),
                      static_cast<std::uint16_t>(cell.removed_faces.size() - first_removed)});
}

void Collapser::merge_state(Cell& cell, std::uint32_t from, std::uint32_t onto) {
  PointState& target = surface_.points[onto];
  const PointState& state = surface_.points[from];
  const Vec3 d = target.position - state.position;
  Quadric moved = state.quadric.moved_by(d);
  if (attributes_ && !attributes_->empty()) {
    for (std::size_t i = 0; i < cell.moved_from.size(); ++i)
      moved += attributes_->merge(cell.moved_from[i], cell.moved_onto[i], d);
    moved.c = std::max(moved.c, 0.0f);
  }
  target.quadric += moved;
  target.weight += state.weight;
}

// A neighbour of the vanished point: its candidate may be gone, or a legal one may have appeared.
void Collapser::touch(Cell& cell, std::uint32_t point, std::uint32_t from) {
  PointState& state = surface_.points[point];
  if (state.target == from) state.flags |= PointState::kDirty;
  if (!(state.flags & PointState::kBlocked)) return;
  if (kCollapseAlong[static_cast<int>(state.kind)] == CollapseAlong::kNothing) return;
  state.flags &= ~PointState::kBlocked;
  state.flags |= PointState::kDirty;
  requeue(cell, point, cell.queue.current());
}

void Collapser::rename_neighbor(std::uint32_t point, std::uint32_t from, std::uint32_t onto) {
  for (RingEntry& entry : surface_.ring_span(point))
    if (entry.neighbor == from) entry.neighbor = onto;
}

// Both rings are plain: splice the ring of `from` into the place that it had in that of `onto`.
//
//        x1 -- a              ring of from:  onto a x1 ... xm b
//       /  \  /  \            ring of onto:  ... a from b ...   becomes   ... a x1 ... xm b ...
//    ..    from -- onto
//       \  /  \  /
//        xm -- b
void Collapser::merge_regular(Cell& cell, std::uint32_t from, std::uint32_t onto) {
  const auto& ring = cell.ring;
  const std::size_t size = ring.size();
  std::size_t at = 0;
  while (ring[at].neighbor != onto) ++at;
  const auto ring_at = [&](std::size_t i) { return ring[(at + i) % size]; };
  const RingEntry a = ring_at(1);
  const RingEntry b = ring_at(size - 1);
  cell.removed_faces.push_back(ring_at(0).face);
  cell.removed_faces.push_back(b.face);

  // Write the new ring of `onto`, beginning at a.
  RingEntry merged[128];
  std::size_t count = 0;
  for (std::size_t i = 1; i + 1 < size; ++i) merged[count++] = ring_at(i);
  const auto old = surface_.ring_span(onto);
  std::size_t old_from = 0;
  while (old[old_from].neighbor != from) ++old_from;
  for (std::size_t i = 1; i + 1 < old.size(); ++i)
    merged[count++] = old[(old_from + i) % old.size()];
  surface_.set_ring(onto, {merged, count});

  for (std::size_t i = 2; i + 1 < size; ++i) rename_neighbor(ring_at(i).neighbor, from, onto);

  // In the rings of a and b the entry of `from` goes, with the face that was removed.
  const auto drop = [&](std::uint32_t point, bool keep_face_of_from) {
    const auto entries = surface_.ring_span(point);
    std::size_t i = 0;
    while (entries[i].neighbor != from) ++i;
    if (keep_face_of_from)  // ... onto (removed) from (kept) next ...
      entries[i == 0 ? entries.size() - 1 : i - 1].face = entries[i].face;
    RingEntry kept[128];
    std::size_t kept_count = 0;
    if (entries.size() <= RingLine::kCapacity || entries.size() > 128) {
      std::copy(entries.begin() + i + 1, entries.end(), entries.begin() + i);
      if (entries.size() <= RingLine::kCapacity) {
        --surface_.points[point].ring_size;
        return;
      }
      const std::vector<RingEntry> copy(entries.begin(), entries.end() - 1);
      surface_.set_ring(point, copy);
      return;
    }
    for (std::size_t k = 0; k < entries.size(); ++k)
      if (k != i) kept[kept_count++] = entries[k];
    surface_.set_ring(point, {kept, kept_count});
  };
  drop(a.neighbor, false);
  drop(b.neighbor, true);
}

// Anything else: gather the link edges of both points, leave out the dead faces, and order anew.
void Collapser::merge_irregular(Cell& cell, std::uint32_t from, std::uint32_t onto) {
  cell.dead_faces.clear();
  cell.edges.clear();
  link_edges(cell.ring, cell.edges);
  std::vector<std::uint32_t> apexes, others;
  std::erase_if(cell.edges, [&](const LinkEdge& edge) {
    if (edge.from != onto && edge.to != onto) return false;
    cell.dead_faces.push_back(edge.face);
    apexes.push_back(edge.from == onto ? edge.to : edge.from);
    return true;
  });
  const auto is_dead = [&](const LinkEdge& edge) {
    return std::find(cell.dead_faces.begin(), cell.dead_faces.end(), edge.face) !=
           cell.dead_faces.end();
  };
  link_edges(surface_.ring_span(onto), cell.edges);
  std::erase_if(cell.edges, is_dead);

  std::vector<RingEntry> ordered;
  order_ring(cell.edges, ordered);
  surface_.set_ring(onto, ordered);

  for (const std::uint32_t apex : apexes) {
    cell.common_edges.clear();
    link_edges(surface_.ring_span(apex), cell.common_edges);
    std::erase_if(cell.common_edges, is_dead);
    for (LinkEdge& edge : cell.common_edges) {
      if (edge.from == from) edge.from = onto;
      if (edge.to == from) edge.to = onto;
    }
    order_ring(cell.common_edges, ordered);
    surface_.set_ring(apex, ordered);
  }
  for (const RingEntry& entry : cell.ring)
    if (entry.neighbor != onto) rename_neighbor(entry.neighbor, from, onto);
  std::sort(cell.dead_faces.begin(), cell.dead_faces.end());
  cell.removed_faces.insert(cell.removed_faces.end(), cell.dead_faces.begin(),
                            cell.dead_faces.end());
}

// Finds for every wedge of `from` the wedge of `onto` that takes its place: on the same side of the
// charts, as the faces along the edge show, and there the one with the nearest attributes.
bool Collapser::match_wedges(Cell& cell, std::uint32_t from, std::uint32_t onto) {
  const WedgeTables& wedge = surface_.wedge;
  const auto from_wedges = wedge.of_point(from);
  const auto onto_wedges = wedge.of_point(onto);
  cell.moved_from.assign(from_wedges.begin(), from_wedges.end());
  cell.moved_onto.assign(from_wedges.size(), kNone);
  if (from_wedges.size() == 1 && onto_wedges.size() == 1) {
    cell.moved_onto[0] = onto_wedges[0];
    return true;
  }

  // Which side of the charts leads where.
  struct Side {
    std::uint32_t from_group, onto_group;
  };
  std::vector<Side> sides;
  std::vector<std::uint32_t> groups_in_use;
  const auto ring = surface_.ring_span(from);
  for (std::size_t i = 0; i < ring.size(); ++i) {
    if (ring[i].face == kNone) continue;
    const std::uint32_t group = wedge.group_of[corner_wedge(surface_, ring[i].face, from)];
    groups_in_use.push_back(group);
    const std::uint32_t next = ring[i + 1 == ring.size() ? 0 : i + 1].neighbor;
    if (ring[i].neighbor != onto && next != onto) continue;
    const std::uint32_t onto_group = wedge.group_of[corner_wedge(surface_, ring[i].face, onto)];
    for (const Side& side : sides)
      if (side.from_group == group && side.onto_group != onto_group) return false;
    sides.push_back({group, onto_group});
  }
  for (const std::uint32_t group : groups_in_use)
    if (std::none_of(sides.begin(), sides.end(), [&](const Side& s) { return s.from_group == group; }))
      return false;

  for (std::size_t i = 0; i < from_wedges.size(); ++i) {
    const std::uint32_t group = wedge.group_of[from_wedges[i]];
    const auto side = std::find_if(sides.begin(), sides.end(),
                                   [&](const Side& s) { return s.from_group == group; });
    float nearest = std::numeric_limits<float>::infinity();
    for (const std::uint32_t candidate : onto_wedges) {
      if (side != sides.end() && wedge.group_of[candidate] != side->onto_group) continue;
      const float distance =
          attributes_ ? attributes_->distance_squared(from_wedges[i], candidate) : 0.0f;
      if (distance >= nearest) continue;
      nearest = distance;
      cell.moved_onto[i] = candidate;
    }
  }
  return true;
}

void Collapser::move_wedges(Cell& cell, std::uint32_t from) {
  WedgeTables& wedge = surface_.wedge;
  for (std::size_t i = 0; i < cell.moved_from.size(); ++i)
    wedge.target[cell.moved_from[i]] = cell.moved_onto[i];
  for (const RingEntry& entry : surface_.ring_span(from)) {
    if (entry.face == kNone) continue;
    std::uint32_t* corner = &wedge.corners[3 * std::size_t{entry.face}];
    for (int k = 0; k < 3; ++k) {
      if (surface_.point_of_vertex[corner[k]] != from) continue;
      for (std::size_t i = 0; i < cell.moved_from.size(); ++i)
        if (cell.moved_from[i] == corner[k]) {
          corner[k] = cell.moved_onto[i];
          break;
        }
      break;
    }
  }
}

}  // namespace varifold
