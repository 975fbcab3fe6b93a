#include <gtest/gtest.h>
#include <tests/models/strips/strips_support.h>
#include <tests/support/count_allocations.h>

#include <varifold/base/random.h>
#include <varifold/models/common/uniform_model.h>

namespace varifold::test {
namespace {

static_assert(UniformModel<StripFramework>);
static_assert(UniformInstance<StripFrameworkInstance, StripFramework>);

std::string at(const NamedFramework& named, std::uint32_t level) {
  return named.name + ", level " + std::to_string(level);
}

TEST(StripsInstance, EveryLevelIsTheMeshByDefinition) {
  for (const NamedFramework& named : all_frameworks()) {
    StripFrameworkInstance instance(named.model);
    for (const std::uint32_t level : spread_levels(named.model->finest_level())) {
      instance.go_to_level(level);
      const TriangleMesh expected = mesh_at_level(named.detailed, level);
      const TriangleMesh mesh = instance.extract();
      EXPECT_TRUE(mesh.positions == expected.positions) << at(named, level);
      EXPECT_TRUE(mesh.normals == expected.normals && mesh.texcoords == expected.texcoords &&
                  mesh.colors == expected.colors)
          << at(named, level);
      EXPECT_EQ(mesh.materials.size(), expected.materials.size());
      ASSERT_TRUE(triangle_set(mesh) == triangle_set(expected)) << at(named, level);
      ASSERT_TRUE(triangle_set(instance.draw_list()) == triangle_set(expected)) << at(named, level);
      EXPECT_EQ(instance.level(), level);
      EXPECT_EQ(instance.vertex_count(), named.model->vertex_count(level));
      EXPECT_EQ(instance.triangle_count(), expected.triangle_count());
      EXPECT_EQ(mesh.triangle_count(), expected.triangle_count());
    }
  }
}

TEST(StripsInstance, AllLevelsOfSmallMeshesDownAndUp) {
  for (const NamedFramework* named : small_frameworks(260)) {
    const std::uint32_t finest = named->model->finest_level();
    StripFrameworkInstance walker(named->model);
    std::vector<std::vector<std::uint32_t>> on_the_way;
    for (std::uint32_t level = 0; level <= finest; ++level) {
      walker.go_to_level(level);
      on_the_way.push_back(walker.slots());
      ASSERT_TRUE(triangle_set(walker.draw_list()) ==
                  triangle_set(mesh_at_level(named->detailed, level)))
          << at(*named, level);
    }
    for (std::uint32_t level = finest + 1; level-- > 0;) {
      walker.go_to_level(level);
      ASSERT_TRUE(walker.slots() == on_the_way[level]) << at(*named, level);
    }
  }
}

TEST(StripsInstance, RandomSeeksLeaveWhatAFreshOneLeaves) {
  Random random(3);
  for (const NamedFramework& named : all_frameworks()) {
    StripFrameworkInstance walker(named.model);
    for (int i = 0; i < 12; ++i) {
      const std::uint32_t level = random.below(named.model->finest_level() + 1);
      StripFrameworkInstance fresh(named.model);
      fresh.go_to_level(level);
      walker.go_to_level(level);
      if (random.below(2) == 0) static_cast<void>(walker.draw_list());
      EXPECT_EQ(difference(walker, fresh), "") << at(named, level);
    }
    walker.go_to_level(0xffffffffu);
    EXPECT_EQ(walker.level(), named.model->finest_level());
  }
}

TEST(StripsModel, KeepsTheStripsAndCountsTheRecords) {
  for (const NamedFramework& named : all_frameworks()) {
    const TriangleStrips strips = some_strips(named.detailed.mesh);
    const TriangleStrips kept = named.model->full_strips();
    EXPECT_EQ(kept.indices, strips.indices) << named.name;
    EXPECT_EQ(kept.first, strips.first) << named.name;
    EXPECT_EQ(kept.range, strips.range) << named.name;
    // A slot has a record for every vertex that it names and that goes.
    std::uint64_t records = 0;
    for (std::uint32_t v : strips.indices)
      for (; named.detailed.sequence.target[v] != kNone; v = named.detailed.sequence.target[v])
        ++records;
    EXPECT_EQ(named.model->record_count(), records) << named.name;
  }
}

// Triangles between the two sides of a seam: the levels above are right in spite of them.
TEST(StripsModel, TornSpheresHaveSlivers) {
  std::size_t slivers = 0;
  for (const NamedFramework& named : all_frameworks()) {
    slivers += named.model->data().slivers.size();
    std::size_t of_strips = 0;
    for (std::uint32_t s = 0; s < named.model->strip_count(); ++s)
      of_strips += named.model->slivers_of(s).size();
    EXPECT_EQ(of_strips, named.model->data().slivers.size());
  }
  EXPECT_GT(slivers, 5u);
}

TEST(StripsModel, LevelsAreThoseOfTheSequence) {
  for (const NamedFramework& named : all_frameworks()) {
    const StripFramework& model = *named.model;
    const CollapseSequence& sequence = named.detailed.sequence;
    for (const std::uint32_t level : spread_levels(model.finest_level())) {
      EXPECT_EQ(model.vertex_count(level), sequence.vertices[level]);
      EXPECT_EQ(model.triangle_count(level), sequence.triangles[level]);
      EXPECT_GE(model.error(level), sequence.error[level]);
      const std::uint32_t triangles = model.triangle_count(level);
      EXPECT_EQ(model.level_for_triangles(triangles), sequence.level_for_triangles(triangles));
    }
  }
}

TEST(StripsInstance, AllocatesNothingPerFrame) {
  Random random(5);
  const Camera camera;
  for (const NamedFramework& named : all_frameworks()) {
    StripFrameworkInstance instance(named.model);
    RefineCriteria criteria;
    criteria.view.emplace(camera);
    criteria.sphere = Sphere{{0, 0, 0}, 0.5f};
    const std::size_t before = allocations;
    for (int i = 0; i < 10; ++i) {
      instance.go_to_level(random.below(named.model->finest_level() + 1));
      static_cast<void>(instance.draw_list());
      instance.adapt(criteria, {.tolerance = 2, .max_triangles = 10 + random.below(100)});
      static_cast<void>(instance.draw_list());
      criteria.sphere->center.x = static_cast<float>(random.uniform());
    }
    EXPECT_EQ(allocations, before) << named.name;
  }
}

}  // namespace
}  // namespace varifold::test
