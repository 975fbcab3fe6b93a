// Bounds of meshes that take several shapes: in blends, against brute force.
#include <varifold/models/vdpm/shape_bounds.h>

#include <gtest/gtest.h>
#include <tests/models/vdpm/bounds_support.h>
#include <tests/support/poses.h>
#include <varifold/measure/surface_distance.h>
#include <varifold/models/common/step_graph.h>
#include <varifold/models/vdpm/build.h>
#include <varifold/models/vdpm/encoding.h>
#include <algorithm>

namespace varifold {
namespace {

std::vector<test::NamedMesh> small_meshes() {
  std::vector<test::NamedMesh> result;
  for (const auto& group :
       {test::group_closed(), test::group_open(), test::group_seams(), test::group_nonmanifold()})
    for (const test::NamedMesh& named : group)
      if (named.mesh.triangle_count() <= 1500) result.push_back(named);
  return result;
}

void add_sequence(const std::string& name, const TriangleMesh& mesh,
                  std::vector<test::NamedSequence>& result) {
  auto simplified = simplify(mesh);
  if (simplified && simplified->detailed.sequence.step_count() > 0)
    result.push_back({name, std::move(simplified->detailed)});
}

std::vector<test::NamedSequence> posed_sequences() {
  std::vector<test::NamedSequence> result;
  std::uint64_t seed = 0;
  for (const test::NamedMesh& named : small_meshes())
    add_sequence(named.name, test::with_poses(named.mesh, 2, ++seed, 0.1f), result);
  return result;
}

// Poses that are turned so far that what lies between them is not like any of them.
std::vector<test::NamedSequence> turned_sequences(float angle) {
  std::vector<test::NamedSequence> result;
  std::uint64_t seed = 0;
  for (const test::NamedMesh& named : small_meshes())
    add_sequence(named.name, test::with_turned_poses(named.mesh, 2, ++seed, angle), result);
  return result;
}

TEST(ShapeBounds, BallsAndConesHoldStarsInEveryBlend) {
  std::uint64_t seed = 0, narrow = 0;
  std::vector<test::NamedSequence> sequences = posed_sequences();
  for (test::NamedSequence& turned : turned_sequences(0.9f)) sequences.push_back(std::move(turned));
  for (const auto& [name, detailed] : sequences) {
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

float error_of(const StepBounds& bounds) {
  return std::max(bounds.mu_length(), bounds.delta_length());
}

// All steps that are off by at most `error`, as far as those that depend on them are such, too.
std::vector<bool> front_of_error(const DetailedMesh& detailed,
                                 const std::vector<StepBounds>& bounds, float error) {
  const StepGraph graph(detailed);
  std::vector<bool> is_collapsed(bounds.size(), false);
  for (auto k = static_cast<std::uint32_t>(bounds.size()); k-- > 0;) {
    bool may = error_of(bounds[k]) <= error;
    for (const std::uint32_t finer : graph.of(k)) may = may && is_collapsed[finer];
    is_collapsed[k] = may;
  }
  return is_collapsed;
}

// The farthest of all vertices that are used, in blends, as a part of the front's error.
void expect_within_error(const DetailedMesh& detailed, const std::vector<StepBounds>& bounds,
                         const std::vector<bool>& is_collapsed, std::uint64_t seed) {
  const float slack = 1e-5f * varifold::bounds(detailed.mesh).diagonal();
  float error = 0;
  for (std::uint32_t k = 0; k < bounds.size(); ++k)
    if (is_collapsed[k]) error = std::max(error, error_of(bounds[k]));
  const DetailedMesh blended = test::in_blend(detailed, test::blend_weights(3, seed));
  const SurfaceDistance surface(test::surface_without(blended, is_collapsed));
  std::vector<bool> is_used(blended.mesh.vertex_count(), false);
  for (const std::uint32_t v : blended.mesh.indices) is_used[v] = true;
  for (std::uint32_t v = 0; v < blended.mesh.vertex_count(); ++v) {
    if (is_used[v]) {
      ASSERT_LE(surface.distance(blended.mesh.positions[v]), error + slack) << "seed " << seed;
    }
  }
}

TEST(ShapeBounds, FrontsAreWithinTheirErrorsInEveryBlend) {
  std::uint64_t seed = 50;
  for (const auto& [name, detailed] : posed_sequences()) {
    SCOPED_TRACE(name);
    const auto bounds = test::bounds_of(detailed);
    for (int round = 0; round < 4; ++round) {
      const std::vector<bool> is_collapsed = test::random_front(detailed, ++seed);
      expect_within_error(detailed, bounds, is_collapsed, seed);
    }
  }
}

// Where the shapes are turned, all that is off is so between them; and a front of all that is off
// by little shows a step that is off by more than it says.
TEST(ShapeBounds, FrontsOfTurnedShapesAreWithinTheirErrorsInEveryBlend) {
  std::uint64_t seed = 900;
  for (const auto& [name, detailed] : turned_sequences(1.5f)) {
    SCOPED_TRACE(name);
    const auto bounds = test::bounds_of(detailed);
    std::vector<float> errors;
    for (const StepBounds& b : bounds) errors.push_back(error_of(b));
    std::sort(errors.begin(), errors.end());
    for (const std::size_t part : {2u, 4u, 6u, 8u}) {
      const auto front = front_of_error(detailed, bounds, errors[(errors.size() - 1) * part / 8]);
      for (int blend = 0; blend < 3; ++blend) expect_within_error(detailed, bounds, front, ++seed);
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

// Of a box that holds all places, so that balls are no greater than they need be.
TEST(ShapeBounds, CentersAreInTheMiddleOfAllPlaces) {
  for (const auto& [name, detailed] : turned_sequences(1.5f)) {
    SCOPED_TRACE(name);
    const std::vector<Vec3> centers = shape_centers(detailed);
    ASSERT_EQ(centers.size(), detailed.sequence.step_count());
    for (std::uint32_t k = 0; k < centers.size(); ++k)
      for (int axis = 0; axis < 3; ++axis) {
        float lower = 1e30f, upper = -1e30f;
        for (const auto& shape : detailed.shapes()) {
          lower = std::min(lower, shape[detailed.sequence.vertices[k]][axis]);
          upper = std::max(upper, shape[detailed.sequence.vertices[k]][axis]);
        }
        ASSERT_NEAR(centers[k][axis], 0.5f * (lower + upper), 1e-5f);
      }
  }
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
