// Levels of view-dependent meshes.
#include <gtest/gtest.h>
#include <tests/models/vdpm/vdpm_support.h>

#include <tests/support/count_allocations.h>

namespace varifold::test {
namespace {

TEST(VdpmInstance, LevelsAreThoseOfTheSequence) {
  for (const NamedVdpm& named : all_vdpms()) {
    ViewDependentInstance instance(named.model);
    Random random(3);
    std::vector<std::uint32_t> levels = spread_levels(named.model->finest_level());
    for (int i = 0; i < 10; ++i) levels.push_back(random.below(named.model->finest_level() + 1));
    for (const std::uint32_t level : levels) {
      instance.go_to_level(level);
      ASSERT_EQ(instance.level(), level);
      const TriangleMesh mesh = instance.extract(), expected = mesh_at_level(named.detailed, level);
      ASSERT_EQ(mesh_difference(mesh, expected), "") << named.name << ", level " << level;
      ASSERT_EQ(mesh.indices, expected.indices) << named.name << ", level " << level;
      ASSERT_EQ(instance.vertex_count(), named.model->vertex_count(level)) << named.name;
      ASSERT_EQ(instance.triangle_count(), named.model->triangle_count(level)) << named.name;
    }
  }
}

TEST(VdpmInstance, AllocatesNothingOnceWarm) {
  for (const NamedVdpm& named : all_vdpms()) {
    ViewDependentInstance instance(named.model);
    const std::uint32_t finest = named.model->finest_level();
    instance.go_to_level(finest);
    (void)instance.draw_list();
    const std::size_t before = allocations;
    for (const std::uint32_t level : {0u, finest, finest / 2, finest / 3, finest}) {
      instance.go_to_level(level);
      (void)instance.draw_list();
    }
    ASSERT_EQ(allocations, before) << named.name;
  }
}

}  // namespace
}  // namespace varifold::test
