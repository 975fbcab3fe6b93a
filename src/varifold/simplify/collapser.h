// Draining collapses from one cell of the surface: pop, test, collapse, log.
#pragma once

#include <varifold/simplify/attribute_field.h>
#include <varifold/simplify/bucket_queue.h>
#include <varifold/simplify/legality.h>
#include <varifold/simplify/point_quadric.h>
#include <varifold/simplify/pose_field.h>
#include <varifold/simplify/ring_merge.h>
#include <varifold/simplify/working_surface.h>
#include <cstdint>
#include <vector>

namespace varifold {

/// One collapse as it was done.
struct CollapseLogEntry {
  std::uint32_t from, onto;     ///< points
  float error;                  ///< an estimate of the distance so far, unit scale
  std::uint16_t bucket;         ///< the bucket of its cost: the order across cells
  std::uint16_t removed_faces;  ///< how many entries of the log of faces belong to it
};

/// A range of points with a queue and a log of its own. During a parallel round only points whose
/// whole ring lies in [begin, end) are touched; the others wait in `deferred`.
struct Cell {
  std::uint32_t begin = 0, end = 0;
  BucketQueue queue;
  std::vector<CollapseLogEntry> log;
  std::vector<std::uint32_t> removed_faces;
  std::vector<std::uint32_t> deferred;
  std::uint32_t limit = 0;  ///< the bucket at which the present round ends
  std::size_t most_faces = static_cast<std::size_t>(-1);  ///< to remove in the present round

  MergeScratch scratch;
  RingOffsets offsets;
  PoseScratch poses;
};

/// What a Collapser works on besides the surface.
struct CollapserOptions {
  LegalityOptions legality;
  QuadricOptions quadric;
  /// A collapse costs at least this times the square of how far the surface around the point has
  /// moved with it: quadrics are weighted by area, and thin spikes have none. 0: quadrics alone.
  float distance_weight = 0;
};

/// What else a collapse has to pass, for those who divide the surface into regions. Several threads
/// ask at once, each of points whose neighbours all belong to the cell that it drains: what one of
/// them reads of its points and of those around the target, no other changes at that time.
class CollapseGuard {
 public:
  virtual ~CollapseGuard() = default;
  /// Whether the guard wants to know of collapses of this point. Not asked of points without
  /// features.
  [[nodiscard]] virtual bool watches(std::uint32_t point) const = 0;
  /// Asked for a legal collapse of a watched point, or onto one.
  [[nodiscard]] virtual bool allows(std::uint32_t from, std::uint32_t onto) = 0;
  /// A watched point has collapsed.
  virtual void collapsed(std::uint32_t from, std::uint32_t onto) = 0;
};

class Collapser {
 public:
  /// `attributes` may be null, or empty: then geometry alone decides.
  Collapser(WorkingSurface& surface, AttributeField* attributes, const CollapserOptions& options)
      : surface_(surface),
        attributes_(attributes && !attributes->empty() ? attributes : nullptr),
        options_(options) {}

  /// Finds the best collapse of a point of the cell and queues it. Nothing for a dead one.
  void queue_one(Cell& cell, std::uint32_t point);

  /// Queues a blocked point of the cell again, to be looked at first. False where it is not blocked
  /// or can never go.
  bool wake(Cell& cell, std::uint32_t point);

  /// Collapses in order of cost until the next bucket is `limit`. With `confined`, points with a
  /// neighbour outside the cell go to `deferred` instead.
  void drain(Cell& cell, std::uint32_t limit, bool confined);

  /// Why the cheapest collapse of a live point is refused; kFixed where its kind allows none.
  [[nodiscard]] Refusal refusal_of(Cell& scratch, std::uint32_t point);

  /// Where `queue` of the cells other than the drained one receive points that become free again:
  /// the serial pass sets this; null means the drained cell itself.
  std::vector<Cell>* home_cells = nullptr;
  CollapseGuard* guard = nullptr;
  const PoseField* poses = nullptr;   ///< other poses of the surface, where there are some
  std::uint32_t points_per_home = 1;  ///< all but the last of those have as many

 private:
  struct Candidate {
    float cost;
    std::uint32_t target;
  };
  [[nodiscard]] bool is_watched(std::uint32_t point) const {
    return guard && surface_.points[point].kind != VertexKind::kManifold && guard->watches(point);
  }
  [[nodiscard]] bool leaves_cell(const Cell& cell, std::uint32_t point);
  /// Errors of collapses of a point, whose offsets are gathered already.
  [[nodiscard]] RingErrors ring_errors(Cell& cell, std::uint32_t point);
  [[nodiscard]] float attribute_cost(std::uint32_t point, std::uint32_t onto, const Vec3& d);
  /// Sets target and step of a point and returns the cost; target kNone where it may not go.
  [[nodiscard]] float find_candidate(Cell& cell, std::uint32_t point);
  [[nodiscard]] Refusal test(Cell& cell, std::uint32_t from, std::uint32_t onto);
  /// Tries the candidates of a point from the cheapest on. True when one was done.
  void try_others(Cell& cell, std::uint32_t point);
  /// Not before which bucket a legal collapse may be done; no less than `now`. Raises the step of
  /// the point to what it would move.
  [[nodiscard]] std::uint32_t due_bucket(std::uint32_t from, std::uint32_t onto, std::uint32_t now);
  void collapse(Cell& cell, std::uint32_t from, std::uint32_t onto);
  void touch(Cell& cell, std::uint32_t point);
  void requeue(Cell& cell, std::uint32_t point, std::uint32_t bucket);

  WorkingSurface& surface_;
  AttributeField* attributes_;
  CollapserOptions options_;
};

}  // namespace varifold
