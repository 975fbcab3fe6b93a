// Based on: [GarlandHeckbert1997]; [SteinitzRademacher1934] for why it ends in a tetrahedron.
#include <varifold/morph/ring_decimation.h>
#include <varifold/simplify/quadric.h>
#include <algorithm>
#include <queue>
#include <vector>

namespace varifold {
namespace {

// How much of the squared length of an edge counts beside the error of the planes. With nothing,
// flat regions would be emptied in any order, and fans of needles be left.
constexpr float kLengthWeight = 0.02f;
// Valences from here on cost more and more.
constexpr float kFreeValence = 8;

struct Candidate {
  float cost;
  std::uint32_t vertex, target, stamp;
  // The cheapest on top; equal costs by number, so that the order is one.
  bool operator<(const Candidate& other) const {
    return cost != other.cost ? cost > other.cost : vertex > other.vertex;
  }
};

class RingDecimation {
 public:
  RingDecimation(RingMesh& mesh, std::span<const Vec3> positions, const DecimationOptions& options)
      : mesh_(mesh),
        options_(options),
        positions_(positions),
        quadrics_(positions.size()),
        stamps_(positions.size(), 0) {}

  CollapseRecord run() {
    const std::uint32_t least = std::max(options_.least, 4u);
    const auto count = static_cast<std::uint32_t>(positions_.size());
    for (std::uint32_t v = 0; v < count; ++v)
      if (mesh_.is_live(v)) quadrics_[v] = quadric_of(v);
    CollapseRecord record;
    const bool has_holds = !options_.holds.empty();
    go_on(has_holds ? std::max(least, options_.late) : least, record);
    if (has_holds) {
      most_ = Hold::kLate;
      go_on(least, record);
    }
    return record;
  }

 private:
  void go_on(std::uint32_t least, CollapseRecord& record) {
    for (std::uint32_t v = 0; v < positions_.size(); ++v)
      if (mesh_.is_live(v)) push_best(v);
    while (mesh_.vertex_count() > least && !queue_.empty()) {
      const Candidate best = queue_.top();
      queue_.pop();
      if (best.stamp != stamps_[best.vertex]) continue;
      // A collapse gives its target new neighbours, which may be those of a candidate, too.
      if (is_allowed(best.vertex, best.target))
        step(best, record);
      else
        push_best(best.vertex);
    }
  }

  Quadric quadric_of(std::uint32_t vertex) const {
    Quadric quadric;
    const auto ring = mesh_.ring(vertex);
    for (std::size_t i = 0; i < ring.size(); ++i) {
      const Vec3 u = positions_[ring[i]] - positions_[vertex];
      const Vec3 v = positions_[ring[(i + 1) % ring.size()]] - positions_[vertex];
      const Vec3 area = 0.5f * glm::cross(u, v);
      quadric.add_plane(normalize_or_zero(area), glm::length(area));
      quadric.add_point(kLengthWeight * glm::length(area));
    }
    return quadric;
  }

  [[nodiscard]] bool is_barred(std::uint32_t target) const {
    return options_.bars_targets && options_.holds[target] == Hold::kAlways;
  }

  void push_best(std::uint32_t vertex) {
    ++stamps_[vertex];
    if (!options_.holds.empty() && options_.holds[vertex] > most_) return;
    Candidate best{0, vertex, kNone, stamps_[vertex]};
    for (const std::uint32_t target : mesh_.ring(vertex)) {
      if (is_barred(target)) continue;
      const Vec3 way = positions_[target] - positions_[vertex];
      const auto valence =
          static_cast<float>(mesh_.ring(vertex).size() + mesh_.ring(target).size()) - 4;
      const float excess = valence > kFreeValence ? valence - kFreeValence : 0.0f;
      const float cost = (quadrics_[vertex].at(way) + 1e-30f) * (1 + excess * excess);
      if (best.target != kNone && !(cost < best.cost)) continue;
      if (!is_allowed(vertex, target)) continue;
      best.cost = cost, best.target = target;
    }
    if (best.target != kNone) queue_.push(best);
  }

  void step(const Candidate& collapse, CollapseRecord& record) {
    ++stamps_[collapse.vertex];
    mesh_.collapse(collapse.vertex, collapse.target, record);
    const Vec3 way = positions_[collapse.target] - positions_[collapse.vertex];
    quadrics_[collapse.target] += quadrics_[collapse.vertex].moved_by(way);
    for (const std::uint32_t v : record.ring(record.steps.back())) push_best(v);
  }

  [[nodiscard]] bool is_allowed(std::uint32_t vertex, std::uint32_t target) const {
    return mesh_.can_collapse(vertex, target) && (options_.points.empty() || sees(vertex, target));
  }

  // Whether the triangles that `target` gets are positive.
  [[nodiscard]] bool sees(std::uint32_t vertex, std::uint32_t target) const {
    const auto ring = mesh_.ring(vertex);
    for (std::size_t i = 0; i < ring.size(); ++i) {
      const std::uint32_t p = ring[i], q = ring[i + 1 == ring.size() ? 0 : i + 1];
      if (p == target || q == target) continue;
      if (orientation(options_.points[target], options_.points[p], options_.points[q]) <= 0)
        return false;
    }
    return true;
  }

  RingMesh& mesh_;
  const DecimationOptions& options_;
  Hold most_ = Hold::kFree;  // that may go now
  std::span<const Vec3> positions_;
  std::vector<Quadric> quadrics_;
  std::vector<std::uint32_t> stamps_;
  std::priority_queue<Candidate> queue_;
};

}  // namespace

CollapseRecord decimate(RingMesh& mesh, std::span<const Vec3> positions,
                        const DecimationOptions& options) {
  return RingDecimation(mesh, positions, options).run();
}

}  // namespace varifold
