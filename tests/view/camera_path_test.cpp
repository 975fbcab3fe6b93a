// Frames of camera paths: exact at keys, smooth between them, the same everywhere.
#include <gtest/gtest.h>

#include <varifold/base/bytes.h>
#include <varifold/base/checksum.h>
#include <varifold/view/camera_path.h>
#include <varifold/view/known_paths.h>
#include <cmath>
#include <limits>
#include <map>

namespace varifold {
namespace {

const Box kBox{Vec3(-1, 2, 3), Vec3(3, 5, 15)};  // diagonal 13 about (1, 3.5, 9)

CameraPath three_keys() {
  CameraPath path;
  path.units = CameraPath::Units::kModel;
  path.frames = 31;
  path.keys = {{0, {0, 0, 10}, {0, 0, 0}, {0, 1, 0}, 30},
               {10, {5, 1, 10}, {1, 0, 0}, {0, 1, 0}, 40},
               {30, {5, 9, 20}, {2, 0, 0}, {0, 2, 1}, 50}};
  return path;
}

Camera camera(const CameraPath& path, std::uint32_t frame) {
  const auto made = camera_at(path, frame, kBox);
  EXPECT_TRUE(made) << made.error().message;
  return made ? *made : Camera();
}

std::string fault(const CameraPath& path, std::uint32_t frame, const Box& box = kBox) {
  const auto made = camera_at(path, frame, box);
  EXPECT_FALSE(made);
  if (made) return {};
  EXPECT_EQ(made.error().kind, ErrorKind::kInvalidInput);
  return made.error().message;
}

TEST(CameraPath, KeysAreMetExactly) {
  for (const auto interpolation :
       {CameraPath::Interpolation::kLinear, CameraPath::Interpolation::kSmooth}) {
    CameraPath path = three_keys();
    path.interpolation = interpolation;
    for (const CameraKey& key : path.keys) {
      const Camera seen = camera(path, key.frame);
      EXPECT_EQ(seen.eye, Vec3(key.eye));
      EXPECT_EQ(seen.target, Vec3(key.target));
      EXPECT_EQ(seen.fovy_degrees, static_cast<float>(key.fovy_degrees));
      EXPECT_TRUE(is_usable(seen));
    }
  }
}

TEST(CameraPath, LinearIsLinear) {
  CameraPath path = three_keys();
  path.interpolation = CameraPath::Interpolation::kLinear;
  EXPECT_EQ(camera(path, 5).eye, Vec3(2.5, 0.5, 10));
  EXPECT_EQ(camera(path, 20).eye, Vec3(5, 5, 15));
  EXPECT_EQ(camera(path, 20).fovy_degrees, 45);
}

// Keys on a parabola: the differences of the neighbours are its slopes where keys are equally far
// apart, so that the cubic between inner keys is the parabola itself.
TEST(CameraPath, SmoothReproducesParabolas) {
  CameraPath path;
  path.units = CameraPath::Units::kModel;
  path.frames = 51;
  for (std::uint32_t f = 0; f <= 50; f += 10)
    path.keys.push_back({f, {f * 1.0, 0.01 * f * f, 30}, {0, 0, 0}, {0, 1, 0}, 30});
  for (std::uint32_t f = 10; f <= 40; ++f) {
    EXPECT_FLOAT_EQ(camera(path, f).eye.x, static_cast<float>(f));
    EXPECT_FLOAT_EQ(camera(path, f).eye.y, 0.01f * static_cast<float>(f * f));
  }
}

TEST(CameraPath, SmoothHasNoKinks) {
  const CameraPath path = three_keys();
  // Straight lines would turn by 0.76 a frame at the key at frame 10.
  for (std::uint32_t f = 2; f < 30; ++f) {
    const Vec3 bend =
        camera(path, f - 1).eye - 2.0f * camera(path, f).eye + camera(path, f + 1).eye;
    EXPECT_LT(glm::length(bend), 0.25f) << f;
  }
}

TEST(CameraPath, ClosedPathsGoOnAndOpenOnesRest) {
  CameraPath path = three_keys();
  path.frames = 41;
  EXPECT_EQ(camera(path, 40).eye, camera(path, 30).eye);
  path.is_closed = true;
  path.interpolation = CameraPath::Interpolation::kLinear;
  const Camera between = camera(path, 36);  // 6 / 11 of the way home
  EXPECT_NEAR(between.eye.x, 5 * 5 / 11.0, 1e-6);
  EXPECT_NEAR(between.fovy_degrees, 50 - 20 * 6 / 11.0, 1e-5);
}

TEST(CameraPath, DiagonalsAreThoseOfTheBounds) {
  CameraPath path;
  path.keys = {{0, {0, 0, 2}, {0, 0.5, 0}, {0, 1, 0}, 30}};
  const Camera seen = camera(path, 0);
  EXPECT_EQ(seen.eye, Vec3(1, 3.5, 9 + 26));
  EXPECT_EQ(seen.target, Vec3(1, 10, 9));
  EXPECT_LT(seen.near_distance, seen.far_distance);
}

TEST(CameraPath, DegenerateFramesAreNamed) {
  CameraPath path = three_keys();
  path.interpolation = CameraPath::Interpolation::kLinear;
  path.keys[1].fovy_degrees = -30;
  EXPECT_EQ(fault(path, 5), "frame 5: the angle of view is not between 0 and 180 degrees");
  path.keys[1].fovy_degrees = 180;
  EXPECT_EQ(fault(path, 10), "frame 10: the angle of view is not between 0 and 180 degrees");
  path = three_keys();
  path.keys[2].eye = path.keys[2].target;
  EXPECT_EQ(fault(path, 30), "frame 30: eye and target are one point");
  path.keys[2].eye = path.keys[2].target + 3.0 * path.keys[2].up;
  EXPECT_EQ(fault(path, 30), "frame 30: up is along the line of sight");
  path.keys[2].eye = {1e300, 0, 0};
  EXPECT_EQ(fault(path, 30), "frame 30: a coordinate is too large");
  path = three_keys();
  path.keys[0].up = {0, 0, 0};
  EXPECT_EQ(fault(path, 0), "frame 0: up is along the line of sight");
  path.units = CameraPath::Units::kDiagonals;
  EXPECT_NE(fault(path, 0, Box{}).find("frame 0: the path is in diagonals"), std::string::npos);
  EXPECT_FALSE(cameras_of(path, kBox));
}

TEST(CameraPath, PathsAreChecked) {
  EXPECT_TRUE(check_camera_path(three_keys()));
  const auto refused = [](auto change, const char* place) {
    CameraPath path = three_keys();
    change(path);
    const auto checked = check_camera_path(path);
    ASSERT_FALSE(checked) << place;
    EXPECT_EQ(checked.error().message.find(place), 0u) << checked.error().message;
  };
  refused([](CameraPath& p) { p.frames = 0; }, "frames");
  refused([](CameraPath& p) { p.frames = kMaxPathFrames + 1; }, "frames");
  refused([](CameraPath& p) { p.frames = 30; }, "keys[2]");
  refused([](CameraPath& p) { p.width = 0; }, "size");
  refused([](CameraPath& p) { p.height = kMaxPathSize + 1; }, "size");
  refused([](CameraPath& p) { p.keys.clear(); }, "keys");
  refused([](CameraPath& p) { p.keys[0].frame = 1; }, "keys[0]");
  refused([](CameraPath& p) { p.keys[2].frame = 10; }, "keys[2]");
  refused([](CameraPath& p) { p.keys[1].eye.y = NAN; }, "keys[1]");
  refused([](CameraPath& p) { p.keys[1].fovy_degrees = INFINITY; }, "keys[1]");
}

std::uint64_t checksum_of(const std::vector<Camera>& cameras) {
  std::vector<std::byte> bytes;
  for (const Camera& c : cameras) {
    for (const Vec3& v : {c.eye, c.target, c.up})
      for (int i = 0; i < 3; ++i) append_little(bytes, v[i]);
    for (const float x :
         {c.fovy_degrees, c.near_distance, c.far_distance, PixelScale(c).focal_pixels()})
      append_little(bytes, x);
  }
  return checksum(bytes);
}

// The same bits on any machine: these were computed once.
TEST(KnownPaths, TheSameBitsEverywhere) {
  const std::map<std::string_view, std::uint64_t> expected{{"orbit", 0x233939a3fd4219a6u},
                                                           {"fly_by", 0x10fc0d82b8e6a3f9u},
                                                           {"dive", 0x3470a3eb47b92e74u},
                                                           {"canyon", 0x8b44596fd77e290bu}};
  for (const std::string_view name : known_path_names()) {
    const auto path = known_path(name);
    ASSERT_TRUE(path);
    const auto cameras = cameras_of(*path, kBox);
    ASSERT_TRUE(cameras) << cameras.error().message;
    EXPECT_EQ(cameras->size(), path->frames);
    EXPECT_EQ(checksum_of(*cameras), expected.at(name)) << name;
  }
}

TEST(KnownPaths, TheOrbitTurnsOneDegreeAFrameAtTwoDiagonals) {
  const auto path = known_path("orbit");
  ASSERT_TRUE(path);
  ASSERT_EQ(path->frames, 360u);
  const Vec3 center = kBox.center();
  for (std::uint32_t f = 0; f < 360; ++f) {
    const Vec3 a = camera(*path, f).eye - center;
    const Vec3 b = camera(*path, (f + 1) % 360).eye - center;
    EXPECT_NEAR(glm::length(a), 26, 1e-4);
    const Vec2 x(a.x, a.z), y(b.x, b.z);
    const float cosine = glm::dot(x, y) / (glm::length(x) * glm::length(y));
    EXPECT_NEAR(cosine, std::cos(3.14159265 / 180), 1e-6) << f;
  }
}

TEST(KnownPaths, OptionsAndNames) {
  KnownPathOptions options;
  for (const std::string_view name : known_path_names()) {
    for (const std::uint32_t frames : {2u, 3u, 7u, 1000u}) {
      options.frames = frames;
      options.width = 640;
      options.fovy_degrees = 44;
      const auto path = known_path(name, options);
      ASSERT_TRUE(path) << name << path.error().message;
      EXPECT_EQ(path->frames, frames);
      EXPECT_EQ(path->width, 640);
      const auto cameras = cameras_of(*path, kBox);
      ASSERT_TRUE(cameras) << cameras.error().message;
      EXPECT_EQ((*cameras)[0].fovy_degrees, 44);
    }
  }
  options.frames = 1;
  EXPECT_FALSE(known_path("orbit", options));
  options = {};
  options.orbit_distance = 0;
  EXPECT_FALSE(known_path("orbit", options));
  EXPECT_EQ(known_path("spiral").error().message,
            "there is no path 'spiral'; there are orbit fly_by dive canyon");
}

}  // namespace
}  // namespace varifold
