#include <tests/models/vdpm/bounds_support.h>

#include <varifold/base/random.h>
#include <varifold/mesh/generators.h>
#include <varifold/models/common/step_graph.h>
#include <varifold/models/vdpm/vertical_nearest.h>
#include <varifold/simplify/sample_carrier.h>
#include <utility>

namespace varifold::test {

std::vector<NamedSequence> sequences(Placement placement, std::uint32_t most_steps) {
  std::vector<NamedMesh> meshes = all_groups();
  meshes.push_back({"planet", planet({{.triangles = 800}})});
  meshes.push_back({"terrain", *generate("terrain", {.triangles = 700})});
  std::vector<NamedSequence> result;
  for (NamedMesh& named : meshes) {
    const auto simplified = simplify(named.mesh, {.placement = placement, .measure_error = false});
    if (simplified && simplified->detailed.sequence.step_count() <= most_steps)
      result.push_back({named.name, simplified->detailed});
  }
  return result;
}

std::vector<std::uint32_t> finest_required(const DetailedMesh& detailed) {
  const StepGraph graph(detailed);
  std::vector<std::uint32_t> parent(detailed.sequence.step_count(), kNone);
  for (std::uint32_t k = 0; k < parent.size(); ++k)
    for (const std::uint32_t finer : graph.of(k)) parent[finer] = k;
  return parent;
}

std::vector<std::uint32_t> random_parents(std::uint32_t steps, std::uint64_t seed) {
  Random random(seed);
  std::vector<std::uint32_t> parent(steps, kNone);
  for (std::uint32_t k = 1; k < steps; ++k)
    if (random.below(20) != 0) parent[k] = k - 1 - random.below(std::min(k, 5u));
  return parent;
}

std::vector<StepBounds> bounds_of(const DetailedMesh& detailed, const StepBoundsOptions& options) {
  std::vector<StepBounds> bounds;
  measure_step_bounds(detailed, finest_required(detailed), options, bounds);
  return bounds;
}

Stars::Stars(const DetailedMesh& detailed) : detailed_(detailed) {
  const CollapseSequence& sequence = detailed.sequence;
  if (!sequence.moves_vertices()) {
    positions_.push_back(detailed.mesh.positions);
    return;
  }
  for (std::uint32_t level = 0; level <= sequence.step_count(); ++level) {
    TriangleMesh mesh = detailed.mesh;
    apply_placement(sequence, level, mesh);
    positions_.push_back(std::move(mesh.positions));
  }
}

Star Stars::of(std::uint32_t step) const {
  const CollapseSequence& sequence = detailed_.sequence;
  const auto& before = positions_[positions_.size() == 1 ? 0 : step + 1];
  const auto& after = positions_[positions_.size() == 1 ? 0 : step];
  std::vector<bool> is_touched(detailed_.mesh.vertex_count(), false);
  for (std::uint32_t v = sequence.vertices[step]; v < sequence.vertices[step + 1]; ++v)
    is_touched[v] = true;
  if (sequence.moves_vertices())
    for (std::uint32_t j = sequence.first_placed[step]; j < sequence.first_placed[step + 1]; ++j)
      is_touched[sequence.placed_vertex[j]] = true;

  const std::vector<std::uint32_t> finer = sequence.ancestors(step + 1);
  const std::vector<std::uint32_t> coarser = sequence.ancestors(step);
  Star star;
  star.center = before[sequence.vertices[step]];
  for (std::uint32_t t = 0; t < detailed_.mesh.triangle_count(); ++t) {
    if (sequence.triangle_level[t] > step + 1) continue;
    const std::uint32_t* c = &detailed_.mesh.indices[3 * std::size_t{t}];
    if (!is_touched[finer[c[0]]] && !is_touched[finer[c[1]]] && !is_touched[finer[c[2]]]) continue;
    star.before.push_back({before[finer[c[0]]], before[finer[c[1]]], before[finer[c[2]]]});
    if (sequence.triangle_level[t] <= step)
      star.after.push_back({after[coarser[c[0]]], after[coarser[c[1]]], after[coarser[c[2]]]});
  }
  return star;
}

namespace {

std::vector<std::uint32_t> step_of_vertices(const CollapseSequence& sequence) {
  std::vector<std::uint32_t> step_of(sequence.target.size(), kNone);
  for (std::uint32_t k = 0; k < sequence.step_count(); ++k)
    for (std::uint32_t v = sequence.vertices[k]; v < sequence.vertices[k + 1]; ++v) step_of[v] = k;
  return step_of;
}

}  // namespace

TriangleMesh surface_without(const DetailedMesh& detailed, const std::vector<bool>& is_collapsed) {
  const CollapseSequence& sequence = detailed.sequence;
  const std::vector<std::uint32_t> step_of = step_of_vertices(sequence);
  TriangleMesh mesh;
  mesh.positions = detailed.mesh.positions;
  for (std::uint32_t t = 0; t < detailed.mesh.triangle_count(); ++t) {
    // The step that removes it leaves the level before its coarsest one.
    const std::uint32_t level = sequence.triangle_level[t];
    if (level > 0 && is_collapsed[level - 1]) continue;
    for (std::size_t i = 0; i < 3; ++i) {
      std::uint32_t corner = detailed.mesh.indices[3 * std::size_t{t} + i];
      while (step_of[corner] != kNone && is_collapsed[step_of[corner]])
        corner = sequence.target[corner];
      mesh.indices.push_back(corner);
    }
  }
  return mesh;
}

std::vector<bool> random_front(const DetailedMesh& detailed, std::uint64_t seed) {
  const CollapseSequence& sequence = detailed.sequence;
  const StepGraph graph(detailed);
  Random random(seed);
  const Box box = bounds(detailed.mesh);
  const int axis = static_cast<int>(random.below(3));
  std::vector<bool> is_collapsed(sequence.step_count(), false);
  for (std::uint32_t k = sequence.step_count(); k-- > 0;) {
    bool may = true;
    for (const std::uint32_t finer : graph.of(k)) may = may && is_collapsed[finer];
    const Vec3& p = detailed.mesh.positions[sequence.vertices[k]];
    const std::uint32_t chance = p[axis] < box.center()[axis] ? 15 : 3;
    is_collapsed[k] = may && random.below(16) < chance;
  }
  return is_collapsed;
}

namespace {

// Finds what another does, and notes how great the triangle is.
template <class Nearest>
struct AreaOfNearest {
  Nearest nearest;
  const std::vector<StarTriangle>* triangles = nullptr;
  float doubled_area = 0;

  void reset(const std::vector<StarTriangle>& all) { nearest.reset(*(triangles = &all)); }
  std::size_t find(const Vec3& p, Vec3& way) {
    const std::size_t found = nearest.find(p, way);
    const std::array<Vec3, 3>& c = (*triangles)[found].corners;
    doubled_area = glm::length(glm::cross(c[1] - c[0], c[2] - c[0]));
    return found;
  }
};

}  // namespace

SampleHistory history_of_samples(const DetailedMesh& detailed, const StepBoundsOptions& options) {
  SampleHistory history;
  const VerticesByPlace places(detailed.mesh);
  const SampleOptions chosen{.inside_triangles = options.inside_triangles,
                             .on_edges = options.on_edges};
  const auto samples = surface_samples(detailed, chosen);
  for (const SurfaceSample& sample : samples) history.positions.push_back(sample.position);
  history.moves.resize(samples.size());
  SampleCarrier carrier(detailed, places, chosen);
  AreaOfNearest<NearestTriangle> nearest;
  AreaOfNearest<VerticalNearest> vertical{
      VerticalNearest(unpack_cone(cone_code::code_of_axis(options.up)).axis)};
  while (carrier.level() > 0) {
    const auto visit = [&](const SampleCarrier::Sample& sample, const Vec3& residual) {
      const float area = options.vertical ? vertical.doubled_area : nearest.doubled_area;
      history.moves[sample.number].push_back(
          {carrier.level(), residual, carrier.is_ear(), area >= sample.released_at});
    };
    if (options.vertical)
      carrier.collapse(vertical, visit);
    else
      carrier.collapse(nearest, visit);
  }
  return history;
}

}  // namespace varifold::test
