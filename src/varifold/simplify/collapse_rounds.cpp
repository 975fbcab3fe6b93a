#include <varifold/base/parallel.h>
#include <varifold/simplify/collapse_rounds.h>

#include <algorithm>
#include <cmath>

namespace varifold {

namespace {

// Below this many live points a cell, the borders between cells outweigh what they gain.
constexpr std::uint32_t kMinLivePerCell = 2048;

class Rounds {
 public:
  Rounds(WorkingSurface& surface, Collapser& collapser, const RoundOptions& options)
      : surface_(surface), collapser_(collapser), options_(options) {
    const std::uint32_t count = surface.point_count();
    // The points of one ring pool are one cell, so that no two cells ever share a pool.
    const std::uint32_t size = surface.points_per_pool();
    for (std::uint32_t begin = 0; begin < count; begin += size) {
      Cell& cell = cells_.emplace_back();
      cell.begin = begin;
      cell.end = std::min(count, begin + size);
    }
    if (cells_.empty()) cells_.emplace_back();
    live_points_ = options.live.empty() ? surface.live_points()
                                        : static_cast<std::uint32_t>(options.live.size());
    merge_cells();
  }

  CollapseLog run() {
    log_.entries.reserve(surface_.point_count());
    if (options_.log_faces) log_.removed_faces.reserve(surface_.face_count);
    for_each_cell([&](Cell& cell) {
      for_each_point(cell, [&](std::uint32_t point) { collapser_.queue_one(cell, point); });
    });
    const std::uint32_t all_faces = std::max(1u, surface_.face_count);
    halfway_ = options_.target_faces + (all_faces - std::min(all_faces, options_.target_faces)) / 2;
    while (surface_.face_count > options_.target_faces && (round() || retry_blocked())) {
      log_.queue_bytes = std::max(log_.queue_bytes, queue_bytes());
      merge_cells();
      const float done = 1.0f - static_cast<float>(surface_.face_count) / all_faces;
      if (!report(options_.progress, "simplifying", done)) {
        log_.cancelled = true;
        break;
      }
    }
    return std::move(log_);
  }

 private:
  template <class Body>
  void for_each_cell(const Body& body) {
    parallel_for(options_.threads, cells_.size(), 1,
                 [&](std::size_t begin, std::size_t) { body(cells_[begin]); });
  }

  // Those that were live at the beginning.
  template <class Body>
  void for_each_point(const Cell& cell, const Body& body) const {
    if (options_.live.empty()) {
      for (std::uint32_t p = cell.begin; p < cell.end; ++p) body(p);
      return;
    }
    const auto first = std::lower_bound(options_.live.begin(), options_.live.end(), cell.begin);
    for (auto p = first; p != options_.live.end() && *p < cell.end; ++p) body(*p);
  }

  [[nodiscard]] std::size_t queue_bytes() const {
    std::size_t sum = border_.queue.bytes();
    for (const Cell& cell : cells_) sum += cell.queue.bytes();
    return sum;
  }

  bool round() {
    std::uint32_t lowest = BucketQueue::kBucketCount;
    for (const Cell& cell : cells_) lowest = std::min(lowest, cell.queue.lowest());
    if (lowest >= dearest_) return false;
    const bool alone = cells_.size() == 1;
    std::uint32_t limit =
        (lowest / BucketQueue::kBucketsPerOctave + 1) * BucketQueue::kBucketsPerOctave;
    limit = std::min(limit, dearest_);
    if (options_.exact && !share_out(lowest, limit)) {
      drain_last(lowest);
      return true;
    }

    for_each_cell([&](Cell& cell) { collapser_.drain(cell, limit, !alone); });
    merge_logs(lowest, limit);
    if (!alone) drain_borders(limit);
    find_dearest(limit);
    return true;
  }

  // Halfway to the target: what the dearest collapse may cost.
  void find_dearest(std::uint32_t limit) {
    if (!(options_.most_cost > 0) || surface_.face_count > halfway_ ||
        dearest_ != BucketQueue::kBucketCount)
      return;
    const float cost = options_.most_cost * BucketQueue::least_cost(limit);
    if (std::isfinite(cost)) dearest_ = BucketQueue::bucket_of(cost);
  }

  // Divides the faces that may still go among the cells, by what they have to do below a limit:
  // as many octaves as there is enough for, so that cells are gone through a few times only, or
  // less than one. False where the end is too near for that.
  bool share_out(std::uint32_t lowest, std::uint32_t& limit) {
    const std::uint64_t remaining = surface_.face_count - options_.target_faces;
    const auto entries_below = [&](std::uint32_t bucket) {
      std::uint64_t sum = 0;
      for (const Cell& cell : cells_) sum += cell.queue.count_below(bucket);
      return sum;
    };
    // A collapse removes two faces, and gives way to another one nearby.
    const auto fits = [&](std::uint64_t entries) { return 5 * entries <= 2 * remaining; };
    const std::uint64_t all = entries_below(BucketQueue::kBucketCount);
    std::uint64_t entries = entries_below(limit);
    while (fits(entries) && entries < all && limit < dearest_) {
      const std::uint32_t next = std::min(limit + BucketQueue::kBucketsPerOctave, dearest_);
      const std::uint64_t more = entries_below(next);
      if (!fits(more)) break;
      limit = next;
      entries = more;
    }
    while (!fits(entries) && limit > lowest + 1) {
      limit = lowest + (limit - lowest) / 2;
      entries = entries_below(limit);
    }
    if (!fits(entries) || remaining < 16 * cells_.size()) return false;
    for (Cell& cell : cells_)
      cell.most_faces = remaining * (1 + cell.queue.count_below(limit)) / (entries + cells_.size());
    return true;
  }

  // The lowest bucket of all cells by one thread, up to the target.
  void drain_last(std::uint32_t bucket) {
    border_.queue.restart();
    for (Cell& cell : cells_)
      if (cell.queue.lowest() == bucket) cell.queue.give(bucket, border_.queue);
    drain_border_cell(bucket + 1);
  }

  // A point that had no legal collapse is woken by changes in its own ring only, though one farther
  // off may have made a collapse legal. So they are all tried once more, as long as that helps.
  bool retry_blocked() {
    if (log_.entries.size() == entries_at_retry_) return false;
    entries_at_retry_ = log_.entries.size();
    bool any = false;
    for (Cell& cell : cells_) {
      cell.queue.restart();
      for_each_point(cell, [&](std::uint32_t point) { any |= collapser_.wake(cell, point); });
    }
    return any;
  }

  // Orders the steps of all cells by cost. A cell's own buckets never go down, so each cell keeps
  // its order; steps of different cells touch nothing in common.
  void merge_logs(std::uint32_t lowest, std::uint32_t limit) {
    if (cells_.size() == 1) return append(cells_[0]);
    std::vector<std::size_t> entry_at(cells_.size(), 0), face_at(cells_.size(), 0);
    for (std::uint32_t bucket = lowest; bucket < limit; ++bucket) {
      for (std::size_t i = 0; i < cells_.size(); ++i) {
        const Cell& cell = cells_[i];
        std::size_t faces = 0;
        const std::size_t first = entry_at[i];
        for (; entry_at[i] < cell.log.size() && cell.log[entry_at[i]].bucket <= bucket;
             ++entry_at[i])
          faces += cell.log[entry_at[i]].removed_faces;
        append_range(cell, first, entry_at[i], face_at[i], faces);
        face_at[i] += faces;
      }
    }
    for (Cell& cell : cells_) clear_log(cell);
  }

  void append_range(const Cell& cell, std::size_t first, std::size_t last, std::size_t first_face,
                    std::size_t faces) {
    log_.entries.insert(log_.entries.end(), cell.log.begin() + first, cell.log.begin() + last);
    if (options_.log_faces) {
      const auto face = cell.removed_faces.begin() + static_cast<std::ptrdiff_t>(first_face);
      log_.removed_faces.insert(log_.removed_faces.end(), face,
                                face + static_cast<std::ptrdiff_t>(faces));
    }
    live_points_ -= static_cast<std::uint32_t>(last - first);
    surface_.face_count -= static_cast<std::uint32_t>(faces);
  }

  static void clear_log(Cell& cell) {
    cell.log.clear();
    cell.removed_faces.clear();
  }

  void append(Cell& cell) {
    append_range(cell, 0, cell.log.size(), 0, cell.removed_faces.size());
    clear_log(cell);
  }

  // What touched other cells: now nobody else is at work.
  void drain_borders(std::uint32_t limit) {
    border_.queue.restart();
    for (Cell& cell : cells_) {
      for (const std::uint32_t point : cell.deferred) {
        surface_.points[point].flags |= PointState::kDirty;
        border_.queue.push(point, 0);
      }
      cell.deferred.clear();
    }
    drain_border_cell(limit);
  }

  void drain_border_cell(std::uint32_t limit) {
    Cell& border = border_;
    border.begin = 0;
    border.end = surface_.point_count();
    if (options_.exact) {
      if (surface_.face_count <= options_.target_faces) return;
      border.most_faces = surface_.face_count - options_.target_faces;
    }
    collapser_.home_cells = &cells_;
    collapser_.points_per_home = cells_.front().end;
    collapser_.drain(border, limit, false);
    collapser_.home_cells = nullptr;
    append(border);
  }

  void merge_cells() {
    while (cells_.size() > 1 && live_points_ / cells_.size() < kMinLivePerCell) {
      std::vector<Cell> merged((cells_.size() + 1) / 2);
      for (std::size_t i = 0; i < merged.size(); ++i) {
        merged[i] = std::move(cells_[2 * i]);
        if (2 * i + 1 == cells_.size()) continue;
        merged[i].end = cells_[2 * i + 1].end;
        merged[i].queue.take(cells_[2 * i + 1].queue);
      }
      cells_ = std::move(merged);
    }
  }

  WorkingSurface& surface_;
  Collapser& collapser_;
  const RoundOptions& options_;
  std::vector<Cell> cells_;
  Cell border_;
  CollapseLog log_;
  std::uint32_t live_points_ = 0;
  std::size_t entries_at_retry_ = 0;
  std::uint32_t halfway_ = 0;                          // faces
  std::uint32_t dearest_ = BucketQueue::kBucketCount;  // no bucket from here on
};

}  // namespace

CollapseLog run_rounds(WorkingSurface& surface, Collapser& collapser, const RoundOptions& options) {
  return Rounds(surface, collapser, options).run();
}

}  // namespace varifold
