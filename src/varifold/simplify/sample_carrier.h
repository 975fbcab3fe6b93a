// Points of the full surface, carried down a sequence on the triangles near them.
//
// Based on: [Hoppe1996] section 4.1 (sample points stay attached to their nearest faces).
#pragma once

#include <varifold/base/progress.h>
#include <varifold/simplify/collapse_sequence.h>
#include <varifold/simplify/sample_blocks.h>
#include <varifold/simplify/star_triangles.h>
#include <varifold/simplify/star_walk.h>
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <span>
#include <vector>

namespace varifold {

/// The vertices at each position: where a mesh has seams, the triangles around a point are spread
/// over several of them.
class VerticesByPlace {
 public:
  explicit VerticesByPlace(const TriangleMesh& mesh);

  template <class Visit>
  void for_each_at(std::uint32_t vertex, const Visit& visit) const {
    if (class_of_.empty()) return visit(vertex);
    const std::uint32_t c = class_of_[vertex];
    for (std::uint32_t i = first_[c]; i < first_[c + 1]; ++i) visit(vertices_[i]);
  }

 private:
  std::vector<std::uint32_t> class_of_, first_, vertices_;
};

/// A point of the full mesh, and a triangle that holds it.
struct SurfaceSample {
  Vec3 position;
  std::uint32_t triangle;
  /// It is `part` of the way between two vertices; kNone where it lies inside a triangle.
  std::uint32_t from = kNone, to = kNone;
  float part = 0;
  /// The sample is let go when it comes to a triangle of this area, doubled; beside such ones its
  /// neighbours tell as much.
  float released_at = std::numeric_limits<float>::infinity();
};

struct SampleOptions {
  /// Points at random places of every triangle of the full mesh, beside its vertices. Their places
  /// depend on the triangle's number alone.
  std::uint32_t inside_triangles = 0;
  /// Points that divide every edge into equal parts: where edges cross ridges and valleys of the
  /// coarse mesh they are farther off than their ends. Let go on triangles whose doubled area is
  /// kReleaseAt times the edge's length squared; the one at the middle at twice that.
  std::uint32_t on_edges = 0;
  /// Only every `shares`th of them, from `share` on.
  std::uint32_t share = 0, shares = 1;
};

/// See SampleOptions::on_edges.
inline constexpr float kReleaseAt = 16;

/// All vertices that have triangles, points inside the triangles and on the edges, along a Morton
/// curve; those of an edge follow one another. O(n).
[[nodiscard]] std::vector<SurfaceSample> surface_samples(const DetailedMesh& detailed,
                                                         const SampleOptions& options);

/// Replays the collapses and moves the samples of the triangles that a collapse touches to the
/// nearest of those that it leaves there. 20 bytes a triangle, 12 a vertex,
/// 20 a sample and as much again for room to grow; without a history 12 bytes more a triangle and 8
/// a vertex.
class SampleCarrier {
 public:
  struct Sample {
    Vec3 position;
    float released_at;
    std::uint32_t number;
  };

  /// With the samples of surface_samples(), numbered in that order.
  SampleCarrier(const DetailedMesh& detailed, const VerticesByPlace& places,
                const SampleOptions& options, const SequenceHistory* history = nullptr);

  [[nodiscard]] std::uint32_t level() const { return walk_.level(); }

  /// One collapse, to level() - 1. `nearest` finds the triangle that a sample goes to, as
  /// NearestTriangle does, or by the number of the sample (then there is no residual);
  /// visit(sample, residual) gets each Sample that the collapse moved, and the way to the point
  /// where it is now attached. A sample whose triangle is so great that it is let go is visited for
  /// the last time.
  ///
  /// A collapse that leaves none of the triangles around its point and moves none (is_ear()) hands
  /// its samples to the triangles at its target.
  ///
  /// stars(slots) gets the slots of the vertices that the collapse removes or moves, before it,
  /// and after it those that it has changed and of the vertices that it has moved; position() and
  /// corners() are those of the level. With vertices that move slots of a triangle may be in there
  /// more than once.
  template <class Nearest, class Visit, class Stars>
  void collapse(Nearest& nearest, const Visit& visit, const Stars& stars) {
    prefetch();
    gather_before();
    stars(std::span<const std::uint32_t>(slots_));
    detach();
    walk_.collapse();
    move_placed();
    gather_left();
    stars(std::span<const std::uint32_t>(slots_));
    gather_candidates();
    if (moving_.empty()) return;
    nearest.reset(candidates_);
    const auto move_to = [&](const Sample& sample, std::size_t found, const Vec3& residual) {
      if (doubled_areas_[found] < sample.released_at)
        samples_.add(candidates_[found].triangle, sample);
      visit(sample, residual);
    };
    if constexpr (requires(NearestBatch batch) { nearest.find(batch); }) {
      find_in_batches(nearest, move_to);
    } else if constexpr (requires(const Sample& sample) { nearest.find(sample); }) {
      for (const Sample& sample : moving_) move_to(sample, nearest.find(sample), Vec3(0));
    } else {
      for (const Sample& sample : moving_) {
        Vec3 residual;
        const std::size_t found = nearest.find(sample.position, residual);
        move_to(sample, found, residual);
      }
    }
    samples_.tidy();
  }
  template <class Nearest, class Visit>
  void collapse(Nearest& nearest, const Visit& visit) {
    collapse(nearest, visit, [](std::span<const std::uint32_t>) {});
  }
  [[nodiscard]] bool is_ear() const { return is_ear_; }
  [[nodiscard]] const std::vector<std::uint32_t>& corners() const { return walk_.corners(); }
  /// Of a vertex at the present level.
  [[nodiscard]] const Vec3& position(std::uint32_t vertex) const { return positions_[vertex]; }

 private:
  template <class Nearest, class MoveTo>
  void find_in_batches(const Nearest& nearest, const MoveTo& move_to) const {
    NearestBatch batch{};
    for (std::size_t begin = 0; begin < moving_.size(); begin += NearestBatch::kSize) {
      const std::size_t count = std::min(NearestBatch::kSize, moving_.size() - begin);
      for (std::size_t i = 0; i < count; ++i) {
        const Vec3& p = moving_[begin + i].position;
        batch.x[i] = p.x, batch.y[i] = p.y, batch.z[i] = p.z;
      }
      nearest.find(batch);
      for (std::size_t i = 0; i < count; ++i)
        move_to(moving_[begin + i], static_cast<std::size_t>(batch.found[i]),
                Vec3(batch.way_x[i], batch.way_y[i], batch.way_z[i]));
    }
  }
  [[nodiscard]] std::span<const std::uint32_t> placed_by(std::uint32_t step) const;
  void prefetch() const;
  void gather_before();
  void detach();
  void move_placed();
  void gather_left();
  void gather_candidates();

  const DetailedMesh& detailed_;
  const VerticesByPlace& places_;
  std::vector<Vec3> positions_;  // at the present level
  StarWalk walk_;
  SamplesOfOwners<Sample, 4> samples_;  // of triangles
  std::vector<Sample> moving_;
  std::vector<std::uint32_t> slots_;
  std::vector<StarTriangle> candidates_;  // for the samples that move
  std::vector<float> doubled_areas_;      // of each
  bool is_ear_ = false;
};

/// How the samples are carried in parallel: in so many shares.
[[nodiscard]] std::uint32_t sample_shares(int threads, const CollapseSequence& sequence);

struct CarryOptions {
  int threads = 0;
  Progress progress;
  std::uint32_t inside_triangles = 0, on_edges = 0;  ///< see SampleOptions
  const SequenceHistory* history = nullptr;          ///< of the sequence, where there is one
};

/// Carries all samples from the full level to the base, sample_shares() carriers at a time:
/// collapse(share, carrier) has to call carrier.collapse() once. Returns false when cancelled.
bool carry_samples(const DetailedMesh& detailed, const CarryOptions& options,
                   const std::function<void(std::uint32_t share, SampleCarrier&)>& collapse);

}  // namespace varifold
