// Exact slack: no answer may change before its odometer says so.
#include <gtest/gtest.h>
#include <varifold/base/random.h>
#include <varifold/models/vdpm/odometers.h>
#include <varifold/models/vdpm/view_query.h>

#include <cmath>

namespace varifold {
namespace {

float within(Random& random, float low, float high) {
  return low + (high - low) * static_cast<float>(random.uniform());
}

Vec3 random_direction(Random& random) {
  for (;;) {
    const Vec3 p(within(random, -1, 1), within(random, -1, 1), within(random, -1, 1));
    const float length = glm::length(p);
    if (length > 0.1f && length <= 1) return p / length;
  }
}

ViewRegion random_region(Random& random, const Sphere& mesh) {
  ViewRegion region;
  region.radius = mesh.radius * 0.5f * std::pow(within(random, 0.01f, 1), 3.0f);
  region.center =
      mesh.center + random_direction(random) * within(random, 0, 1) * (mesh.radius - region.radius);
  region.cone.axis = random_direction(random);
  const float angle = within(random, 0, 2);
  region.cone.cosine = std::cos(angle);
  region.cone.sine = std::sin(angle);
  region.mu = mesh.radius * std::pow(10.0f, within(random, -5, -1));
  region.delta = within(random, 0, 1) < 0.5f
                     ? 0
                     : region.mu * (random.below(2) == 0 ? within(random, 0.9f, 1.5f)
                                                         : within(random, 0.5f, 20));
  return region;
}

struct Walk {
  Vec3 eye, target, up;
  float tolerance, near_distance;
};

ViewQuery query_of(const Walk& walk, Odometers& odometers) {
  Camera camera;
  camera.eye = walk.eye;
  camera.target = walk.target;
  camera.up = walk.up;
  camera.near_distance = walk.near_distance;
  camera.far_distance = 50;
  const ViewCriterion view(camera);
  return {view, walk.tolerance, odometers.reach(camera.eye, camera.near_distance)};
}

// A step of some kind: far jumps are rare, trembling is frequent.
void move(Walk& walk, int kind, Random& random) {
  const float size = std::pow(10.0f, within(random, -4, 0));
  const auto turn = [&](float angle) {
    const float c = std::cos(angle), s = std::sin(angle);
    walk.eye = Vec3(c * walk.eye.x - s * walk.eye.y, s * walk.eye.x + c * walk.eye.y, walk.eye.z);
  };
  switch (kind) {
    case 0:
      walk.eye += random_direction(random) * size;
      break;
    case 1:
      turn(0.05f * size);
      break;
    case 2:
      walk.eye *= 1 + within(random, -0.3f, 0.3f) * size;
      break;
    case 3:
      walk.target += random_direction(random) * 0.2f * size;
      break;
    case 4:
      walk.tolerance *= std::pow(4.0f, size * within(random, -1, 1));
      break;
    case 5:
      walk.near_distance *= std::pow(1.5f, size * within(random, -1, 1));
      walk.eye += random_direction(random) * 0.1f * size;
      break;
    default:
      walk.eye -= walk.eye * 0.01f * size;
  }
}

TEST(ViewQuery, NoAnswerChangesBeforeItsKeyIsDue) {
  Random random(4);
  const Sphere mesh{Vec3(0.3f, -0.2f, 0.1f), 1};
  std::uint64_t held = 0, changes = 0, due = 0;
  for (int trial = 0; trial < 60; ++trial) {
    Odometers odometers(mesh);
    Walk walk{random_direction(random) * within(random, 0.2f, 6), Vec3(0), Vec3(0, 0, 1),
              std::pow(10.0f, within(random, -1, 1)), trial % 2 == 0 ? 0.02f : 0.5f};
    ViewQuery before = query_of(walk, odometers);
    odometers.rebase();
    struct Kept {
      ViewRegion region;
      float keep, key;
      bool asked;
    };
    std::vector<Kept> kept(200);
    const auto ask = [&](Kept& k) {
      const ViewAnswer answer = before.test(k.region, k.keep);
      k.asked = answer.asked;
      k.key = odometers.key(answer.mover, answer.slack);
    };
    for (Kept& k : kept) {
      k.region = random_region(random, mesh);
      k.keep = within(random, 0, 1) < 0.5f ? 0.0f : 0.1f;
      ask(k);
    }
    for (int frame = 0; frame < 200; ++frame) {
      move(walk, (trial + frame / 40) % 7, random);
      if (glm::length(walk.eye - walk.target) < 0.05f) walk.eye += Vec3(0.2f, 0, 0);
      const ViewQuery now = query_of(walk, odometers);
      odometers.advance(before, now);
      before = now;
      const bool anew = odometers.is_worn();
      if (anew) odometers.rebase();
      for (Kept& k : kept) {
        const bool asked = now.test(k.region, k.keep).asked;
        changes += asked != k.asked ? 1 : 0;
        if (anew || odometers.is_due(k.key)) {
          ++due;
          ask(k);
        } else {
          ++held;
          ASSERT_EQ(asked, k.asked) << "trial " << trial << " frame " << frame;
        }
      }
    }
  }
  EXPECT_GT(changes, 1000u);
  EXPECT_GT(held, 4 * due);  // and the slack is good for something
}

// The torus against its definition.
TEST(ViewQuery, AsksWhereTheDeviationIsSeenLargerThanTheTolerance) {
  Random random(5);
  Odometers odometers(Sphere{Vec3(0), 1});
  std::uint32_t asked_count = 0;
  for (int trial = 0; trial < 20000; ++trial) {
    const Walk walk{random_direction(random) * within(random, 0.5f, 5), Vec3(0), Vec3(0, 0, 1), 1,
                    0.02f};
    const ViewQuery query = query_of(walk, odometers);
    ViewRegion region = random_region(random, Sphere{Vec3(0), 1});
    region.radius = 0;
    region.cone.cosine = -1;
    const Vec3 p = walk.eye - region.center;
    const double distance = glm::length(DVec3(p));
    const double along = glm::dot(DVec3(p), DVec3(region.cone.axis)) / distance;
    const double seen = std::max(static_cast<double>(region.mu),
                                 region.delta * std::sqrt(std::max(0.0, 1 - along * along)));
    const double pixels = seen * query.unit_distance() / distance;
    if (std::abs(pixels - 1) < 1e-4) continue;
    const bool in_view = contains(query.frustum(), region.center);
    EXPECT_EQ(query.test(region).asked, pixels > 1 && in_view);
    asked_count += pixels > 1 && in_view ? 1 : 0;
  }
  EXPECT_GT(asked_count, 500u);
}

}  // namespace
}  // namespace varifold
