// Patch trees of meshes that take several shapes.
#include <gtest/gtest.h>
#include <tests/models/patch_tree/tree_fronts.h>
#include <tests/support/meshes.h>
#include <tests/support/poses.h>
#include <varifold/base/random.h>
#include <varifold/measure/surface_distance.h>
#include <varifold/mesh/generators.h>
#include <varifold/models/patch_tree/build.h>
#include <varifold/models/patch_tree/encoding.h>
#include <varifold/models/patch_tree/instance.h>
#include <algorithm>
#include <memory>

namespace varifold {
namespace {

PatchTreeBuild build(const TriangleMesh& mesh, std::uint32_t triangles, int threads = 1) {
  PatchTreeOptions options;
  options.triangles_per_patch = triangles;
  options.threads = threads;
  auto result = build_patch_tree(mesh, options);
  EXPECT_TRUE(result.has_value()) << result.error().message;
  return std::move(*result);
}

// The blend of the mesh at rest and its poses, as a mesh of its own.
TriangleMesh blended(const TriangleMesh& mesh, const std::vector<float>& weights) {
  DetailedMesh detailed;
  detailed.mesh = mesh;
  return test::in_blend(detailed, weights).mesh;
}

PatchTree blended(const PatchTree& tree, const std::vector<float>& weights) {
  PatchTreeData data = tree.data();
  data.vertices = blended(data.vertices, weights);
  return PatchTree(std::move(data));
}

std::vector<test::NamedMesh> posed_meshes() {
  std::vector<test::NamedMesh> meshes = test::all_groups();
  meshes.push_back({"planet", planet({{.triangles = 4000}})});
  std::uint64_t seed = 0;
  for (test::NamedMesh& named : meshes)
    named.mesh = test::with_poses(std::move(named.mesh), 2, ++seed, 0.1f);
  return meshes;
}

// The same in poses that are turned: cones and errors are those of what lies between them.
std::vector<test::NamedMesh> turned_meshes() {
  std::vector<test::NamedMesh> meshes = test::all_groups();
  meshes.push_back({"planet", planet({{.triangles = 4000}})});
  std::uint64_t seed = 40;
  for (test::NamedMesh& named : meshes) {
    named.name += " turned";
    named.mesh = test::with_turned_poses(std::move(named.mesh), 2, ++seed, 0.9f);
  }
  return meshes;
}

TEST(PatchTreePoses, EveryFrontIsSoundInEveryShape) {
  std::uint64_t seed = 0;
  for (const auto& [name, mesh] : posed_meshes()) {
    for (const std::uint32_t triangles : {4u, 32u}) {
      SCOPED_TRACE(name + " " + std::to_string(triangles));
      const PatchTreeBuild built = build(mesh, triangles);
      if (built.tree.node_count() == 0) continue;
      for (std::size_t shape = 0; shape < 3; ++shape) {
        std::vector<float> weights(3, 0);
        weights[shape] = 1;
        const PatchTree tree = blended(built.tree, weights);
        const test::WholeSurface whole(tree);
        Random random(++seed);
        for (int i = 0; i < 15; ++i) {
          const test::SplitNodes front = test::random_front(tree.topology(), random);
          ASSERT_EQ(test::fault_of_front(tree, front, whole), "") << "shape " << shape;
          ASSERT_EQ(test::turned_triangles(tree.data(), front), 0u) << "shape " << shape;
        }
      }
    }
  }
}

TEST(PatchTreePoses, BallsConesAndErrorsHoldInEveryBlend) {
  std::uint64_t seed = 300, narrow = 0;
  std::vector<test::NamedMesh> meshes = posed_meshes();
  for (test::NamedMesh& named : turned_meshes()) meshes.push_back(std::move(named));
  for (const auto& [name, mesh] : meshes) {
    SCOPED_TRACE(name);
    const PatchTreeBuild built = build(mesh, 16);
    const PatchTreeData& data = built.tree.data();
    const float slack = 1e-5f * bounds(mesh).diagonal();
    for (int round = 0; round < 5; ++round) {
      const std::vector<float> weights = test::blend_weights(3, ++seed);
      const PatchTree tree = blended(built.tree, weights);
      const std::vector<Vec3>& at = tree.data().vertices.positions;
      for (std::uint32_t node = 0; node < built.tree.node_count(); ++node) {
        const PatchBounds& bounds = data.bounds[node];
        const PatchOffsets &begin = data.offsets[node], &end = data.offsets[node + 1];
        for (std::uint32_t v = begin.vertex; v < end.vertex; ++v)
          ASSERT_LE(glm::length(at[v] - bounds.ball.center), bounds.ball.radius + slack);
        if (!(bounds.cone.cosine > 0)) continue;
        ++narrow;
        for (std::size_t t = begin.triangle; t < end.triangle; ++t) {
          const auto corner = [&](std::size_t k) {
            return DVec3(at[begin.vertex + data.corners[3 * t + k]]);
          };
          const DVec3 normal = glm::cross(corner(1) - corner(0), corner(2) - corner(0));
          if (glm::length(normal) < 1e-4 * slack) continue;
          ASSERT_GE(glm::dot(glm::normalize(normal), DVec3(bounds.cone.axis)),
                    bounds.cone.cosine - 1e-3);
        }
      }
      // Uniform levels against all vertices of the input.
      if (built.tree.node_count() == 0) continue;
      const TriangleMesh original = without_unused_vertices(blended(mesh, weights));
      PatchTreeInstance instance(std::make_shared<const PatchTree>(tree));
      for (std::uint32_t level = 0; level <= tree.finest_level(); ++level) {
        instance.go_to_level(level);
        const SurfaceDistance surface(instance.extract());
        float error = slack;
        for (std::uint32_t node = data.topology.first_of_level[level];
             node < data.topology.first_of_level[level + 1]; ++node)
          error = std::max(error, data.bounds[node].error);
        if (built.report.vanished_points > 0) continue;  // their components are not there
        for (const std::uint32_t v : original.indices)
          ASSERT_LE(surface.distance(original.positions[v]), error * 1.0001 + slack);
      }
    }
  }
  EXPECT_GT(narrow, 100u);
}

TEST(PatchTreePoses, DoNotDependOnThreads) {
  const TriangleMesh mesh = test::with_poses(planet({{.triangles = 20000}}), 2, 5);
  const PatchTree one = build(mesh, 64, 1).tree, three = build(mesh, 64, 3).tree;
  EXPECT_EQ(one.data().vertices.positions, three.data().vertices.positions);
  EXPECT_EQ(one.data().vertices.poses, three.data().vertices.poses);
  EXPECT_EQ(one.data().corners, three.data().corners);
  for (std::uint32_t node = 0; node < one.node_count(); ++node) {
    EXPECT_EQ(one.data().bounds[node].error, three.data().bounds[node].error);
    EXPECT_EQ(one.data().bounds[node].ball.radius, three.data().bounds[node].ball.radius);
  }
}

TEST(PatchTreePoses, SamplesCountLikePosesButAreNotKept) {
  const TriangleMesh rest = planet({{.triangles = 4000}});
  const TriangleMesh posed = test::with_poses(rest, 2, 5);
  PatchTreeOptions options;
  options.triangles_per_patch = 64;
  options.poses.samples = posed.poses;
  const auto sampled = build_patch_tree(rest, options);
  ASSERT_TRUE(sampled);
  const PatchTree kept = build(posed, 64).tree;
  EXPECT_TRUE(sampled->tree.data().vertices.poses.empty());
  EXPECT_EQ(sampled->tree.data().corners, kept.data().corners);
  for (std::uint32_t node = 0; node < kept.node_count(); ++node) {
    EXPECT_EQ(sampled->tree.data().bounds[node].error, kept.data().bounds[node].error);
    EXPECT_EQ(sampled->tree.data().bounds[node].cone.cosine, kept.data().bounds[node].cone.cosine);
  }
}

}  // namespace
}  // namespace varifold
