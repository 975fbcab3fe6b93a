// Points of the full surface, carried down a sequence on the triangles near them.
//
// Based on: [Hoppe1996] section 4.1 (sample points stay attached to their nearest faces).
#pragma once

#include <varifold/base/progress.h>
#include <varifold/simplify/collapse_sequence.h>
#include <varifold/simplify/sequence_replay.h>
#include <varifold/simplify/star_triangles.h>
#include <cstdint>
#include <functional>
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
};

struct SampleOptions {
  /// Points at random places of every triangle of the full mesh, beside its vertices. Their places
  /// depend on the triangle's number alone.
  std::uint32_t inside_triangles = 0;
  /// Only every `shares`th of them, from `share` on.
  std::uint32_t share = 0, shares = 1;
};

/// All vertices that have triangles, and points inside the triangles, along a Morton curve. O(n).
[[nodiscard]] std::vector<SurfaceSample> surface_samples(const DetailedMesh& detailed,
                                                         const SampleOptions& options);

/// Replays the collapses and moves the samples of the triangles that a collapse touches to the
/// nearest of those that it leaves there. 28 bytes a triangle, 20 a vertex, 16 a sample.
class SampleCarrier {
 public:
  SampleCarrier(const DetailedMesh& detailed, const VerticesByPlace& places,
                const std::vector<SurfaceSample>& samples);

  [[nodiscard]] std::uint32_t level() const { return replay_.level(); }

  /// One collapse, to level() - 1. `nearest` finds the triangle that a sample goes to, as
  /// NearestTriangle does; visit(sample, residual) gets each sample that the collapse moved, by its
  /// number, and the way to the point where it is now attached.
  ///
  /// A collapse that leaves none of the triangles around its point and moves none (is_ear()) hands
  /// its samples to the triangles at its target.
  template <class Nearest, class Visit>
  void collapse(Nearest& nearest, const Visit& visit) {
    gather_before();
    replay_.collapse();
    move_placed();
    gather_after();
    if (moving_ != kNone) nearest.reset(candidates_);
    for (std::uint32_t sample = moving_; sample != kNone;) {
      const std::uint32_t next = samples_[sample].next;
      Vec3 residual;
      attach(sample, candidates_[nearest.find(samples_[sample].position, residual)].triangle);
      visit(sample, residual);
      sample = next;
    }
  }
  [[nodiscard]] bool is_ear() const { return is_ear_; }
  /// Of the samples' positions, and of the vertices at the present level.
  [[nodiscard]] const Vec3& sample(std::uint32_t number) const { return samples_[number].position; }
  [[nodiscard]] const Vec3& position(std::uint32_t vertex) const { return positions_[vertex]; }

 private:
  struct Sample {
    Vec3 position;
    std::uint32_t next;  // of the same triangle
  };
  void attach(std::uint32_t sample, std::uint32_t triangle) {
    samples_[sample].next = first_sample_[triangle];
    first_sample_[triangle] = sample;
  }
  [[nodiscard]] std::span<const std::uint32_t> placed_by(std::uint32_t step) const;
  void gather_before();
  void move_placed();
  void gather_after();

  const DetailedMesh& detailed_;
  const VerticesByPlace& places_;
  std::vector<Vec3> positions_;  // at the present level
  SequenceReplay replay_;
  std::vector<std::uint32_t> first_sample_;  // per triangle
  std::vector<Sample> samples_;
  std::vector<std::uint32_t> slots_;
  std::vector<StarTriangle> candidates_;  // for the samples that move
  std::uint32_t moving_ = kNone;
  bool is_ear_ = false;
};

/// How the samples are carried in parallel: in so many shares.
[[nodiscard]] std::uint32_t sample_shares(int threads, const CollapseSequence& sequence);

struct CarryOptions {
  int threads = 0;
  Progress progress;
  std::uint32_t inside_triangles = 0;  ///< see SampleOptions
};

/// Carries all samples from the full level to the base, sample_shares() carriers at a time:
/// collapse(share, carrier) has to call carrier.collapse() once. Returns false when cancelled.
bool carry_samples(const DetailedMesh& detailed, const CarryOptions& options,
                   const std::function<void(std::uint32_t share, SampleCarrier&)>& collapse);

}  // namespace varifold
