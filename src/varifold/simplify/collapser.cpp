// Based on: [GarlandHeckbert1997] (quadric error), [Hoppe1996] (edge collapse).
// Differs: half-edge collapses, one candidate a vertex, its cost the quadric of the vertex' present
//   faces at the target; candidates are found anew when they come up, not when they change;
//   legality is tested when a candidate comes up, since few fail.
#include <varifold/simplify/collapser.h>

#include <varifold/simplify/classify.h>
#include <varifold/simplify/closest_on_triangle.h>
#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

namespace varifold {

namespace {

// Brings a point and its ring into the cache, then the neighbours that the ring names.
struct Prefetcher {
  WorkingSurface& surface;

  void later(std::uint32_t point) const {
    __builtin_prefetch(&surface.points[point]);
    __builtin_prefetch(&surface.lines[point]);
  }
  void soon(std::uint32_t point) const {
    const PointState& state = surface.points[point];
    if (state.ring_size > RingLine::kCapacity) return;
    // A dirty point is likely to go back to the queue, and then only positions are read.
    const bool will_collapse = !(state.flags & PointState::kDirty);
    for (const RingEntry& entry : surface.ring_span(point)) {
      __builtin_prefetch(&surface.points[entry.neighbor]);
      if (will_collapse) __builtin_prefetch(&surface.lines[entry.neighbor]);
    }
  }
};

// From a point to the faces that would be there if it were gone; not below `enough`, where the
// nearest need not be found. Those across from the target are the likeliest, so they come first.
float squared_distance_after(const WorkingSurface& surface, std::uint32_t from, std::uint32_t onto,
                             float enough) {
  const Vec3 origin = surface.points[from].position;
  const Vec3 apex = surface.points[onto].position - origin;
  const std::span ring(surface.ring(from), surface.points[from].ring_size);
  std::size_t at = 0;
  while (at < ring.size() && ring[at].neighbor != onto) ++at;
  at += ring.size() / 2;
  float least = glm::dot(apex, apex);
  for (std::size_t i = 0; i < ring.size() && least > enough; ++i) {
    // Alternately before and after the one across.
    const std::size_t step = (i + 1) / 2;
    const std::size_t here = (at + (i % 2 == 0 ? step : 2 * ring.size() - step)) % ring.size();
    const std::uint32_t m = ring[here].neighbor;
    const std::uint32_t n = ring[here + 1 == ring.size() ? 0 : here + 1].neighbor;
    if (ring[here].face == kNone || m == onto || n == onto) continue;
    const Vec3 nearest = closest_on_triangle(apex, surface.points[m].position - origin,
                                             surface.points[n].position - origin)
                             .position;
    least = std::min(least, glm::dot(nearest, nearest));
  }
  return least;
}

}  // namespace

// Within the round a point stays with the cell that drains it; later it is due in its own cell.
void Collapser::requeue(Cell& cell, std::uint32_t point, std::uint32_t bucket) {
  if (!home_cells || bucket < cell.limit) return cell.queue.push(point, bucket);
  (*home_cells)[point / points_per_home].queue.push(point, bucket);
}

bool Collapser::leaves_cell(const Cell& cell, std::uint32_t point) {
  for (const RingEntry& entry : surface_.ring_span(point))
    if (entry.neighbor < cell.begin || entry.neighbor >= cell.end) return true;
  return false;
}

// Of the wedges that meet along the edge; the others are matched when it collapses.
float Collapser::attribute_cost(std::uint32_t point, std::uint32_t onto, const Vec3& d) {
  float sum = 0;
  for_edge_wedges(surface_, point, onto, [&](std::uint32_t from_wedge, std::uint32_t onto_wedge) {
    sum += attributes_->cost(from_wedge, onto_wedge, d);
  });
  return sum;
}

RingErrors Collapser::ring_errors(Cell& cell, std::uint32_t point) {
  const PointQuadric from = point_quadric(surface_, point, options_.quadric, cell.offsets);
  const RingErrors at_rest{cell.offsets.errors(from.quadric), from.weight};
  if (!poses) return at_rest;
  return poses->mean_errors(surface_, point, options_.quadric, at_rest, cell.poses);
}

float Collapser::find_candidate(Cell& cell, std::uint32_t point) {
  PointState& state = surface_.points[point];
  state.flags &= ~PointState::kDirty;
  state.target = kNone;
  const CollapseAlong along = kCollapseAlong[static_cast<int>(state.kind)];
  float least = std::numeric_limits<float>::infinity();
  if (along == CollapseAlong::kNothing) return least;
  cell.offsets.gather(surface_, point);
  RingOffsets& offsets = cell.offsets;
  const auto [errors, weight] = ring_errors(cell, point);
  const RingEntry* ring = surface_.ring(point);
  for (std::size_t i = 0; i < offsets.size(); ++i) {
    const std::uint32_t onto = ring[i].neighbor;
    float cost = errors[i];
    if (!(cost < least)) continue;
    if (along == CollapseAlong::kFeatureEdge && !edge_use_at(surface_, point, i).is_feature())
      continue;
    if (attributes_) cost += attribute_cost(point, onto, offsets[i]);
    if (!(cost < least)) continue;
    least = cost;
    state.target = onto;
  }
  state.step = weight > 0 ? std::sqrt(least / weight) : 0.0f;
  return least;
}

Refusal Collapser::refusal_of(Cell& scratch, std::uint32_t point) {
  (void)find_candidate(scratch, point);
  if (surface_.points[point].target == kNone) return Refusal::kFixed;
  return test(scratch, point, surface_.points[point].target);
}

void Collapser::queue_one(Cell& cell, std::uint32_t point) {
  PointState& state = surface_.points[point];
  if (state.flags & PointState::kDead) return;
  state.flags &= ~PointState::kBlocked;
  const float cost = find_candidate(cell, point);
  if (state.target != kNone)
    cell.queue.push(point, BucketQueue::bucket_of(cost));
  else
    state.flags |= PointState::kBlocked;
}

void Collapser::drain(Cell& cell, std::uint32_t limit, bool confined) {
  cell.limit = limit;
  const Prefetcher prefetch{surface_};
  while (true) {
    if (cell.removed_faces.size() >= cell.most_faces) return;
    const std::uint32_t point = cell.queue.pop(limit, prefetch);
    if (point == kNone) return;
    PointState& state = surface_.points[point];
    if (state.flags & (PointState::kDead | PointState::kBlocked)) continue;
    if (confined && leaves_cell(cell, point)) {
      cell.deferred.push_back(point);
      continue;
    }
    if (state.flags & PointState::kDirty) {
      const float cost = find_candidate(cell, point);
      if (state.target == kNone) {
        state.flags |= PointState::kBlocked;
        continue;
      }
      const std::uint32_t bucket = BucketQueue::bucket_of(cost);
      if (bucket > cell.queue.current()) {
        requeue(cell, point, bucket);
        continue;
      }
    }
    if (test(cell, point, state.target) != Refusal::kLegal) {
      try_others(cell, point);
      continue;
    }
    const std::uint32_t due = due_bucket(point, state.target, cell.queue.current());
    if (due > cell.queue.current())
      requeue(cell, point, due);
    else
      collapse(cell, point, state.target);
  }
}

void Collapser::try_others(Cell& cell, std::uint32_t point) {
  PointState& state = surface_.points[point];
  Candidate candidates[64];
  int count = 0;
  cell.offsets.gather(surface_, point);
  RingOffsets& offsets = cell.offsets;
  const auto [errors, weight] = ring_errors(cell, point);
  const RingEntry* ring = surface_.ring(point);
  for (std::size_t i = 0; i < offsets.size() && count < 64; ++i) {
    if (ring[i].neighbor == state.target) continue;
    float cost = errors[i];
    if (attributes_) cost += attribute_cost(point, ring[i].neighbor, offsets[i]);
    candidates[count++] = {cost, ring[i].neighbor};
  }
  std::sort(candidates, candidates + count, [](const Candidate& a, const Candidate& b) {
    return a.cost != b.cost ? a.cost < b.cost : a.target < b.target;
  });
  for (int i = 0; i < count; ++i) {
    if (test(cell, point, candidates[i].target) != Refusal::kLegal) continue;
    state.target = candidates[i].target;
    state.step = weight > 0 ? std::sqrt(candidates[i].cost / weight) : 0.0f;
    const std::uint32_t bucket =
        due_bucket(point, state.target,
                   std::max(cell.queue.current(), BucketQueue::bucket_of(candidates[i].cost)));
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
  if (refusal != Refusal::kLegal) return refusal;
  if (poses) {
    const Refusal in_poses = poses->test(surface_, from, onto, options_.legality);
    if (in_poses != Refusal::kLegal) return in_poses;
  }
  if ((is_watched(from) || is_watched(onto)) && !guard->allows(from, onto))
    return Refusal::kTopology;
  if (!attributes_ && !surface_.wedge.has_seams()) return refusal;
  RingMerger merger(surface_, cell.scratch);
  return merger.match_wedges(attributes_, from, onto) ? Refusal::kLegal : Refusal::kSeam;
}

std::uint32_t Collapser::due_bucket(std::uint32_t from, std::uint32_t onto, std::uint32_t now) {
  if (!(options_.distance_weight > 0)) return now;
  PointState& state = surface_.points[from];
  // Nearer than this there is nothing to wait for.
  const float free =
      std::sqrt(BucketQueue::least_cost(now) / options_.distance_weight) - state.error;
  const float distance =
      std::sqrt(squared_distance_after(surface_, from, onto, free > 0 ? free * free : 0.0f));
  state.step = std::max(state.step, distance);
  if (distance <= free) return now;
  const float moved = state.error + distance;
  return std::max(now, BucketQueue::bucket_of(options_.distance_weight * moved * moved));
}

void Collapser::collapse(Cell& cell, std::uint32_t from, std::uint32_t onto) {
  const std::size_t first_removed = cell.removed_faces.size();
  PointState& state = surface_.points[from];
  PointState& target = surface_.points[onto];
  const Vec3 d = target.position - state.position;

  RingMerger(surface_, cell.scratch).merge(from, onto, cell.removed_faces);
  if (attributes_)
    for (std::size_t i = 0; i < cell.scratch.moved_from.size(); ++i)
      attributes_->merge(cell.scratch.moved_from[i], cell.scratch.moved_onto[i], d);
  state.flags |= PointState::kDead;
  if (is_watched(from)) guard->collapsed(from, onto);
  target.error = std::max(target.error, state.error + state.step);
  for (const RingEntry& entry : cell.scratch.ring) touch(cell, entry.neighbor);

  cell.log.push_back({from, onto, target.error, static_cast<std::uint16_t>(cell.queue.current()),
                      static_cast<std::uint16_t>(cell.removed_faces.size() - first_removed)});
}

// A neighbour of the vanished point has other faces now, so its candidate must be found anew, and
// if it had none, it may have one.
void Collapser::touch(Cell& cell, std::uint32_t point) {
  PointState& state = surface_.points[point];
  state.flags |= PointState::kDirty;
  wake(cell, point);
}

bool Collapser::wake(Cell& cell, std::uint32_t point) {
  PointState& state = surface_.points[point];
  if (!(state.flags & PointState::kBlocked) || (state.flags & PointState::kDead)) return false;
  if (kCollapseAlong[static_cast<int>(state.kind)] == CollapseAlong::kNothing) return false;
  state.flags &= ~PointState::kBlocked;
  state.flags |= PointState::kDirty;
  requeue(cell, point, cell.queue.current());
  return true;
}

}  // namespace varifold
