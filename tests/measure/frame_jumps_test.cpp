// Jumps between frames, on surfaces of a few triangles whose pixels can be computed by hand.
#include <gtest/gtest.h>

#include <varifold/measure/frame_jumps.h>
#include <cstdint>
#include <vector>

namespace varifold {
namespace {

// One unit in the plane z = 0 is 100 pixels for an eye at z = 10.
Camera camera_above() {
  Camera camera;
  camera.eye = Vec3(0, 0, 10);
  camera.target = Vec3(0);
  camera.fovy_degrees = 90;
  camera.width = camera.height = 2000;
  camera.near_distance = 1;
  camera.far_distance = 100;
  return camera;
}

//  2---3      4 lies in the middle; it collapses onto 0.
//  | 4 |
//  0---1
struct Square {
  std::vector<Vec3> positions{{-1, -1, 0}, {1, -1, 0}, {-1, 1, 0}, {1, 1, 0}, {0, 0, 0}};
  std::vector<std::uint32_t> coarse{0, 1, 3, 0, 3, 2};
  std::vector<std::uint32_t> fine{0, 1, 4, 1, 3, 4, 3, 2, 4, 2, 0, 4};
  std::vector<std::uint32_t> targets{kNone, kNone, kNone, kNone, 0};
};

DrawList list_of(const std::vector<Vec3>& positions, const std::vector<std::uint32_t>& indices,
                 DrawRange& range, Primitive primitive = Primitive::kTriangles) {
  range = {0, static_cast<std::uint32_t>(indices.size()), primitive};
  DrawList list;
  list.positions = positions;
  list.indices = indices;
  list.ranges = {&range, 1};
  return list;
}

class Jumps : public ::testing::Test {
 protected:
  FrameJumps::Jumps go(const std::vector<std::uint32_t>& indices) {
    return jumps_.next(list_of(square_.positions, indices, range_), {}, camera_);
  }
  Square square_;
  DrawRange range_;
  Camera camera_ = camera_above();
  FrameJumps jumps_{square_.targets};
};

TEST_F(Jumps, TheFirstFrameAndARestingOneHaveNone) {
  EXPECT_EQ(go(square_.fine).vertex_pixels, 0);
  EXPECT_EQ(go(square_.fine).vertex_pixels, 0);
  camera_.eye.x = 3;  // moving the camera is no jump
  EXPECT_EQ(go(square_.fine).vertex_pixels, 0);
}

TEST_F(Jumps, InAFlatPartTheVertexJumpsButNotTheSurface) {
  (void)go(square_.coarse);
  for (const auto* const indices : {&square_.fine, &square_.coarse}) {
    const auto jumps = go(*indices);
    EXPECT_NEAR(jumps.vertex_pixels, 141.4214, 1e-3);  // from the corner to the middle, and back
    EXPECT_NEAR(jumps.surface_pixels, 0, 1e-3);
  }
}

TEST_F(Jumps, TheSurfaceJumpsByTheDistanceToIt) {
  square_.positions[4] = Vec3(0, 0, 0.2f);
  camera_.eye = Vec3(0, -10, 0.1f);  // from the side, along the square
  camera_.up = Vec3(0, 0, 1);
  camera_.eye.z = 3;
  (void)go(square_.coarse);
  const auto jumps = go(square_.fine);
  // The foot of the vertex is right below it; seen from 17 degrees above the ground.
  EXPECT_GT(jumps.surface_pixels, 15);
  EXPECT_LT(jumps.surface_pixels, 21);
  EXPECT_GT(jumps.vertex_pixels, 100);
}

TEST_F(Jumps, WhatIsNotSeenInBothFramesDoesNotCount) {
  (void)go(square_.coarse);
  camera_.target.x = 100;  // looks away
  EXPECT_EQ(go(square_.fine).vertex_pixels, 0);
  camera_.target.x = 0;  // looks back: what changed has not been seen
  EXPECT_EQ(go(square_.coarse).vertex_pixels, 0);
  EXPECT_GT(go(square_.fine).vertex_pixels, 0);
  camera_.eye.z = -10;  // from behind
  EXPECT_EQ(go(square_.coarse).vertex_pixels, 0);
  EXPECT_EQ(go(square_.fine).vertex_pixels, 0);
}

TEST_F(Jumps, GeomorphsJumpByTheirStride) {
  (void)go(square_.fine);
  square_.positions[4] = Vec3(0.25f, 0, 0);
  EXPECT_NEAR(go(square_.fine).vertex_pixels, 25, 1e-3);
}

TEST_F(Jumps, BuffersOfTheirOwnAndStripsAreUnderstood) {
  // The same five vertices from slots in another order, as a strip and a restart.
  const std::vector<std::uint32_t> vertex_of{4, 3, 2, 1, 0};
  std::vector<Vec3> slots;
  for (const std::uint32_t v : vertex_of) slots.push_back(square_.positions[v]);
  const std::vector<std::uint32_t> strip{4, 3, 0, 1, 2, kStripRestart, 2, 4, 0};
  (void)go(square_.coarse);
  DrawRange range;
  const auto jumps =
      jumps_.next(list_of(slots, strip, range, Primitive::kStrips), vertex_of, camera_);
  EXPECT_NEAR(jumps.vertex_pixels, 141.4214, 1e-3);
  EXPECT_EQ(go(square_.fine).vertex_pixels, 0);
}

}  // namespace
}  // namespace varifold
