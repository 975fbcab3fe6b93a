// Bounds of meshes that take several shapes: in blends, against brute force.
#include <varifold/models/vdpm/shape_bounds.h>

#include <gtest/gtest.h>
#include <tests/models/vdpm/bounds_support.h>
#include <tests/support/poses.h>
#include <varifold/measure/surface_distance.h>
#include <varifold/models/vdpm/build.h>
#include <varifold/models/vdpm/encoding.h>
#include <algorithm>

namespace varifold {
namespace {

std::vector<test::NamedSequence> posed_sequences() {
  std::vector<test::NamedSequence> result;
  std::uint64_t seed = 0;
  auto meshes = test::group_closed();
  for (auto&& more : {test::group_open(), test::group_seams(), test::group_nonmanifold()})
    meshes.insert(meshes.end(), more.begin(), more.end());
  for (const test::NamedMesh& named : meshes) {
    if (named.mesh.triangle_count() > 1500) continue;
    auto simplified = simplify(test::with_poses(named.mesh, 2, ++seed, 0.1f));
    if (simplified && simplified->detailed.sequence.step_count() > 0)
      result.push_back({named.name, std::move(simplified->detailed)});
  }
  return result;
}

TEST(ShapeBounds, BallsAndConesHoldStarsInEveryBlend) {
  std::uint64_t seed = 0, narrow = 0;
  for (const auto& [name, detailed] : posed_sequences()) {
    SCOPED_TRACE(name);
    const auto bounds = test::bounds_of(detailed);
    const std::vector<Vec3> centers = shape_centers(detailed);
    const float slack = 1e-5f * varifold::bounds(detailed.mesh).diagonal();
    for (int blend = 0; blend < 4; ++blend) {
      const DetailedMesh blended = test::in_blend(detailed, test::blend_weights(3, ++seed));
      const test::Stars stars(blended);
      for (std::uint32_t k = 0; k < bounds.size(); k += 1 + bounds.size() / 60) {
        const test::Star star = stars.of(k);
        const NormalCone cone = bounds[k].own_cone();
        narrow += cone.cosine > 0.5f ? 1 : 0;
        for (const auto* triangles : {&star.before, &star.after})
          for (const auto& t : *triangles) {
            for (const Vec3& p : t)
              ASSERT_LE(glm::length(p - centers[k]), bounds[k].radius_length() + slack);
            const DVec3 normal = glm::cross(DVec3(t[1]) - DVec3(t[0]), DVec3(t[2]) - DVec3(t[0]));
            if (!(cone.cosine > 0) || glm::length(normal) < 1e-4 * slack) continue;
            ASSERT_LE(test::angle_between(Vec3(glm::normalize(normal)), cone.axis),
                      test::angle_of(cone) + 1e-3)
                << "step " << k;
          }
      }
    }
  }
  EXPECT_GT(narrow, 100u);  // cones that say something
}

TEST(ShapeBounds, FrontsAreWithinTheirErrorsInEveryBlend) {
  std::uint64_t seed = 50;
  for (const auto& [name, detailed] : posed_sequences()) {
    SCOPED_TRACE(name);
    const auto bounds = test::bounds_of(detailed);
    const float slack = 1e-5f * varifold::bounds(detailed.mesh).diagonal();
    for (int round = 0; round < 4; ++round) {
      const std::vector<bool> is_collapsed = test::random_front(detailed, ++seed);
      float error = 0;
      for (std::uint32_t k = 0; k < bounds.size(); ++k)
        if (is_collapsed[k])
          error = std::max({error, bounds[k].mu_length(), bounds[k].delta_length()});
      const DetailedMesh blended = test::in_blend(detailed, test::blend_weights(3, seed));
      const SurfaceDistance surface(test::surface_without(blended, is_collapsed));
      std::vector<bool> is_used(blended.mesh.vertex_count(), false);
      for (const std::uint32_t v : blended.mesh.indices) is_used[v] = true;
      for (std::uint32_t v = 0; v < blended.mesh.vertex_count(); ++v) {
        if (is_used[v]) {
          ASSERT_LE(surface.distance(blended.mesh.positions[v]), error + slack);
        }
      }
    }
  }
}

TEST(ShapeBounds, DoNotDependOnThreads) {
  const auto simplified = simplify(test::with_poses(test::icosphere(30000), 2, 9));
  ASSERT_TRUE(simplified);
  const auto model = [&](int threads) {
    StepBoundsOptions options;
    options.threads = threads;
    return encode_view_dependent_mesh(build_view_dependent_mesh(simplified->detailed, options));
  };
  EXPECT_EQ(model(1), model(3));
}

TEST(ShapeBounds, CentersSurviveTheFile) {
  for (const auto& [name, detailed] : posed_sequences()) {
    SCOPED_TRACE(name);
    const ViewDependentMesh model = build_view_dependent_mesh(detailed);
    const auto bytes = encode_view_dependent_mesh(model);
    const auto again = decode_view_dependent_mesh(bytes);
    ASSERT_TRUE(again) << again.error().message;
    EXPECT_EQ(again->data().centers, model.data().centers);
    EXPECT_EQ(encode_view_dependent_mesh(*again), bytes);
    auto damaged = bytes;
    damaged.resize(damaged.size() - 4);
    EXPECT_FALSE(decode_view_dependent_mesh(damaged));
    damaged = bytes;
    damaged[damaged.size() - 1] = std::byte{0x7f};
    damaged[damaged.size() - 2] = std::byte{0xff};
    EXPECT_FALSE(decode_view_dependent_mesh(damaged));
  }
}

}  // namespace
}  // namespace varifold
