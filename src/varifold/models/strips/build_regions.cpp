#include <varifold/models/strips/build_regions.h>

#include <varifold/models/common/error_code.h>
#include <varifold/models/strips/nested_ranges.h>
#include <varifold/simplify/deviation.h>
#include <varifold/simplify/sequence_replay.h>
#include <varifold/view/cone_code.h>
#include <algorithm>
#include <cmath>

namespace varifold {

namespace {

// Distances in double, and what floats lose on the way.
constexpr double kRounding = 1 + 1e-6;

// Walks down the sequence and notes what the triangles around each collapse are like.
class StarWalk {
 public:
  explicit StarWalk(const DetailedMesh& detailed) : detailed_(detailed), replay_(detailed) {
    const std::uint32_t steps = detailed.sequence.step_count();
    radius.assign(steps, 0);
    own_normals.assign(steps, 0);
    while (replay_.level() > 0) step();
  }

  std::vector<float> radius;               // of the triangles of the step alone
  std::vector<std::uint32_t> own_normals;  // how many, per step
  std::vector<Vec3> normals;               // of all steps, the finest first

 private:
  void step() {
    const CollapseSequence& sequence = detailed_.sequence;
    const std::uint32_t k = replay_.level() - 1;
    const std::size_t first = normals.size();
    slots_.clear();
    for (std::uint32_t v = sequence.vertices[k]; v < sequence.vertices[k + 1]; ++v)
      replay_.slots_of(v, slots_);
    const DVec3 center(detailed_.mesh.positions[sequence.vertices[k]]);
    double greatest = 0;
    for (const std::uint32_t slot : slots_) {
      for (std::uint32_t corner = 0; corner < 3; ++corner)
        greatest = std::max(greatest, glm::length(DVec3(position(slot / 3, corner)) - center));
      add_normal(slot / 3);
    }
    replay_.collapse();
    for (const std::uint32_t slot : replay_.changed()) add_normal(slot / 3);
    radius[k] = static_cast<float>(greatest * kRounding);
    own_normals[k] = static_cast<std::uint32_t>(normals.size() - first);
  }
  [[nodiscard]] const Vec3& position(std::uint32_t triangle, std::uint32_t corner) const {
    return detailed_.mesh.positions[replay_.corners()[3 * std::size_t{triangle} + corner]];
  }
  void add_normal(std::uint32_t triangle) {
    const Vec3 a = position(triangle, 0);
    const Vec3 n =
        normalize_or_zero(glm::cross(position(triangle, 1) - a, position(triangle, 2) - a));
    if (n != Vec3(0)) normals.push_back(n);
  }

  const DetailedMesh& detailed_;
  SequenceReplay replay_;
  std::vector<std::uint32_t> slots_;
};

// The step that removes the point onto which each step collapses; kNone where the base has it.
std::vector<std::uint32_t> parent_steps(const CollapseSequence& sequence) {
  const std::vector<std::uint32_t> step_of = steps_of_vertices(sequence);
  std::vector<std::uint32_t> parent(sequence.step_count());
  for (std::uint32_t k = 0; k < parent.size(); ++k)
    parent[k] = step_of[sequence.target[sequence.vertices[k]]];
  return parent;
}

// Balls of parents hold those of their children.
void nest_balls(const DetailedMesh& detailed, const std::vector<std::uint32_t>& parent,
                std::vector<float>& radius) {
  const auto center = [&](std::uint32_t k) {
    return DVec3(detailed.mesh.positions[detailed.sequence.vertices[k]]);
  };
  for (auto k = static_cast<std::uint32_t>(parent.size()); k-- > 0;) {
    if (parent[k] == kNone) continue;
    const double reach =
        glm::length(center(k) - center(parent[k])) + static_cast<double>(radius[k]);
    radius[parent[k]] = std::max(radius[parent[k]], static_cast<float>(reach * kRounding));
  }
}

// The normals of a step and all below it stand in one row, as do their sums.
std::vector<std::uint32_t> nested_cones(const StarWalk& walk,
                                        const std::vector<std::uint32_t>& parent) {
  const std::vector<NestedRange> ranges = nested_ranges(parent, walk.own_normals);
  std::vector<Vec3> rows(walk.normals.size());
  std::size_t next = 0;
  for (std::size_t k = parent.size(); k-- > 0;)
    for (std::uint32_t i = 0; i < walk.own_normals[k]; ++i)
      rows[ranges[k].begin + i] = walk.normals[next++];
  std::vector<DVec3> sums(rows.size() + 1, DVec3(0));
  for (std::size_t i = 0; i < rows.size(); ++i) sums[i + 1] = sums[i] + DVec3(rows[i]);

  std::vector<std::uint32_t> codes(parent.size(), kWideConeCode);
  for (std::size_t k = 0; k < parent.size(); ++k) {
    const std::size_t begin = ranges[k].begin, end = begin + ranges[k].count;
    const Vec3 axis = normalize_or_zero(Vec3(sums[end] - sums[begin]));
    if (begin == end || axis == Vec3(0)) continue;
    // Cones of 90 degrees and more tell nothing, so their angle need not be known.
    float cosine = 1;
    for (std::size_t i = begin; i < end && cosine > 0; ++i)
      cosine = std::min(cosine, glm::dot(axis, rows[i]));
    cosine -= 1e-6f;
    if (cosine <= 0) continue;
    codes[k] = pack_cone({axis, cosine, std::sqrt(std::max(0.0f, 1 - cosine * cosine))});
  }
  return codes;
}

}  // namespace

void measure_regions(const DetailedMesh& detailed, const StepGraph& graph,
                     StripFrameworkData& data) {
  const std::vector<std::uint32_t> parent = parent_steps(detailed.sequence);
  StarWalk walk(detailed);
  nest_balls(detailed, parent, walk.radius);
  data.cone = nested_cones(walk, parent);
  data.radius = std::move(walk.radius);

  const std::vector<float> deviations = step_deviations(detailed, {});
  data.error_codes.resize(parent.size());
  for (auto k = static_cast<std::uint32_t>(parent.size()); k-- > 0;) {
    data.error_codes[k] = static_cast<std::uint16_t>(error_code(deviations[k]));
    for (const std::uint32_t finer : graph.of(k))
      data.error_codes[k] = std::max(data.error_codes[k], data.error_codes[finer]);
  }
}

}  // namespace varifold
