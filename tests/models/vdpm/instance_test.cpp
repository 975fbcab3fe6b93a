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

// `draw` takes the list of a frame.
template <class Draw>
void expect_no_allocation_on_orbit(const Draw& draw) {
  const NamedVdpm named = make_vdpm({"sphere", icosphere(5000)}, Placement::kKept);
  const Sphere ball = named.model->bounding_ball();
  ViewDependentInstance instance(named.model);
  for (int round = 0; round < 8; ++round) {
    const std::size_t before = allocations;
    for (int frame = 0; frame < 100; ++frame) {
      instance.adapt(orbit_view(ball, 0.0628f * static_cast<float>(frame)), {0.5f, kNone});
      draw(instance);
    }
    if (round == 7) {
      EXPECT_EQ(allocations, before);
    }
  }
}

TEST(VdpmInstance, FramesAllocateNothingWhereTheyHaveBeen) {
  expect_no_allocation_on_orbit([](auto& instance) { (void)instance.draw_list(); });
}

TEST(VdpmInstance, FramesOfStripsAllocateNothingWhereTheyHaveBeen) {
  expect_no_allocation_on_orbit([](auto& instance) { (void)instance.draw_strips(); });
}

TEST(VdpmInstance, StripsAllocateNothingWhereTheyHaveBeen) {
  for (const NamedVdpm& named : all_vdpms()) {
    ActiveSurface surface(*named.model);
    FrontStrips strips;
    RandomWalk walk(*named.model, 41);
    for (const double upwards : {0.9, 0.2}) {
      walk.walk(surface, 2 * named.model->step_count(), upwards);
      for (const StripJoin join : {StripJoin::kRestart, StripJoin::kDegenerate}) {
        const DrawList triangles = surface.draw_list();
        (void)strips.build(triangles, join);
        const std::size_t before = allocations;
        (void)strips.build(triangles, join);
        ASSERT_EQ(allocations, before) << named.name;
      }
    }
  }
}

// Whatever the front still finds room for, morphs need no more.
TEST(VdpmInstance, MorphsAllocateNothingWhereTheyHaveBeen) {
  const NamedVdpm named = make_vdpm({"sphere", icosphere(5000)}, Placement::kKept);
  const Sphere ball = named.model->bounding_ball();
  ViewDependentInstance instances[2] = {ViewDependentInstance(named.model),
                                        ViewDependentInstance(named.model)};
  for (int round = 0; round < 6; ++round) {
    std::size_t made[2] = {0, 0};
    for (int with = 0; with < 2; ++with) {
      FrontLimits limits;
      limits.morph_frames = with == 0 ? 0 : 15;
      const std::size_t before = allocations;
      for (int frame = 0; frame < 100; ++frame) {
        instances[with].adapt(orbit_view(ball, 0.0628f * static_cast<float>(frame)), {0.5f, kNone},
                              limits);
        (void)instances[with].draw_list();
      }
      made[with] = allocations - before;
    }
    if (round >= 2) {
      EXPECT_EQ(made[1], made[0]) << round;
    }
  }
}

}  // namespace
}  // namespace varifold::test
