// Fronts of variable resolution: what they must be by definition, and what they must not break.
#include <gtest/gtest.h>
#include <tests/models/strips/strips_support.h>

#include <varifold/base/random.h>
#include <varifold/mesh/topology.h>
#include <varifold/mesh/validation.h>
#include <algorithm>
#include <cmath>
#include <set>

namespace varifold::test {
namespace {

// Urgencies that ask for some steps at random, few or many.
std::vector<float> random_urgencies(std::uint32_t steps, Random& random) {
  std::vector<float> urgencies(steps, 0);
  const double share = std::pow(2.0, -8 * random.uniform()) * random.uniform();
  for (float& urgency : urgencies)
    if (random.uniform() < share) urgency = 2;
  return urgencies;
}

FrontStatistics adapt_to(StripFrameworkInstance& instance, const std::vector<float>& urgencies) {
  return instance.adapt_by([&](std::uint32_t step) { return urgencies[step]; });
}

// What no front may lose.
struct Shape {
  std::int64_t euler_characteristic;
  std::uint32_t components, boundary_loops, nonmanifold_vertices, duplicates;
  bool closed, oriented;
  friend bool operator==(const Shape&, const Shape&) = default;
};

Shape shape_of(const TriangleMesh& mesh) {
  const TopologyReport report = analyze_topology(mesh, weld_exact(mesh.positions), 1);
  return {report.euler_characteristic,
          report.components,
          report.boundary_loops,
          report.nonmanifold_vertices,
          report.duplicate_triangles,
          report.closed,
          report.oriented()};
}

// Every triangle of every level.
std::set<Triangle> triangles_of_levels(const NamedFramework& named) {
  std::set<Triangle> triangles;
  for (std::uint32_t level = 0; level <= named.model->finest_level(); ++level)
    for (const Triangle& t : triangle_set(mesh_at_level(named.detailed, level)))
      triangles.insert(t);
  return triangles;
}

TEST(StripsFront, IsTheMeshByDefinition) {
  Random random(1);
  for (const NamedFramework& named : all_frameworks()) {
    StripFrameworkInstance instance(named.model);
    for (int i = 0; i < 25; ++i) {
      const std::vector<float> urgencies = random_urgencies(named.model->finest_level(), random);
      const FrontStatistics statistics = adapt_to(instance, urgencies);
      const std::vector<bool> split = splits_of(instance);
      std::uint32_t forced = 0;
      for (std::uint32_t k = 0; k < split.size(); ++k) {
        ASSERT_TRUE(split[k] || urgencies[k] == 0) << named.name;
        forced += split[k] && urgencies[k] == 0 ? 1 : 0;
      }
      const TriangleMesh expected = mesh_of_front(named.detailed, split);
      const std::vector<Triangle> triangles = triangle_set(expected);
      ASSERT_TRUE(triangle_set(instance.draw_list()) == triangles) << named.name;
      EXPECT_EQ(statistics.triangles, triangles.size()) << named.name;
      EXPECT_EQ(statistics.forced_splits, forced);
      std::uint32_t vertices = named.model->vertex_count(0);
      for (std::uint32_t k = 0; k < split.size(); ++k)
        if (split[k]) vertices += named.model->levels().step(k).vertices;
      EXPECT_EQ(statistics.vertices, vertices);
      EXPECT_EQ(instance.triangle_count(), statistics.triangles);
      // What is extracted: the same but for vertices that are not used, unless it is a level.
      if (instance.level() != kNone) continue;
      const TriangleMesh extracted = instance.extract();
      const TriangleMesh used = without_unused_vertices(expected);
      EXPECT_TRUE(extracted.positions == used.positions) << named.name;
      EXPECT_TRUE(triangle_set(extracted) == triangle_set(used)) << named.name;
    }
  }
}

TEST(StripsFront, KeepsTheSurfaceWhole) {
  Random random(2);
  for (const NamedFramework& named : all_frameworks()) {
    if (named.model->triangle_count(0) == 0) continue;
    const Shape full = shape_of(named.detailed.mesh);
    StripFrameworkInstance instance(named.model);
    const int fronts = named.model->finest_level() < 1000 ? 60 : 8;
    for (int i = 0; i < fronts; ++i) {
      adapt_to(instance, random_urgencies(named.model->finest_level(), random));
      const Shape shape = shape_of(instance.extract());
      ASSERT_TRUE(shape == full) << named.name << " front " << i << ": Euler characteristic "
                                 << shape.euler_characteristic << ", not "
                                 << full.euler_characteristic << "; duplicates " << shape.duplicates
                                 << ", not " << full.duplicates;
    }
  }
}

// So there is no fold that no level has.
TEST(StripsFront, HasOnlyTrianglesOfLevels) {
  Random random(3);
  for (const NamedFramework* named : small_frameworks(700)) {
    const std::set<Triangle> known = triangles_of_levels(*named);
    StripFrameworkInstance instance(named->model);
    for (int i = 0; i < 40; ++i) {
      adapt_to(instance, random_urgencies(named->model->finest_level(), random));
      for (const Triangle& triangle : triangle_set(instance.draw_list()))
        ASSERT_TRUE(known.count(triangle) == 1) << named->name;
    }
  }
}

// The triangles around the vertices of each step, in the sequence, just before its collapse.
std::vector<std::vector<Triangle>> stars_of(const DetailedMesh& detailed) {
  const CollapseSequence& sequence = detailed.sequence;
  std::vector<std::vector<Triangle>> stars(sequence.step_count());
  for (std::uint32_t k = 0; k < stars.size(); ++k)
    for (const Triangle& t : triangle_set(mesh_at_level(detailed, k + 1)))
      if (std::any_of(t.begin(), t.begin() + 3,
                      [&](std::uint32_t v) { return v >= sequence.vertices[k]; }))
        stars[k].push_back(t);
  return stars;
}

// From the full mesh, collapses in any order that the dependencies allow: each must find the very
// triangles around it that it found in the sequence.
TEST(StripsFront, EveryCollapseSeesTheStarOfTheSequence) {
  Random random(4);
  for (const NamedFramework* named : small_frameworks(120)) {
    const CollapseSequence& sequence = named->detailed.sequence;
    const std::uint32_t steps = sequence.step_count();
    const auto dependencies = dependencies_of(*named->model);
    const auto stars = stars_of(named->detailed);
    for (int round = 0; round < 6; ++round) {
      std::vector<bool> split(steps, true);
      for (;;) {
        std::vector<std::uint32_t> ready;
        for (std::uint32_t k = 0; k < steps; ++k)
          if (split[k] && std::none_of(dependencies[k].begin(), dependencies[k].end(),
                                       [&](std::uint32_t finer) { return split[finer]; }))
            ready.push_back(k);
        if (ready.empty()) break;
        // The coarsest ready ones are those most at odds with the sequence.
        const std::uint32_t k = round == 0 ? ready[0]
                                           : ready[random.below(static_cast<std::uint32_t>(
                                                 std::min<std::size_t>(ready.size(), 8)))];
        std::vector<Triangle> star;
        for (const Triangle& t : triangle_set(mesh_of_front(named->detailed, split)))
          if (std::any_of(t.begin(), t.begin() + 3, [&](std::uint32_t v) {
                return v >= sequence.vertices[k] && v < sequence.vertices[k + 1];
              }))
            star.push_back(t);
        ASSERT_TRUE(star == stars[k]) << named->name << ", step " << k;
        split[k] = false;
      }
      EXPECT_EQ(std::count(split.begin(), split.end(), true), 0) << named->name;
    }
  }
}

// Greatest: a step that is split, and that nobody asked for, has one that depends on it split.
TEST(StripsFront, SplitsNothingWithoutNeed) {
  Random random(5);
  for (const NamedFramework& named : all_frameworks()) {
    const std::uint32_t steps = named.model->finest_level();
    const auto dependencies = dependencies_of(*named.model);
    StripFrameworkInstance instance(named.model);
    for (int i = 0; i < 10; ++i) {
      const std::vector<float> urgencies = random_urgencies(steps, random);
      adapt_to(instance, urgencies);
      const std::vector<bool> split = splits_of(instance);
      for (std::uint32_t k = 0; k < steps; ++k) {
        const bool needed = std::any_of(dependencies[k].begin(), dependencies[k].end(),
                                        [&](std::uint32_t finer) { return split[finer]; });
        ASSERT_EQ(split[k], needed || urgencies[k] > 0) << named.name;
        for (const std::uint32_t finer : dependencies[k]) ASSERT_GT(finer, k);
      }
    }
  }
}

TEST(StripsFront, UniformLevelsAreThoseOfGoTo) {
  for (const NamedFramework& named : all_frameworks()) {
    StripFrameworkInstance adapted(named.model), walker(named.model);
    for (const std::uint32_t level : spread_levels(named.model->finest_level())) {
      const FrontStatistics statistics =
          adapted.adapt_by([&](std::uint32_t step) { return step < level ? 2.0f : 0.0f; });
      walker.go_to_level(level);
      EXPECT_EQ(difference(adapted, walker), "") << named.name << " " << level;
      EXPECT_EQ(statistics.forced_splits, 0u);
    }
  }
}

TEST(StripsFront, DependsOnTheLastAdaptAlone) {
  Random random(6);
  for (const NamedFramework& named : all_frameworks()) {
    const std::uint32_t steps = named.model->finest_level();
    StripFrameworkInstance walker(named.model);
    for (int i = 0; i < 12; ++i) {
      const std::vector<float> urgencies = random_urgencies(steps, random);
      StripFrameworkInstance fresh(named.model);
      fresh.go_to_level(random.below(steps + 1));
      adapt_to(fresh, urgencies);
      const std::vector<bool> before = splits_of(walker);
      const FrontStatistics statistics = adapt_to(walker, urgencies);
      std::uint32_t splits = 0, collapses = 0;
      for (std::uint32_t k = 0; k < steps; ++k) {
        splits += !before[k] && walker.is_split(k) ? 1 : 0;
        collapses += before[k] && !walker.is_split(k) ? 1 : 0;
      }
      EXPECT_EQ(statistics.splits, splits);
      EXPECT_EQ(statistics.collapses, collapses);
      if (random.below(2) == 0) static_cast<void>(walker.draw_list());
      ASSERT_EQ(difference(walker, fresh), "") << named.name;
      const FrontStatistics again = adapt_to(walker, urgencies);
      EXPECT_EQ(again.splits + again.collapses, 0u);
      const DrawList list = walker.draw_list();
      EXPECT_TRUE(list.changed_indices.empty() && list.changed_vertices.empty());
      if (i % 3 != 2) continue;
      const std::uint32_t level = random.below(steps + 1);
      StripFrameworkInstance at_level(named.model);
      at_level.go_to_level(level);
      walker.go_to_level(level);
      ASSERT_EQ(difference(walker, at_level), "") << named.name;
    }
  }
}

TEST(StripsFront, MeetsBudgets) {
  Random random(7);
  for (const NamedFramework& named : all_frameworks()) {
    const std::uint32_t steps = named.model->finest_level();
    std::vector<float> urgencies(steps);
    for (float& urgency : urgencies)
      urgency = static_cast<float>(std::pow(10, 8 * random.uniform() - 4));
    const std::uint32_t full = named.model->triangle_count(steps);
    const std::uint32_t base = named.model->triangle_count(0);
    StripFrameworkInstance instance(named.model), plain(named.model);
    const auto urgency = [&](std::uint32_t step) { return urgencies[step]; };
    for (int i = 0; i < 20; ++i) {
      AdaptOptions options{static_cast<float>(random.uniform()), random.below(full + 2)};
      const FrontStatistics met = instance.adapt_by(urgency, options);
      EXPECT_LE(met.triangles, std::max(base, options.max_triangles)) << named.name;
      EXPECT_GE(met.tolerance, options.tolerance);
      plain.adapt_by(urgency, {met.tolerance, kNone});
      EXPECT_EQ(difference(instance, plain), "") << named.name;
      if (met.tolerance == options.tolerance) continue;
      // The next lower tolerance would be too much.
      const float lower = std::nextafter(met.tolerance, 0.0f);
      EXPECT_GT(plain.adapt_by(urgency, {lower, kNone}).triangles, options.max_triangles);
    }
  }
}

// The criteria are asked in a short cut; the front is that of asking them in full.
TEST(StripsFront, CriteriaAreAskedInFull) {
  Random random(9);
  for (const NamedFramework& named : all_frameworks()) {
    StripFrameworkInstance instance(named.model), plain(named.model);
    for (int i = 0; i < 10; ++i) {
      Camera camera;
      camera.eye = {4 * static_cast<float>(random.uniform()) - 2,
                    4 * static_cast<float>(random.uniform()) - 2, 3};
      RefineCriteria criteria;
      criteria.view.emplace(camera);
      criteria.view->silhouette_weight = static_cast<float>(4 * random.uniform());
      if (i % 2 == 0) criteria.view->outside_weight = 2;
      if (i % 3 == 0) criteria.sphere = Sphere{{1, 0, 0}, 0.2f};
      const AdaptOptions options{static_cast<float>(20 * random.uniform()),
                                 i % 4 == 0 ? 50 + random.below(500) : kNone};
      const FrontStatistics a = instance.adapt(criteria, options);
      const FrontStatistics b = plain.adapt_by(
          [&](std::uint32_t k) {
            return criteria.urgency(named.model->region(k, named.detailed.sequence.vertices[k]));
          },
          options);
      EXPECT_EQ(difference(instance, plain), "") << named.name;
      EXPECT_EQ(a.tolerance, b.tolerance);
      EXPECT_EQ(a.forced_splits, b.forced_splits);
    }
  }
}

double distance_to_triangle(DVec3 p, DVec3 a, DVec3 b, DVec3 c) {
  const auto to_segment = [&](DVec3 u, DVec3 v) {
    const double length = glm::dot(v - u, v - u);
    const double t = length > 0 ? std::clamp(glm::dot(p - u, v - u) / length, 0.0, 1.0) : 0.0;
    return glm::length(p - (u + t * (v - u)));
  };
  const DVec3 n = glm::cross(b - a, c - a);
  const auto inside = [&](DVec3 u, DVec3 v) { return glm::dot(glm::cross(v - u, p - u), n) >= 0; };
  if (glm::dot(n, n) > 0 && inside(a, b) && inside(b, c) && inside(c, a))
    return std::abs(glm::dot(p - a, n)) / glm::length(n);
  return std::min({to_segment(a, b), to_segment(b, c), to_segment(c, a)});
}

// A front whose collapsed steps have errors of at most e is within e of all vertices.
TEST(StripsFront, ErrorsBoundDistances) {
  Random random(8);
  for (const NamedMesh& mesh : group_closed()) {
    const NamedFramework named = make_framework(mesh);
    const std::uint32_t steps = named.model->finest_level();
    if (steps > 1500 || steps == 0) continue;
    StripFrameworkInstance instance(named.model);
    const auto error = [&](std::uint32_t step) {
      return named.model->region(step, named.detailed.sequence.vertices[step]).error;
    };
    for (int i = 0; i < 3; ++i) {
      const float tolerance = error(random.below(steps));
      // Here and there more detail, so that it is no level.
      const std::vector<float> more = random_urgencies(steps, random);
      instance.adapt_by(
          [&](std::uint32_t k) { return error(k) > tolerance || more[k] > 0 ? 2.0f : 0.0f; });
      const TriangleMesh front = instance.extract();
      for (std::uint32_t v = 0; v < named.detailed.mesh.vertex_count(); v += 7) {
        double least = 1e30;
        for (std::size_t t = 0; t < front.indices.size(); t += 3)
          least =
              std::min(least, distance_to_triangle(DVec3(named.detailed.mesh.positions[v]),
                                                   DVec3(front.positions[front.indices[t]]),
                                                   DVec3(front.positions[front.indices[t + 1]]),
                                                   DVec3(front.positions[front.indices[t + 2]])));
        ASSERT_LE(least, static_cast<double>(tolerance) * 1.0001 + 1e-9) << named.name;
      }
    }
  }
}

// Balls hold what the step and all below it change, and cones its normals; errors do not fall.
TEST(StripsModel, RegionsHoldWhatTheyAreOf) {
  for (const NamedFramework* named : small_frameworks(700)) {
    const CollapseSequence& sequence = named->detailed.sequence;
    const std::uint32_t steps = sequence.step_count();
    const std::vector<Vec3>& positions = named->detailed.mesh.positions;
    const auto stars =
        steps <= 120 ? stars_of(named->detailed) : std::vector<std::vector<Triangle>>{};
    std::vector<std::uint32_t> step_of(positions.size(), kNone);
    for (std::uint32_t k = 0; k < steps; ++k)
      for (std::uint32_t v = sequence.vertices[k]; v < sequence.vertices[k + 1]; ++v)
        step_of[v] = k;
    const auto dependencies = dependencies_of(*named->model);
    for (std::uint32_t k = 0; k < steps; ++k) {
      const RegionBounds own = named->model->region(k, sequence.vertices[k]);
      for (const std::uint32_t finer : dependencies[k])
        EXPECT_GE(own.error, named->model->region(finer, sequence.vertices[finer]).error);
      // The step itself and all above it.
      for (std::uint32_t above = k; above != kNone;
           above = step_of[sequence.target[sequence.vertices[above]]]) {
        const RegionBounds region = named->model->region(above, sequence.vertices[above]);
        const float reach = glm::length(own.ball.center - region.ball.center) + own.ball.radius;
        EXPECT_LE(reach, region.ball.radius * 1.0001f) << named->name;
        if (stars.empty()) continue;
        for (const Triangle& t : stars[k]) {
          const Vec3 n = normalize_or_zero(
              glm::cross(positions[t[1]] - positions[t[0]], positions[t[2]] - positions[t[0]]));
          if (n == Vec3(0)) continue;
          EXPECT_GE(glm::dot(n, region.cone.axis), region.cone.cosine - 1e-6f) << named->name;
          for (std::uint32_t c = 0; c < 3; ++c)
            EXPECT_LE(glm::length(positions[t[c]] - region.ball.center),
                      region.ball.radius * 1.0001f);
        }
      }
    }
  }
}

}  // namespace
}  // namespace varifold::test
