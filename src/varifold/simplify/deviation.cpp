#include <varifold/base/parallel.h>
#include <varifold/simplify/deviation.h>

#include <varifold/mesh/weld.h>
#include <varifold/simplify/closest_on_triangle.h>
#include <varifold/simplify/morton.h>
#include <varifold/simplify/sequence_replay.h>
#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>

namespace varifold {

namespace {

// The vertices at each position: where a mesh has seams, the triangles around a point are spread
// over several of them.
class VerticesByPlace {
 public:
  explicit VerticesByPlace(const TriangleMesh& mesh) {
    if (!mesh.has_normals() && !mesh.has_texcoords() && !mesh.has_colors() &&
        mesh.ranges.size() <= 1)
      return;  // without attributes there is one vertex at a place
    WeldMap weld = weld_exact(mesh.positions);
    first_.assign(weld.class_count + 1, 0);
    for (const std::uint32_t c : weld.class_of) ++first_[c + 1];
    for (std::size_t c = 1; c < first_.size(); ++c) first_[c] += first_[c - 1];
    std::vector<std::uint32_t> cursor(first_.begin(), first_.end() - 1);
    vertices_.resize(weld.class_of.size());
    for (std::uint32_t v = 0; v < weld.class_of.size(); ++v)
      vertices_[cursor[weld.class_of[v]]++] = v;
    class_of_ = std::move(weld.class_of);
  }

  template <class Visit>
  void for_each_at(std::uint32_t vertex, const Visit& visit) const {
    if (class_of_.empty()) return visit(vertex);
    const std::uint32_t c = class_of_[vertex];
    for (std::uint32_t i = first_[c]; i < first_[c + 1]; ++i) visit(vertices_[i]);
  }

 private:
  std::vector<std::uint32_t> class_of_, first_, vertices_;
};

// One share of the samples, carried down a replay of its own.
class SampleCarrier {
 public:
  SampleCarrier(const DetailedMesh& detailed, const VerticesByPlace& places, std::uint32_t share,
                std::uint32_t shares)
      : detailed_(detailed),
        places_(places),
        positions_(detailed.mesh.positions),
        replay_(detailed) {
    first_sample_.assign(detailed.mesh.triangle_count(), kNone);
    std::vector<std::uint32_t> triangle_of(detailed.mesh.vertex_count(), kNone);
    for (std::size_t slot = 0; slot < detailed.mesh.indices.size(); ++slot)
      triangle_of[detailed.mesh.indices[slot]] = static_cast<std::uint32_t>(slot / 3);

    // Along a Morton curve, so that the samples of a triangle share cache lines.
    std::vector<std::uint32_t> chosen;
    for (std::uint32_t v = share; v < detailed.mesh.vertex_count(); v += shares)
      if (triangle_of[v] != kNone) chosen.push_back(v);
    samples_.reserve(chosen.size());
    for (const std::uint32_t v : morton_order(positions_, chosen, bounds(detailed.mesh))) {
      samples_.push_back({positions_[v], kNone});
      attach(static_cast<std::uint32_t>(samples_.size() - 1), triangle_of[v]);
    }
  }

  [[nodiscard]] std::uint32_t level() const { return replay_.level(); }

  /// The greatest squared distance of a sample that this collapse moved.
  float collapse() {
    gather_before();
    replay_.collapse();
    move_placed();
    gather_after();
    float greatest = 0;
    for (std::uint32_t sample = moving_; sample != kNone;) {
      const std::uint32_t next = samples_[sample].next;
      greatest = std::max(greatest, attach_to_nearest(sample));
      sample = next;
    }
    return greatest;
  }

 private:
  struct Sample {
    Vec3 position;
    std::uint32_t next;  // of the same triangle
  };
  void attach(std::uint32_t sample, std::uint32_t triangle) {
    samples_[sample].next = first_sample_[triangle];
    first_sample_[triangle] = sample;
  }

  // Detach the samples of all triangles at the vertices that move (and, with placement, at those
  // that are moved).
  void gather_before() {
    const CollapseSequence& sequence = detailed_.sequence;
    const std::uint32_t level = replay_.level();
    slots_.clear();
    for (std::uint32_t v = sequence.vertices[level - 1]; v < sequence.vertices[level]; ++v)
      replay_.slots_of(v, slots_);
    if (sequence.moves_vertices())
      for (std::uint32_t j = sequence.first_placed[level - 1]; j < sequence.first_placed[level];
           ++j)
        replay_.slots_of(sequence.placed_vertex[j], slots_);
    moving_ = kNone;
    for (const std::uint32_t slot : slots_) {
      std::uint32_t sample = first_sample_[slot / 3];
      first_sample_[slot / 3] = kNone;
      while (sample != kNone) {
        const std::uint32_t next = samples_[sample].next;
        samples_[sample].next = moving_;
        moving_ = sample;
        sample = next;
      }
    }
  }

  void move_placed() {
    const CollapseSequence& sequence = detailed_.sequence;
    if (!sequence.moves_vertices()) return;
    const std::uint32_t level = replay_.level();
    for (std::uint32_t j = sequence.first_placed[level]; j < sequence.first_placed[level + 1]; ++j)
      positions_[sequence.placed_vertex[j]] = sequence.placed.positions[j];
  }

  // The triangles that the samples may go to.
  void gather_after() {
    candidates_.clear();
    if (moving_ == kNone) return;
    const CollapseSequence& sequence = detailed_.sequence;
    const std::uint32_t level = replay_.level();
    for (const std::uint32_t slot : replay_.changed()) candidates_.push_back(slot / 3);
    if (sequence.moves_vertices() || candidates_.empty()) {
      slots_.clear();
      for (std::uint32_t v = sequence.vertices[level]; v < sequence.vertices[level + 1]; ++v)
        places_.for_each_at(sequence.target[v],
                            [&](std::uint32_t w) { replay_.slots_of(w, slots_); });
      for (const std::uint32_t slot : slots_) candidates_.push_back(slot / 3);
    }
    if (candidates_.empty()) candidates_.push_back(0);  // never: a collapse leaves faces behind
  }

  float attach_to_nearest(std::uint32_t sample) {
    const Vec3 p = samples_[sample].position;
    float least = std::numeric_limits<float>::infinity();
    std::uint32_t nearest = candidates_[0];
    for (const std::uint32_t triangle : candidates_) {
      const std::uint32_t* corner = &replay_.corners()[3 * std::size_t{triangle}];
      const Vec3 from_p = closest_on_triangle(positions_[corner[0]] - p, positions_[corner[1]] - p,
                                              positions_[corner[2]] - p)
                              .position;
      const float distance = glm::dot(from_p, from_p);
      if (!(distance < least)) continue;
      least = distance;
      nearest = triangle;
    }
    attach(sample, nearest);
    return least;
  }

  const DetailedMesh& detailed_;
  const VerticesByPlace& places_;
  std::vector<Vec3> positions_;  // at the present level
  SequenceReplay replay_;
  std::vector<std::uint32_t> first_sample_;  // per triangle
  std::vector<Sample> samples_;
  std::vector<std::uint32_t> slots_, candidates_;
  std::uint32_t moving_ = kNone;
};

constexpr std::uint32_t kReportEvery = 4096;
// Distances are rounded a few times on their way; the bound must hold all the same.
constexpr float kRounding = 1 + 1e-5f;

}  // namespace

std::vector<float> step_deviations(const DetailedMesh& detailed, const DeviationOptions& options) {
  const std::uint32_t steps = detailed.sequence.step_count();
  const std::uint32_t shares =
      std::min(options.threads > 0 ? options.threads : hardware_threads(), 4) > 1 && steps > 10000
          ? 2
          : 1;
  std::vector<std::vector<float>> squared(shares, std::vector<float>(steps, 0));
  std::atomic<bool> cancelled{false};
  const VerticesByPlace places(detailed.mesh);

  parallel_for(options.threads, shares, 1, [&](std::size_t share, std::size_t) {
    SampleCarrier carrier(detailed, places, static_cast<std::uint32_t>(share), shares);
    while (carrier.level() > 0 && !cancelled) {
      const std::uint32_t level = carrier.level() - 1;
      squared[share][level] = carrier.collapse();
      if (share == 0 && level % kReportEvery == 0 &&
          !report(options.progress, "measuring", 1 - static_cast<float>(level) / steps))
        cancelled = true;
    }
  });
  if (cancelled) return {};

  std::vector<float> deviations(steps);
  for (std::uint32_t level = 0; level < steps; ++level) {
    float greatest = 0;
    for (const auto& share : squared) greatest = std::max(greatest, share[level]);
    deviations[level] = std::sqrt(greatest) * kRounding;
  }
  return deviations;
}

bool measure_deviation(DetailedMesh& detailed, const DeviationOptions& options) {
  CollapseSequence& sequence = detailed.sequence;
  const std::uint32_t steps = sequence.step_count();
  const std::vector<float> deviations = step_deviations(detailed, options);
  if (deviations.size() != steps) return false;

  sequence.error.assign(steps + 1, 0);
  for (std::uint32_t level = steps; level-- > 0;)
    sequence.error[level] = std::max(sequence.error[level + 1], deviations[level]);
  sequence.error_is_measured = true;
  return true;
}

}  // namespace varifold
