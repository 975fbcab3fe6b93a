#include <varifold/measure/patch_borders.h>

#include <varifold/mesh/weld.h>
#include <varifold/models/patch_tree/extract.h>
#include <algorithm>
#include <cmath>
#include <span>
#include <tuple>
#include <utility>

namespace varifold::check {

namespace {

/// A point as a patch has it.
struct BorderPoint {
  std::uint32_t point, node, vertex;
  friend bool operator<(const BorderPoint& a, const BorderPoint& b) {
    return std::tie(a.point, a.node, a.vertex) < std::tie(b.point, b.node, b.vertex);
  }
};

class BorderChecker {
 public:
  BorderChecker(const PatchTree& tree, PlaceFaults& faults)
      : data_(tree.data()), faults_(faults), weld_(weld_points(data_.vertices)) {}

  void check_level(std::uint32_t level) {
    gather(level);
    for (std::size_t i = 0, end = 0; i < points_.size(); i = end) {
      while (end < points_.size() && points_[end].point == points_[i].point) ++end;
      const std::span<const BorderPoint> group(points_.data() + i, end - i);
      if (!are_neighbors(group)) faults_.add("neighbor_missing", level, name_of(group));
      if (level > 0) check_survivors(level, group);
    }
  }

 private:
  // Vertices that triangles use; others are there for the children alone.
  void gather(std::uint32_t level) {
    points_.clear();
    const PatchTopology& t = data_.topology;
    for (std::uint32_t node = t.first_of_level[level]; node < t.first_of_level[level + 1]; ++node) {
      const PatchOffsets& at = data_.offsets[node];
      const PatchOffsets& end = data_.offsets[node + 1];
      is_used_.assign(end.vertex - at.vertex, 0);
      for (std::size_t i = 3 * std::size_t{at.triangle}; i < 3 * std::size_t{end.triangle}; ++i)
        is_used_[data_.corners[i]] = 1;
      for (std::uint32_t v = at.vertex; v < end.vertex; ++v)
        if (is_used_[v - at.vertex]) points_.push_back({weld_.class_of[v], node, v});
    }
    std::sort(points_.begin(), points_.end());
  }

  [[nodiscard]] bool are_neighbors(std::span<const BorderPoint> group) const {
    for (const BorderPoint& a : group)
      for (const BorderPoint& b : group) {
        const auto known = data_.topology.neighbors_of(a.node);
        if (a.node != b.node && std::find(known.begin(), known.end(), b.node) == known.end())
          return false;
      }
    return true;
  }

  void check_survivors(std::uint32_t level, std::span<const BorderPoint> group) {
    parents_.clear();
    for (const BorderPoint& p : group) parents_.push_back(data_.topology.parent[p.node]);
    std::sort(parents_.begin(), parents_.end());
    parents_.erase(std::unique(parents_.begin(), parents_.end()), parents_.end());
    const std::uint32_t survivor = survivor_of(group.front());
    for (const BorderPoint& p : group) {
      if (survivor_of(p) != survivor) return faults_.add("survivors_differ", level, name_of(group));
      const std::uint32_t controller = controller_of(p);
      if (survivor == p.point) continue;  // moves nowhere, whoever moves it
      const bool is_right =
          parents_.size() == 1
              ? controller == kNone
              : parents_.size() == 2 && controller == other_parent(data_.topology.parent[p.node]);
      if (!is_right) return faults_.add("wrong_controller", level, name_of(group));
    }
  }

  [[nodiscard]] std::uint32_t other_parent(std::uint32_t parent) const {
    return parents_[0] == parent ? parents_[1] : parents_[0];
  }
  [[nodiscard]] std::uint32_t survivor_of(const BorderPoint& p) const {
    const std::uint32_t parent = data_.topology.parent[p.node];
    return weld_.class_of[data_.offsets[parent].vertex + data_.survivors[p.vertex]];
  }
  [[nodiscard]] std::uint32_t controller_of(const BorderPoint& p) const {
    const PatchOffsets& at = data_.offsets[p.node];
    const std::uint32_t local = p.vertex - at.vertex;
    if (local >= data_.offsets[p.node + 1].controller - at.controller) return kNone;
    return data_.topology.neighbors_of(
        data_.topology.parent[p.node])[data_.controllers[at.controller + local]];
  }
  [[nodiscard]] static std::string name_of(std::span<const BorderPoint> group) {
    return "vertex " + std::to_string(group.front().vertex) + " of patch " +
           std::to_string(group.front().node);
  }

  const PatchTreeData& data_;
  PlaceFaults& faults_;
  WeldMap weld_;
  std::vector<BorderPoint> points_;
  std::vector<std::uint8_t> is_used_;
  std::vector<std::uint32_t> parents_;
};

DVec3 normal_of(const Vec3& a, const Vec3& b, const Vec3& c) {
  return glm::cross(DVec3(b) - DVec3(a), DVec3(c) - DVec3(a));
}

// The square of the longest edge: the rounding of a normal goes with it.
double longest_square(const Vec3& a, const Vec3& b, const Vec3& c) {
  const auto square = [](const DVec3& v) { return glm::dot(v, v); };
  return std::max(
      {square(DVec3(b) - DVec3(a)), square(DVec3(c) - DVec3(b)), square(DVec3(a) - DVec3(c))});
}

// Triangles on a line, up to the rounding of their corners, have no side to turn to.
bool has_area(const DVec3& normal, const Vec3& a, const Vec3& b, const Vec3& c) {
  constexpr double kRounding = 1e-6;
  return glm::length(normal) > kRounding * longest_square(a, b, c);
}

// Whether a normal is in a cone that was made around normals of single precision.
bool is_within(const NormalCone& cone, const Vec3& a, const Vec3& b, const Vec3& c) {
  constexpr double kRounding = 1e-5, kRoundingOfNormals = 1e-6;
  const DVec3 normal = normal_of(a, b, c);
  const double least = (cone.cosine - kRounding) * glm::length(normal);
  return glm::dot(normal, DVec3(cone.axis)) >= least - kRoundingOfNormals * longest_square(a, b, c);
}

bool is_turned(const PatchTreeData& data, const std::uint32_t* own,
               const std::uint32_t (&drawn)[3]) {
  // 75 degrees, and what floats may be off by where the builder looks.
  constexpr double kMinCosine = 0.2588 - 0.002;
  if (is_collapsed(data, drawn)) return false;
  const std::vector<Vec3>& at = data.vertices.positions;
  const DVec3 before = normal_of(at[own[0]], at[own[1]], at[own[2]]);
  const DVec3 after = normal_of(at[drawn[0]], at[drawn[1]], at[drawn[2]]);
  if (!has_area(before, at[own[0]], at[own[1]], at[own[2]]) ||
      !has_area(after, at[drawn[0]], at[drawn[1]], at[drawn[2]]))
    return false;
  return glm::dot(before, after) < kMinCosine * glm::length(before) * glm::length(after);
}

// Whether a triangle turns under some set of the bits that move its corners.
bool turns(const PatchTreeData& data, std::uint32_t node, const std::uint32_t* own) {
  const PatchOffsets& at = data.offsets[node];
  const std::uint32_t moving = data.offsets[node + 1].controller - at.controller;
  std::uint32_t bits[3];
  for (std::size_t k = 0; k < 3; ++k) {
    const std::uint32_t local = own[k] - at.vertex;
    bits[k] = local < moving ? 1u << data.controllers[at.controller + local] : 0;
  }
  for (std::uint32_t set = 1; set < 8; ++set) {
    std::uint32_t mask = 0, drawn[3];
    for (std::size_t k = 0; k < 3; ++k) mask |= (set >> k & 1u) != 0 ? bits[k] : 0;
    if (mask == 0) continue;
    for (std::size_t k = 0; k < 3; ++k) drawn[k] = drawn_vertex(data, node, own[k], mask);
    if (is_turned(data, own, drawn)) return true;
  }
  return false;
}

}  // namespace

void check_borders(const PatchTree& tree, PlaceFaults& faults) {
  BorderChecker checker(tree, faults);
  for (std::uint32_t level = 0; level < tree.topology().level_count(); ++level)
    checker.check_level(level);
}

void check_turns(const PatchTree& tree, PlaceFaults& faults) {
  const PatchTreeData& data = tree.data();
  for (std::uint32_t node = 0; node < tree.node_count(); ++node) {
    const std::uint32_t first = data.offsets[node].vertex;
    std::size_t begin = data.offsets[node].triangle, turned = 0;
    for (std::uint32_t r = data.offsets[node].range; r < data.offsets[node + 1].range; ++r) {
      const PatchRange& range = data.ranges[r];
      for (std::size_t t = begin + range.constant_triangles; t < begin + range.triangle_count;
           ++t) {
        const std::uint32_t own[3] = {first + data.corners[3 * t], first + data.corners[3 * t + 1],
                                      first + data.corners[3 * t + 2]};
        turned += turns(data, node, own) ? 1 : 0;
      }
      begin += range.triangle_count;
    }
    if (turned > 0)
      faults.add("turned_triangle", node, std::to_string(turned) + " of its triangles");
  }
}

void check_bounds_of_patches(const PatchTree& tree, PlaceFaults& faults) {
  constexpr double kRounding = 1e-5;
  const PatchTreeData& data = tree.data();
  const std::vector<Vec3>& at = data.vertices.positions;
  for (std::uint32_t node = 0; node < tree.node_count(); ++node) {
    const PatchBounds& bounds = data.bounds[node];
    const std::uint32_t first = data.offsets[node].vertex;
    bool is_outside = false, is_turned_away = false;
    for (std::uint32_t v = first; v < data.offsets[node + 1].vertex; ++v)
      is_outside |= glm::length(DVec3(at[v]) - DVec3(bounds.ball.center)) >
                    bounds.ball.radius * (1 + kRounding);
    for (std::size_t t = data.offsets[node].triangle; t < data.offsets[node + 1].triangle; ++t) {
      const std::uint16_t* const c = &data.corners[3 * t];
      is_turned_away |=
          !is_within(bounds.cone, at[first + c[0]], at[first + c[1]], at[first + c[2]]);
    }
    if (is_outside) faults.add("outside_ball", node);
    if (is_turned_away) faults.add("outside_cone", node);
  }
}

}  // namespace varifold::check
