#include <tests/models/vdpm/vdpm_support.h>

#include <tests/models/strips/strips_support.h>
#include <varifold/mesh/weld.h>
#include <algorithm>
#include <cmath>
#include <utility>

namespace varifold::test {

NamedVdpm make_vdpm(const NamedMesh& named, Placement placement) {
  SimplifyOptions options;
  options.placement = placement;
  options.threads = 1;
  NamedVdpm result;
  result.name = named.name + (placement == Placement::kOptimal ? "/optimal" : "");
  result.detailed = std::move(simplify(named.mesh, options)->detailed);
  result.model = std::make_shared<ViewDependentMesh>(
      build_view_dependent_mesh(result.detailed, {.threads = 1}));
  return result;
}

const std::vector<NamedVdpm>& all_vdpms() {
  static const std::vector<NamedVdpm> models = [] {
    std::vector<NamedVdpm> made;
    for (const NamedMesh& named : all_groups())
      for (const Placement placement : {Placement::kKept, Placement::kOptimal})
        made.push_back(make_vdpm(named, placement));
    for (const std::uint64_t seed : {1u, 2u, 3u})
      for (const Placement placement : {Placement::kKept, Placement::kOptimal}) {
        made.push_back(make_vdpm(torn_sphere(seed), placement));
        made.push_back(make_vdpm(fringed_sheet(seed), placement));
      }
    return made;
  }();
  return models;
}

TriangleMesh mesh_of_steps(const DetailedMesh& detailed, const std::vector<bool>& split) {
  const CollapseSequence& sequence = detailed.sequence;
  const TriangleMesh& full = detailed.mesh;
  const std::uint32_t base = sequence.vertices.empty() ? 0 : sequence.vertices[0];
  std::vector<std::uint32_t> step_of(full.vertex_count(), kNone);
  for (std::uint32_t k = 0; k < sequence.step_count(); ++k)
    for (std::uint32_t v = sequence.vertices[k]; v < sequence.vertices[k + 1]; ++v) step_of[v] = k;
  const auto is_there = [&](std::uint32_t v) { return v < base || split[step_of[v]]; };

  // Attributes are those that the coarsest collapse that is done gave.
  TriangleMesh looks = full;
  for (std::uint32_t k = sequence.step_count(); sequence.moves_vertices() && k-- > 0;) {
    if (split[k]) continue;
    for (std::uint32_t j = sequence.first_placed[k]; j < sequence.first_placed[k + 1]; ++j) {
      const std::uint32_t v = sequence.placed_vertex[j];
      looks.positions[v] = sequence.placed.positions[j];
      if (full.has_normals()) looks.normals[v] = sequence.placed.normals[j];
      if (full.has_texcoords()) looks.texcoords[v] = sequence.placed.texcoords[j];
      if (full.has_colors()) looks.colors[v] = sequence.placed.colors[j];
    }
  }

  TriangleMesh mesh;
  mesh.materials = full.materials;
  mesh.images = full.images;
  std::vector<std::uint32_t> number(full.vertex_count(), kNone);
  for (std::uint32_t v = 0; v < full.vertex_count(); ++v) {
    if (!is_there(v)) continue;
    number[v] = mesh.vertex_count();
    mesh.positions.push_back(looks.positions[v]);
    if (full.has_normals()) mesh.normals.push_back(looks.normals[v]);
    if (full.has_texcoords()) mesh.texcoords.push_back(looks.texcoords[v]);
    if (full.has_colors()) mesh.colors.push_back(looks.colors[v]);
  }
  // A triangle is gone where two corners are at one point: vertices of one step, or of one point
  // of the base.
  const WeldMap points = weld_exact(full.positions);
  const auto point_of = [&](std::uint32_t v) {
    return step_of[v] == kNone ? sequence.step_count() + points.class_of[v] : step_of[v];
  };
  std::vector<MaterialRange> ranges = full.ranges;
  if (ranges.empty()) ranges.push_back({0, 0, full.triangle_count()});
  for (const MaterialRange& range : ranges) {
    MaterialRange kept{range.material, mesh.triangle_count(), 0};
    for (std::uint32_t t = range.first_triangle; t < range.first_triangle + range.triangle_count;
         ++t) {
      std::array<std::uint32_t, 3> corners{};
      for (std::size_t c = 0; c < 3; ++c) {
        corners[c] = full.indices[3 * std::size_t{t} + c];
        while (!is_there(corners[c])) corners[c] = sequence.target[corners[c]];
      }
      const std::uint32_t a = point_of(corners[0]), b = point_of(corners[1]),
                          c = point_of(corners[2]);
      if (a == b || b == c || c == a) continue;
      for (const std::uint32_t v : corners) mesh.indices.push_back(number[v]);
      ++kept.triangle_count;
    }
    if (!full.ranges.empty() && kept.triangle_count > 0) mesh.ranges.push_back(kept);
  }
  return mesh;
}

RandomWalk::RandomWalk(const ViewDependentMesh& model, std::uint64_t seed)
    : steps_(model.step_count()),
      random_(seed),
      split_(steps_, false),
      required_(steps_),
      required_by_(steps_) {
  for (std::uint32_t k = 0; k < steps_; ++k) {
    model.for_each_required(k, [&](std::uint32_t coarser) {
      required_[k].push_back(coarser);
      required_by_[coarser].push_back(k);
    });
  }
}

bool RandomWalk::may_change(std::uint32_t step) const {
  const auto is_split = [&](std::uint32_t k) { return split_[k]; };
  if (split_[step])
    return std::none_of(required_by_[step].begin(), required_by_[step].end(), is_split);
  return std::all_of(required_[step].begin(), required_[step].end(), is_split);
}

void RandomWalk::walk(ActiveSurface& surface, std::uint32_t tries, double upwards) {
  for (std::uint32_t i = 0; i < tries && steps_ > 0; ++i) {
    const std::uint32_t step = random_.below(steps_);
    if (!may_change(step) || (random_.uniform() < upwards) == split_[step]) continue;
    if (split_[step])
      surface.collapse(step);
    else
      surface.split(step);
    split_[step] = !split_[step];
  }
}

RefineCriteria random_view(const Sphere& ball, Random& random) {
  const float radius = std::max(ball.radius, 0.1f);
  const auto part = [&] { return static_cast<float>(2 * random.uniform() - 1); };
  Camera camera;
  camera.target = ball.center;
  camera.eye = ball.center + radius * (Vec3(1.3f, 0.4f, 1.1f) + Vec3(part(), part(), part()));
  set_depth_range(camera, ball);
  RefineCriteria criteria;
  criteria.view.emplace(camera);
  return criteria;
}

RefineCriteria orbit_view(const Sphere& ball, float angle) {
  Camera camera;
  camera.eye = ball.center + 3 * ball.radius * Vec3(std::cos(angle), 0.4f, std::sin(angle));
  camera.target = ball.center;
  RefineCriteria criteria;
  criteria.view.emplace(camera);
  return criteria;
}

}  // namespace varifold::test
