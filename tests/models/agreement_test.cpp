// Models built from the same sequence are the same surface at every level.
#include <gtest/gtest.h>
#include <tests/models/level_checks.h>
#include <tests/support/meshes.h>

#include <varifold/io/any_model.h>
#include <varifold/models/lodstrips/build.h>
#include <varifold/models/mts/build.h>
#include <varifold/models/pm/build.h>
#include <varifold/models/strips/build.h>
#include <varifold/models/vdpm/build.h>
#include <varifold/simplify/simplify.h>
#include <varifold/strip/sequence_strips.h>
#include <varifold/strip/stripify.h>
#include <functional>

namespace varifold::test {
namespace {

// A model by what it shows at a level; levels come in any order.
struct Shown {
  std::string name;
  std::function<TriangleMesh(std::uint32_t)> at_level;
};

template <class Model>
Shown show(std::string name, Model model) {
  using Instance = InstanceOf<Model>;
  const auto shared = std::make_shared<const Model>(std::move(model));
  const auto instance = std::make_shared<Instance>(shared);
  return {std::move(name), [instance](std::uint32_t level) {
            instance->go_to_level(level);
            return instance->extract();
          }};
}

// One line for each model and form.
std::vector<Shown> all_models(const DetailedMesh& detailed) {
  const TriangleStrips strips = stripify(detailed.mesh);
  const TriangleStrips cached = stripify(detailed.mesh, {.method = StripMethod::kCacheAware});
  return {show("pm", build_progressive_mesh(detailed)),
          show("vdpm", build_view_dependent_mesh(detailed)),
          show("mts", build_mts(detailed, strips)),
          show("mts of cache strips", build_mts(detailed, cached)),
          show("mts along the sequence", build_mts(detailed, stripify_along_sequence(detailed))),
          show("strips", build_strip_framework(detailed, strips)),
          show("strips of cache strips", build_strip_framework(detailed, cached)),
          show("lodstrips in blocks", build_lod_strips(detailed)),
          show("lodstrips, grouped", build_lod_strips(detailed, LodStripsForm::kGrouped, strips)),
          show("lodstrips, thesis", build_lod_strips(detailed, LodStripsForm::kThesis, cached))};
}

// All levels of a small mesh in one direction, then a spread in the other; of a large one the
// spread alone.
std::vector<std::uint32_t> levels_to_visit(std::uint32_t finest) {
  std::vector<std::uint32_t> levels;
  for (std::uint32_t k = 0; finest <= 600 && k <= finest; ++k) levels.push_back(k);
  const std::vector<std::uint32_t> spread = spread_levels(finest);
  levels.insert(levels.end(), spread.rbegin(), spread.rend());
  return levels;
}

TEST(Agreement, SameTrianglesAtEveryLevel) {
  for (const NamedMesh& named : all_groups()) {
    const DetailedMesh detailed = std::move(simplify(named.mesh, {.threads = 1})->detailed);
    const std::vector<Shown> models = all_models(detailed);
    for (const std::uint32_t level : levels_to_visit(detailed.sequence.step_count())) {
      const TriangleMesh reference = mesh_at_level(detailed, level);
      const auto triangles = triangle_set(reference);
      for (const Shown& model : models) {
        const TriangleMesh mesh = model.at_level(level);
        ASSERT_TRUE(triangle_set(mesh) == triangles)
            << model.name << " of " << named.name << ", level " << level;
        ASSERT_TRUE(same_attributes(mesh, reference)) << model.name << " of " << named.name;
      }
    }
  }
}

}  // namespace
}  // namespace varifold::test
