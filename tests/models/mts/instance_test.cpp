#include <gtest/gtest.h>
#include <tests/models/mts/mts_support.h>

#include <varifold/base/random.h>
#include <varifold/mesh/generators.h>

namespace varifold::test {
namespace {

std::string at(const NamedMts& named, std::uint32_t level) {
  return named.name + ", level " + std::to_string(level);
}

// All levels of small meshes, some of large ones.
std::vector<std::uint32_t> levels_of(std::uint32_t finest) {
  if (finest > 600) return spread_levels(finest);
  std::vector<std::uint32_t> levels(finest + 1);
  for (std::uint32_t k = 0; k <= finest; ++k) levels[k] = k;
  return levels;
}

void expect_same_draw(MultiresolutionStripsInstance& a, MultiresolutionStripsInstance& b,
                      const std::string& where) {
  EXPECT_TRUE(a.indices() == b.indices()) << where;
  const DrawList x = a.draw_list(), y = b.draw_list();
  ASSERT_EQ(x.ranges.size(), y.ranges.size()) << where;
  for (std::size_t r = 0; r < x.ranges.size(); ++r)
    ASSERT_TRUE(x.ranges[r].first_index == y.ranges[r].first_index &&
                x.ranges[r].index_count == y.ranges[r].index_count &&
                x.ranges[r].material == y.ranges[r].material)
        << where;
}

TEST(MtsInstance, EveryLevelIsTheMeshByDefinition) {
  for (const NamedMts& named : all_mts()) {
    MultiresolutionStripsInstance instance(named.model);
    for (const std::uint32_t level : levels_of(named.model->finest_level())) {
      instance.go_to_level(level);
      const TriangleMesh mesh = instance.extract();
      ASSERT_EQ(mesh_difference(mesh, mesh_at_level(named.detailed, level)), "")
          << at(named, level);
      EXPECT_EQ(mesh.triangle_count(), named.model->triangle_count(level)) << at(named, level);
    }
  }
}

TEST(MtsInstance, DownAndUpIsTheIdentity) {
  for (const NamedMts& named : all_mts()) {
    const std::vector<std::uint32_t> levels = spread_levels(named.model->finest_level());
    std::vector<MultiresolutionStripsInstance> fresh;
    MultiresolutionStripsInstance walker(named.model);
    for (const std::uint32_t level : levels) {
      fresh.emplace_back(named.model);
      fresh.back().go_to_level(level);
      walker.go_to_level(level);
      expect_same_draw(walker, fresh.back(), at(named, level));
    }
    for (std::size_t i = levels.size(); i-- > 0;) {
      walker.go_to_level(levels[i]);
      expect_same_draw(walker, fresh[i], at(named, levels[i]) + " on the way down");
    }
  }
}

TEST(MtsInstance, RandomSeeks) {
  Random random(3);
  for (const NamedMts& named : all_mts()) {
    MultiresolutionStripsInstance walker(named.model);
    for (int i = 0; i < 12; ++i) {
      const std::uint32_t level = random.below(named.model->finest_level() + 1);
      MultiresolutionStripsInstance fresh(named.model);
      fresh.go_to_level(level);
      walker.go_to_level(level);
      expect_same_draw(walker, fresh, at(named, level));
    }
    walker.go_to_level(0xffffffffu);
    EXPECT_EQ(walker.level(), named.model->finest_level());
  }
}

TEST(MtsInstance, ChangedRangesCoverAllChanges) {
  Random random(4);
  const NamedMts large = make_mts({"large", planet({{.triangles = 30000}, 0.12f, false})}, false);
  std::vector<const NamedMts*> models{&large};
  for (const NamedMts& named : all_mts()) models.push_back(&named);
  for (const NamedMts* each : models) {
    const NamedMts& named = *each;
    if (named.model->strip_count() == 0) continue;
    MultiresolutionStripsInstance instance(named.model);
    DeviceCopy device;
    for (int i = 0; i < 12; ++i) {
      const DrawList list = instance.draw_list();
      device.take(list);
      device.expect_same(list, at(named, instance.level()));
      std::size_t end = 0;
      for (const DrawRange& range : list.ranges) {
        EXPECT_GE(range.first_index, end);
        end = std::size_t{range.first_index} + range.index_count;
        for (std::size_t j = range.first_index; j < end; ++j)
          ASSERT_TRUE(list.indices[j] < instance.vertex_count() ||
                      list.indices[j] == kStripRestart);
      }
      const DrawList again = instance.draw_list();
      EXPECT_TRUE(again.changed_indices.empty() && again.changed_vertices.empty());
      const std::uint32_t finest = named.model->finest_level();
      instance.go_to_level(i % 3 == 1 ? instance.level() + 5 : random.below(finest + 1));
    }
  }
}

// Degenerate triangles are few: fewer indices than a list of triangles with restarts would take.
TEST(MtsInstance, StripsStayShort) {
  for (const NamedMts& named : all_mts()) {
    MultiresolutionStripsInstance instance(named.model);
    for (const std::uint32_t level : spread_levels(named.model->finest_level())) {
      instance.go_to_level(level);
      const DrawList list = instance.draw_list();
      std::uint64_t indices = 0;
      for (const DrawRange& range : list.ranges) indices += range.index_count + 1;
      EXPECT_LE(indices, 4 * std::uint64_t{instance.triangle_count()}) << at(named, level);
    }
  }
}

// Strips that run out of numbers for their nodes go on as others; here all of them, again and
// again.
TEST(MtsModel, ArcsGoForwardAndCoverEveryState) {
  for (const NamedMts& named : all_mts()) {
    const MultiresolutionStripsData& data = named.model->data();
    for (std::uint32_t s = 0; s < named.model->strip_count(); ++s) {
      const auto& here = data.strips[s];
      const auto& next = data.strips[s + 1];
      const std::uint32_t nodes = next.first_node - here.first_node;
      const std::uint32_t states = next.first_change - here.first_change + 1;
      for (std::uint32_t n = 0; n < nodes; ++n) {
        const std::uint32_t begin = data.node_arc[here.first_node + n];
        const std::uint32_t end = n + 1 < nodes ? data.node_arc[here.first_node + n + 1]
                                                : next.first_arc - here.first_arc;
        ASSERT_LT(begin, end);
        for (std::uint32_t a = begin; a < end; ++a) {
          const auto& arc = data.arcs[here.first_arc + a];
          ASSERT_GT(arc.to, n);
          ASSERT_LE(arc.to, nodes);
          ASSERT_LT(arc.last, states);
          if (a > begin) {
            ASSERT_LT(data.arcs[here.first_arc + a - 1].last, arc.last);
          }
        }
        if (n == 0) {
          ASSERT_EQ(data.arcs[here.first_arc + end - 1].last + 1u, states);
        }
      }
    }
  }
}

}  // namespace
}  // namespace varifold::test
