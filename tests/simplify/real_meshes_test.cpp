// The simplifier on real meshes: what they are good for stands in their README.
#include <gtest/gtest.h>
#include <tests/simplify/sequence_checks.h>
#include <tests/support/test_files.h>
#include <varifold/io/mesh_file.h>
#include <varifold/measure/surface_distance.h>

#include <meshoptimizer.h>

namespace varifold {
namespace {

class RealMesh : public testing::TestWithParam<const char*> {};

TEST_P(RealMesh, IsSoundAtEveryLevelLookedAt) {
  VARIFOLD_REAL_MESH_OR_SKIP(path, GetParam());
  const auto file = read_mesh(path);
  ASSERT_TRUE(file) << file.error().message;
  for (const Placement placement : {Placement::kKept, Placement::kOptimal}) {
    SimplifyOptions options;
    options.placement = placement;
    options.measure_error = false;
    const auto result = simplify(file->mesh, options);
    ASSERT_TRUE(result) << result.error().message;
    test::expect_consistent(result->detailed);
    const std::uint32_t levels = file->mesh.triangle_count() > 100000 ? 5 : 9;
    for (const std::uint32_t level : test::spread_levels(result->detailed.sequence, levels))
      test::expect_sound_level(result->detailed, level);
  }
}

INSTANTIATE_TEST_SUITE_P(Files, RealMesh,
                         testing::Values("bunny.ply", "armadillo.ply", "cow.obj", "fandisk.obj",
                                         "spot.obj", "beetle.obj", "mengerSponge3.glb",
                                         "motorbike.ply", "58011.stl", "DamagedHelmet.glb",
                                         "camel.ply", "horse.ply"),
                         [](const auto& param) {
                           std::string name = param.param;
                           for (char& c : name)
                             if (c == '.') c = '_';
                           return name;
                         });

// The error at equal counts, against the simplifier that people use today, in the same run.
TEST(RealMesh, HasLessErrorThanMeshoptimizer) {
  for (const char* name : {"bunny.ply", "armadillo.ply"}) {
    VARIFOLD_REAL_MESH_OR_SKIP(path, name);
    const TriangleMesh mesh = without_unused_vertices(read_mesh(path)->mesh);
    const auto ours = simplify(mesh, {.measure_error = false});
    for (const double ratio : {0.5, 0.1, 0.01}) {
      const auto count = static_cast<std::uint32_t>(ratio * mesh.triangle_count());
      const auto level = ours->detailed.sequence.level_for_triangles(count);
      const TriangleMesh kept = mesh_at_level(ours->detailed, level);
      TriangleMesh theirs = mesh;
      theirs.indices.resize(
          meshopt_simplify(theirs.indices.data(), mesh.indices.data(), mesh.indices.size(),
                           &mesh.positions[0].x, mesh.positions.size(), sizeof(Vec3),
                           3 * std::size_t{kept.triangle_count()}, 1e9f, 0, nullptr));
      const auto our_distance = surface_distance(kept, mesh);
      const auto their_distance = surface_distance(theirs, mesh);
      EXPECT_LT(our_distance.rms, 0.95 * their_distance.rms) << name << " at " << ratio;
    }
  }
}

}  // namespace
}  // namespace varifold
