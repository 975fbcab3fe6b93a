#include <varifold/io/pose_files.h>

#include <tests/io/io_support.h>
#include <tests/support/meshes.h>
#include <tests/support/test_files.h>
#include <varifold/base/random.h>
#include <varifold/io/mesh_file.h>
#include <varifold/io/output_file.h>

namespace varifold {
namespace {

namespace fs = std::filesystem;
using test::message_of;

/// Every vertex moved by a function of its place, so that equal places stay equal.
TriangleMesh bent(TriangleMesh mesh) {
  for (Vec3& p : mesh.positions) p = Vec3(p.x + 0.25f * p.y * p.y, p.y * 0.5f, p.z - p.x * p.y);
  return mesh;
}

class PoseFiles : public testing::Test {
 protected:
  fs::path text(const std::string& name, std::string_view content) {
    const fs::path path = folder_.file(name);
    EXPECT_TRUE(write_file(path, as_bytes(content)));
    return path;
  }
  fs::path mesh(const std::string& name, const TriangleMesh& mesh) {
    const fs::path path = folder_.file(name);
    EXPECT_TRUE(write_mesh(mesh, path));
    return path;
  }
  static Result<ImportedMesh> read(const fs::path& rest, const std::vector<fs::path>& poses) {
    return read_pose_files(rest, poses);
  }
  test::TemporaryFolder folder_;
};

TEST_F(PoseFiles, GiveThePlacesOfEveryFile) {
  for (const test::NamedMesh& group : test::all_groups()) {
    SCOPED_TRACE(group.name);
    const TriangleMesh moved = bent(group.mesh);
    for (const std::string extension : {".ply", ".obj"}) {
      if (extension == ".obj" && group.mesh.positions.empty()) continue;  // no OBJ file
      const fs::path rest = mesh("rest" + extension, group.mesh);
      const fs::path pose = mesh("Pose 1" + extension, moved);
      VARIFOLD_ASSERT_VALUE(read_rest, read_mesh(rest));
      VARIFOLD_ASSERT_VALUE(read_pose, read_mesh(pose));
      VARIFOLD_ASSERT_VALUE(found, read({rest}, {pose, rest}));
      test::expect_same_geometry(found.mesh, read_rest.mesh);
      ASSERT_EQ(found.mesh.poses.size(), 2u);
      EXPECT_EQ(found.mesh.poses[0],
                (Pose{"Pose 1", read_pose.mesh.positions, read_pose.mesh.normals}));
      EXPECT_EQ(found.mesh.poses[1],
                (Pose{"rest", read_rest.mesh.positions, read_rest.mesh.normals}));
    }
  }
}

TEST_F(PoseFiles, AreRefusedByNameWithTheFirstDifference) {
  const std::string head = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";
  const fs::path rest = text("rest.obj", head + "f 1 2 3\nf 1 3 4\n");
  const auto error_of = [&](std::string_view content) {
    const fs::path pose = text("pose.obj", content);
    const std::string message = message_of(read(rest, {rest, pose}));
    EXPECT_TRUE(message.starts_with(pose.string() + ": ")) << message;
    return message.substr(std::min(message.size(), pose.string().size() + 2));
  };
  const std::string in = ", in " + rest.string() + " ";
  EXPECT_EQ(error_of(head + "f 1 2 3\nf 1 4 3\n"), "triangle 1 is 0 3 2" + in + "0 2 3");
  EXPECT_EQ(error_of(head + "f 1 2 3\n"), "1 triangles" + in + "2");
  EXPECT_EQ(error_of(head + "v 0 0 0\nf 1 2 3\nf 1 3 4\n"), "5 vertices" + in + "4");
  EXPECT_EQ(error_of(head + "f 1 2 9\n"),
            "line 5: vertex index 9 is out of range (the file has 4)");
  EXPECT_EQ(message_of(read(rest, {"no such.ply"})), "no such.ply: No such file or directory");
}

TEST_F(PoseFiles, KeepTheSeamsOfTheMeshAtRest) {
  // The pose numbers its normals anew: one for both triangles where the mesh at rest has two.
  const std::string uv = "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n";
  const fs::path rest = text("rest.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n" + uv +
                                             "vn 0 0 1\nvn 0 1 0\n"
                                             "f 1/1/1 2/2/1 3/3/1\nf 1/1/2 3/3/2 4/4/2\n");
  const fs::path pose = text("pose.obj", "v 0 0 5\nv 1 0 6\nv 1 1 7\nv 0 1 8\n" + uv +
                                             "vn 1 0 0\n"
                                             "f 1/1/1 2/2/1 3/3/1\nf 1/1/1 3/3/1 4/4/1\n");
  VARIFOLD_ASSERT_VALUE(split, read(rest, {pose}));
  ASSERT_EQ(split.mesh.vertex_count(), 6u);
  EXPECT_EQ(split.mesh.poses[0].positions,
            (std::vector<Vec3>{{0, 0, 5}, {1, 0, 6}, {1, 1, 7}, {0, 0, 5}, {1, 1, 7}, {0, 1, 8}}));
  EXPECT_EQ(split.mesh.poses[0].normals, std::vector<Vec3>(6, Vec3(1, 0, 0)));
  EXPECT_TRUE(split.warnings.empty());

  // The other way round, a vertex gets the mean of the normals that its corners have.
  VARIFOLD_ASSERT_VALUE(merged, read(pose, {rest}));
  ASSERT_EQ(merged.mesh.vertex_count(), 4u);
  EXPECT_EQ(merged.mesh.poses[0].positions,
            (std::vector<Vec3>{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}));
  const Vec3 mean = glm::normalize(Vec3(0, 1, 1));
  EXPECT_EQ(merged.mesh.poses[0].normals,
            (std::vector<Vec3>{mean, Vec3(0, 0, 1), mean, Vec3(0, 1, 0)}));
}

TEST_F(PoseFiles, CutPolygonsAsTheMeshAtRest) {
  // A quadrilateral that is concave at corner 0 in one file and at corner 1 in the other.
  const std::string face = "f 1 2 3 4\n";
  const fs::path a = text("a.obj", "v 0.9 0.9 0\nv 0 1 0\nv 1 1 0\nv 1 0 0\nv 7 7 7\n" + face);
  const fs::path b = text("b.obj", "v 0 0 0\nv 0.6 0.4 0\nv 1 0 0\nv 0.5 1 0\nv 8 8 8\n" + face);
  VARIFOLD_ASSERT_VALUE(read_a, read_mesh(a));
  VARIFOLD_ASSERT_VALUE(read_b, read_mesh(b));
  ASSERT_NE(read_a.mesh.indices, read_b.mesh.indices) << "the test does not test";
  VARIFOLD_ASSERT_VALUE(found, read(a, {b}));
  EXPECT_EQ(found.mesh.indices, read_a.mesh.indices);
  EXPECT_EQ(found.mesh.poses[0].positions, read_b.mesh.positions);
}

TEST_F(PoseFiles, WarnOfOtherAttributes) {
  const std::string head = "v 0 0 0\nv 1 0 0\nv 1 1 0\n";
  const fs::path rest = text("rest.obj", head + "vt 0 0\nusemtl a\nf 1/1 2/1 3/1\n");
  const fs::path pose =
      text("pose.obj", head + "vt 0 1\nvn 0 0 1\nusemtl b\nf 1/1/1 2/1/1 3/1/1\n");
  VARIFOLD_ASSERT_VALUE(found, read(rest, {pose}));
  const std::string unknown = "1 materials are in no material file";
  const std::string those = " differ from those of " + rest.string() + ", and were dropped";
  EXPECT_EQ(
      found.warnings,
      (std::vector<std::string>{
          unknown, pose.string() + ": " + unknown, pose.string() + ": texture coordinates" + those,
          pose.string() + ": materials" + those,
          pose.string() + ": normals were dropped: " + rest.string() + " has none"}));
  EXPECT_TRUE(found.mesh.poses[0].normals.empty());
}

TEST_F(PoseFiles, ReadTheHorse) {
  VARIFOLD_REAL_MESH_OR_SKIP(rest, "horse_poses/horse_ref.ply");
  std::vector<fs::path> poses;
  for (int i = 1; i <= 10; ++i)
    poses.push_back(rest.parent_path() /
                    ((i < 10 ? "horse_0" : "horse_") + std::to_string(i) + ".ply"));
  VARIFOLD_ASSERT_VALUE(found, read_pose_files(rest, poses));
  ASSERT_EQ(found.mesh.poses.size(), 10u);
  EXPECT_TRUE(found.warnings.empty());
  for (std::size_t i = 0; i < poses.size(); ++i) {
    VARIFOLD_ASSERT_VALUE(pose, read_mesh(poses[i]));
    EXPECT_EQ(found.mesh.poses[i], (Pose{poses[i].stem().string(), pose.mesh.positions, {}}));
  }
}

}  // namespace
}  // namespace varifold
