// What holds for the instances of every model whose levels hold for the whole mesh.
#include <gtest/gtest.h>
#include <tests/models/level_checks.h>
#include <tests/support/count_allocations.h>
#include <tests/support/meshes.h>

#include <varifold/base/random.h>
#include <varifold/io/any_model.h>
#include <varifold/mesh/generators.h>
#include <varifold/models/common/uniform_model.h>
#include <varifold/models/lodstrips/build.h>
#include <varifold/models/mts/build.h>
#include <varifold/models/pm/build.h>
#include <varifold/models/strips/build.h>
#include <varifold/simplify/simplify.h>
#include <varifold/strip/stripify.h>
#include <cstring>
#include <thread>

namespace varifold::test {
namespace {

DetailedMesh simplified(const TriangleMesh& mesh, Placement placement = Placement::kKept) {
  SimplifyOptions options;
  options.threads = 1;
  options.placement = placement;
  options.measure_error = false;
  return std::move(simplify(mesh, options)->detailed);
}

struct Pm {
  using Model = ProgressiveMesh;
  static constexpr Placement kPlacement = Placement::kKept;
  static Model build(const DetailedMesh& detailed) { return build_progressive_mesh(detailed); }
};
struct PmOfMovedVertices : Pm {
  static constexpr Placement kPlacement = Placement::kOptimal;
};
struct Mts {
  using Model = MultiresolutionStrips;
  static constexpr Placement kPlacement = Placement::kKept;
  static Model build(const DetailedMesh& detailed) {
    return build_mts(detailed, stripify(detailed.mesh));
  }
};
struct Framework {
  using Model = StripFramework;
  static constexpr Placement kPlacement = Placement::kKept;
  static Model build(const DetailedMesh& detailed) {
    return build_strip_framework(detailed, stripify(detailed.mesh));
  }
};
template <LodStripsForm kForm>
struct Lod {
  using Model = LodStrips;
  static constexpr Placement kPlacement = Placement::kKept;
  static Model build(const DetailedMesh& detailed) {
    return build_lod_strips(detailed, {.form = kForm});
  }
};

template <class Kind>
class UniformInstanceTest : public ::testing::Test {
 protected:
  using Model = typename Kind::Model;
  using Instance = InstanceOf<Model>;
  static_assert(UniformInstance<Instance, Model>);

  struct Named {
    std::string name;
    DetailedMesh detailed;
    std::shared_ptr<const Model> model;

    [[nodiscard]] std::string at(std::uint32_t level) const {
      return name + ", level " + std::to_string(level);
    }
  };
  static Named make(const NamedMesh& mesh) {
    Named named{mesh.name, simplified(mesh.mesh, Kind::kPlacement), nullptr};
    named.model = std::make_shared<const Model>(Kind::build(named.detailed));
    return named;
  }
  // Every test mesh, and one that is large enough for changes to be noted in several parts.
  static const std::vector<Named>& models() {
    static const std::vector<Named> all = [] {
      std::vector<Named> made;
      for (const NamedMesh& mesh : all_groups()) made.push_back(make(mesh));
      made.push_back(make({"large", planet({{.triangles = 30000}, 0.12f, false})}));
      return made;
    }();
    return all;
  }
  // All that is handed over, but what has changed.
  static void expect_same(const DrawList& a, const DrawList& b, const std::string& where) {
    const auto same = [](const auto& x, const auto& y) {
      return x.size() == y.size() &&
             (x.empty() || std::memcmp(x.data(), y.data(), x.size_bytes()) == 0);
    };
    EXPECT_TRUE(same(a.indices, b.indices)) << where;
    EXPECT_TRUE(same(a.positions, b.positions)) << where;
    EXPECT_TRUE(same(a.normals, b.normals)) << where;
    EXPECT_TRUE(same(a.texcoords, b.texcoords)) << where;
    EXPECT_TRUE(same(a.colors, b.colors)) << where;
    EXPECT_EQ(a.level, b.level) << where;
    ASSERT_EQ(a.ranges.size(), b.ranges.size()) << where;
    for (std::size_t r = 0; r < a.ranges.size(); ++r)
      ASSERT_TRUE(a.ranges[r].first_index == b.ranges[r].first_index &&
                  a.ranges[r].index_count == b.ranges[r].index_count &&
                  a.ranges[r].primitive == b.ranges[r].primitive &&
                  a.ranges[r].material == b.ranges[r].material &&
                  a.ranges[r].level == b.ranges[r].level)
          << where;
  }
};

using Kinds = ::testing::Types<Pm, PmOfMovedVertices, Mts, Framework, Lod<LodStripsForm::kBlocks>,
                               Lod<LodStripsForm::kGrouped>, Lod<LodStripsForm::kThesis>>;
TYPED_TEST_SUITE(UniformInstanceTest, Kinds);

TYPED_TEST(UniformInstanceTest, EveryLevelIsTheMeshByDefinition) {
  for (const auto& named : this->models()) {
    typename TestFixture::Instance instance(named.model);
    for (const std::uint32_t level : spread_levels(named.model->finest_level())) {
      instance.go_to_level(level);
      const TriangleMesh mesh = instance.extract();
      ASSERT_EQ(mesh_difference(mesh, mesh_at_level(named.detailed, level)), "") << named.at(level);
      EXPECT_EQ(mesh.vertex_count(), named.model->vertex_count(level)) << named.at(level);
      EXPECT_EQ(mesh.triangle_count(), named.model->triangle_count(level)) << named.at(level);
      for (std::size_t r = 1; r < mesh.ranges.size(); ++r)
        EXPECT_LT(mesh.ranges[r - 1].material, mesh.ranges[r].material) << named.at(level);
    }
  }
}

// Up and down, with a list after each stop, in small steps and at random.
TYPED_TEST(UniformInstanceTest, ListsDependOnTheLevelAlone) {
  Random random(3);
  for (const auto& named : this->models()) {
    const std::uint32_t finest = named.model->finest_level();
    std::vector<std::uint32_t> levels = spread_levels(finest);
    levels.insert(levels.end(), levels.rbegin(), levels.rend());
    for (int i = 0; i < 12; ++i) levels.push_back(random.below(finest + 1));
    for (int i = 0; i < 6; ++i) levels.push_back(std::min(finest, levels.back() + random.below(4)));
    typename TestFixture::Instance walker(named.model);
    for (const std::uint32_t level : levels) {
      walker.go_to_level(level);
      typename TestFixture::Instance fresh(named.model);
      fresh.go_to_level(level);
      this->expect_same(walker.draw_list(), fresh.draw_list(), named.at(level));
      if (this->HasFatalFailure()) return;
    }
    walker.go_to_level(0xffffffffu);
    EXPECT_EQ(walker.level(), finest) << named.name;
  }
}

TYPED_TEST(UniformInstanceTest, ChangedRangesAreEnoughForADevice) {
  Random random(4);
  for (const auto& named : this->models()) {
    if (named.detailed.mesh.positions.empty()) continue;
    const std::uint32_t finest = named.model->finest_level();
    typename TestFixture::Instance instance(named.model);
    DeviceCopy device;
    for (int i = 0; i < 12; ++i) {
      const DrawList list = instance.draw_list();
      device.take(list);
      device.expect_same(list, named.at(instance.level()));
      const std::uint32_t vertices = named.model->vertex_count(instance.level());
      for (const DrawRange& range : list.ranges)
        for (const std::uint32_t v : list.indices.subspan(range.first_index, range.index_count))
          ASSERT_TRUE(v < vertices || v == kStripRestart) << named.at(instance.level());
      const DrawList again = instance.draw_list();
      EXPECT_TRUE(again.changed_indices.empty() && again.changed_vertices.empty()) << named.name;
      instance.go_to_level(i % 3 == 1 ? instance.level() + 5 : random.below(finest + 1));
    }
  }
}

TYPED_TEST(UniformInstanceTest, AllocatesNothingPerFrame) {
  Random random(5);
  for (const auto& named : this->models()) {
    typename TestFixture::Instance instance(named.model);
    const std::size_t before = allocations;
    for (int i = 0; i < 20; ++i) {
      instance.go_to_level(random.below(named.model->finest_level() + 1));
      static_cast<void>(instance.draw_list());
    }
    EXPECT_EQ(allocations, before) << named.name;
  }
}

TYPED_TEST(UniformInstanceTest, ThreadsShareAModel) {
  const auto named = this->make({"icosphere", icosphere(2000)});
  const std::uint32_t finest = named.model->finest_level();
  const auto wander = [&](std::uint64_t seed) {
    Random random(seed);
    typename TestFixture::Instance instance(named.model);
    for (int i = 0; i < 100; ++i) {
      instance.go_to_level(random.below(finest + 1));
      static_cast<void>(instance.draw_list());
    }
    instance.go_to_level(finest / 2);
    return instance.extract();
  };
  TriangleMesh a, b;
  std::thread first([&] { a = wander(1); });
  std::thread second([&] { b = wander(2); });
  first.join();
  second.join();
  EXPECT_TRUE(same_attributes(a, b) && a.indices == b.indices);
  EXPECT_EQ(mesh_difference(a, mesh_at_level(named.detailed, finest / 2)), "");
}

}  // namespace
}  // namespace varifold::test
