// A small fixed job for callgrind; see instructions.sh.
#include <varifold/mesh/generators.h>
#include <varifold/models/lodstrips/build.h>
#include <varifold/models/pm/build.h>
#include <varifold/models/pm/instance.h>
#include <varifold/simplify/deviation.h>
#include <varifold/simplify/simplify.h>
#include <cstdint>
#include <cstdio>
#include <memory>

int main() {
  varifold::PlanetOptions planet;
  planet.triangles = 20'000;
  planet.threads = 1;
  varifold::SimplifyOptions options;
  options.threads = 1;
  options.measure_error = false;
  auto result = varifold::simplify(varifold::planet(planet), options);
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
  std::printf("%u triangles at the base\n", instance.triangle_count());
  return 0;
}
