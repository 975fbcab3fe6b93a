// Skin, poses and rigs in the bytes and files of all models.
#include <gtest/gtest.h>
#include <tests/support/meshes.h>
#include <tests/support/rigged_meshes.h>
#include <tests/support/test_files.h>
#include <varifold/base/random.h>
#include <varifold/io/model_file.h>
#include <varifold/mesh/vertex_arrays.h>
#include <varifold/models/common/rig_bytes.h>
#include <varifold/models/lodstrips/build.h>
#include <varifold/models/mts/build.h>
#include <varifold/models/patch_tree/build.h>
#include <varifold/models/pm/build.h>
#include <varifold/models/pm/deformation.h>
#include <varifold/models/strips/build.h>
#include <varifold/models/vdpm/build.h>
#include <varifold/simplify/simplify.h>
#include <varifold/strip/stripify.h>

namespace varifold::test {
namespace {

using Bytes = std::vector<std::byte>;

/// A sequence of the mesh at rest, whose vertices get a random rig afterwards.
DetailedMesh rigged(const TriangleMesh& mesh, Placement placement, std::uint64_t seed,
                    const RigOptions& options = {}) {
  DetailedMesh detailed = std::move(simplify(mesh, {.placement = placement})->detailed);
  detailed.mesh = with_random_rig(detailed.mesh, seed, options);
  TriangleMesh& placed = detailed.sequence.placed;
  placed = with_random_rig(placed, seed + 1, options);
  placed.rig = detailed.mesh.rig;
  return detailed;
}

void expect_same_motion(const TriangleMesh& found, const TriangleMesh& expected) {
  EXPECT_TRUE(found.skin == expected.skin);
  EXPECT_TRUE(found.poses == expected.poses);
  ASSERT_EQ(found.rig != nullptr, expected.rig != nullptr);
  if (expected.rig) {
    EXPECT_TRUE(*found.rig == *expected.rig);
  }
}

std::vector<NamedMesh> meshes() {
  std::vector<NamedMesh> all = group_seams();
  all.push_back({"icosphere", icosphere(320)});
  all.push_back({"grid", grid(6, 5)});
  return all;
}

template <class Model>
void expect_identity(const Model& model) {
  const Bytes bytes = ModelKind<Model>::encode(model);
  const auto decoded = ModelKind<Model>::decode(bytes);
  ASSERT_TRUE(decoded) << decoded.error().message;
  expect_same_motion(decoded->attributes(), model.attributes());
  EXPECT_EQ(ModelKind<Model>::encode(*decoded), bytes);
}

TEST(RigEncoding, KindsWithOneBlockOfAttributes) {
  std::uint64_t seed = 0;
  for (const NamedMesh& named : meshes()) {
    SCOPED_TRACE(named.name);
    for (const RigOptions options : {RigOptions{3, 5, 2}, {2, 0, 0}, {0, 4, 1}}) {
      const DetailedMesh detailed = rigged(named.mesh, Placement::kKept, ++seed, options);
      const TriangleStrips strips = stripify(detailed.mesh);
      expect_identity(build_mts(detailed, strips));
      expect_identity(build_lod_strips(detailed, kLodStripsForms[0], strips));
      expect_identity(build_strip_framework(detailed, strips));
    }
  }
}

TEST(RigEncoding, ViewDependentMeshes) {
  std::uint64_t seed = 0;
  for (const NamedMesh& named : meshes()) {
    SCOPED_TRACE(named.name);
    for (const Placement placement : {Placement::kKept, Placement::kOptimal})
      expect_identity(build_view_dependent_mesh(rigged(named.mesh, placement, ++seed)));
  }
}

/// The same tree with a random rig.
PatchTree rigged_tree(const TriangleMesh& mesh, std::uint64_t seed) {
  PatchTreeOptions options;
  options.triangles_per_patch = 12;
  const auto built = build_patch_tree(mesh, options);
  PatchTreeData data = built->tree.data();
  data.vertices = with_random_rig(data.vertices, seed);
  return PatchTree(std::move(data));
}

TEST(RigEncoding, PatchTrees) {
  std::uint64_t seed = 0;
  for (const NamedMesh& named : meshes()) {
    SCOPED_TRACE(named.name);
    expect_identity(rigged_tree(named.mesh, ++seed));
  }
}

TEST(RigEncoding, ProgressiveMeshes) {
  std::uint64_t seed = 0;
  for (const NamedMesh& named : meshes()) {
    SCOPED_TRACE(named.name);
    for (const RigOptions options : {RigOptions{3, 5, 2}, {2, 0, 0}, {0, 4, 1}}) {
      const ProgressiveMesh model =
          build_progressive_mesh(rigged(named.mesh, Placement::kKept, ++seed, options));
      const Bytes moving = encode_deformation(model);
      const auto still = decode_progressive_mesh(encode_progressive_mesh(model));
      ASSERT_TRUE(still);
      EXPECT_TRUE(encode_deformation(*still).empty());
      const auto decoded = decode_deformation(moving, *still);
      ASSERT_TRUE(decoded) << decoded.error().message;
      expect_same_motion(decoded->attributes(), model.attributes());
      EXPECT_EQ(encode_deformation(*decoded), moving);
    }
  }
}

TEST(RigEncoding, PartsOfProgressiveMeshesAreWhatTheirLevelsAre) {
  const auto model = std::make_shared<const ProgressiveMesh>(
      build_progressive_mesh(rigged(icosphere(320), Placement::kKept, 7)));
  const Bytes stream = encode_progressive_mesh(*model);
  const Bytes moving = encode_deformation(*model);
  std::size_t bytes_a_vertex = kJointWeightsBytes;
  for (const Pose& pose : model->attributes().poses)
    bytes_a_vertex += pose.normals.empty() ? 12 : 24;
  for (std::uint32_t level = 0; level <= model->finest_level(); level += 13) {
    SCOPED_TRACE(level);
    const auto size = progressive_mesh_prefix(stream, level);
    ASSERT_TRUE(size);
    const auto part = decode_progressive_mesh(std::span(stream).first(*size));
    ASSERT_TRUE(part);
    const std::size_t missing =
        model->attributes().vertex_count() - part->attributes().vertex_count();
    const std::size_t end = moving.size() - missing * bytes_a_vertex;
    const auto found = decode_deformation(std::span(moving).first(end), *part);
    ASSERT_TRUE(found) << found.error().message;
    ProgressiveMeshInstance instance(model);
    instance.go_to_level(level);
    expect_same_motion(found->attributes(), instance.extract());
    EXPECT_FALSE(decode_deformation(std::span(moving).first(end - 1), *part));
  }
}

TEST(RigEncoding, ModelsThatMoveVerticesBackHaveNoPoses) {
  const auto moving =
      encode_deformation(build_progressive_mesh(rigged(icosphere(80), Placement::kKept, 1)));
  auto detailed = std::move(simplify(icosphere(80), {.placement = Placement::kOptimal})->detailed);
  EXPECT_FALSE(decode_deformation(moving, build_progressive_mesh(detailed)));
}

TEST(RigEncoding, DamageIsAFaultOrASoundMesh) {
  const DetailedMesh detailed = rigged(icosphere(80), Placement::kKept, 5);
  const MultiresolutionStrips mts = build_mts(detailed, stripify(detailed.mesh));
  const Bytes bytes = encode_mts(mts);
  const ProgressiveMesh model = build_progressive_mesh(detailed);
  const Bytes moving = encode_deformation(model);
  const auto check = [](const TriangleMesh& mesh) {
    for (const JointWeights& followed : mesh.skin)
      ASSERT_TRUE(is_sound(followed, mesh.rig ? mesh.rig->joints.size() : 0));
    for (const Pose& pose : mesh.poses) ASSERT_EQ(pose.positions.size(), mesh.positions.size());
  };
  for (std::size_t size = 0; size < moving.size(); size += 1 + size / 50)
    ASSERT_FALSE(decode_deformation(std::span(moving).first(size), model));
  Random random(3);
  std::size_t refused = 0;
  constexpr int kTrials = 3000;
  for (int trial = 0; trial < kTrials; ++trial) {
    Bytes bad = trial % 2 == 0 ? bytes : moving;
    for (std::uint32_t i = 0; i < 1 + random.below(3); ++i)
      bad[random.below(static_cast<std::uint32_t>(bad.size()))] =
          static_cast<std::byte>(random.below(256));
    if (trial % 2 == 0) {
      const auto decoded = decode_mts(bad);
      refused += decoded ? 0 : 1;
      if (decoded) check(decoded->attributes());
    } else {
      const auto decoded = decode_deformation(bad, model);
      refused += decoded ? 0 : 1;
      if (decoded) check(decoded->attributes());
    }
  }
  EXPECT_GT(refused, kTrials / 20u);
}

TEST(RigEncoding, FilesOfAllKindsKeepIt) {
  const TemporaryFolder folder;
  const auto path = folder.file("m.vfm");
  const auto expect_kept = [&](const auto& model) {
    ASSERT_TRUE(write_model(model, path));
    const auto read = read_any_model(path);
    ASSERT_TRUE(read) << read.error().message;
    std::visit(
        [&](const auto& found) { expect_same_motion(found->attributes(), model.attributes()); },
        *read);
  };
  const DetailedMesh detailed = rigged(icosphere(320), Placement::kKept, 5);
  const TriangleStrips strips = stripify(detailed.mesh);
  expect_kept(build_progressive_mesh(detailed));
  expect_kept(build_mts(detailed, strips));
  expect_kept(build_lod_strips(detailed, kLodStripsForms[0], strips));
  expect_kept(build_strip_framework(detailed, strips));
  expect_kept(build_view_dependent_mesh(detailed));
  expect_kept(rigged_tree(icosphere(320), 2));
  ASSERT_TRUE(write_model(build_progressive_mesh(detailed), path));
  const auto model = read_progressive_mesh(path);
  ASSERT_TRUE(model);
  expect_same_motion(model->attributes(), detailed.mesh);
}

}  // namespace
}  // namespace varifold::test
