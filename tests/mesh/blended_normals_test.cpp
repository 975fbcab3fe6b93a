// Directions that bound the normals of blends, against normals of blends.
#include <gtest/gtest.h>
#include <varifold/base/random.h>
#include <varifold/mesh/blended_normals.h>
#include <algorithm>

namespace varifold {
namespace {

Vec3 any_vector(Random& random) {
  const auto any = [&] { return static_cast<float>(2 * random.uniform() - 1); };
  return {any(), any(), any()};
}

// A halfspace that holds the directions holds the normals of all blends; and so does a cone. Those
// of the shapes alone are not enough for that.
TEST(BlendedNormals, HalfspacesThatHoldThemHoldTheNormalsOfBlends) {
  Random random(5);
  int held = 0, needed = 0;
  for (int round = 0; round < 100000; ++round) {
    std::vector<std::vector<Vec3>> places(3);
    std::vector<std::span<const Vec3>> shapes;
    for (auto& shape : places) {
      for (int k = 0; k < 3; ++k) shape.push_back(any_vector(random));
      shapes.emplace_back(shape);
    }
    const Vec3 axis = any_vector(random);
    const auto holds = [&](const Vec3& n) { return glm::dot(n, axis) >= 0; };
    const auto own = [&](const std::vector<Vec3>& p) {
      return glm::cross(p[1] - p[0], p[2] - p[0]);
    };
    std::vector<Vec3> normals;
    blended_normals(shapes, {0, 1, 2}, normals);
    ASSERT_EQ(normals.size(), 6u);
    const bool all_held = std::all_of(normals.begin(), normals.end(), holds);
    const bool shapes_held = std::all_of(places.begin(), places.end(),
                                         [&](const auto& shape) { return holds(own(shape)); });
    EXPECT_TRUE(shapes_held || !all_held);

    DVec3 weights(random.uniform(), random.uniform(), random.uniform());
    weights /= weights.x + weights.y + weights.z;
    const auto corner = [&](std::size_t k) {
      return weights.x * DVec3(places[0][k]) + weights.y * DVec3(places[1][k]) +
             weights.z * DVec3(places[2][k]);
    };
    const DVec3 normal = glm::cross(corner(1) - corner(0), corner(2) - corner(0));
    const bool blend_held = glm::dot(normal, DVec3(axis)) > -1e-6;
    ASSERT_TRUE(blend_held || !all_held) << "round " << round;
    held += all_held ? 1 : 0;
    needed += shapes_held && !blend_held ? 1 : 0;
  }
  EXPECT_GT(held, 1000);
  EXPECT_GT(needed, 100);
}

}  // namespace
}  // namespace varifold
