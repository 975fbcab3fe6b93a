// Based on: [Hoppe1996] sections 3.2 and 4 (collapses in order of the change of energy).
// Differs: a point stands in the queue with the best of its edges, which gives the same order as a
//   queue of edges; what a collapse changes around it is evaluated anew when it comes up, not at
//   once; a half-edge collapse does not move the samples of faces that it leaves as they are.
#include <varifold/simplify/energy_collapser.h>

#include <varifold/base/parallel.h>
#include <varifold/simplify/classify.h>
#include <varifold/simplify/cost_heap.h>
#include <varifold/simplify/edge_placement.h>
#include <varifold/simplify/packed_normal.h>
#include <algorithm>
#include <limits>
#include <optional>

namespace varifold {

namespace {

constexpr std::uint32_t kReportEvery = 4096;
constexpr std::size_t kPointsPerPiece = 4096;
constexpr double kInfinity = std::numeric_limits<double>::infinity();
// So many legal collapses of a point are fitted.
constexpr int kMaxFitted = 2;

class EnergyCollapser {
 public:
  EnergyCollapser(const EnergyInput& input, const EnergyCollapseOptions& options,
                  PlacementLog* placement)
      : surface_(input.surface),
        field_(input.attributes && !input.attributes->empty() ? input.attributes : nullptr),
        options_(options),
        energy_(input, options.energy),
        heap_(input.surface.point_count()) {
    if (placement) {
      recorder_.emplace(input.surface, input.mesh, *placement);
      place_.resize(surface_.point_count());
    }
    changed_at_.assign(surface_.point_count(), 0);
    seen_at_.assign(surface_.point_count(), 0);
  }

  EnergyLog run() {
    const std::uint32_t all_faces = std::max(1u, surface_.face_count);
    queue_all();
    do {
      while (surface_.face_count > options_.target_faces && !heap_.empty()) {
        const std::size_t steps = out_.costs.size();
        try_top();
        const float done = 1.0f - static_cast<float>(surface_.face_count) / all_faces;
        if (out_.costs.size() > steps && steps % kReportEvery == 0 &&
            !report(options_.progress, "simplifying", done)) {
          out_.log.cancelled = true;
          return std::move(out_);
        }
      }
    } while (surface_.face_count > options_.target_faces && retry_blocked());
    out_.log.queue_bytes = heap_.bytes() + energy_.bytes() + scratch_bytes();
    return std::move(out_);
  }

 private:
  using Collapse = SurfaceEnergy::Collapse;

  // The cheapest legal collapse of a point; onto kNone where there is none.
  [[nodiscard]] Collapse find_best(EnergyScratch& scratch, std::uint32_t point) {
    const Collapse none{point, kNone, false, Vec3(0), {kInfinity, 0, 0}};
    const PointState& state = surface_.points[point];
    const CollapseAlong along = kCollapseAlong[static_cast<int>(state.kind)];
    if (along == CollapseAlong::kNothing) return none;
    energy_.look_at(scratch, point);
    // The best one of last time is likely to be good still, and then the others are seen to be
    // worse before all of their samples have been measured.
    scratch.neighbors.clear();
    for (const RingEntry& entry : surface_.ring_span(point)) {
      if (along == CollapseAlong::kFeatureEdge &&
          !edge_use(surface_, point, entry.neighbor).is_feature())
        continue;
      scratch.neighbors.push_back(entry.neighbor);
      if (entry.neighbor == state.target)
        std::swap(scratch.neighbors.front(), scratch.neighbors.back());
    }
    return recorder_ ? find_best_placed(scratch, none) : find_best_kept(scratch, none);
  }

  [[nodiscard]] Collapse find_best_kept(EnergyScratch& scratch, const Collapse& none) {
    Collapse best = none;
    for (const std::uint32_t onto : scratch.neighbors) {
      if (field_ && !match(scratch, best.from, onto)) continue;
      const Collapse found = energy_.kept(scratch, onto, best.change.total());
      if (found.change.total() < best.change.total() && is_legal(scratch, found)) best = found;
    }
    return best;
  }

  // Of all neighbours the middle is evaluated, but only the most promising are fitted.
  [[nodiscard]] Collapse find_best_placed(EnergyScratch& scratch, const Collapse& none) {
    std::vector<Collapse>& starts = scratch.starts;
    starts.clear();
    double limit = kInfinity;
    for (const std::uint32_t onto : scratch.neighbors) {
      if (field_ && !match(scratch, none.from, onto)) continue;
      starts.push_back(moves(none.from, onto) ? energy_.middle(scratch, onto, limit)
                                              : energy_.kept(scratch, onto, limit));
      limit = std::min(limit, starts.back().change.total());
    }
    std::sort(starts.begin(), starts.end(), [](const Collapse& a, const Collapse& b) {
      const double x = a.change.total(), y = b.change.total();
      return x != y ? x < y : a.onto < b.onto;
    });
    Collapse best = none;
    int found = 0;
    for (const Collapse& start : starts) {
      if (found == kMaxFitted || !(start.change.total() < kInfinity)) break;
      if (field_ && !match(scratch, start.from, start.onto)) continue;
      const Collapse end = start.moves
                               ? energy_.fitted(scratch, energy_.started(scratch, start.onto))
                               : energy_.kept(scratch, start.onto, kInfinity);
      if (!is_legal(scratch, end)) continue;
      ++found;
      if (end.change.total() < best.change.total()) best = end;
    }
    return best;
  }

  // A feature vertex, or a corner, does not leave its feature for an inner one.
  [[nodiscard]] bool moves(std::uint32_t from, std::uint32_t onto) const {
    const VertexKind from_kind = surface_.points[from].kind;
    const VertexKind kind = surface_.points[onto].kind;
    const bool stays = (kind != VertexKind::kManifold && from_kind == VertexKind::kManifold) ||
                       kind == VertexKind::kCorner || kind == VertexKind::kLocked;
    return !stays;
  }

  [[nodiscard]] bool match(EnergyScratch& scratch, std::uint32_t from, std::uint32_t onto) {
    return RingMerger(surface_, scratch.merge).match_wedges(field_, from, onto);
  }

  // The input's normal where the point will be.
  [[nodiscard]] std::uint32_t normal_of(const Collapse& collapse) const {
    const std::uint32_t from = surface_.points[collapse.from].normal;
    const std::uint32_t onto = surface_.points[collapse.onto].normal;
    return collapse.moves ? pack_normal(unpack_normal(from) + unpack_normal(onto)) : onto;
  }

  [[nodiscard]] bool is_legal(EnergyScratch& scratch, const Collapse& collapse) {
    const auto [from, onto, moves, place, change] = collapse;
    const Refusal refusal =
        moves ? test_placed_collapse(surface_, {from, onto, place, normal_of(collapse)},
                                     options_.legality)
              : test_collapse(surface_, from, onto, options_.legality);
    if (refusal != Refusal::kLegal) return false;
    return (!field_ && !surface_.wedge.has_seams()) || match(scratch, from, onto);
  }

  // All that is kept of an evaluation but its cost, which is in the queue.
  void note(const Collapse& best) {
    surface_.points[best.from].target = best.onto;
    if (recorder_) place_[best.from] = best.place;
  }

  void queue_all() {
    const std::uint32_t count = surface_.point_count();
    std::vector<float> costs(count);
    parallel_for(options_.threads, count, kPointsPerPiece, [&](std::size_t begin, std::size_t end) {
      EnergyScratch scratch;
      for (auto p = static_cast<std::uint32_t>(begin); p < end; ++p) {
        const Collapse best = find_best(scratch, p);
        note(best);
        costs[p] = static_cast<float>(best.change.total());
      }
    });
    for (std::uint32_t p = 0; p < count; ++p)
      if (surface_.points[p].target != kNone) heap_.set(p, costs[p]);
  }

  [[nodiscard]] std::uint32_t now() const { return static_cast<std::uint32_t>(out_.costs.size()); }

  [[nodiscard]] bool is_stale(std::uint32_t point) const {
    const std::uint32_t seen = seen_at_[point];
    return changed_at_[point] > seen || changed_at_[surface_.points[point].target] > seen;
  }

  // Sets a point's entry in the queue. False where it has no legal collapse.
  bool update(std::uint32_t point) {
    const Collapse best = find_best(scratch_, point);
    note(best);
    seen_at_[point] = now();
    if (best.onto == kNone) {
      heap_.remove(point);
      return false;
    }
    heap_.set(point, static_cast<float>(best.change.total()));
    return true;
  }

  void try_top() {
    const std::uint32_t point = heap_.top();
    if (is_stale(point)) {
      update(point);
      return;
    }
    const std::uint32_t onto = surface_.points[point].target;
    const Vec3 place = recorder_ ? place_[point] : surface_.points[onto].position;
    const Collapse best{point, onto, recorder_ && moves(point, onto), place, {}};
    if (is_legal(scratch_, best))
      collapse(best, heap_.top_cost());
    else  // the valence of the target may have grown
      update(point);
  }

  void collapse(const Collapse& best, float cost) {
    const auto [from, onto, moves, place, change] = best;
    PointState& state = surface_.points[from];
    PointState& target = surface_.points[onto];
    if (recorder_)
      recorder_->record(onto, place,
                        moves ? edge_parameter(state.position, target.position, place) : 1.0f,
                        scratch_.merge);
    const std::uint32_t normal = normal_of(best);
    const float error = std::max(target.error, energy_.collapse(scratch_, best));
    const std::size_t first_removed = out_.log.removed_faces.size();
    RingMerger(surface_, scratch_.merge).merge(from, onto, out_.log.removed_faces);
    const std::size_t removed = out_.log.removed_faces.size() - first_removed;
    state.flags |= PointState::kDead;
    target.position = place;
    target.normal = normal;
    target.error = std::max(state.error, error);
    surface_.face_count -= static_cast<std::uint32_t>(removed);
    heap_.remove(from);
    out_.costs.push_back(cost);
    out_.log.entries.push_back({from, onto, target.error, 0, static_cast<std::uint16_t>(removed)});
    touch(onto);
    const auto ring = surface_.ring_span(onto);
    around_.assign(ring.begin(), ring.end());
    for (const RingEntry& entry : around_) touch(entry.neighbor);
  }

  // The faces around the point have changed.
  void touch(std::uint32_t point) {
    changed_at_[point] = now();
    if (!heap_.contains(point)) update(point);
  }

  // Points without a legal collapse may have got one by changes farther off.
  bool retry_blocked() {
    bool any = false;
    for (std::uint32_t p = 0; p < surface_.point_count(); ++p)
      if (!(surface_.points[p].flags & PointState::kDead)) any = update(p) || any;
    return any;
  }

  [[nodiscard]] std::size_t scratch_bytes() const {
    return (changed_at_.capacity() + seen_at_.capacity()) * sizeof(std::uint32_t) +
           place_.capacity() * sizeof(Vec3);
  }

  WorkingSurface& surface_;
  AttributeField* field_;
  const EnergyCollapseOptions& options_;
  SurfaceEnergy energy_;
  CostHeap heap_;
  std::optional<PlacementRecorder> recorder_;
  std::vector<std::uint32_t> changed_at_;  // per point: the step that changed its faces last
  std::vector<std::uint32_t> seen_at_;     // per point: steps done when it was evaluated
  std::vector<Vec3> place_;                // per point: where its best collapse leads, if recorded
  EnergyScratch scratch_;
  std::vector<RingEntry> around_;
  EnergyLog out_;
};

}  // namespace

EnergyLog collapse_by_energy(const EnergyInput& input, const EnergyCollapseOptions& options,
                             PlacementLog* placement) {
  return EnergyCollapser(input, options, placement).run();
}

}  // namespace varifold
