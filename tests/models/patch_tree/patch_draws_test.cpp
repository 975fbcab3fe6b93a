// Draw lists of patches: what they draw, what they change, and that blending leaves no crack.
#include <gtest/gtest.h>
#include <tests/models/patch_tree/tree_fronts.h>
#include <tests/models/patch_tree/tree_of.h>
#include <tests/support/meshes.h>
#include <varifold/mesh/generators.h>
#include <varifold/models/patch_tree/front.h>
#include <varifold/models/patch_tree/patch_draws.h>
#include <varifold/view/patch_morph.h>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <map>
#include <set>
#include <tuple>

namespace varifold {
namespace {

using test::tree_of;
using TreePointer = std::shared_ptr<const PatchTree>;
using Place = std::tuple<float, float, float>;

Place place_of(const Vec3& p) { return {p.x + 0.0f, p.y + 0.0f, p.z + 0.0f}; }

TreePointer planet_tree(std::uint32_t triangles, std::uint32_t per_patch) {
  PlanetOptions options;
  options.triangles = triangles;
  return tree_of(planet(options), per_patch);
}

std::shared_ptr<const PatchDrawTables> tables_of(const TreePointer& tree) {
  return std::make_shared<const PatchDrawTables>(tree, PatchMeasure::kPixels);
}

// Near to far, from all sides, or inside.
Camera random_view(const Box& box, Random& random) {
  const auto number = [&] { return static_cast<float>(2 * random.uniform() - 1); };
  Camera camera;
  camera.target = box.center() + 0.3f * box.diagonal() * Vec3(number(), number(), number());
  const Vec3 side = normalize_or_zero(Vec3(number(), number(), number()) + Vec3(0, 0, 0.01f));
  camera.eye = camera.target +
               side * box.diagonal() * static_cast<float>(std::pow(10, 1.5 * random.uniform() - 1));
  camera.up = Vec3(side.y, side.z, -side.x) + Vec3(0.01f, 0, 0);
  set_depth_range(camera, sphere_around(box));
  return camera;
}

// The vertices that the shader draws for the corners of a list, by triangle.
std::vector<std::array<std::uint32_t, 3>> drawn_triangles(const PatchDrawList& list) {
  std::vector<std::array<std::uint32_t, 3>> triangles;
  for (const PatchDrawCommand& draw : list.draws)
    for (std::size_t i = draw.first_index; i < draw.first_index + draw.index_count; i += 3) {
      std::array<std::uint32_t, 3>& triangle = triangles.emplace_back();
      for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t v = draw.first_vertex + list.indices[i + k];
        triangle[k] = switched_vertex(v, list.remap[v], draw.parent_vertex, draw.mask);
      }
    }
  return triangles;
}

TEST(PatchDraws, DrawTheTrianglesAndMaterialsOfTheFront) {
  Random random(3);
  for (const auto& [name, mesh] : test::all_groups()) {
    SCOPED_TRACE(name);
    const TreePointer tree = tree_of(mesh, 16);
    const PatchTreeData& data = tree->data();
    PatchDraws draws(std::make_shared<const PatchDrawTables>(tree));
    EXPECT_TRUE(draws.list().morphs.empty());
    if (tree->node_count() == 0) continue;
    for (int i = 0; i < 10; ++i) {
      const test::SplitNodes front = test::random_front(tree->topology(), random);
      std::multiset<std::array<std::uint32_t, 4>> expected, found;
      for (std::uint32_t node = 0; node < tree->node_count(); ++node) {
        if (!is_in_front(tree->topology(), front, node)) continue;
        const std::uint32_t parent = tree->topology().parent[node];
        const std::uint32_t mask =
            parent == kNone ? 0 : coarse_neighbors(tree->topology(), front, parent);
        std::uint32_t t = data.offsets[node].triangle;
        for (std::uint32_t r = data.offsets[node].range; r < data.offsets[node + 1].range; ++r)
          for (std::uint32_t n = 0; n < data.ranges[r].triangle_count; ++n, ++t) {
            std::array<std::uint32_t, 4> triangle{0, 0, 0, data.ranges[r].material};
            for (std::size_t k = 0; k < 3; ++k)
              triangle[k] = drawn_vertex(
                  data, node, data.offsets[node].vertex + data.corners[3 * std::size_t{t} + k],
                  mask);
            expected.insert(triangle);
          }
      }
      draws.show(front);
      const PatchDrawList list = draws.list();
      const auto drawn = drawn_triangles(list);
      std::size_t t = 0;
      for (const PatchDrawCommand& draw : list.draws)
        for (std::uint32_t n = 0; n < draw.index_count / 3; ++n, ++t)
          found.insert({drawn[t][0], drawn[t][1], drawn[t][2], draw.material});
      ASSERT_EQ(found, expected);
      ASSERT_EQ(submitted_triangles(list), expected.size());
    }
  }
}

TEST(PatchDraws, WhatChangedIsAllThatReadersNeed) {
  Random random(5);
  TriangleMesh two = test::join(test::icosphere(4000), test::icosphere(2000), Vec3(1.5f, 0, 0));
  two.materials.resize(2);
  std::vector<std::uint32_t> materials(two.triangle_count());
  for (std::uint32_t& material : materials) material = random.below(2);
  set_triangle_materials(two, materials);
  for (const TreePointer& tree : {planet_tree(20000, 64), tree_of(two, 64)}) {
    PatchFront front(tree);
    const auto tables = std::make_shared<const PatchDrawTables>(tree);
    PatchDraws draws(tables);
    std::vector<PatchDrawCommand> copy;
    std::size_t kept = 0;
    Camera camera = random_view(Box{Vec3(-1), Vec3(1)}, random);
    for (int frame = 0; frame < 200; ++frame) {
      if (frame % 10 == 0) camera = random_view(Box{Vec3(-1), Vec3(1)}, random);
      camera.eye *= 0.97f;
      RefineCriteria criteria;
      criteria.view.emplace(camera);
      PatchFrontOptions options;
      options.limits.tolerance = 2;
      if (frame % 3 == 0) options.limits.max_triangles = 1000 + random.below(9000);
      front.adapt(criteria, options);
      draws.follow(front.draws());
      const PatchDrawList list = draws.list();
      const std::size_t before = copy.size();
      copy.resize(list.draws.size());
      for (std::size_t i = before; i < copy.size(); ++i) copy[i] = list.draws[i];
      for (const std::uint32_t i : list.changed_draws) copy[i] = list.draws[i];
      kept += copy.size() - std::min(copy.size(), list.changed_draws.size());
      PatchDraws fresh(tables);
      fresh.follow(front.draws(), true);
      ASSERT_EQ(fresh.list().draws.size(), copy.size());
      ASSERT_EQ(std::memcmp(copy.data(), fresh.list().draws.data(),
                            copy.size() * sizeof(PatchDrawCommand)),
                0);
    }
    EXPECT_GT(kept, 1000u);
  }
}

// By the definition: vertices that are drawn at one place must be blended to one place.
TEST(PatchMorph, WhatMeetsKeepsMeeting) {
  Random random(7);
  std::size_t shared = 0, blended = 0;
  for (const auto& [name, mesh] : test::all_groups()) {
    SCOPED_TRACE(name);
    const TreePointer tree = tree_of(mesh, 16);
    if (tree->node_count() == 0) continue;
    PatchDraws draws(tables_of(tree));
    const Box box = bounds(mesh);
    for (int i = 0; i < 30; ++i) {
      draws.show(test::random_front(tree->topology(), random));
      const PatchDrawList list = draws.list();
      const PixelScale scale(random_view(box, random));
      const PatchMorphRange range =
          pixel_morph_range(scale, static_cast<float>(std::pow(10, 3 * random.uniform())));
      std::map<Place, Vec3> blend_of;
      for (const auto& triangle : drawn_triangles(list))
        for (const std::uint32_t v : triangle) {
          const Vec3 morphed = morphed_position(list, v, range);
          const auto [found, is_new] = blend_of.emplace(place_of(list.positions[v]), morphed);
          ASSERT_TRUE(is_new || place_of(found->second) == place_of(morphed));
          shared += is_new ? 0 : 1;
          const float part = morph_part(range, list.positions[v], list.morphs[v].error);
          blended += part > 0 && part < 1 ? 1 : 0;
        }
    }
  }
  EXPECT_GT(shared, 100000u);
  EXPECT_GT(blended, 5000u);
}

// Every edge is passed as often one way as the other, so a ray from outside never sees the inside
// of a closed surface through a gap.
TEST(PatchMorph, ClosedSurfacesStayClosed) {
  Random random(11);
  for (const auto& [name, mesh] : test::group_closed()) {
    SCOPED_TRACE(name);
    const TreePointer tree = tree_of(mesh, 30);
    PatchDraws draws(tables_of(tree));
    const Box box = bounds(mesh);
    for (int i = 0; i < 10; ++i) {
      draws.show(test::random_front(tree->topology(), random));
      const PatchDrawList list = draws.list();
      const PixelScale scale(random_view(box, random));
      const PatchMorphRange range =
          pixel_morph_range(scale, static_cast<float>(std::pow(10, 3 * random.uniform())));
      std::map<std::pair<Place, Place>, int> balance;
      for (const auto& triangle : drawn_triangles(list)) {
        std::array<Place, 3> p;
        for (std::size_t k = 0; k < 3; ++k)
          p[k] = place_of(morphed_position(list, triangle[k], range));
        for (std::size_t k = 0; k < 3; ++k) {
          const Place &a = p[k], &b = p[(k + 1) % 3];
          if (a < b) ++balance[{a, b}];
          if (b < a) --balance[{b, a}];
        }
      }
      for (const auto& [edge, count] : balance) ASSERT_EQ(count, 0);
    }
  }
}

// The triangles of a morphed list with their corners numbered by place, up to rounding.
class Surface {
 public:
  Surface(const PatchDrawList& list, const PatchMorphRange& range, float precision) {
    for (const auto& triangle : drawn_triangles(list)) {
      std::array<Vec3, 3>& p = triangles.emplace_back();
      for (std::size_t k = 0; k < 3; ++k) p[k] = morphed_position(list, triangle[k], range);
      const auto cell = [&](float x) { return std::lround(x / precision); };
      for (const Vec3& corner : p) cells.insert({cell(corner.x), cell(corner.y), cell(corner.z)});
    }
  }
  // A vertex that is not at a place of the other surface.
  [[nodiscard]] bool has(const Vec3& p, float precision) const {
    const auto cell = [&](float x) { return std::lround(x / precision); };
    for (long x = -1; x <= 1; ++x)
      for (long y = -1; y <= 1; ++y)
        for (long z = -1; z <= 1; ++z)
          if (cells.count({cell(p.x) + x, cell(p.y) + y, cell(p.z) + z}) != 0) return true;
    return false;
  }
  std::vector<std::array<Vec3, 3>> triangles;
  std::set<std::tuple<long, long, long>> cells;
};

double volume_of(const Surface& surface) {
  double sum = 0;
  for (const auto& t : surface.triangles)
    sum += glm::dot(DVec3(t[0]), glm::cross(DVec3(t[1]), DVec3(t[2])));
  return sum / 6;
}

// The last node that a tolerance leaves whole is split by one that is a hair smaller. What is drawn
// then has its vertices where there were vertices before, and encloses the same volume.
class SplittingANode : public ::testing::TestWithParam<PatchMeasure> {};
INSTANTIATE_TEST_SUITE_P(PatchMorph, SplittingANode,
                         ::testing::Values(PatchMeasure::kPixels, PatchMeasure::kMeanSquared));

TEST_P(SplittingANode, MovesNothing) {
  Random random(13);
  const bool squares = GetParam() == PatchMeasure::kMeanSquared;
  const TreePointer tree = planet_tree(30000, 64);
  PatchFront front(tree);
  PatchDraws draws(std::make_shared<const PatchDrawTables>(tree, GetParam()));
  const float precision = 4e-6f;
  std::uint32_t splits = 0, plain_jumps = 0;
  for (int i = 0; i < 60; ++i) {
    RefineCriteria criteria;
    criteria.view.emplace(random_view(Box{Vec3(-1), Vec3(1)}, random));
    criteria.view->outside_weight = criteria.view->back_weight = 1;
    PatchFrontOptions options;
    options.measure = GetParam();
    const double power = squares ? -7 + 3 * random.uniform() : 1.5 * random.uniform();
    options.limits.tolerance = static_cast<float>(std::pow(10, power));
    front.adapt(criteria, options);
    float greatest = 0;
    for (const PatchDraw& draw : front.draws().draws())
      if (!tree->topology().is_leaf(draw.node))
        greatest = std::max(greatest, front.nodes().priority(draw.node));
    if (greatest == 0) continue;
    PatchMorphRange range = squares ? mean_squared_morph_range(criteria.view->eye, greatest)
                                    : pixel_morph_range(criteria.view->scale, greatest);
    if (i % 2 == 0) range.band = 3;
    options.limits.tolerance = greatest;
    front.adapt(criteria, options);
    draws.follow(front.draws(), true);
    const Surface before(draws.list(), range, precision);
    options.limits.tolerance = std::nextafter(greatest, 0.0f);
    front.adapt(criteria, options);
    ASSERT_GT(front.draws().splits(), 0u);
    splits += front.draws().splits();
    draws.follow(front.draws());
    const Surface after(draws.list(), range, precision);
    for (const auto& triangle : after.triangles)
      for (const Vec3& corner : triangle) ASSERT_TRUE(before.has(corner, precision));
    EXPECT_NEAR(volume_of(before), volume_of(after), 1e-6 * volume_of(before));
    // Without blending vertices appear elsewhere.
    PatchMorphRange none = range;
    none.tolerance = 1e-30f;
    const Surface jumped(draws.list(), none, precision);
    for (const auto& triangle : jumped.triangles)
      for (const Vec3& corner : triangle) plain_jumps += before.has(corner, precision) ? 0 : 1;
  }
  EXPECT_GE(splits, 40u);
  EXPECT_GT(plain_jumps, 1000u);
}

TEST(PatchMorph, NoVertexIsFartherOffThanTheTolerance) {
  for (const float band : {1.1f, 1.25f, 2.0f})
    for (float distance = 0.01f; distance < 1e5f; distance *= 1.01f) {
      const PatchMorphRange range = {Vec3(0), 0.1f, 1000, 1.5f, band};
      const float error = 0.3f;
      const float pixels = error * range.scale / std::max(distance, range.near_distance);
      const float part = morph_part(range, Vec3(distance, 0, 0), error);
      EXPECT_LE(part * pixels, range.tolerance * 1.0001f);
      EXPECT_EQ(part == 1, pixels <= range.tolerance);
      EXPECT_EQ(part == 0, pixels >= band * range.tolerance);
    }
}

}  // namespace
}  // namespace varifold
