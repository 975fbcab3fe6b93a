#include <varifold/simplify/placement_collapser.h>

#include <varifold/simplify/bucket_queue.h>
#include <varifold/simplify/classify.h>
#include <varifold/simplify/edge_placement.h>
#include <varifold/simplify/packed_normal.h>
#include <varifold/simplify/ring_merge.h>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace varifold {

namespace {

constexpr std::uint32_t kReportEvery = 8192;

struct NoPrefetch {
  void later(std::uint32_t) const {}
  void soon(std::uint32_t) const {}
};

class PlacementCollapser {
 public:
  PlacementCollapser(const PlacementInput& input, const PlacementOptions& options,
                     PlacementLog& placement)
      : surface_(input.surface),
        field_(input.attributes && !input.attributes->empty() ? input.attributes : nullptr),
        options_(options),
        recorder_(input.surface, input.mesh, placement),
        merger_(input.surface, scratch_) {
    bucket_.assign(surface_.point_count(), kNone);
    quadrics_.resize(surface_.point_count());
  }

  CollapseLog run() {
    const std::uint32_t all_faces = std::max(1u, surface_.face_count);
    for (std::uint32_t p = 0; p < surface_.point_count(); ++p) update_quadric(p);
    for (std::uint32_t p = 0; p < surface_.point_count(); ++p) queue_best(p);
    while (surface_.face_count > options_.target_faces) {
      const std::uint32_t point = queue_.pop(BucketQueue::kBucketCount, NoPrefetch{});
      if (point == kNone) break;
      if (surface_.points[point].flags & PointState::kDead) continue;
      if (bucket_[point] > queue_.current()) continue;
      try_point(point);
      const float done = 1.0f - static_cast<float>(surface_.face_count) / all_faces;
      if (log_.entries.size() % kReportEvery == 0 &&
          !report(options_.progress, "simplifying", done)) {
        log_.cancelled = true;
        break;
      }
    }
    log_.queue_bytes = queue_.bytes() + bucket_.capacity() * sizeof(std::uint32_t) +
                       quadrics_.capacity() * sizeof(PointQuadric);
    return std::move(log_);
  }

 private:
  void update_quadric(std::uint32_t point) {
    quadrics_[point] = point_quadric(surface_, point, options_.quadric);
  }

  [[nodiscard]] EdgePlacement place(std::uint32_t from, std::uint32_t onto) {
    // A feature vertex, or a corner, does not leave its feature for an inner one.
    const VertexKind from_kind = surface_.points[from].kind;
    const VertexKind kind = surface_.points[onto].kind;
    const bool stays = (kind != VertexKind::kManifold && from_kind == VertexKind::kManifold) ||
                       kind == VertexKind::kCorner || kind == VertexKind::kLocked;
    const PlacementEdge edge{surface_.points[from].position, surface_.points[onto].position,
                             quadrics_[from], quadrics_[onto]};
    EdgePlacement result = stays ? placement_at_end(edge) : place_edge(edge);
    if (field_)
      for_edge_wedges(
          surface_, from, onto, [&](std::uint32_t from_wedge, std::uint32_t onto_wedge) {
            result.error +=
                field_->cost(blend_of(from, onto, {from_wedge, onto_wedge}, result.position));
          });
    return result;
  }

  [[nodiscard]] float parameter_of(std::uint32_t from, std::uint32_t onto,
                                   const Vec3& position) const {
    return edge_parameter(surface_.points[from].position, surface_.points[onto].position, position);
  }

  [[nodiscard]] AttributeField::Blend blend_of(std::uint32_t from, std::uint32_t onto,
                                               std::pair<std::uint32_t, std::uint32_t> wedges,
                                               const Vec3& position) const {
    return {wedges.first, wedges.second, parameter_of(from, onto, position),
            position - surface_.points[from].position, position - surface_.points[onto].position};
  }

  [[nodiscard]] bool may_go(std::uint32_t from, std::uint32_t onto) {
    const CollapseAlong along = kCollapseAlong[static_cast<int>(surface_.points[from].kind)];
    if (along == CollapseAlong::kNothing) return false;
    return along == CollapseAlong::kAnyEdge || edge_use(surface_, from, onto).is_feature();
  }

  void queue_best(std::uint32_t point) {
    PointState& state = surface_.points[point];
    float best = std::numeric_limits<float>::infinity();
    state.target = kNone;
    for (const RingEntry& entry : surface_.ring_span(point)) {
      if (!may_go(point, entry.neighbor)) continue;
      const float cost = place(point, entry.neighbor).error;
      if (!(cost < best)) continue;
      best = cost;
      state.target = entry.neighbor;
    }
    bucket_[point] = kNone;
    if (state.target == kNone) return;
    bucket_[point] = BucketQueue::bucket_of(best);
    queue_.push(point, bucket_[point]);
  }

  // Collapses the point by its cheapest legal candidate, or queues it where that belongs.
  void try_point(std::uint32_t point) {
    candidates_.clear();
    for (const RingEntry& entry : surface_.ring_span(point)) {
      if (!may_go(point, entry.neighbor)) continue;
      const EdgePlacement placement = place(point, entry.neighbor);
      candidates_.push_back({placement.error, entry.neighbor, placement});
    }
    std::sort(candidates_.begin(), candidates_.end(), [](const Candidate& a, const Candidate& b) {
      return a.cost != b.cost ? a.cost < b.cost : a.target < b.target;
    });
    bucket_[point] = kNone;
    for (const Candidate& candidate : candidates_) {
      if (test_placed_collapse(
              surface_,
              {point, candidate.target, candidate.placement.position,
               merged_normal(point, candidate.target, candidate.placement.position)},
              options_.legality) != Refusal::kLegal)
        continue;
      if (!merger_.match_wedges(field_, point, candidate.target)) continue;
      const std::uint32_t bucket = BucketQueue::bucket_of(candidate.cost);
      if (bucket > queue_.current()) {
        bucket_[point] = bucket;
        queue_.push(point, bucket);
      } else {
        collapse(point, candidate.target, candidate.placement);
      }
      return;
    }
  }

  // The input's normal where the point will be: its own if it stays, else the mean of both.
  [[nodiscard]] std::uint32_t merged_normal(std::uint32_t from, std::uint32_t onto,
                                            const Vec3& position) const {
    if (position == surface_.points[onto].position) return surface_.points[onto].normal;
    return pack_normal(quadrics_[from].weight * unpack_normal(surface_.points[from].normal) +
                       quadrics_[onto].weight * unpack_normal(surface_.points[onto].normal));
  }

  void collapse(std::uint32_t from, std::uint32_t onto, const EdgePlacement& placement) {
    recorder_.record(onto, placement.position, parameter_of(from, onto, placement.position),
                     scratch_);
    if (field_)
      for (std::size_t i = 0; i < scratch_.moved_from.size(); ++i)
        field_->merge(blend_of(from, onto, {scratch_.moved_from[i], scratch_.moved_onto[i]},
                               placement.position));
    const std::size_t first_removed = log_.removed_faces.size();
    merger_.merge(from, onto, log_.removed_faces);
    const std::size_t removed = log_.removed_faces.size() - first_removed;
    surface_.points[from].flags |= PointState::kDead;
    surface_.points[onto].normal = merged_normal(from, onto, placement.position);
    surface_.points[onto].position = placement.position;
    surface_.face_count -= static_cast<std::uint32_t>(removed);
    const float step = placement.weight > 0 ? std::sqrt(placement.error / placement.weight) : 0.0f;
    float& error = surface_.points[onto].error;
    error = std::max(error, surface_.points[from].error) + step;
    log_.entries.push_back({from, onto, error, static_cast<std::uint16_t>(queue_.current()),
                            static_cast<std::uint16_t>(removed)});

    // All quadrics around have changed, and with them all candidates that involve them.
    const auto ring = surface_.ring_span(onto);
    around_.assign(ring.begin(), ring.end());
    update_quadric(onto);
    for (const RingEntry& entry : around_) update_quadric(entry.neighbor);
    queue_best(onto);
    for (const RingEntry& entry : around_) queue_best(entry.neighbor);
  }

  struct Candidate {
    float cost;
    std::uint32_t target;
    EdgePlacement placement;
  };

  WorkingSurface& surface_;
  AttributeField* field_;
  const PlacementOptions& options_;
  PlacementRecorder recorder_;
  MergeScratch scratch_;
  RingMerger merger_;
  std::vector<PointQuadric> quadrics_;
  CollapseLog log_;
  BucketQueue queue_;
  std::vector<std::uint32_t> bucket_;  // per point: of its valid entry in the queue, or kNone
  std::vector<Candidate> candidates_;
  std::vector<RingEntry> around_;
};

}  // namespace

CollapseLog collapse_with_placement(const PlacementInput& input, const PlacementOptions& options,
                                    PlacementLog& placement) {
  return PlacementCollapser(input, options, placement).run();
}

}  // namespace varifold
