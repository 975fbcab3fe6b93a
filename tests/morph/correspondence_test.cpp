#include <gtest/gtest.h>
#include <tests/support/meshes.h>
#include <varifold/base/random.h>
#include <varifold/morph/correspondence.h>
#include <varifold/morph/limb_pairs.h>
#include <varifold/morph/sphere_embedding.h>
#include <varifold/morph/supermesh.h>
#include <varifold/morph/surface_lift.h>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

namespace varifold {
namespace {

// Five directions, no two pairs alike: a head, and four legs of other lengths.
const std::array<Vec3, 5> kLimbs{Vec3(0.9f, 0.1f, 0.45f), Vec3(0.55f, 0.5f, -0.65f),
                                 Vec3(0.5f, -0.55f, -0.7f), Vec3(-0.6f, 0.45f, -0.6f),
                                 Vec3(-0.65f, -0.5f, -0.55f)};
constexpr std::array<float, 5> kLengths{2.6f, 1.9f, 2.0f, 2.2f, 2.3f};

Vec3 unit_vector(Random& random) {
  for (;;) {
    const DVec3 v(random.uniform() - 0.5, random.uniform() - 0.5, random.uniform() - 0.5);
    if (glm::dot(v, v) > 0.01 && glm::dot(v, v) < 0.25) return Vec3(glm::normalize(v));
  }
}

// A ball with limbs; `bend` moves each of them to a side of its own.
struct Animal {
  TriangleMesh mesh;
  std::array<std::uint32_t, 5> tips{};
};

Animal animal(std::uint32_t triangles, float bend, std::uint64_t seed) {
  Animal result{test::icosphere(triangles), {}};
  result.mesh.normals.clear();
  Random random(seed);
  std::array<Vec3, 5> ways{};
  for (std::size_t i = 0; i < ways.size(); ++i)
    ways[i] = glm::normalize(glm::normalize(kLimbs[i]) + bend * unit_vector(random));
  std::array<float, 5> highest{};
  for (std::uint32_t v = 0; v < result.mesh.vertex_count(); ++v) {
    const Vec3 way = glm::normalize(result.mesh.positions[v]);
    float radius = 1;
    for (std::size_t i = 0; i < ways.size(); ++i) {
      const float rise = std::exp(-25 * (1 - glm::dot(way, ways[i])));
      radius += kLengths[i] * rise;
      if (rise > highest[i]) highest[i] = rise, result.tips[i] = v;
    }
    result.mesh.positions[v] = radius * way;
  }
  return result;
}

SurfaceView view_of(const TriangleMesh& mesh) { return {mesh.indices, mesh.positions}; }

// Where the place of a vertex of a is on b.
DVec3 met_by(const Correspondence& found, const Animal& a, const Animal& b, std::uint32_t vertex) {
  (void)a;
  const SphereTriangulation sphere(b.mesh.indices, found.points[1]);
  const SurfaceLift lift(sphere, b.mesh.positions);
  std::uint32_t triangle = 0;
  return lift.at(glm::normalize(direction(found.points[0][vertex])), triangle);
}

TEST(Correspondence, LimbsFindEachOther) {
  for (const std::uint64_t seed : {1u, 2u}) {
    SCOPED_TRACE(seed);
    const Animal a = animal(5'000, 0, 1), b = animal(1'200, 0.25f, seed);
    const auto found = find_correspondence({view_of(a.mesh), view_of(b.mesh)});
    ASSERT_TRUE(found) << found.error().message;
    for (const int s : {0, 1})
      EXPECT_EQ(count_flipped_on_sphere(s == 0 ? a.mesh.indices : b.mesh.indices, found->points[s]),
                0u);
    for (std::size_t i = 0; i < a.tips.size(); ++i)
      EXPECT_LT(glm::distance(met_by(*found, a, b, a.tips[i]), DVec3(b.mesh.positions[b.tips[i]])),
                0.25 * kLengths[i])
          << "limb " << i;
    EXPECT_LT(found->distortion, 0.5);
  }
}

TEST(Correspondence, SameForAnyNumberOfThreads) {
  const Animal a = animal(1'200, 0, 1), b = animal(1'200, 0.2f, 2);
  CorrespondenceOptions one, three;
  one.threads = 1, three.threads = 3;
  const auto first = find_correspondence({view_of(a.mesh), view_of(b.mesh)}, one);
  const auto second = find_correspondence({view_of(a.mesh), view_of(b.mesh)}, three);
  ASSERT_TRUE(first && second);
  EXPECT_EQ(first->points, second->points);
}

// Features that say otherwise are stronger than what is alike.
TEST(Correspondence, FeaturesMeetWhereverTheyAre) {
  const Animal a = animal(5'000, 0, 1), b = animal(1'200, 0.1f, 2);
  for (const std::size_t count : {1u, 3u, 5u}) {
    SCOPED_TRACE(count);
    std::vector<FeaturePoint> features;
    for (std::size_t i = 0; i < count; ++i) features.emplace_back(a.tips[i], b.tips[i]);
    CorrespondenceOptions options;
    options.features = features;
    const auto found = find_correspondence({view_of(a.mesh), view_of(b.mesh)}, options);
    ASSERT_TRUE(found) << found.error().message;
    EXPECT_EQ(found->feature_distance, 0);
    for (const auto& [in_a, in_b] : features)
      EXPECT_EQ(found->points[0][in_a], found->points[1][in_b]);
  }
}

TEST(Correspondence, TinySurfaces) {
  const TriangleMesh tetrahedron = test::tetrahedron(), ball = test::icosphere(80);
  for (const TriangleMesh* a : {&tetrahedron, &ball})
    for (const TriangleMesh* b : {&tetrahedron, &ball}) {
      const auto found = find_correspondence({view_of(*a), view_of(*b)});
      ASSERT_TRUE(found) << found.error().message;
      EXPECT_EQ(count_flipped_on_sphere(a->indices, found->points[0]), 0u);
      EXPECT_EQ(count_flipped_on_sphere(b->indices, found->points[1]), 0u);
    }
}

TEST(PairGrowth, OneShapeTwiceIsNotDistorted) {
  const Animal a = animal(3'000, 0, 1);
  PairGrowth pair({view_of(a.mesh), view_of(a.mesh)});
  const auto points = embed_on_sphere(a.mesh.indices, a.mesh.positions);
  ASSERT_TRUE(points);
  for (const int s : {0, 1})
    for (std::uint32_t v = 0; v < points->size(); ++v) pair.put(s, v, (*points)[v]);
  ASSERT_TRUE(pair.is_positive());
  EXPECT_LT(pair.distortion(), 2e-3);
  for (const Meeting& meeting : pair.meetings())
    EXPECT_LT(glm::distance(meeting.on_a, meeting.on_b), 1e-6);
  ASSERT_TRUE(pair.grow({}));
  EXPECT_LT(pair.distortion(), 0.02);
}

// All pairs of distances by a method of its own.
TEST(Extremities, EachIsTheFarthestFromThoseBefore) {
  const TriangleMesh mesh = animal(400, 0.1f, 4).mesh;
  const std::size_t n = mesh.vertex_count();
  std::vector<double> d(n * n, std::numeric_limits<double>::infinity());
  for (std::size_t v = 0; v < n; ++v) d[v * n + v] = 0;
  for (std::size_t h = 0; h < mesh.indices.size(); ++h) {
    const std::uint32_t p = mesh.indices[h], q = mesh.indices[h % 3 == 2 ? h - 2 : h + 1];
    d[p * n + q] = d[q * n + p] = glm::distance(DVec3(mesh.positions[p]), DVec3(mesh.positions[q]));
  }
  for (std::size_t k = 0; k < n; ++k)
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t j = 0; j < n; ++j)
        d[i * n + j] = std::min(d[i * n + j], d[i * n + k] + d[k * n + j]);
  const Extremities found = find_extremities(view_of(mesh), 6);
  ASSERT_EQ(found.vertices.size(), 6u);
  double greatest = 0;
  for (const std::uint32_t i : found.vertices)
    for (const std::uint32_t j : found.vertices) greatest = std::max(greatest, d[i * n + j]);
  for (std::size_t i = 0; i < 6; ++i)
    for (std::size_t j = 0; j < 6; ++j)
      EXPECT_NEAR(found.distance(i, j) * greatest, d[found.vertices[i] * n + found.vertices[j]],
                  1e-9);
  for (std::size_t i = 1; i < 6; ++i) {
    const auto nearest = [&](std::size_t v) {
      double least = std::numeric_limits<double>::infinity();
      for (std::size_t j = 0; j < i; ++j) least = std::min(least, d[found.vertices[j] * n + v]);
      return least;
    };
    double farthest = 0;
    for (std::size_t v = 0; v < n; ++v) farthest = std::max(farthest, nearest(v));
    EXPECT_NEAR(nearest(found.vertices[i]), farthest, 1e-9);
  }
}

TEST(LimbPairs, TheSameLimbsComeFirst) {
  const Animal a = animal(2'000, 0, 1);
  const std::array<SurfaceView, 2> views{view_of(a.mesh), view_of(a.mesh)};
  const Extremities limbs = find_extremities(views[0], 6);
  const auto pairs = pair_limbs(views, {limbs, limbs}, kNoRotation, 15);
  ASSERT_EQ(pairs.size(), 15u);
  for (const LimbPairs& pair : pairs)
    for (const auto& [in_a, in_b] : pair) EXPECT_EQ(in_a, in_b);
}

TEST(RingDecimation, HoldsAndSignsAreKept) {
  const Animal a = animal(1'500, 0.1f, 7);
  const auto points = embed_on_sphere(a.mesh.indices, a.mesh.positions);
  ASSERT_TRUE(points);
  RingMesh held(a.mesh.indices, a.mesh.vertex_count());
  std::vector<Hold> holds(a.mesh.vertex_count(), Hold::kFree);
  for (const std::uint32_t tip : a.tips) holds[tip] = Hold::kAlways;
  (void)decimate(held, a.mesh.positions, {.holds = holds});
  EXPECT_EQ(held.vertex_count(), 5u);
  for (const std::uint32_t tip : a.tips) EXPECT_TRUE(held.is_live(tip));

  for (Hold& hold : holds)
    if (hold == Hold::kAlways) hold = Hold::kLate;
  RingMesh late(a.mesh.indices, a.mesh.vertex_count());
  (void)decimate(late, a.mesh.positions, {.least = 50, .holds = holds, .late = 50});
  EXPECT_EQ(late.vertex_count(), 50u);
  for (const std::uint32_t tip : a.tips) EXPECT_TRUE(late.is_live(tip));

  for (const std::uint32_t least : {300u, 60u, 4u}) {
    RingMesh positive(a.mesh.indices, a.mesh.vertex_count());
    (void)decimate(positive, a.mesh.positions, {.least = least, .points = *points});
    EXPECT_EQ(count_flipped_on_sphere(positive.triangles(), *points), 0u);
    if (least >= 60) {
      EXPECT_EQ(positive.vertex_count(), least);
    }
  }
}

TEST(BestAxisTurn, FindsEachOfThem) {
  Random random(3);
  std::vector<Vec3> places;
  for (int i = 0; i < 100; ++i)
    places.emplace_back(random.uniform(), 2 * random.uniform(),
                        3 * random.uniform() * random.uniform());
  const std::array<std::array<int, 3>, 3> orders{{{0, 1, 2}, {1, 2, 0}, {2, 0, 1}}};
  for (const auto& order : orders)
    for (const std::array<int, 3>& signs :
         {std::array{1, 1, 1}, std::array{-1, -1, 1}, std::array{1, -1, -1}}) {
      std::vector<Vec3> turned;
      for (const Vec3& p : places)
        turned.emplace_back(signs[0] * p[order[0]], signs[1] * p[order[1]], signs[2] * p[order[2]]);
      const Rotation back = best_axis_turn(places, turned);
      for (std::size_t i = 0; i < places.size(); ++i)
        EXPECT_LT(glm::distance(rotated(back, DVec3(turned[i])), DVec3(places[i])), 1e-6);
    }
}

}  // namespace
}  // namespace varifold
