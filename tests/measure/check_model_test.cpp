// A checker is worth what it finds: sound models pass, planted faults are named.
#include <gtest/gtest.h>

#include <tests/models/level_checks.h>
#include <tests/support/greedy_strips.h>
#include <tests/support/meshes.h>
#include <tests/support/poses.h>
#include <varifold/base/random.h>
#include <varifold/io/any_model.h>
#include <varifold/measure/check_model.h>
#include <varifold/mesh/generators.h>
#include <varifold/models/lodstrips/build.h>
#include <varifold/models/mts/build.h>
#include <varifold/models/mts/instance.h>
#include <varifold/models/pm/build.h>
#include <varifold/models/strips/build.h>
#include <varifold/models/vdpm/build.h>
#include <varifold/simplify/simplify.h>
#include <algorithm>
#include <functional>

namespace varifold {
namespace {

using Shared = std::shared_ptr<const ProgressiveMesh>;

Shared model_of(const TriangleMesh& mesh, Placement placement = Placement::kKept) {
  SimplifyOptions options;
  options.placement = placement;
  const auto simplified = simplify(mesh, options);
  EXPECT_TRUE(simplified) << simplified.error().message;
  return std::make_shared<const ProgressiveMesh>(build_progressive_mesh(simplified->detailed));
}

std::string listed(const std::vector<Fault>& faults) {
  std::string text;
  for (const Fault& fault : faults) text += fault.kind + " at " + fault.where + "; ";
  return text;
}

bool has(const std::vector<Fault>& faults, const char* kind) {
  return std::any_of(faults.begin(), faults.end(),
                     [&](const Fault& fault) { return fault.kind == kind; });
}

TEST(CheckModel, AllGroupsAreSound) {
  for (const auto& [name, mesh] : test::all_groups()) {
    for (const Placement placement : {Placement::kKept, Placement::kOptimal}) {
      const auto check = check_progressive_mesh(model_of(mesh, placement));
      ASSERT_TRUE(check);
      EXPECT_TRUE(is_sound(check->faults)) << name << ": " << listed(check->faults);
    }
  }
}

TEST(CheckModel, VisitsAllLevelsOfASmallModelAndASpreadOfALargeOne) {
  const Shared model = model_of(test::icosphere(1280));
  EXPECT_EQ(check_progressive_mesh(model)->levels_checked, model->finest_level() + 1);
  ModelCheckOptions few;
  few.all_levels_up_to = 100;
  few.spread_levels = 20;
  const auto check = check_progressive_mesh(model, few);
  EXPECT_GE(check->levels_checked, 15u);
  EXPECT_LE(check->levels_checked, 24u);
  EXPECT_TRUE(check->faults.empty());
}

TEST(CheckModel, EmptyModel) {
  const auto check = check_progressive_mesh(std::make_shared<const ProgressiveMesh>());
  ASSERT_TRUE(check);
  EXPECT_TRUE(check->faults.empty());
}

TEST(CheckModel, CanBeCancelled) {
  ModelCheckOptions options;
  options.progress = [](std::string_view, float) { return false; };
  const auto check = check_progressive_mesh(model_of(test::icosphere(320)), options);
  ASSERT_FALSE(check);
  EXPECT_EQ(check.error().kind, ErrorKind::kCancelled);
}

TEST(CheckModel, SameReportForAnyNumberOfThreads) {
  const Shared model = model_of(test::icosphere(2000));
  ModelCheckOptions one, three;
  one.threads = 1;
  three.threads = 3;
  EXPECT_EQ(listed(check_progressive_mesh(model, one)->faults),
            listed(check_progressive_mesh(model, three)->faults));
}

/// The faults of a sphere's model after a change of its data.
std::vector<Fault> faults_after(const std::function<void(ProgressiveMeshData&)>& damage) {
  ProgressiveMeshData data = model_of(test::icosphere(320))->data();
  damage(data);
  const auto check =
      check_progressive_mesh(std::make_shared<const ProgressiveMesh>(std::move(data)));
  EXPECT_TRUE(check);
  return check ? check->faults : std::vector<Fault>{};
}

TEST(CheckModel, FindsASlotThatIsNotThere) {
  const auto faults = faults_after([](ProgressiveMeshData& data) {
    // The split of the middle changes one corner of another triangle instead.
    std::uint32_t& slot = data.slots[data.slots.size() / 2];
    const std::uint32_t flag = slot & ProgressiveMeshData::kLastSlot;
    slot = ((slot & ~flag) + 3) % static_cast<std::uint32_t>(data.mesh.indices.size()) | flag;
  });
  EXPECT_TRUE(has(faults, "wrong_corner")) << listed(faults);
  EXPECT_TRUE(has(faults, "not_closed") || has(faults, "not_identical")) << listed(faults);
}

TEST(CheckModel, FindsAWrongAncestor) {
  const auto faults = faults_after(
      [](ProgressiveMeshData& data) { data.target.back() = data.target.back() == 0 ? 1 : 0; });
  EXPECT_TRUE(has(faults, "not_identical") || has(faults, "wrong_corner")) << listed(faults);
}

TEST(CheckModel, FindsALostTriangle) {
  const auto faults = faults_after([](ProgressiveMeshData& data) {
    // The last split shows one of its triangles; the other comes never.
    data.splits.back().triangles = 1;
  });
  EXPECT_TRUE(has(faults, "lost_triangle")) << listed(faults);
}

TEST(CheckModel, FindsRisingAndBrokenErrors) {
  EXPECT_TRUE(
      has(faults_after([](ProgressiveMeshData& data) { data.error[5] = data.error[4] + 1; }),
          "error_not_monotone"));
  EXPECT_TRUE(has(faults_after([](ProgressiveMeshData& data) {
                    data.error[5] = std::numeric_limits<float>::quiet_NaN();
                  }),
                  "error_not_monotone"));
}

TEST(CheckModel, FindsErrorsThatAreTooSmall) {
  const auto halve = [](ProgressiveMeshData& data) {
    for (float& error : data.error) error *= 0.5f;
  };
  EXPECT_TRUE(has(faults_after(halve), "error_exceeded"));
  // Nobody promised anything of estimates.
  EXPECT_FALSE(has(faults_after([&](ProgressiveMeshData& data) {
                     halve(data);
                     data.error_is_measured = false;
                   }),
                   "error_exceeded"));
}

// A flat mesh along no axis: distances are what floats round away.
TEST(CheckModel, FlatMeshesAreSound) {
  for (std::uint64_t seed = 1; seed < 8; ++seed) {
    TriangleMesh mesh = test::grid(20, 20);
    mesh.positions = test::turned_pose(mesh, seed, 0.7f).positions;
    const auto check = check_progressive_mesh(model_of(mesh));
    ASSERT_TRUE(check);
    EXPECT_TRUE(is_sound(check->faults)) << listed(check->faults);
  }
}

// A dart, whose middle M collapses onto a wing: (B, C, D) turns over.
//
//        A
//        M
//      . C .
//    B       D
TEST(CheckModel, FindsAFlippedTriangle) {
  DetailedMesh detailed;
  detailed.mesh = test::make_mesh({{0, 3, 0}, {-2, -2, 0}, {0, -0.5f, 0}, {2, -2, 0}, {0, 0.5f, 0}},
                                  {4, 2, 3, 4, 3, 0, 4, 0, 1, 4, 1, 2});
  detailed.sequence.target = {kNone, kNone, kNone, kNone, 1};
  detailed.sequence.triangle_level = {0, 0, 1, 1};
  detailed.sequence.vertices = {4, 5};
  detailed.sequence.triangles = {2, 4};
  detailed.sequence.error = {1, 0};
  const auto check = check_progressive_mesh(
      std::make_shared<const ProgressiveMesh>(build_progressive_mesh(detailed)));
  ASSERT_TRUE(check);
  ASSERT_EQ(check->faults.size(), 1u) << listed(check->faults);
  EXPECT_EQ(check->faults[0].kind, "flipped_triangle");
  EXPECT_EQ(check->faults[0].where, "level 0 (1 triangles)");
}

TEST(CheckModel, NotesPointsAtOnePosition) {
  const auto faults = faults_after([](ProgressiveMeshData& data) {
    data.mesh.positions.back() = data.mesh.positions[data.mesh.positions.size() - 2];
  });
  EXPECT_TRUE(has(faults, "coincident_point")) << listed(faults);
}

using SharedMts = std::shared_ptr<const MultiresolutionStrips>;

SharedMts mts_of(const TriangleMesh& mesh) {
  const auto simplified = simplify(mesh);
  EXPECT_TRUE(simplified) << simplified.error().message;
  const DetailedMesh& detailed = simplified->detailed;
  return std::make_shared<const MultiresolutionStrips>(
      build_mts(detailed, test::greedy_strips(detailed.mesh)));
}

TEST(CheckModelMts, AllGroupsAreSound) {
  for (const auto& [name, mesh] : test::all_groups()) {
    const auto check = check_model<MultiresolutionStripsInstance>(mts_of(mesh));
    ASSERT_TRUE(check);
    EXPECT_TRUE(is_sound(check->faults)) << name << ": " << listed(check->faults);
  }
}

TEST(CheckModelMts, EmptyModel) {
  const auto check =
      check_model<MultiresolutionStripsInstance>(std::make_shared<const MultiresolutionStrips>());
  ASSERT_TRUE(check);
  EXPECT_TRUE(check->faults.empty());
}

std::vector<Fault> mts_faults_after(const std::function<void(MultiresolutionStripsData&)>& damage) {
  MultiresolutionStripsData data = mts_of(test::icosphere(320))->data();
  damage(data);
  const auto check = check_model<MultiresolutionStripsInstance>(
      std::make_shared<const MultiresolutionStrips>(std::move(data)));
  EXPECT_TRUE(check);
  return check ? check->faults : std::vector<Fault>{};
}

// Whatever vertex of whatever node is another one: some level has a triangle that it should not.
TEST(CheckModelMts, FindsEveryWrongVertex) {
  const std::size_t nodes = mts_of(test::icosphere(320))->data().node_vertex.size();
  for (std::size_t node = 1; node < nodes; node += 13) {
    bool is_vertex = false;
    const auto faults = mts_faults_after([&](MultiresolutionStripsData& data) {
      const auto start = [&](const MultiresolutionStripsData::Strip& s) {
        return s.first_node == node;
      };
      std::uint32_t& vertex = data.node_vertex[node];
      is_vertex =
          vertex != kStripRestart && std::none_of(data.strips.begin(), data.strips.end(), start);
      if (is_vertex) vertex = vertex == 0 ? 1 : 0;
    });
    EXPECT_EQ(is_sound(faults), !is_vertex) << node;
  }
}

TEST(CheckModelMts, FindsAWrongInterval) {
  const auto faults = mts_faults_after([](MultiresolutionStripsData& data) {
    // The start of some strip leaves its first vertex one state too early.
    for (std::size_t s = data.strips.size() / 2; s + 1 < data.strips.size(); ++s) {
      const std::uint32_t node = data.strips[s].first_node;
      auto& first = data.arcs[data.strips[s].first_arc];
      if (data.node_arc[node + 1] < 2 || first.last < 1) continue;
      --first.last;
      return;
    }
    FAIL() << "no such strip";
  });
  EXPECT_TRUE(has(faults, "wrong_corner") || has(faults, "lost_triangle")) << listed(faults);
}

TEST(CheckModelMts, FindsAChangeAtAnotherLevel) {
  const auto faults = mts_faults_after(
      [](MultiresolutionStripsData& data) { --data.changes[data.changes.size() / 2]; });
  EXPECT_FALSE(is_sound(faults));
}

TEST(CheckModelMts, FindsAVertexThatIsNotThere) {
  const auto faults = mts_faults_after([](MultiresolutionStripsData& data) {
    for (std::uint32_t& v : data.node_vertex)
      if (v != kStripRestart) v = data.mesh.vertex_count() - 1;
  });
  EXPECT_TRUE(has(faults, "wrong_corner")) << listed(faults);
}

TEST(CheckModelMts, FindsAStripThatIsDrawnTwice) {
  const auto faults = mts_faults_after([](MultiresolutionStripsData& data) {
    // The last strip becomes a copy of the first.
    const auto first = data.strips[0], second = data.strips[1];
    data.node_vertex.insert(data.node_vertex.end(), data.node_vertex.begin(),
                            data.node_vertex.begin() + second.first_node);
    data.node_arc.insert(data.node_arc.end(), data.node_arc.begin(),
                         data.node_arc.begin() + second.first_node);
    data.arcs.insert(data.arcs.end(), data.arcs.begin(), data.arcs.begin() + second.first_arc);
    data.changes.insert(data.changes.end(), data.changes.begin(),
                        data.changes.begin() + second.first_change);
    const auto end = data.strips.back();
    data.strips.push_back({end.first_node + second.first_node, end.first_arc + second.first_arc,
                           end.first_change + second.first_change,
                           end.first_index + second.first_index - first.first_index});
    ++data.first_strip.back();
  });
  EXPECT_TRUE(has(faults, "wrong_count")) << listed(faults);
}

TEST(CheckModelLodStrips, AllGroupsAreSound) {
  for (const auto& [name, mesh] : test::all_groups()) {
    const auto check = check_model<LodStripsInstance>(
        std::make_shared<const LodStrips>(build_lod_strips(simplify(mesh)->detailed)));
    ASSERT_TRUE(check);
    EXPECT_TRUE(is_sound(check->faults)) << name << ": " << listed(check->faults);
  }
}

TEST(CheckModelStrips, AllGroupsAreSound) {
  for (const auto& [name, mesh] : test::all_groups()) {
    const DetailedMesh detailed = simplify(mesh)->detailed;
    const auto check = check_model<StripFrameworkInstance>(std::make_shared<const StripFramework>(
        build_strip_framework(detailed, test::greedy_strips(detailed.mesh))));
    ASSERT_TRUE(check);
    EXPECT_TRUE(is_sound(check->faults)) << name << ": " << listed(check->faults);
  }
}

TEST(CheckModelVdpm, AllGroupsAreSoundWithBothPlacements) {
  for (const auto& [name, mesh] : test::all_groups()) {
    for (const Placement placement : {Placement::kKept, Placement::kOptimal}) {
      SimplifyOptions options;
      options.placement = placement;
      const auto check =
          check_model<ViewDependentInstance>(std::make_shared<const ViewDependentMesh>(
              build_view_dependent_mesh(simplify(mesh, options)->detailed)));
      ASSERT_TRUE(check);
      EXPECT_TRUE(is_sound(check->faults)) << name << ": " << listed(check->faults);
    }
  }
}

// Damage that a decoder lets pass and that changes what some level draws: the check sees it, but
// where the full level changes in a way that all levels follow, as if the mesh had been another.
template <class Model>
void expect_most_damage_found(const Model& model, std::uint64_t seed) {
  using Kind = ModelKind<Model>;
  const std::vector<std::byte> good = Kind::encode(model);
  InstanceOf<Model> original(std::make_shared<const Model>(model));
  Random random(seed);
  int changed = 0, found = 0;
  for (int i = 0; i < 3000 && changed < 150; ++i) {
    std::vector<std::byte> bytes = good;
    const auto at = random.below(static_cast<std::uint32_t>(bytes.size()));
    bytes[at] ^= std::byte{1} << static_cast<int>(random.below(8));
    auto decoded = Kind::decode(bytes);
    if (!decoded || decoded->finest_level() != model.finest_level()) continue;
    const auto damaged = std::make_shared<const Model>(std::move(*decoded));
    InstanceOf<Model> instance(damaged);
    bool is_changed = false;
    for (std::uint32_t k = 0; k <= model.finest_level() && !is_changed; ++k) {
      instance.go_to_level(k);
      original.go_to_level(k);
      is_changed = test::triangle_set(instance.extract()) != test::triangle_set(original.extract());
    }
    if (!is_changed) continue;
    ++changed;
    const auto check = check_model<InstanceOf<Model>>(damaged);
    ASSERT_TRUE(check);
    if (!is_sound(check->faults)) ++found;
  }
  ::testing::Test::RecordProperty(Kind::kName,
                                  std::to_string(found) + " of " + std::to_string(changed));
  EXPECT_GE(found * 10, changed * 8) << Kind::kName << " " << changed;
}

TEST(CheckModel, FindsMostDamageThatDecodersLetPass) {
  const DetailedMesh detailed = simplify(test::icosphere(80))->detailed;
  expect_most_damage_found(build_progressive_mesh(detailed), 1);
  expect_most_damage_found(build_mts(detailed, test::greedy_strips(detailed.mesh)), 2);
  expect_most_damage_found(build_lod_strips(detailed), 3);
  expect_most_damage_found(build_strip_framework(detailed, test::greedy_strips(detailed.mesh)), 4);
}

}  // namespace
}  // namespace varifold
