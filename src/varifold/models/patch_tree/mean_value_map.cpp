#include <varifold/models/patch_tree/mean_value_map.h>

#include <algorithm>
#include <cmath>
#include <tuple>
#include <vector>

namespace varifold {

namespace {

constexpr int kMaxRounds = 500;
// Of the size of the piece; what is left to move counts for nothing in a mean of squares.
constexpr double kResolution = 1e-5;
// Tangents of half angles beyond this (179.4 degrees) would drown all other weights.
constexpr double kMaxTangent = 200;

struct Weight {
  std::uint32_t neighbor;
  double weight;
};

class Map {
 public:
  explicit Map(const MappedPiece& piece)
      : piece_(piece), image_(piece.positions.begin(), piece.positions.end()) {
    gather_weights();
    mark_reachable();
  }

  void relax() {
    Box box;
    for (const Vec3& p : piece_.positions) box.add(p);
    const double still = kResolution * (box.empty() ? 0 : box.diagonal());
    for (int round = 0; round < kMaxRounds; ++round) {
      double greatest = 0;
      for (std::uint32_t v = 0; v < image_.size(); ++v)
        if (has_image_[v] && !piece_.is_locked[v]) greatest = std::max(greatest, move(v));
      if (greatest <= still) return;
    }
  }

  void write(std::span<float> squared) const {
    for (std::size_t v = 0; v < image_.size(); ++v) {
      const DVec3 way = image_[v] - DVec3(piece_.positions[v]);
      squared[v] = has_image_[v] ? static_cast<float>(glm::dot(way, way)) : -1.0f;
    }
  }

 private:
  double move(std::uint32_t v) {
    DVec3 sum(0);
    double total = 0;
    for (std::uint32_t i = first_[v]; i < first_[v + 1]; ++i) {
      sum += weights_[i].weight * image_[weights_[i].neighbor];
      total += weights_[i].weight;
    }
    const DVec3 to = sum / total;
    const double way = glm::length(to - image_[v]);
    image_[v] = to;
    return way;
  }

  // Every corner adds the tangent of half its angle to the two edges beside it.
  void gather_weights() {
    struct Part {
      std::uint32_t v, n;
      double tangent;
    };
    std::vector<Part> parts;
    parts.reserve(2 * piece_.corners.size());
    for (std::size_t t = 0; t < piece_.corners.size(); t += 3) {
      for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t v = piece_.corners[t + k];
        const std::uint32_t a = piece_.corners[t + (k + 1) % 3];
        const std::uint32_t b = piece_.corners[t + (k + 2) % 3];
        const double tangent = half_tangent(v, a, b);
        parts.push_back({v, a, tangent});
        parts.push_back({v, b, tangent});
      }
    }
    std::stable_sort(parts.begin(), parts.end(), [](const Part& x, const Part& y) {
      return std::tie(x.v, x.n) < std::tie(y.v, y.n);
    });
    const auto end_of_edge = [&](std::size_t i) {
      std::size_t end = i + 1;
      while (end < parts.size() && parts[end].v == parts[i].v && parts[end].n == parts[i].n) ++end;
      return end;
    };
    std::vector<std::uint8_t> is_rim(image_.size(), 0);
    for (std::size_t i = 0, end; i < parts.size(); i = end) {
      end = end_of_edge(i);
      if (end == i + 1) is_rim[parts[i].v] = 1;
    }
    first_.assign(image_.size() + 1, 0);
    for (std::size_t i = 0, end; i < parts.size(); i = end) {
      end = end_of_edge(i);
      if (is_rim[parts[i].v] && end != i + 1) continue;
      double sum = 0;
      for (std::size_t k = i; k < end; ++k) sum += parts[k].tangent;
      add_weight(parts[i].v, parts[i].n, is_rim[parts[i].v] ? 1 : sum);
    }
    for (std::size_t v = 1; v < first_.size(); ++v) first_[v] += first_[v - 1];
  }

  void add_weight(std::uint32_t v, std::uint32_t n, double tangents) {
    const double length = glm::length(DVec3(piece_.positions[n]) - DVec3(piece_.positions[v]));
    const double weight = tangents / length;
    if (!(weight > 0) || !std::isfinite(weight)) return;
    weights_.push_back({n, weight});
    ++first_[v + 1];
  }

  [[nodiscard]] double half_tangent(std::uint32_t v, std::uint32_t a, std::uint32_t b) const {
    const DVec3 to_a = DVec3(piece_.positions[a]) - DVec3(piece_.positions[v]);
    const DVec3 to_b = DVec3(piece_.positions[b]) - DVec3(piece_.positions[v]);
    const double cosine = glm::dot(to_a, to_b);
    const double length = glm::length(to_a) * glm::length(to_b);
    // tan(x / 2) = (1 - cos x) / sin x
    const double sine = glm::length(glm::cross(to_a, to_b));
    return sine > 0 ? std::min(kMaxTangent, (length - cosine) / sine)
                    : (cosine < 0 ? kMaxTangent : 0);
  }

  // Only what has a vertex that stays within reach has a place.
  void mark_reachable() {
    has_image_.assign(piece_.is_locked.begin(), piece_.is_locked.end());
    for (bool grew = true; grew;) {
      grew = false;
      for (std::uint32_t v = 0; v < image_.size(); ++v) {
        if (has_image_[v]) continue;
        for (std::uint32_t i = first_[v]; i < first_[v + 1] && !has_image_[v]; ++i)
          has_image_[v] = has_image_[weights_[i].neighbor];
        grew |= has_image_[v] != 0;
      }
    }
  }

  const MappedPiece& piece_;
  std::vector<DVec3> image_;
  std::vector<std::uint8_t> has_image_;
  std::vector<std::uint32_t> first_;  // per vertex, and one more: in weights_
  std::vector<Weight> weights_;
};

}  // namespace

void map_by_mean_values(const MappedPiece& piece, std::span<float> squared) {
  Map map(piece);
  map.relax();
  map.write(squared);
}

}  // namespace varifold
