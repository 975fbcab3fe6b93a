#include <gtest/gtest.h>
#include <tests/models/pm/pm_support.h>
#include <tests/support/count_allocations.h>

#include <varifold/base/random.h>
#include <varifold/mesh/generators.h>
#include <varifold/models/pm/geomorph.h>

namespace varifold::test {
namespace {

std::string at(const NamedModel& named, std::uint32_t level) {
  return named.name + ", level " + std::to_string(level);
}

TEST(PmModel, LevelsByCountErrorAndFraction) {
  for (const NamedModel& named : all_models()) {
    const ProgressiveMesh& model = *named.model;
    const CollapseSequence& sequence = named.detailed.sequence;
    const std::uint32_t finest = model.finest_level();
    for (const std::uint32_t level : spread_levels(finest)) {
      EXPECT_EQ(model.vertex_count(level), sequence.vertices[level]);
      EXPECT_EQ(model.triangle_count(level), sequence.triangles[level]);
      // Stored errors are at most 1/128 above.
      EXPECT_GE(model.error(level), sequence.error[level]) << named.name;
      EXPECT_LE(model.error(level), sequence.error[level] * 1.008f + 1e-37f) << named.name;
      for (const std::uint32_t more : {0u, 1u}) {
        const std::uint32_t triangles = model.triangle_count(level) + more;
        EXPECT_EQ(model.level_for_triangles(triangles), sequence.level_for_triangles(triangles));
        const std::uint32_t vertices = model.vertex_count(level) + more;
        EXPECT_EQ(model.level_for_vertices(vertices), sequence.level_for_vertices(vertices));
      }
      const std::uint32_t by_error = model.level_for_error(model.error(level));
      EXPECT_LE(by_error, level);
      EXPECT_LE(model.error(by_error), model.error(level));
      if (by_error > 0) {
        EXPECT_GT(model.error(by_error - 1), model.error(level));
      }
    }
    for (std::uint32_t k = 1; k <= finest; ++k) ASSERT_LE(model.error(k), model.error(k - 1));
    EXPECT_EQ(model.level_for_fraction(1), finest);
    EXPECT_EQ(model.vertex_count(model.level_for_fraction(0)), model.vertex_count(0));
    EXPECT_EQ(model.level_for_fraction(-1), model.level_for_fraction(0));
    EXPECT_EQ(model.level_for_fraction(2), finest);
  }
}

TEST(PmModel, AncestorsAreThoseOfTheSequence) {
  for (const NamedModel& named : all_models()) {
    for (const std::uint32_t level : spread_levels(named.model->finest_level())) {
      const std::vector<std::uint32_t> ancestors = named.detailed.sequence.ancestors(level);
      for (std::uint32_t v = 0; v < ancestors.size(); v += 1 + v / 16)
        ASSERT_EQ(named.model->ancestor(v, level), ancestors[v]);
    }
  }
}

TEST(PmModel, NewestCornerFirst) {
  for (const NamedModel& named : all_models()) {
    const std::vector<std::uint32_t>& corners = named.model->data().mesh.indices;
    for (std::size_t t = 0; t < corners.size(); t += 3) {
      EXPECT_GT(corners[t], corners[t + 1]) << named.name;
      EXPECT_GT(corners[t], corners[t + 2]) << named.name;
    }
  }
}

TEST(PmInstance, ChangedRangesCoverAllChanges) {
  Random random(4);
  // Changes are noted by blocks of thousands: of two large meshes, too.
  const NamedMesh large{"large", planet({{.triangles = 30000}, 0.12f, false})};
  const NamedModel kept = make_model(large, Placement::kKept);
  const NamedModel optimal = make_model(large, Placement::kOptimal);
  std::vector<const NamedModel*> models = small_models(0xffffffffu);
  models.insert(models.end(), {&kept, &optimal});
  for (const NamedModel* each : models) {
    const NamedModel& named = *each;
    if (named.model->triangle_count() == 0) continue;
    ProgressiveMeshInstance instance(named.model);
    DeviceCopy device;
    for (int i = 0; i < 12; ++i) {
      const DrawList list = instance.draw_list();
      device.take(list);
      device.expect_same(list, at(named, instance.level()));
      EXPECT_EQ(submitted_triangles(list), instance.triangle_count());
      std::size_t end = 0;
      for (const DrawRange& range : list.ranges) {
        EXPECT_GE(range.first_index, end);
        end = std::size_t{range.first_index} + range.index_count;
        for (std::size_t j = range.first_index; j < end; ++j)
          ASSERT_LT(list.indices[j], instance.vertex_count());
      }
      // Nothing changed: nothing to upload.
      const DrawList again = instance.draw_list();
      EXPECT_TRUE(again.changed_indices.empty() && again.changed_vertices.empty());
      if (i % 3 == 1) {  // a small step: most blocks stay
        instance.go_to_level(instance.level() + 5);
        continue;
      }
      if (i % 3 == 2) instance.go_to_level(random.below(named.model->finest_level() + 1));
      instance.go_to_level(random.below(named.model->finest_level() + 1));
    }
  }
}

TEST(PmInstance, AllocatesNothingPerFrame) {
  Random random(5);
  for (const NamedModel& named : all_models()) {
    ProgressiveMeshInstance instance(named.model);
    Geomorph geomorph(*named.model, named.model->finest_level(), 0);
    const std::size_t before = allocations;
    for (int i = 0; i < 20; ++i) {
      instance.go_to_level(random.below(named.model->finest_level() + 1));
      static_cast<void>(instance.draw_list());
      geomorph.blend(static_cast<float>(random.uniform()));
      static_cast<void>(geomorph.draw_list());
    }
    EXPECT_EQ(allocations, before) << named.name;
  }
}

}  // namespace
}  // namespace varifold::test
