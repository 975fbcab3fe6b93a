// What a view-dependent mesh knows of its steps.
#include <gtest/gtest.h>
#include <tests/models/vdpm/vdpm_support.h>

#include <varifold/models/common/step_graph.h>
#include <algorithm>
#include <numeric>

namespace varifold::test {
namespace {

TEST(VdpmModel, RequirementsAreCoarserAndAscend) {
  for (const NamedVdpm& named : all_vdpms()) {
    std::vector<std::vector<std::uint32_t>> expected(named.model->step_count());
    const StepGraph graph(named.detailed);
    for (std::uint32_t k = 0; k < graph.step_count(); ++k)
      for (const std::uint32_t finer : graph.of(k)) expected[finer].push_back(k);
    for (std::uint32_t k = 0; k < graph.step_count(); ++k) {
      std::vector<std::uint32_t> required;
      named.model->for_each_required(k, [&](std::uint32_t r) { required.push_back(r); });
      ASSERT_EQ(required, expected[k]) << named.name << ", step " << k;
      ASSERT_TRUE(required.empty() || required.back() < k) << named.name;
    }
  }
}

TEST(VdpmModel, TheWatchTreeHasEachStepBelowTheFinestThatItRequires) {
  for (const NamedVdpm& named : all_vdpms()) {
    const ViewDependentMesh& model = *named.model;
    std::vector<std::uint32_t> parent(model.step_count(), kNone);
    std::uint32_t found = static_cast<std::uint32_t>(model.watch_roots().size());
    for (std::uint32_t k = 0; k < model.step_count(); ++k)
      model.for_each_watched(k, [&](std::uint32_t child) {
        ASSERT_EQ(parent[child], kNone);
        parent[child] = k;
        ++found;
      });
    EXPECT_EQ(found, model.step_count()) << named.name;
    for (std::uint32_t k = 0; k < model.step_count(); ++k) {
      std::uint32_t finest = kNone;
      model.for_each_required(k, [&](std::uint32_t r) { finest = r; });
      ASSERT_EQ(parent[k], finest) << named.name;
    }
    for (const std::uint32_t root : model.watch_roots()) EXPECT_EQ(parent[root], kNone);
  }
}

TEST(VdpmModel, StepsChangeWhatDiffersBetweenLevels) {
  for (const NamedVdpm& named : all_vdpms()) {
    const ViewDependentMesh& model = *named.model;
    if (model.step_count() > 400) continue;
    const CollapseSequence& sequence = named.detailed.sequence;
    const auto ancestor_corners = [&](std::uint32_t level) {
      std::vector<std::uint32_t> corners = named.detailed.mesh.indices;
      const auto ancestors = sequence.ancestors(level);
      for (std::uint32_t& v : corners) v = ancestors[v];
      return corners;
    };
    auto coarse = ancestor_corners(0);
    for (std::uint32_t k = 0; k < model.step_count(); ++k) {
      const auto fine = ancestor_corners(k + 1);
      model.for_each_added(k, [&](std::uint32_t t, const std::array<std::uint32_t, 3>& corners) {
        ASSERT_EQ(sequence.triangle_level[t], k + 1) << named.name;
        for (std::size_t c = 0; c < 3; ++c)
          ASSERT_EQ(corners[c], fine[3 * std::size_t{t} + c]) << named.name;
      });
      auto changed = coarse;
      model.for_each_changed(k, [&](std::uint32_t t, std::uint32_t corner, std::uint32_t v) {
        ASSERT_EQ(changed[3 * std::size_t{t} + corner], sequence.target[v]) << named.name;
        changed[3 * std::size_t{t} + corner] = v;
      });
      for (std::size_t slot = 0; slot < fine.size(); ++slot)
        if (sequence.triangle_level[slot / 3] <= k) {
          ASSERT_EQ(changed[slot], fine[slot]) << named.name << ", step " << k;
        }
      coarse = fine;
    }
  }
}

TEST(VdpmModel, CentersAreWhereSplitsPutTheirVertices) {
  for (const NamedVdpm& named : all_vdpms()) {
    const CollapseSequence& sequence = named.detailed.sequence;
    for (std::uint32_t k = 0; k < named.model->step_count(); ++k) {
      const std::uint32_t v = sequence.vertices[k];
      ASSERT_EQ(named.model->first_vertex(k), v);
      ASSERT_EQ(named.model->bounds(k).vertex, v);
      if (named.model->step_count() > 300) continue;
      const TriangleMesh finer = mesh_at_level(named.detailed, k + 1);
      ASSERT_EQ(named.model->center(k), finer.positions[v]) << named.name;
    }
  }
}

TEST(VdpmModel, TheBallHoldsEveryLevel) {
  for (const NamedVdpm& named : all_vdpms()) {
    const Sphere& ball = named.model->bounding_ball();
    for (const std::uint32_t level : spread_levels(named.model->finest_level()))
      for (const Vec3& p : mesh_at_level(named.detailed, level).positions)
        ASSERT_LE(glm::length(p - ball.center), ball.radius) << named.name;
  }
}

// Ranges of materials, found by counting.
TEST(VdpmModel, KnowsTheMaterialOfTriangles) {
  for (const NamedVdpm& named : all_vdpms()) {
    const auto& ranges = named.detailed.mesh.ranges;
    for (std::uint32_t r = 0; r < ranges.size(); ++r)
      for (std::uint32_t t = 0; t < ranges[r].triangle_count; ++t)
        ASSERT_EQ(named.model->range_of(ranges[r].first_triangle + t), r) << named.name;
  }
}

}  // namespace
}  // namespace varifold::test
