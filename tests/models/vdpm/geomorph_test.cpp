// Geomorphs of fronts against a simulation that moves every vertex of the model by the rule.
#include <gtest/gtest.h>
#include <tests/models/vdpm/geomorph_simulation.h>
#include <tests/models/vdpm/vdpm_support.h>
#include <tests/support/rigged_meshes.h>

#include <varifold/mesh/pose_blend.h>
#include <varifold/mesh/weld.h>
#include <algorithm>
#include <cmath>
#include <cstring>
#include <glm/gtc/matrix_transform.hpp>
#include <tuple>
#include <utility>

namespace varifold::test {
namespace {

FrontLimits with_morphs(std::uint32_t frames) {
  FrontLimits limits;
  limits.morph_frames = frames;
  return limits;
}

RefineCriteria seen_from(const Sphere& ball, const Vec3& eye) {
  const float radius = std::max(ball.radius, 0.1f);
  Camera camera;
  camera.eye = ball.center + radius * eye;
  camera.target = ball.center;
  camera.near_distance = 0.01f * radius;
  camera.far_distance = 100 * radius;
  RefineCriteria criteria;
  criteria.view.emplace(camera);
  return criteria;
}

/// Jumps, rests and turns back, so that morphs begin, end, and are stopped on their way.
class RestlessCamera {
 public:
  RestlessCamera(const ViewDependentMesh& model, std::uint64_t seed)
      : ball_(model.bounding_ball()), random_(seed) {}
  RefineCriteria next() {
    const double what = random_.uniform();
    if (what < 0.3) std::swap(eye_, before_);
    if (what > 0.6) {
      before_ = eye_;
      const auto place = [&] { return static_cast<float>(2 * random_.uniform() - 1); };
      eye_ = Vec3(place(), place(), place()) * (what > 0.8 ? 2.5f : 12.0f);
      if (std::abs(eye_.x) < 0.1f) eye_.x = 0.4f;
    }
    return seen_from(ball_, eye_);
  }

 private:
  Sphere ball_;
  Random random_;
  Vec3 eye_{1, 2, 3}, before_{-2, 1, 1};
};

/// The greatest difference of what is drawn from the simulation; the wrong vertices count.
std::pair<float, std::uint32_t> difference(const ViewDependentInstance& instance,
                                           const Simulation& simulation) {
  const ActiveVertices& vertices = instance.surface().vertices();
  float most = 0;
  std::uint32_t wrong = 0;
  for (std::uint32_t v = 0; v < instance.model().attributes().vertex_count(); ++v) {
    if (vertices.is_active(v) != simulation.is_drawn(v)) {
      ++wrong;
    } else if (vertices.is_active(v)) {
      const Vec3 drawn = vertices.buffer().positions[vertices.slot(v)];
      most = std::max(most, glm::length(drawn - simulation.at(v)));
    }
  }
  return {most, wrong};
}

TEST(FrontGeomorphs, MoveAsTheRuleSays) {
  int turns = 0;
  for (const NamedVdpm& named : all_vdpms()) {
    const ViewDependentMesh& model = *named.model;
    if (model.step_count() == 0) continue;
    for (const std::uint32_t frames : {2u, 5u, 12u}) {
      ViewDependentInstance moving(named.model), still(named.model);
      Simulation simulation(still, frames);
      RestlessCamera camera(model, 7 + frames);
      for (int frame = 0; frame < 30; ++frame) {
        const RefineCriteria criteria = camera.next();
        moving.adapt(criteria, {1, kNone}, with_morphs(frames));
        still.adapt(criteria, {1, kNone});
        simulation.next(criteria);
        const auto [most, wrong] = difference(moving, simulation);
        ASSERT_EQ(wrong, 0u) << named.name << ", frame " << frame << " of " << frames;
        ASSERT_LE(most, 1e-5f * model.bounding_ball().radius)
            << named.name << ", frame " << frame << " of " << frames;
      }
      turns += simulation.turns();
    }
  }
  EXPECT_GT(turns, 1000);
}

// A pose that is an affine image of the mesh at rest is one of what is drawn, on any way.
TEST(FrontGeomorphs, MovePosesAlong) {
  TriangleMesh mesh = icosphere(2000);
  mesh.normals.clear();
  const glm::mat3 linear(1.2f, 0.1f, 0.3f, -0.2f, 0.9f, 0, 0.1f, 0.4f, 1);
  const auto image = [&](const Vec3& p) { return linear * p + Vec3(3, 1, 2); };
  Pose pose;
  for (const Vec3& p : mesh.positions) pose.positions.push_back(image(p));
  mesh.poses.push_back(pose);
  const auto model = std::make_shared<const ViewDependentMesh>(
      build_view_dependent_mesh(simplify(mesh)->detailed));
  ViewDependentInstance moving(model);
  RestlessCamera camera(*model, 11);
  std::uint32_t moves = 0;
  for (int frame = 0; frame < 40; ++frame) {
    moving.adapt(camera.next(), {1, kNone}, with_morphs(6));
    moves += moving.moving_vertices();
    const DrawList list = moving.draw_list();
    for (const std::uint32_t v : list.indices)
      ASSERT_LE(glm::length(list.poses[0].positions[v] - image(list.positions[v])), 1e-5f);
  }
  EXPECT_GT(moves, 100u);
}

// Joints go along, too: the last step of a way is no jump to other weights.
TEST(FrontGeomorphs, MoveJointsAlong) {
  TriangleMesh mesh = with_random_rig(icosphere(2000), 3, {.poses = 0});
  for (std::uint32_t v = 0; v < mesh.vertex_count(); ++v)
    mesh.skin[v] = {{0, 1, 0, 0}, {0.1f + 0.01f * (v % 80), 0.9f - 0.01f * (v % 80), 0, 0}};
  const auto model = std::make_shared<const ViewDependentMesh>(
      build_view_dependent_mesh(simplify(mesh)->detailed));
  const std::vector<glm::mat4> joints{glm::mat4(1),
                                      glm::rotate(glm::mat4(1), 1.5f, Vec3(0.6f, 0.8f, 0))};
  const auto places = [&](const DrawList& list) {
    PosedVertices vertices;
    vertices.positions.assign(list.positions.begin(), list.positions.end());
    skin_vertices(list.skin, joints, vertices);
    return vertices.positions;
  };
  constexpr std::uint32_t kFrames = 8;
  ViewDependentInstance moving(model);
  for (const float distance : {60.0f, 2.0f}) {
    const RefineCriteria criteria = seen_from(model->bounding_ball(), Vec3(0, 0, distance));
    std::vector<std::vector<Vec3>> ways;
    std::vector<std::uint32_t> drawn;  // those of the finer front, all the time from the first
    for (std::uint32_t frame = 0; frame < kFrames; ++frame) {
      moving.adapt(criteria, {1, kNone}, with_morphs(kFrames));
      const DrawList list = moving.draw_list();
      ways.push_back(places(list));
      if (frame == 0) drawn.assign(list.indices.begin(), list.indices.end());
    }
    if (distance > 10) continue;
    EXPECT_EQ(moving.moving_vertices(), 0u);
    float longest = 0;
    for (const std::uint32_t v : drawn) {
      float whole = 0;
      for (std::size_t i = 1; i < kFrames; ++i) whole += glm::distance(ways[i][v], ways[i - 1][v]);
      longest = std::max(longest, whole);
      const float last = glm::distance(ways[kFrames - 1][v], ways[kFrames - 2][v]);
      ASSERT_LE(last, 0.35f * whole + 1e-5f) << v;
    }
    EXPECT_GT(longest, 0.01f);
  }
}

// From where a vertex, or what stood for it, was drawn in the frame before.
TEST(FrontGeomorphs, NoVertexMovesFurtherThanItsPart) {
  for (const NamedVdpm& named : all_vdpms()) {
    const ViewDependentMesh& model = *named.model;
    if (model.step_count() == 0) continue;
    const std::uint32_t frames = 8, count = model.vertex_count(model.finest_level());
    ViewDependentInstance moving(named.model), still(named.model);
    Simulation simulation(still, frames);
    RestlessCamera camera(model, 5);
    std::vector<Vec3> before(count), now(count);
    for (int frame = 0; frame < 40; ++frame) {
      const RefineCriteria criteria = camera.next();
      moving.adapt(criteria, {1, kNone}, with_morphs(frames));
      still.adapt(criteria, {1, kNone});
      simulation.next(criteria);
      const ActiveVertices& vertices = moving.surface().vertices();
      const float rounding = 1e-5f * model.bounding_ball().radius;
      for (std::uint32_t v = 0; v < count; ++v) {
        const bool is_drawn = vertices.is_active(v);
        now[v] = is_drawn ? vertices.buffer().positions[vertices.slot(v)]
                          : now[model.levels().target(v)];
        if (frame == 0 || !is_drawn) continue;
        ASSERT_LE(glm::length(now[v] - before[v]), simulation.reach(v) + rounding)
            << named.name << ", frame " << frame;
      }
      before = now;
    }
  }
}

bool same_bytes(const TriangleMesh& a, const TriangleMesh& b) {
  const auto same = [](const auto& x, const auto& y) {
    return x.size() == y.size() &&
           (x.empty() || std::memcmp(x.data(), y.data(), x.size() * sizeof(x[0])) == 0);
  };
  return same(a.positions, b.positions) && same(a.normals, b.normals) &&
         same(a.texcoords, b.texcoords) && same(a.colors, b.colors) && a.indices == b.indices &&
         a.ranges == b.ranges;
}

// The surface without morphs has no collapsed and no folded state (surface_test.cpp), so nor has
// this one at rest.
TEST(FrontGeomorphs, AtRestNothingIsDifferent) {
  for (const NamedVdpm& named : all_vdpms()) {
    const ViewDependentMesh& model = *named.model;
    if (model.step_count() == 0) continue;
    ViewDependentInstance moving(named.model), still(named.model);
    RestlessCamera camera(model, 3);
    for (const std::uint32_t frames : {1u, 3u, 9u, 255u}) {
      RefineCriteria criteria;
      for (int frame = 0; frame < 12; ++frame) {
        criteria = camera.next();
        moving.adapt(criteria, {1, kNone}, with_morphs(frames));
      }
      for (std::uint32_t frame = 1; frame < frames; ++frame)
        moving.adapt(criteria, {1, kNone}, with_morphs(frames));
      ASSERT_EQ(moving.moving_vertices(), 0u) << named.name;
      still.adapt(criteria, {1, kNone});
      ASSERT_TRUE(same_bytes(moving.extract(), still.extract())) << named.name << ", " << frames;
    }
  }
}

// Wedges of one point stay together, so that no seam opens.
TEST(FrontGeomorphs, SeamsStayClosed) {
  for (const NamedVdpm& named : all_vdpms()) {
    const ViewDependentMesh& model = *named.model;
    if (model.step_count() == 0) continue;
    const std::vector<std::uint32_t> step_of = steps_of_vertices(model);
    const WeldMap points = weld_exact(model.attributes().positions);
    ViewDependentInstance instance(named.model);
    RestlessCamera camera(model, 9);
    for (int frame = 0; frame < 30; ++frame) {
      instance.adapt(camera.next(), {1, kNone}, with_morphs(6));
      const ActiveVertices& vertices = instance.surface().vertices();
      for (std::uint32_t v = 1; v < step_of.size(); ++v) {
        if (step_of[v] == kNone || step_of[v - 1] != step_of[v] || !vertices.is_active(v)) continue;
        if (points.class_of[v] != points.class_of[v - 1]) continue;
        ASSERT_EQ(vertices.buffer().positions[vertices.slot(v)],
                  vertices.buffer().positions[vertices.slot(v - 1)])
            << named.name << ", frame " << frame;
      }
    }
  }
}

TEST(FrontGeomorphs, WhatTurnsRoundTakesAsLongBack) {
  const NamedVdpm named = make_vdpm({"sphere", icosphere(5000)}, Placement::kKept);
  const Sphere ball = named.model->bounding_ball();
  // All of it is seen: nothing comes at once.
  RefineCriteria far = seen_from(ball, Vec3(0, 30, 60)), near = seen_from(ball, Vec3(0, 1, 2));
  far.view->back_weight = near.view->back_weight = 1;
  const AdaptOptions options{1, kNone};
  ViewDependentInstance instance(named.model);
  for (int frame = 0; frame < 10; ++frame) instance.adapt(far, options, with_morphs(10));
  const std::uint32_t base = instance.triangle_count();
  for (int frame = 0; frame < 4; ++frame) instance.adapt(near, options, with_morphs(10));
  const std::uint32_t moving = instance.moving_vertices();
  EXPECT_GT(moving, 200u);
  for (int frame = 0; frame < 4; ++frame) {
    EXPECT_EQ(instance.moving_vertices(), moving);
    instance.adapt(far, options, with_morphs(10));
  }
  EXPECT_EQ(instance.moving_vertices(), 0u);
  EXPECT_EQ(instance.triangle_count(), base);
  // All layers slide at once: n frames from any front to any other.
  for (int frame = 0; frame < 10; ++frame) instance.adapt(near, options, with_morphs(10));
  EXPECT_EQ(instance.moving_vertices(), 0u);
  for (int frame = 0; frame < 10; ++frame) instance.adapt(far, options, with_morphs(10));
  EXPECT_EQ(instance.moving_vertices(), 0u);
  EXPECT_EQ(instance.triangle_count(), base);
}

// What comes into the picture is where it belongs in the first frame that sees it.
TEST(FrontGeomorphs, WhatNobodySawDoesNotSlide) {
  const NamedVdpm named = make_vdpm({"sphere", icosphere(5000)}, Placement::kKept);
  const Sphere ball = named.model->bounding_ball();
  const AdaptOptions options{1, kNone};
  ViewDependentInstance instance(named.model), still(named.model);
  instance.adapt(seen_from(ball, Vec3(4000, 0, 1)), options, with_morphs(10));  // too far away
  const RefineCriteria near = seen_from(ball, Vec3(0, 1, 2));
  const FrontStatistics statistics = instance.adapt(near, options, with_morphs(10));
  still.adapt(near, options);
  EXPECT_GT(statistics.splits, 200u);
  EXPECT_EQ(instance.moving_vertices(), 0u);
  EXPECT_TRUE(same_bytes(instance.extract(), still.extract()));
}

TEST(FrontGeomorphs, LastAsManyFramesAsAreAskedForNow) {
  for (const NamedVdpm& named : all_vdpms()) {
    const ViewDependentMesh& model = *named.model;
    if (model.step_count() == 0) continue;
    ViewDependentInstance moving(named.model), still(named.model);
    RestlessCamera camera(model, 21);
    Random random(4);
    RefineCriteria criteria;
    for (int frame = 0; frame < 40; ++frame) {
      criteria = camera.next();
      moving.adapt(criteria, {1, kNone}, with_morphs(random.below(20)));
    }
    // Without morphs: now.
    moving.adapt(criteria, {1, kNone});
    still.adapt(criteria, {1, kNone});
    ASSERT_EQ(moving.moving_vertices(), 0u) << named.name;
    ASSERT_TRUE(same_bytes(moving.extract(), still.extract())) << named.name;
    // A level comes at once, too.
    moving.adapt(camera.next(), {1, kNone}, with_morphs(20));
    moving.adapt(camera.next(), {1, kNone}, with_morphs(20));
    moving.go_to_level(model.finest_level() / 2);
    still.go_to_level(model.finest_level() / 2);
    ASSERT_TRUE(same_bytes(moving.extract(), still.extract())) << named.name;
  }
}

TEST(FrontGeomorphs, WhatIsDrawnStaysInTheBudget) {
  for (const NamedVdpm& named : all_vdpms()) {
    const ViewDependentMesh& model = *named.model;
    if (model.step_count() == 0) continue;
    const std::uint32_t base = model.triangle_count(0);
    const std::uint32_t full = model.triangle_count(model.finest_level());
    const AdaptOptions options{0.05f, base + (full - base) / 4};
    ViewDependentInstance moving(named.model), still(named.model);
    RestlessCamera camera(model, 2);
    RefineCriteria criteria;
    for (int frame = 0; frame < 12; ++frame) {
      criteria = camera.next();
      const FrontStatistics statistics = moving.adapt(criteria, options, with_morphs(7));
      ASSERT_LE(statistics.triangles, options.max_triangles) << named.name;
      ASSERT_EQ(statistics.triangles, moving.triangle_count()) << named.name;
    }
    for (int frame = 1; frame < 7; ++frame) moving.adapt(criteria, options, with_morphs(7));
    still.adapt(criteria, options);
    ASSERT_TRUE(same_bytes(moving.extract(), still.extract())) << named.name;
  }
}

// Whoever uploads only what the lists name has the buffers of the instance.
TEST(FrontGeomorphs, ListsNameWhatMoves) {
  const NamedVdpm named = make_vdpm({"sphere", icosphere(5000)}, Placement::kOptimal);
  ViewDependentInstance instance(named.model);
  RestlessCamera camera(*named.model, 8);
  std::vector<Vec3> uploaded;
  for (int frame = 0; frame < 60; ++frame) {
    instance.adapt(camera.next(), {1, kNone}, with_morphs(9));
    const DrawList list = instance.draw_list();
    const std::size_t known = std::min(uploaded.size(), list.positions.size());
    uploaded.resize(list.positions.size());
    std::copy(list.positions.begin() + static_cast<std::ptrdiff_t>(known), list.positions.end(),
              uploaded.begin() + static_cast<std::ptrdiff_t>(known));
    for (const ElementRange& range : list.changed_vertices)
      std::copy_n(list.positions.begin() + range.first, range.count,
                  uploaded.begin() + range.first);
    ASSERT_TRUE(std::equal(uploaded.begin(), uploaded.end(), list.positions.begin()));
  }
}

TEST(FrontGeomorphs, OnlyWhatMovesTakesMemory) {
  const NamedVdpm named = make_vdpm({"sphere", icosphere(20000)}, Placement::kKept);
  FrontGeomorphs morphs(*named.model);
  EXPECT_EQ(morphs.bytes(), 0u);
  ActiveSurface surface(*named.model);
  std::uint32_t changes = 0;
  for (std::uint32_t step = 0; step < 3000; step += 500) {
    morphs.begin_frame(surface, nullptr, false);
    for (std::uint32_t k = step; k < step + 500; ++k, ++changes) morphs.split(k);
    morphs.advance(surface, 200, kNone);
  }
  EXPECT_EQ(morphs.moving_vertices(), changes);
  EXPECT_LE(morphs.bytes(), 1.25 * 20 * changes + 2.0 * 28 * 500 + 4096);
}

}  // namespace
}  // namespace varifold::test
