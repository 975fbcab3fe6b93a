// Single steps in any order that the rule allows, against the surface by its definition.
#include <gtest/gtest.h>
#include <tests/models/vdpm/vdpm_support.h>

#include <algorithm>
#include <array>
#include <set>

namespace varifold::test {
namespace {

// Corner by corner, in the same order.
std::string exact_difference(const TriangleMesh& a, const TriangleMesh& b) {
  if (a.vertex_count() != b.vertex_count()) return "vertex count";
  if (!same_attributes(a, b)) return "attributes";
  if (!same_materials(a, b)) return "materials";
  if (a.ranges != b.ranges) return "ranges";
  if (a.indices != b.indices) return "indices";
  return {};
}

// What is drawn, as a mesh with the vertices of the list in the order of the model.
void expect_draws(ActiveSurface& surface, const TriangleMesh& expected, const std::string& where) {
  const DrawList list = surface.draw_list();
  // From points back to vertices of the list would be ambiguous; positions of corners are not.
  using Corners = std::array<float, 10>;
  const auto sorted = [](std::vector<Corners> all) {
    std::sort(all.begin(), all.end());
    return all;
  };
  const auto corners = [](std::span<const Vec3> positions, std::span<const std::uint32_t> triangle,
                          std::uint32_t material) {
    Corners values{};
    for (std::size_t c = 0; c < 3; ++c)
      for (int i = 0; i < 3; ++i)
        values[3 * c + static_cast<std::size_t>(i)] = positions[triangle[c]][i];
    values[9] = static_cast<float>(material);
    return values;
  };
  std::vector<Corners> drawn, wanted;
  for (const DrawRange& range : list.ranges)
    for (std::uint32_t i = 0; i < range.index_count; i += 3)
      drawn.push_back(
          corners(list.positions, list.indices.subspan(range.first_index + i, 3), range.material));
  const auto materials = triangle_materials(expected);
  for (std::uint32_t t = 0; t < expected.triangle_count(); ++t)
    wanted.push_back(corners(expected.positions,
                             std::span(expected.indices).subspan(3 * std::size_t{t}, 3),
                             materials[t]));
  EXPECT_TRUE(sorted(drawn) == sorted(wanted)) << where;
  for (const std::uint32_t v : list.indices) ASSERT_LT(v, list.positions.size()) << where;
}

TEST(VdpmSurface, StepsInAnyOrderGiveTheSurfaceByDefinition) {
  for (const NamedVdpm& named : all_vdpms()) {
    ActiveSurface surface(*named.model);
    RandomWalk walk(*named.model, 7);
    DeviceCopy device;
    const std::uint32_t tries = 3 * named.model->step_count() + 1;
    int stage = 0;
    for (const double upwards : {0.9, 0.5, 1.0, 0.1, 0.6, 0.0}) {
      walk.walk(surface, tries, upwards);
      const std::string where = named.name + ", stage " + std::to_string(stage++);
      const TriangleMesh expected = mesh_of_steps(named.detailed, walk.split());
      ASSERT_EQ(exact_difference(surface.extract(), expected), "") << where;
      ASSERT_EQ(surface.vertex_count(), expected.vertex_count()) << where;
      ASSERT_EQ(surface.triangle_count(), expected.triangle_count()) << where;
      expect_draws(surface, expected, where);
    }
  }
}

using Places = std::array<float, 9>;

std::vector<Places> places_of_triangles(const TriangleMesh& mesh) {
  std::vector<Places> all;
  for (std::size_t slot = 0; slot < mesh.indices.size(); slot += 3) {
    Places places{};
    for (std::size_t i = 0; i < 9; ++i)
      places[i] = mesh.positions[mesh.indices[slot + i / 3]][static_cast<int>(i % 3)];
    all.push_back(places);
  }
  return all;
}

// Corner by corner, where vertices move as well: steps that touch a triangle are a chain.
TEST(VdpmSurface, EveryTriangleOfAFrontIsThatOfSomeLevel) {
  std::size_t looked_at = 0;
  for (const NamedVdpm& named : all_vdpms()) {
    const std::uint32_t steps = named.model->step_count();
    if (steps > 400) continue;
    std::set<Places> known;
    for (std::uint32_t level = 0; level <= steps; ++level)
      for (const Places& places : places_of_triangles(mesh_at_level(named.detailed, level)))
        known.insert(places);
    ActiveSurface surface(*named.model);
    RandomWalk walk(*named.model, 11);
    for (const double upwards : {0.8, 0.5, 0.4, 0.6, 0.3}) {
      walk.walk(surface, 2 * steps + 1, upwards);
      for (const Places& places : places_of_triangles(surface.extract())) {
        ASSERT_TRUE(known.contains(places)) << named.name;
        ++looked_at;
      }
    }
  }
  EXPECT_GT(looked_at, 5000u);
}

TEST(VdpmSurface, ChangedRangesAreEnough) {
  for (const NamedVdpm& named : all_vdpms()) {
    ActiveSurface surface(*named.model);
    RandomWalk walk(*named.model, 8);
    DeviceCopy device;
    for (int i = 0; i < 12; ++i) {
      walk.walk(surface, 1 + (named.model->step_count() >> (i % 5)), i < 6 ? 0.8 : 0.2);
      const DrawList list = surface.draw_list();
      device.take(list);
      device.expect_same(list, named.name);
    }
  }
}

TEST(VdpmSurface, IsSplitTellsWhatIsSplit) {
  for (const NamedVdpm& named : all_vdpms()) {
    ActiveSurface surface(*named.model);
    RandomWalk walk(*named.model, 9);
    walk.walk(surface, named.model->step_count(), 0.7);
    for (std::uint32_t k = 0; k < named.model->step_count(); ++k)
      ASSERT_EQ(surface.is_split(k), walk.split()[k]) << named.name;
  }
}

}  // namespace
}  // namespace varifold::test
