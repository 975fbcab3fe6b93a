// A small fixed job for callgrind; see instructions.sh.
#include <varifold/mesh/generators.h>
#include <varifold/models/lodstrips/build.h>
#include <varifold/models/patch_tree/build.h>
#include <varifold/models/patch_tree/front.h>
#include <varifold/models/pm/build.h>
#include <varifold/models/pm/instance.h>
#include <varifold/models/vdpm/build.h>
#include <varifold/models/vdpm/instance.h>
#include <varifold/simplify/deviation.h>
#include <varifold/simplify/simplify.h>
#include <varifold/view/criteria.h>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <utility>

namespace {

// Half an orbit, a degree a frame.
template <class Visit>
void for_each_view(const varifold::Sphere& ball, const Visit& visit) {
  for (int frame = 0; frame < 180; ++frame) {
    const float angle = 0.01745f * static_cast<float>(frame);
    varifold::Camera camera;
    camera.eye =
        ball.center + 3 * ball.radius * varifold::Vec3(std::cos(angle), 0.4f, std::sin(angle));
    camera.target = ball.center;
    varifold::set_depth_range(camera, ball);
    varifold::RefineCriteria criteria;
    criteria.view.emplace(camera);
    visit(criteria);
  }
}

std::uint32_t orbit(const varifold::DetailedMesh& detailed) {
  varifold::StepBoundsOptions options;
  options.threads = 1;
  varifold::ViewDependentInstance instance(std::make_shared<const varifold::ViewDependentMesh>(
      varifold::build_view_dependent_mesh(detailed, options)));
  for_each_view(instance.model().bounding_ball(),
                [&](const varifold::RefineCriteria& criteria) { instance.adapt(criteria, {2}); });
  return instance.triangle_count();
}

std::uint32_t orbit_of_patches(const varifold::TriangleMesh& mesh) {
  varifold::PatchTreeOptions options;
  options.triangles_per_patch = 64;
  options.threads = 1;
  auto built = varifold::build_patch_tree(mesh, options);
  if (!built) return 0;
  const auto tree = std::make_shared<const varifold::PatchTree>(std::move(built->tree));
  varifold::PatchFront front(tree);
  varifold::PatchFrontOptions front_options;
  front_options.limits.tolerance = 2;
  std::uint32_t triangles = 0;
  for_each_view(tree->data().bounds[0].ball, [&](const varifold::RefineCriteria& criteria) {
    triangles = front.adapt(criteria, front_options).statistics.triangles;
  });
  return triangles;
}

}  // namespace

int main() {
  varifold::PlanetOptions planet;
  planet.triangles = 20'000;
  planet.threads = 1;
  varifold::SimplifyOptions options;
  options.threads = 1;
  options.measure_error = false;
  const varifold::TriangleMesh mesh = varifold::planet(planet);
  auto result = varifold::simplify(mesh, options);
  if (!result || !varifold::measure_deviation(result->detailed, {1, {}})) return 1;
  varifold::ProgressiveMeshInstance instance(std::make_shared<const varifold::ProgressiveMesh>(
      varifold::build_progressive_mesh(result->detailed)));
  const std::uint32_t finest = instance.model().finest_level();
  for (std::uint32_t i = 0; i <= 100; ++i) instance.go_to_level(finest / 100 * i);
  instance.go_to_level(0);
  varifold::LodStripsInstance strips(
      std::make_shared<const varifold::LodStrips>(varifold::build_lod_strips(result->detailed)));
  for (std::uint32_t i = 0; i <= 100; ++i) strips.go_to_level(finest / 100 * i);
  strips.go_to_level(0);
  std::printf("%u triangles at the base, %u and %u in the last view\n", instance.triangle_count(),
              orbit(result->detailed), orbit_of_patches(mesh));
  return 0;
}
