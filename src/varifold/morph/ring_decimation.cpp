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
  RingDecimation(RingMesh& mesh, std::span<const Vec3> positions, const std::vector<bool>& is_fixed)
      : mesh_(mesh),
        positions_(positions),
        is_fixed_(is_fixed),
        quadrics_(positions.size()),
        stamps_(positions.size(), 0) {}

  CollapseRecord run(std::uint32_t least) {
    const auto count = static_cast<std::uint32_t>(positions_.size());
    for (std::uint32_t v = 0; v < count; ++v) quadrics_[v] = quadric_of(v);
    for (std::uint32_t v = 0; v < count; ++v) push_best(v);
    CollapseRecord record;
    while (mesh_.vertex_count() > least && !queue_.empty()) {
      const Candidate best = queue_.top();
      queue_.pop();
      if (best.stamp != stamps_[best.vertex]) continue;
      // A collapse gives its target new neighbours, which may be those of a candidate, too.
      if (mesh_.can_collapse(best.vertex, best.target))
        step(best, record);
      else
        push_best(best.vertex);
    }
    return record;
  }

 private:
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

  [[nodiscard]] bool is_fixed(std::uint32_t vertex) const {
    return !is_fixed_.empty() && is_fixed_[vertex];
  }

  void push_best(std::uint32_t vertex) {
    if (is_fixed(vertex)) return;
    ++stamps_[vertex];
    Candidate best{0, vertex, kNone, stamps_[vertex]};
    for (const std::uint32_t target : mesh_.ring(vertex)) {
      if (is_fixed(target)) continue;
      const Vec3 way = positions_[target] - positions_[vertex];
      const auto valence =
          static_cast<float>(mesh_.ring(vertex).size() + mesh_.ring(target).size()) - 4;
      const float excess = valence > kFreeValence ? valence - kFreeValence : 0.0f;
      const float cost = (quadrics_[vertex].at(way) + 1e-30f) * (1 + excess * excess);
      if (best.target != kNone && !(cost < best.cost)) continue;
      if (!mesh_.can_collapse(vertex, target)) continue;
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

  RingMesh& mesh_;
  std::span<const Vec3> positions_;
  const std::vector<bool>& is_fixed_;
  std::vector<Quadric> quadrics_;
  std::vector<std::uint32_t> stamps_;
  std::priority_queue<Candidate> queue_;
};

}  // namespace

CollapseRecord decimate_to_tetrahedron(RingMesh& mesh, std::span<const Vec3> positions) {
  const std::vector<bool> none;
  return RingDecimation(mesh, positions, none).run(4);
}

CollapseRecord decimate_to_cone(RingMesh& mesh, std::span<const Vec3> positions,
                                const std::vector<bool>& is_fixed) {
  const auto fixed = std::count(is_fixed.begin(), is_fixed.end(), true);
  return RingDecimation(mesh, positions, is_fixed).run(static_cast<std::uint32_t>(fixed) + 1);
}

}  // namespace varifold
