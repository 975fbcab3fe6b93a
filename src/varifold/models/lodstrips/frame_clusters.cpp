#include <varifold/models/lodstrips/frame_clusters.h>

#include <varifold/simplify/closest_on_triangle.h>
#include <algorithm>
#include <cmath>
#include <limits>

namespace varifold {

namespace {

// The triangles around each vertex, in rows.
struct Stars {
  std::vector<std::uint32_t> first, triangles;
  explicit Stars(const TriangleMesh& mesh) : first(mesh.vertex_count() + 1, 0) {
    for (const std::uint32_t v : mesh.indices) ++first[v + 1];
    for (std::size_t v = 1; v < first.size(); ++v) first[v] += first[v - 1];
    std::vector<std::uint32_t> next(first.begin(), first.end() - 1);
    triangles.resize(mesh.indices.size());
    for (std::uint32_t i = 0; i < mesh.indices.size(); ++i)
      triangles[next[mesh.indices[i]]++] = i / 3;
  }
};

// What some centres cost: the greatest ratio of a frame to its own sequence, and the sum of all.
struct Cost {
  double greatest = 0, sum = 0;
  friend bool operator<(const Cost& a, const Cost& b) {
    return a.greatest != b.greatest ? a.greatest < b.greatest : a.sum < b.sum;
  }
};

class Grouping {
 public:
  Grouping(std::span<const double> loss, std::uint32_t count) : loss_(loss), count_(count) {}

  [[nodiscard]] std::vector<std::uint32_t> centers(std::uint32_t groups) const {
    std::vector<std::uint32_t> chosen;
    while (chosen.size() < groups) {
      chosen.push_back(0);
      chosen.back() = best_at(chosen, chosen.size() - 1);
    }
    Cost now = cost_of(chosen);
    for (bool any = true; any;) {
      any = false;
      for (std::size_t i = 0; i < chosen.size(); ++i) {
        const std::uint32_t before = chosen[i];
        chosen[i] = best_at(chosen, i);
        const Cost cost = cost_of(chosen);
        if (cost < now) {
          now = cost;
          any = true;
        } else {
          chosen[i] = before;
        }
      }
    }
    std::sort(chosen.begin(), chosen.end());
    return chosen;
  }

  [[nodiscard]] std::uint32_t nearest(const std::vector<std::uint32_t>& centers,
                                      std::uint32_t frame) const {
    std::uint32_t best = 0;
    for (std::uint32_t i = 1; i < centers.size(); ++i)
      if (ratio(centers[i], frame) < ratio(centers[best], frame)) best = i;
    return best;
  }

 private:
  [[nodiscard]] double ratio(std::uint32_t sequence, std::uint32_t frame) const {
    if (sequence == frame) return 1;
    const double own = loss_[std::size_t{frame} * count_ + frame];
    const double other = loss_[std::size_t{sequence} * count_ + frame];
    return own > 0 ? std::max(1.0, other / own) : other > 0 ? 1e30 : 1.0;
  }
  [[nodiscard]] Cost cost_of(const std::vector<std::uint32_t>& centers) const {
    Cost cost;
    for (std::uint32_t frame = 0; frame < count_; ++frame) {
      const double least = ratio(centers[nearest(centers, frame)], frame);
      cost.greatest = std::max(cost.greatest, least);
      cost.sum += least;
    }
    return cost;
  }
  // The frame that would be the best centre in that place.
  [[nodiscard]] std::uint32_t best_at(std::vector<std::uint32_t> centers, std::size_t place) const {
    std::uint32_t best = 0;
    Cost least{std::numeric_limits<double>::infinity(), 0};
    for (std::uint32_t frame = 0; frame < count_; ++frame) {
      centers[place] = frame;
      const Cost cost = cost_of(centers);
      if (!(cost < least)) continue;
      least = cost;
      best = frame;
    }
    return best;
  }

  std::span<const double> loss_;
  std::uint32_t count_;
};

}  // namespace

double level_distance(const DetailedMesh& detailed, std::uint32_t level,
                      std::span<const Vec3> shape) {
  const TriangleMesh at_level = mesh_at_level(detailed, level);
  const std::vector<std::uint32_t> ancestors = detailed.sequence.ancestors(level);
  const Stars stars(at_level);
  double sum = 0;
  for (std::uint32_t v = 0; v < ancestors.size(); ++v) {
    const std::uint32_t ancestor = ancestors[v];
    const Vec3 way = shape[ancestor] - shape[v];
    float least = glm::dot(way, way);
    for (std::uint32_t i = stars.first[ancestor]; i < stars.first[ancestor + 1]; ++i) {
      const std::uint32_t* corner = &at_level.indices[3 * std::size_t{stars.triangles[i]}];
      const Vec3 nearest =
          closest_on_triangle(shape[corner[0]] - shape[v], shape[corner[1]] - shape[v],
                              shape[corner[2]] - shape[v])
              .position;
      least = std::min(least, glm::dot(nearest, nearest));
    }
    sum += least;
  }
  return std::sqrt(sum / std::max<std::size_t>(1, ancestors.size()));
}

std::vector<std::uint32_t> group_frames(std::span<const double> loss, std::uint32_t count,
                                        std::uint32_t groups) {
  const Grouping grouping(loss, count);
  const std::vector<std::uint32_t> centers = grouping.centers(std::min(groups, count));
  std::vector<std::uint32_t> number(centers.size(), kNone), result(count);
  std::uint32_t used = 0;
  for (std::uint32_t frame = 0; frame < count; ++frame) {
    std::uint32_t& group = number[grouping.nearest(centers, frame)];
    if (group == kNone) group = used++;
    result[frame] = group;
  }
  return result;
}

}  // namespace varifold
