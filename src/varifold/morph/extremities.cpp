// Based on: [Gonzalez1985], the farthest of all that are left.
#include <varifold/morph/extremities.h>
#include <algorithm>
#include <limits>
#include <queue>
#include <utility>

namespace varifold {
namespace {

constexpr double kFar = std::numeric_limits<double>::infinity();

class EdgeGraph {
 public:
  explicit EdgeGraph(const SurfaceView& surface)
      : surface_(surface), first_(surface.positions.size() + 1, 0) {
    for (const std::uint32_t vertex : surface.indices) ++first_[vertex + 1];
    for (std::size_t v = 1; v < first_.size(); ++v) first_[v] += first_[v - 1];
    next_.resize(surface.indices.size());
    std::vector<std::uint32_t> filled(first_.begin(), first_.end() - 1);
    // Every edge of a closed surface leaves each of its ends once.
    for (std::size_t h = 0; h < surface.indices.size(); ++h)
      next_[filled[surface.indices[h]]++] = surface.indices[h % 3 == 2 ? h - 2 : h + 1];
  }

  [[nodiscard]] std::vector<double> distances_from(std::uint32_t start) const {
    std::vector<double> distance(first_.size() - 1, kFar);
    using Entry = std::pair<double, std::uint32_t>;
    std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
    distance[start] = 0;
    queue.emplace(0, start);
    while (!queue.empty()) {
      const auto [at, vertex] = queue.top();
      queue.pop();
      if (at > distance[vertex]) continue;
      for (std::uint32_t i = first_[vertex]; i < first_[vertex + 1]; ++i) {
        const std::uint32_t other = next_[i];
        const double there =
            at + glm::distance(DVec3(surface_.positions[vertex]), DVec3(surface_.positions[other]));
        if (there < distance[other]) queue.emplace(distance[other] = there, other);
      }
    }
    return distance;
  }

 private:
  const SurfaceView& surface_;
  std::vector<std::uint32_t> first_, next_;
};

std::uint32_t farthest(const std::vector<double>& distances) {
  return static_cast<std::uint32_t>(std::max_element(distances.begin(), distances.end()) -
                                    distances.begin());
}

}  // namespace

Extremities find_extremities(const SurfaceView& surface, std::size_t count) {
  Extremities found;
  const EdgeGraph graph(surface);
  std::vector<std::vector<double>> rows;
  std::vector<double> nearest(surface.positions.size(), kFar);
  std::uint32_t next = farthest(graph.distances_from(0));
  while (found.vertices.size() < count &&
         std::find(found.vertices.begin(), found.vertices.end(), next) == found.vertices.end()) {
    found.vertices.push_back(next);
    rows.push_back(graph.distances_from(next));
    for (std::size_t v = 0; v < nearest.size(); ++v)
      nearest[v] = std::min(nearest[v], rows.back()[v]);
    next = farthest(nearest);
  }
  double greatest = 0;
  for (const auto& row : rows)
    for (const std::uint32_t v : found.vertices) greatest = std::max(greatest, row[v]);
  for (const auto& row : rows)
    for (const std::uint32_t v : found.vertices)
      found.distances.push_back(greatest > 0 ? row[v] / greatest : 0.0);
  return found;
}

}  // namespace varifold
