#include <varifold/models/vdpm/step_bounds.h>

#include <gtest/gtest.h>
#include <tests/models/vdpm/bounds_support.h>
#include <tests/view/random_points.h>
#include <varifold/measure/closest_point.h>
#include <varifold/measure/surface_distance.h>
#include <varifold/mesh/generators.h>
#include <varifold/simplify/sample_carrier.h>
#include <algorithm>
#include <cstring>
#include <limits>
#include <set>
#include <tuple>
#include <utility>

namespace varifold {
namespace {

using test::angle_between;
using test::angle_of;

Vec3 normal_of(const std::array<Vec3, 3>& triangle) {
  return normalize_or_zero(glm::cross(triangle[1] - triangle[0], triangle[2] - triangle[0]));
}

class StepBoundsOf : public testing::TestWithParam<Placement> {};
INSTANTIATE_TEST_SUITE_P(Placements, StepBoundsOf,
                         testing::Values(Placement::kKept, Placement::kOptimal));

TEST_P(StepBoundsOf, BallsAndConesHoldTheirStars) {
  std::uint32_t narrow = 0;
  for (const test::NamedSequence& named : test::sequences(GetParam(), 600)) {
    SCOPED_TRACE(named.name);
    const DetailedMesh& detailed = named.detailed;
    const test::Stars stars(detailed);
    const std::vector<StepBounds> bounds = test::bounds_of(detailed);
    ASSERT_EQ(bounds.size(), detailed.sequence.step_count());
    for (std::uint32_t k = 0; k < bounds.size(); ++k) {
      const test::Star star = stars.of(k);
      ASSERT_EQ(bounds[k].vertex, detailed.sequence.vertices[k]);
      double radius = 0;
      std::vector<Vec3> normals;
      for (const auto* triangles : {&star.before, &star.after})
        for (const std::array<Vec3, 3>& triangle : *triangles) {
          for (const Vec3& p : triangle)
            radius = std::max(radius, glm::length(DVec3(p) - DVec3(star.center)));
          if (normal_of(triangle) != Vec3(0)) normals.push_back(normal_of(triangle));
        }
      ASSERT_LE(radius, bounds[k].radius_length());
      ASSERT_LE(bounds[k].radius_length(), radius * 1.01);
      const NormalCone cone = bounds[k].own_cone();
      for (const Vec3& n : normals)
        ASSERT_LE(angle_between(cone.axis, n), angle_of(cone) + 1e-6) << "step " << k;
      // As narrow as the cone that is made for them at leisure.
      const NormalCone leisure = unpack_cone(pack_cone(cone_around(normals)));
      if (leisure.is_wide() || normals.empty()) continue;
      EXPECT_LE(angle_of(cone), angle_of(leisure) + 0.006) << "step " << k;
      ++narrow;
    }
  }
  EXPECT_GT(narrow, 1000u);
}

// By its meaning: from no side does the vector look longer than the space.
void expect_holds(const StepBounds& bounds, const DVec3& residual, double slack, Random& random) {
  const DVec3 axis(bounds.own_cone().axis);
  for (int i = 0; i < 20; ++i) {
    DVec3 seen(test::unit_vector(random));
    // Some of them along the vector's shadow, where it matters.
    if (i < 10 && glm::length(residual) > 0)
      seen = axis * random.uniform() + glm::cross(glm::cross(residual, axis), axis) *
                                           (random.uniform() / glm::length(residual));
    if (!(glm::length(seen) > 1e-9)) continue;
    seen = glm::normalize(seen);
    const double sine = glm::length(glm::cross(seen, axis));
    const double extent =
        std::max(double{bounds.mu_length()}, double{bounds.delta_length()} * sine);
    ASSERT_LE(glm::length(glm::cross(residual, seen)), extent * (1 + 1e-5) + slack);
  }
}

TEST_P(StepBoundsOf, SpacesHoldTheDeviationOfEverySampleThatTheStepMoves) {
  Random random(5);
  std::size_t ears = 0, moves = 0;
  for (const test::NamedSequence& named : test::sequences(GetParam(), 250)) {
    SCOPED_TRACE(named.name);
    const DetailedMesh& detailed = named.detailed;
    const test::Stars stars(detailed);
    const std::vector<StepBounds> bounds = test::bounds_of(detailed);
    const test::SampleHistory history = test::history_of_samples(detailed);
    const double slack = 5e-6 * varifold::bounds(detailed.mesh).diagonal();
    std::vector<test::Star> star(bounds.size());
    for (std::uint32_t k = 0; k < bounds.size(); ++k) star[k] = stars.of(k);
    for (std::size_t s = 0; s < history.positions.size(); ++s) {
      const DVec3 p(history.positions[s]);
      for (const test::Move& move : history.moves[s]) {
        SCOPED_TRACE("step " + std::to_string(move.step));
        // The way to the nearest point of what the collapse leaves; to the target if it is nothing.
        DVec3 nearest(detailed.mesh.positions[detailed.sequence.target[bounds[move.step].vertex]]);
        double least = std::numeric_limits<double>::infinity();
        for (const std::array<Vec3, 3>& triangle : star[move.step].after) {
          const DVec3 q =
              closest_on_triangle(p, DVec3(triangle[0]), DVec3(triangle[1]), DVec3(triangle[2]));
          if (glm::length(q - p) < least) least = glm::length(q - p), nearest = q;
        }
        ASSERT_EQ(move.is_ear, star[move.step].after.empty());
        ears += move.is_ear;
        ++moves;
        if (!move.is_ear) {
          ASSERT_NEAR(glm::length(DVec3(move.residual)), least, slack);
          // Of several nearest points any may be taken: it has to be a point of them.
          double off = std::numeric_limits<double>::infinity();
          for (const std::array<Vec3, 3>& triangle : star[move.step].after)
            off = std::min(
                off, glm::length(closest_on_triangle(p + DVec3(move.residual), DVec3(triangle[0]),
                                                     DVec3(triangle[1]), DVec3(triangle[2])) -
                                 p - DVec3(move.residual)));
          ASSERT_LE(off, slack);
        }
        expect_holds(bounds[move.step], move.is_ear ? nearest - p : DVec3(move.residual), slack,
                     random);
        if (HasFatalFailure()) return;
      }
    }
  }
  EXPECT_GT(moves, 20000u);
  if (GetParam() == Placement::kKept) {
    EXPECT_GT(ears, 0u);
  }
}

TEST(StepBounds, HoldSamplesOnSurfacesWhoseLevelVaries) {
  double tightest = std::numeric_limits<double>::infinity();
  std::size_t tested = 0, samples = 0;
  for (const test::NamedSequence& named : test::sequences(Placement::kKept, 700)) {
    SCOPED_TRACE(named.name);
    const DetailedMesh& detailed = named.detailed;
    const std::vector<StepBounds> bounds = test::bounds_of(detailed);
    const test::SampleHistory history = test::history_of_samples(detailed);
    const double diagonal = varifold::bounds(detailed.mesh).diagonal();
    for (std::uint64_t seed = 0; seed < 6; ++seed) {
      const std::vector<bool> is_collapsed = test::random_front(detailed, seed);
      const SurfaceDistance surface(test::surface_without(detailed, is_collapsed));
      if (surface.empty()) continue;
      samples += history.positions.size();
      for (std::size_t s = 0; s < history.positions.size(); ++s) {
        // The last step that moved it; what comes behind a step that is not done has not happened.
        double bound = 0;
        bool is_let_go = false;
        for (const test::Move& move : history.moves[s]) {
          if (!is_collapsed[move.step]) break;
          ASSERT_FALSE(is_let_go);
          bound = std::max(bounds[move.step].mu_length(), bounds[move.step].delta_length());
          is_let_go = move.is_last;
        }
        if (is_let_go) continue;
        ++tested;
        const double distance = surface.distance(DVec3(history.positions[s]));
        ASSERT_LE(distance, bound * (1 + 1e-5) + 2e-6 * diagonal) << "sample " << s;
        if (distance > 1e-3 * diagonal) tightest = std::min(tightest, bound / distance);
      }
    }
  }
  EXPECT_LT(tightest, 1.01);
  EXPECT_GT(tested, samples / 2);
}

TEST_P(StepBoundsOf, HoldSamplesAtEveryLevel) {
  for (const test::NamedSequence& named : test::sequences(GetParam(), 700)) {
    SCOPED_TRACE(named.name);
    const DetailedMesh& detailed = named.detailed;
    const std::vector<StepBounds> bounds = test::bounds_of(detailed);
    const test::SampleHistory history = test::history_of_samples(detailed);
    const double diagonal = varifold::bounds(detailed.mesh).diagonal();
    const auto steps = static_cast<std::uint32_t>(bounds.size());
    for (std::uint32_t level = 0; level < steps; level += 1 + steps / 12) {
      const SurfaceDistance surface(mesh_at_level(detailed, level));
      for (std::size_t s = 0; s < history.positions.size(); ++s) {
        double bound = 0;
        bool is_let_go = false;
        for (const test::Move& move : history.moves[s]) {
          if (move.step < level) break;
          bound = std::max(bounds[move.step].mu_length(), bounds[move.step].delta_length());
          is_let_go = move.is_last;
        }
        if (is_let_go) continue;
        ASSERT_LE(surface.distance(DVec3(history.positions[s])),
                  bound * (1 + 1e-5) + 5e-6 * diagonal)
            << "sample " << s << " at level " << level;
      }
    }
  }
}

TEST(StepBounds, OfAHeightFieldBoundVerticalDistances) {
  const auto mesh = generate("terrain", {.triangles = 1500});
  const auto result = simplify(*mesh, {.measure_error = false});
  const DetailedMesh& detailed = result->detailed;
  const StepBoundsOptions options{.vertical = true};
  const std::vector<StepBounds> bounds = test::bounds_of(detailed, options);
  const test::SampleHistory history = test::history_of_samples(detailed, options);
  const test::Stars stars(detailed);
  const auto plan_area = [](const std::vector<std::array<Vec3, 3>>& triangles) {
    double area = 0;
    for (const std::array<Vec3, 3>& t : triangles)
      area += std::abs(glm::cross(DVec3(t[1] - t[0]), DVec3(t[2] - t[0])).y);
    return area;
  };
  std::uint32_t shrinking = 0;
  for (std::uint32_t k = 0; k < bounds.size(); ++k) {
    EXPECT_EQ(bounds[k].own_cone().axis, Vec3(0, 1, 0));
    // Only where the ground itself gives way at a border there are deviations to the side.
    const test::Star star = stars.of(k);
    const double before = plan_area(star.before), after = plan_area(star.after);
    if (after > 0.999 * before)
      EXPECT_EQ(bounds[k].mu, 0) << "step " << k;
    else
      ++shrinking;
  }
  EXPECT_LT(shrinking, 10u);
  std::size_t tested = 0;
  for (std::uint64_t seed = 0; seed < 6; ++seed) {
    const std::vector<bool> is_collapsed = test::random_front(detailed, seed);
    const TriangleMesh surface = test::surface_without(detailed, is_collapsed);
    for (std::size_t s = 0; s < history.positions.size(); ++s) {
      double bound = 0;
      bool is_beside = false;
      for (const test::Move& move : history.moves[s]) {
        if (!is_collapsed[move.step]) break;
        bound = bounds[move.step].delta_length();
        is_beside = bounds[move.step].mu > 0 || move.is_last;
      }
      if (is_beside) continue;
      ++tested;
      // The triangles above and below the sample.
      const DVec3 p(history.positions[s]);
      double least = std::numeric_limits<double>::infinity();
      for (std::size_t i = 0; i < surface.indices.size(); i += 3) {
        const DVec3 a = DVec3(surface.positions[surface.indices[i]]) - p;
        const DVec3 b = DVec3(surface.positions[surface.indices[i + 1]]) - p;
        const DVec3 c = DVec3(surface.positions[surface.indices[i + 2]]) - p;
        const double u = b.x * c.z - b.z * c.x, v = c.x * a.z - c.z * a.x,
                     w = a.x * b.z - a.z * b.x;
        if (std::min({u, v, w}) < -1e-7 && std::max({u, v, w}) > 1e-7) continue;
        if (std::abs(u + v + w) < 1e-9) continue;
        least = std::min(least, std::abs((u * a.y + v * b.y + w * c.y) / (u + v + w)));
      }
      ASSERT_LE(least, bound * (1 + 1e-5) + 1e-5) << "sample " << s;
    }
  }
  EXPECT_GT(tested, 3 * history.positions.size());
}

TEST(StepBounds, DoNotDependOnThreads) {
  for (const Placement placement : {Placement::kKept, Placement::kOptimal}) {
    const auto result =
        simplify(planet({{.triangles = 30000}}), {.placement = placement, .measure_error = false});
    ASSERT_GT(result->detailed.sequence.step_count(), 10000u);
    const auto one = test::bounds_of(result->detailed, {.threads = 1});
    const auto two = test::bounds_of(result->detailed, {.threads = 2});
    ASSERT_EQ(one.size(), two.size());
    EXPECT_EQ(std::memcmp(one.data(), two.data(), one.size() * sizeof(StepBounds)), 0);
  }
}

TEST(StepBounds, TellHowFarTheyAreAndCanBeCancelled) {
  const auto result = simplify(planet({{.triangles = 30000}}), {.measure_error = false});
  const auto watch = test::finest_required(result->detailed);
  std::vector<StepBounds> bounds;
  std::vector<float> done;
  const auto cancel = [&](std::string_view, float part) {
    done.push_back(part);
    return part < 0.5f;
  };
  EXPECT_FALSE(measure_step_bounds(result->detailed, watch, {.progress = cancel}, bounds));
  ASSERT_FALSE(done.empty());
  EXPECT_TRUE(std::is_sorted(done.begin(), done.end()));
  EXPECT_LE(done.back(), 1);
}

// Points that divide all edges into equal parts, each edge once.
std::vector<Vec3> points_of_edges(const TriangleMesh& mesh, std::uint32_t count) {
  std::set<std::pair<std::uint32_t, std::uint32_t>> edges;
  for (std::size_t i = 0; i < mesh.indices.size(); ++i)
    edges.insert(std::minmax(mesh.indices[i], mesh.indices[i % 3 == 2 ? i - 2 : i + 1]));
  std::vector<Vec3> points;
  for (const auto& [v, w] : edges)
    for (std::uint32_t i = 1; i <= count; ++i)
      points.push_back(mesh.positions[v] + static_cast<float>(i) / static_cast<float>(count + 1) *
                                               (mesh.positions[w] - mesh.positions[v]));
  return points;
}

bool lies_before(const Vec3& a, const Vec3& b) {
  return std::tie(a.x, a.y, a.z) < std::tie(b.x, b.y, b.z);
}

TEST(SurfaceSamples, AreAllVerticesInUseAndPointsOfAllTrianglesAndEdges) {
  for (const test::NamedSequence& named : test::sequences(Placement::kKept, 3000)) {
    SCOPED_TRACE(named.name);
    const TriangleMesh& mesh = named.detailed.mesh;
    std::vector<SurfaceSample> samples;
    for (std::uint32_t share = 0; share < 3; ++share)
      for (const SurfaceSample& sample : surface_samples(named.detailed, {2, 3, share, 3}))
        samples.push_back(sample);
    const auto order = [](const SurfaceSample& a, const SurfaceSample& b) {
      return std::memcmp(&a, &b, sizeof a) < 0;
    };
    std::vector<SurfaceSample> whole =
        surface_samples(named.detailed, {.inside_triangles = 2, .on_edges = 3});
    std::sort(samples.begin(), samples.end(), order);
    std::sort(whole.begin(), whole.end(), order);
    ASSERT_EQ(samples.size(), whole.size());
    ASSERT_TRUE(whole.empty() ||
                std::memcmp(samples.data(), whole.data(), whole.size() * sizeof whole[0]) == 0);

    // On their triangles; two in each, and besides every vertex once; three on every edge.
    std::vector<int> inside(mesh.triangle_count(), 0), at(mesh.vertex_count(), 0);
    for (const std::uint32_t v : mesh.indices) at[v] = -1;
    std::vector<Vec3> on_edges;
    for (const SurfaceSample& sample : whole) {
      const std::uint32_t* c = &mesh.indices[3 * std::size_t{sample.triangle}];
      const auto corner = std::find_if(
          c, c + 3, [&](std::uint32_t v) { return mesh.positions[v] == sample.position; });
      if (std::isfinite(sample.released_at))
        on_edges.push_back(sample.position);
      else if (corner != c + 3)
        ++at[*corner];
      else
        ++inside[sample.triangle];
      const DVec3 p(sample.position);
      const DVec3 q = closest_on_triangle(p, DVec3(mesh.positions[c[0]]),
                                          DVec3(mesh.positions[c[1]]), DVec3(mesh.positions[c[2]]));
      ASSERT_LE(glm::length(p - q), 1e-6 * bounds(mesh).diagonal());
    }
    for (const int count : at) ASSERT_EQ(count, 0);
    for (const int count : inside) ASSERT_EQ(count, 2);
    std::vector<Vec3> wanted = points_of_edges(mesh, 3);
    std::sort(wanted.begin(), wanted.end(), lies_before);
    std::sort(on_edges.begin(), on_edges.end(), lies_before);
    ASSERT_EQ(on_edges, wanted);
  }
}

// Points inside the triangles tell of folds that no vertex of the full mesh does.
TEST(StepBounds, PointsInsideTrianglesAreSamples) {
  const auto result = simplify(planet({{.triangles = 3000}}), {.measure_error = false});
  const auto few = test::bounds_of(result->detailed, {.inside_triangles = 0, .on_edges = 0});
  const auto many = test::bounds_of(result->detailed, {.inside_triangles = 4, .on_edges = 0});
  std::uint32_t greater = 0;
  for (std::size_t k = 0; k < few.size(); ++k)
    greater += std::max(many[k].mu, many[k].delta) > std::max(few[k].mu, few[k].delta);
  EXPECT_GT(greater, few.size() / 10);
}

}  // namespace
}  // namespace varifold
