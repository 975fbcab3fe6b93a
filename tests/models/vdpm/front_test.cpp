// Fronts kept up from frame to frame against fronts by their definition.
#include <gtest/gtest.h>
#include <tests/models/vdpm/vdpm_support.h>
#include <varifold/models/vdpm/key_scan.h>
#include <varifold/models/vdpm/region_batch.h>
#include <varifold/models/vdpm/step_regions.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numeric>

namespace varifold::test {
namespace {

float within(Random& random, float low, float high) {
  return low + (high - low) * static_cast<float>(random.uniform());
}

// All steps that are asked, and all that they require: no watch tree, no keys, no counts.
std::vector<bool> front_by_definition(const ViewDependentMesh& model,
                                      const RefineCriteria& criteria, float tolerance) {
  Odometers odometers(model.bounding_ball());
  FrontQuestion question;
  question.set(criteria, tolerance, model.bounding_ball().radius, odometers);
  std::vector<bool> split(model.step_count());
  for (std::uint32_t step = model.step_count(); step-- > 0;) {
    if (!split[step]) split[step] = question.own(model.bounds(step), model.center(step), 0).asked;
    if (split[step])
      model.for_each_required(step, [&](std::uint32_t required) { split[required] = true; });
  }
  return split;
}

void expect_front(const ViewDependentInstance& instance, const std::vector<bool>& split,
                  const std::string& where) {
  std::uint32_t different = 0;
  for (std::uint32_t step = 0; step < split.size(); ++step)
    different += split[step] != instance.is_split(step) ? 1 : 0;
  EXPECT_EQ(different, 0u) << where;
}

// A camera that flies about a mesh in some way.
class Flight {
 public:
  Flight(const ViewDependentMesh& model, int kind, std::uint64_t seed)
      : ball_(model.bounding_ball()), kind_(kind), random_(seed) {
    ball_.radius = std::max(ball_.radius, 0.1f);
    eye_ = Vec3(0.8f, 0.5f, 0.9f) * 2.0f;
  }
  static constexpr int kKinds = 7;

  RefineCriteria next() {
    const float size = std::pow(10.0f, within(random_, -4, -0.5f));
    switch (kind_) {
      case 0:
        turn(0.02f);
        break;
      case 1:
        eye_ *= 1 + 0.1f * std::sin(0.3f * static_cast<float>(frame_));
        break;
      case 2:
        eye_ += Vec3(size_(), size_(), size_()) * size;
        break;
      case 3:
        eye_ = Vec3(size_(), size_(), size_()) * 3.0f;
        break;
      case 4:
        tolerance *= std::pow(2.0f, within(random_, -0.3f, 0.3f));
        break;
      case 5:
        target_ = Vec3(size_(), size_(), size_()) * 0.5f;
        break;
      default:
        turn(frame_ % 10 == 0 ? 0.3f : 0.001f);
    }
    tolerance = std::clamp(tolerance, 0.05f, 50.0f);
    if (glm::length(eye_) < 0.05f) eye_ = Vec3(0, 0, 1);
    if (glm::length(eye_) > 30) eye_ *= 0.1f;
    if (glm::length(glm::cross(eye_ - target_, Vec3(0, 1, 0))) < 0.05f) eye_.x += 0.2f;
    ++frame_;
    camera_.eye = ball_.center + ball_.radius * eye_;
    camera_.target = ball_.center + ball_.radius * target_;
    camera_.near_distance = 0.01f * ball_.radius;
    camera_.far_distance = 20 * ball_.radius;
    RefineCriteria criteria;
    criteria.view.emplace(camera_);
    return criteria;
  }
  /// That of the last frame.
  [[nodiscard]] const Camera& camera() const { return camera_; }
  float tolerance = 4;

 private:
  float size_() { return within(random_, -1, 1); }
  void turn(float angle) {
    const float c = std::cos(angle), s = std::sin(angle);
    eye_ = Vec3(c * eye_.x + s * eye_.z, eye_.y, c * eye_.z - s * eye_.x);
  }
  Sphere ball_;
  int kind_, frame_ = 0;
  Random random_;
  Vec3 eye_, target_{0};
  Camera camera_;
};

TEST(ViewFront, EachFrameIsTheFrontByDefinition) {
  for (const NamedVdpm& named : all_vdpms()) {
    const ViewDependentMesh& model = *named.model;
    if (model.step_count() == 0) continue;
    for (int kind = 0; kind < Flight::kKinds; ++kind) {
      ViewDependentInstance instance(named.model);
      Flight flight(model, kind, 17);
      for (int frame = 0; frame < 12; ++frame) {
        const RefineCriteria criteria = flight.next();
        instance.adapt(criteria, {flight.tolerance, kNone});
        expect_front(instance, front_by_definition(model, criteria, flight.tolerance),
                     named.name + ", flight " + std::to_string(kind));
      }
    }
  }
}

// The paper's traversal of the whole front, and one that looks at a part of it each frame.
TEST(ViewFront, SchedulesLeadToTheSameFront) {
  const NamedVdpm named = make_vdpm({"sphere", icosphere(5000)}, Placement::kKept);
  for (int kind = 0; kind < Flight::kKinds; ++kind) {
    ViewDependentInstance by_keys(named.model), by_all(named.model), by_parts(named.model);
    Flight flight(*named.model, kind, 5);
    std::uint32_t tests[2] = {0, 0};
    for (int frame = 0; frame < 60; ++frame) {
      const RefineCriteria criteria = flight.next();
      const AdaptOptions options{flight.tolerance, kNone};
      const FrontStatistics due = by_keys.adapt(criteria, options);
      FrontLimits all, part;
      all.schedule = FrontSchedule::kAll;
      part.schedule = FrontSchedule::kAmortized;
      part.amortized_part = 0.3f;
      const FrontStatistics every = by_all.adapt(criteria, options, all);
      EXPECT_EQ(due.triangles, every.triangles);
      for (std::uint32_t step = 0; step < named.model->step_count(); ++step)
        ASSERT_EQ(by_keys.is_split(step), by_all.is_split(step));
      tests[0] += due.tests;
      tests[1] += every.tests;
      by_parts.adapt(criteria, options, part);
    }
    EXPECT_LT(tests[0], tests[1]);
    // When the camera rests, the parts catch up.
    const RefineCriteria criteria = flight.next();
    FrontLimits part;
    part.schedule = FrontSchedule::kAmortized;
    for (int frame = 0; frame < 400; ++frame)
      by_parts.adapt(criteria, {flight.tolerance, kNone}, part);
    expect_front(by_parts, front_by_definition(*named.model, criteria, flight.tolerance), "parts");
  }
}

TEST(ViewFront, PlacesOfTheUserAreRefined) {
  class Below : public RegionPredicate {
   public:
    [[nodiscard]] bool asks(const Sphere& ball, float error) const override {
      return ball.center.y - ball.radius < height && error > 0.001f;
    }
    float height = 0;
  };
  for (const NamedVdpm& named : all_vdpms()) {
    const ViewDependentMesh& model = *named.model;
    if (model.step_count() == 0) continue;
    ViewDependentInstance instance(named.model);
    Flight flight(model, 0, 3);
    Below below;
    const Sphere ball = model.bounding_ball();
    std::vector<BoxCriterion> boxes(1);
    for (int frame = 0; frame < 12; ++frame) {
      RefineCriteria criteria = flight.next();
      if (frame % 4 == 3) criteria.view.reset();
      if (frame % 3 == 0) criteria.sphere = Sphere{ball.center, 0.3f * ball.radius};
      if (frame % 5 == 1)
        criteria.plane = Plane{Vec3(1, 0, 0), -ball.center.x - 0.5f * ball.radius};
      if (frame % 2 == 1) {
        boxes[0].box = Box{ball.center, ball.center + Vec3(ball.radius)};
        boxes[0].error = 0.01f * static_cast<float>(frame) * ball.radius;
        criteria.boxes = boxes;
      }
      if (frame > 6) {
        below.height = ball.center.y + 0.1f * static_cast<float>(frame - 9) * ball.radius;
        criteria.predicate = &below;
        criteria.predicate_version = static_cast<std::uint32_t>(frame);
      }
      if (frame == 10) criteria.view->light = LightCriterion{};
      instance.adapt(criteria, {flight.tolerance, kNone});
      expect_front(instance, front_by_definition(model, criteria, flight.tolerance),
                   named.name + ", frame " + std::to_string(frame));
    }
  }
}

TEST(ViewFront, NeverShowsMoreThanTheBudget) {
  for (const NamedVdpm& named : all_vdpms()) {
    const ViewDependentMesh& model = *named.model;
    if (model.step_count() == 0) continue;
    const std::uint32_t base = model.triangle_count(0);
    const std::uint32_t full = model.triangle_count(model.finest_level());
    const AdaptOptions options{0.05f, base + (full - base) / 5};
    ViewDependentInstance instance(named.model);
    RefineCriteria everything;  // what the first frame has to get rid of
    everything.plane = Plane{Vec3(0, 0, 1), 1e6f};
    instance.adapt(everything);
    EXPECT_EQ(instance.triangle_count(), full) << named.name;
    Flight flight(model, 2, 23);
    for (int frame = 0; frame < 10; ++frame) {
      RefineCriteria criteria = flight.next();
      const Sphere ball = model.bounding_ball();
      if (frame % 4 == 1) criteria.sphere = Sphere{ball.center, 0.5f * ball.radius};
      if (frame % 4 == 2) criteria.view->silhouette_weight = 4;
      if (frame % 4 == 3) criteria.view.reset();
      if (frame % 8 == 3) criteria.plane = Plane{Vec3(1, 0, 0), -ball.center.x};
      const FrontStatistics statistics = instance.adapt(criteria, options);
      EXPECT_LE(statistics.triangles, std::max(options.max_triangles, base)) << named.name;
      EXPECT_EQ(statistics.triangles, instance.triangle_count());
      EXPECT_EQ(statistics.waiting, 0u) << named.name;
      // The tolerance explains the front, which is that of an instance without a past.
      expect_front(instance, front_by_definition(model, criteria, statistics.tolerance),
                   named.name);
      ViewDependentInstance fresh(named.model);
      EXPECT_EQ(fresh.adapt(criteria, options).tolerance, statistics.tolerance) << named.name;
    }
  }
}

TEST(ViewFront, ChangesOnlySoManyAFrame) {
  const NamedVdpm named = make_vdpm({"sphere", icosphere(5000)}, Placement::kKept);
  ViewDependentInstance instance(named.model);
  Flight flight(*named.model, 3, 2);
  FrontLimits limits;
  limits.max_changes = 50;
  for (int view = 0; view < 4; ++view) {
    const RefineCriteria criteria = flight.next();
    FrontStatistics statistics;
    int frames = 0;
    do {
      statistics = instance.adapt(criteria, {1, kNone}, limits);
      // A split brings those that it requires along, whatever the limit.
      EXPECT_LE(statistics.splits + statistics.collapses, 50u + 200u);
    } while (statistics.waiting > 0 && ++frames < 1000);
    EXPECT_LT(frames, 1000);
    expect_front(instance, front_by_definition(*named.model, criteria, 1), "at rest");
  }
}

TEST(ViewFront, ATremblingCameraChangesNothing) {
  const NamedVdpm named = make_vdpm({"sphere", icosphere(20000)}, Placement::kKept);
  const Sphere ball = named.model->bounding_ball();
  std::uint32_t changes[2] = {0, 0}, collapses = 0;
  for (int with = 0; with < 2; ++with) {
    ViewDependentInstance instance(named.model);
    FrontLimits limits;
    limits.hysteresis = with == 0 ? 0.0f : 0.2f;
    Random random(4);
    for (int frame = 0; frame < 200; ++frame) {
      Camera camera;
      const Vec3 tremble(within(random, -1, 1), within(random, -1, 1), within(random, -1, 1));
      camera.eye = ball.center + ball.radius * (Vec3(1.8f, 1.1f, 2) + 0.03f * tremble);
      camera.target = ball.center;
      camera.near_distance = 0.01f * ball.radius;
      RefineCriteria criteria;
      criteria.view.emplace(camera);
      const FrontStatistics statistics = instance.adapt(criteria, {0.5f, kNone}, limits);
      if (frame < 100) continue;
      changes[with] += statistics.splits + statistics.collapses;
      if (with == 1) collapses += statistics.collapses;
    }
  }
  // What is left are splits of places that the camera had not come so near to before.
  EXPECT_GT(changes[0], 50u);
  EXPECT_LT(changes[1], changes[0] / 20);
  EXPECT_EQ(collapses, 0u);
}

TEST(ViewFront, LevelsAndFrontsFollowEachOther) {
  for (const NamedVdpm& named : all_vdpms()) {
    const ViewDependentMesh& model = *named.model;
    if (model.step_count() == 0) continue;
    ViewDependentInstance instance(named.model);
    Flight flight(model, 3, 11);
    Random random(3);
    for (int frame = 0; frame < 6; ++frame) {
      instance.go_to_level(random.below(model.finest_level() + 1));
      const RefineCriteria criteria = flight.next();
      instance.adapt(criteria, {1, kNone});
      expect_front(instance, front_by_definition(model, criteria, 1), named.name);
      std::vector<bool> split(model.step_count());
      for (std::uint32_t step = 0; step < model.step_count(); ++step)
        split[step] = instance.is_split(step);
      EXPECT_EQ(triangle_set(instance.extract()),
                triangle_set(mesh_of_steps(named.detailed, split)))
          << named.name;
    }
    instance.go_to_level(0);
    EXPECT_EQ(instance.triangle_count(), model.triangle_count(0));
  }
}

TEST(ViewFront, UnusableCamerasAskForNothing) {
  const NamedVdpm named = make_vdpm({"sphere", icosphere(5000)}, Placement::kKept);
  ViewDependentInstance instance(named.model);
  Flight flight(*named.model, 0, 5);
  for (int frame = 0; frame < 12; ++frame) {
    const RefineCriteria good = flight.next();
    instance.adapt(good, {1, kNone});
    expect_front(instance, front_by_definition(*named.model, good, 1), "usable");
    EXPECT_GT(instance.triangle_count(), named.model->triangle_count(0));
    // Like the good one but for one thing.
    Camera camera = flight.camera();
    if (frame % 4 == 0) camera.eye.x = std::nanf("");
    if (frame % 4 == 1) camera.target = camera.eye;
    if (frame % 4 == 2) camera.fovy_degrees = std::nanf("");
    if (frame % 4 == 3) camera.eye.y = std::numeric_limits<float>::infinity();
    RefineCriteria bad;
    bad.view.emplace(camera);
    instance.adapt(bad, {1, frame % 2 == 0 ? kNone : 1000u});
    EXPECT_EQ(instance.triangle_count(), named.model->triangle_count(0)) << frame;
    if (frame % 3 == 0) instance.adapt(good, {std::nanf(""), kNone});
  }
}

TEST(KeyScan, VectorsFindWhatThePlainFormFinds) {
  Odometers odometers(Sphere{Vec3(0), 1});
  (void)odometers.reach(Vec3(2, 0, 0), 0.1f);
  odometers.rebase();
  Random random(8);
  std::vector<std::uint32_t> fast, plain;
  std::size_t due_count = 0;
  for (std::size_t count = 0; count < 300; ++count) {
    std::vector<float> keys(count);
    for (float& key : keys)
      key = odometers.key(static_cast<Mover>(random.below(6)), within(random, -0.5f, 0.5f));
    const auto due = find_due_keys(keys, odometers, fast);
    const auto expected = find_due_keys_plain(keys, odometers, plain);
    EXPECT_TRUE(std::equal(due.begin(), due.end(), expected.begin(), expected.end()));
    due_count = expected.size();
  }
  EXPECT_GT(due_count, 50u);
}

void expect_plain_is_the_same(const ViewDependentMesh& model, const ViewQuery& view,
                              const Odometers& odometers) {
  RegionBatch batch;
  batch.keeps = true;
  for (std::uint32_t step = 0; step + RegionBatch::kSize <= model.step_count(); ++step) {
    for (std::uint32_t i = 0; i < RegionBatch::kSize; ++i) {
      batch.bounds[i] = &model.packed_bounds(step + i);
      batch.centers[i] = &model.center(step + i);
      batch.keep[i] = 0.01f * static_cast<float>(i % 2);
    }
    AnswerBatch fast, plain;
    const auto expect_same = [&] {
      ASSERT_EQ(fast.keys, plain.keys);
      ASSERT_EQ(fast.asked, plain.asked);
    };
    test_own_regions(view, odometers, batch, fast);
    test_own_regions_plain(view, odometers, batch, plain);
    expect_same();
    test_nested_regions(view, odometers, batch, fast);
    test_nested_regions_plain(view, odometers, batch, plain);
    expect_same();
  }
}

TEST(RegionBatch, LanesAnswerAsSingleTestsToTheBit) {
  const NamedVdpm named = make_vdpm({"sphere", icosphere(5000)}, Placement::kKept);
  const ViewDependentMesh& model = *named.model;
  Flight flight(model, 3, 9);
  Odometers odometers(model.bounding_ball());
  std::vector<std::uint32_t> steps(model.step_count());
  std::iota(steps.begin(), steps.end(), 0u);
  const std::vector<float> keep(steps.size(), 0.01f);
  for (int frame = 0; frame < 10; ++frame) {
    FrontQuestion question;
    question.set(flight.next(), 0.5f, model.bounding_ball().radius, odometers);
    FrontAnswers own, nested;
    question.own(model, odometers, steps, keep, own);
    question.nested(model, odometers, steps, nested);
    const auto expect_same = [&](const ViewAnswer& one, const FrontAnswers& many, std::size_t i) {
      ASSERT_EQ(one.asked, many.asked[i] != 0);
      ASSERT_EQ(odometers.key(one.mover, one.slack), many.keys[i]);
    };
    for (const std::uint32_t step : steps) {
      expect_same(question.own(model.bounds(step), model.center(step), 0.01f), own, step);
      expect_same(question.nested(model.bounds(step), model.center(step)), nested, step);
    }
    expect_plain_is_the_same(model, question.view(), odometers);
  }
}

}  // namespace
}  // namespace varifold::test
