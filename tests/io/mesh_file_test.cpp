#include <varifold/io/mesh_file.h>

#include <tests/io/io_support.h>
#include <tests/strip/oriented_triangles.h>
#include <tests/support/meshes.h>
#include <tests/support/rigged_meshes.h>
#include <tests/support/test_files.h>
#include <varifold/io/gltf.h>
#include <varifold/io/mapped_file.h>
#include <varifold/io/output_file.h>
#include <varifold/io/ply.h>
#include <varifold/mesh/weld.h>
#include <varifold/strip/stripify.h>
#include <algorithm>
#include <chrono>

namespace varifold {
namespace {

namespace fs = std::filesystem;
using test::message_of;

std::optional<MeshFormat> format_of(std::string_view content, const fs::path& path) {
  return mesh_format(as_bytes(content), path);
}

TEST(MeshFile, TellsFormatsByContentFirst) {
  EXPECT_EQ(format_of("ply\nformat ascii 1.0\n", "a.obj"), MeshFormat::kPly);
  EXPECT_EQ(format_of("glTF\2", "a.gltf"), MeshFormat::kGlb);
  EXPECT_EQ(format_of(" \n{\"asset\"", "a.ply"), MeshFormat::kGltf);
  EXPECT_EQ(format_of("solid x\nfacet normal", "a"), MeshFormat::kStl);
  EXPECT_EQ(format_of(std::string(84, '\0'), "a.ply"), MeshFormat::kStl);
  EXPECT_EQ(format_of("v 0 0 0\n", "a.OBJ"), MeshFormat::kObj);
  EXPECT_EQ(format_of("solid as a rock", "a.obj"), MeshFormat::kObj);
  EXPECT_EQ(format_of("v 0 0 0\n", "a.off"), std::nullopt);
}

TEST(MeshFile, NamesTheFileInEveryError) {
  const test::TemporaryFolder folder;
  const auto error_of = [&](const std::string& name, std::string_view content) {
    const fs::path path = folder.file(name);
    EXPECT_TRUE(write_file(path, as_bytes(content)));
    const std::string message = message_of(read_mesh(path));
    EXPECT_TRUE(message.starts_with(path.string() + ": ")) << message;
    return message.substr(std::min(message.size(), path.string().size() + 2));
  };
  EXPECT_EQ(error_of("a.ply", "ply\nformat utf8\n"), "line 2: unknown format 'utf8'");
  EXPECT_EQ(error_of("a.obj", "v 1 2\n"), "line 1: 'v' needs 3 numbers");
  EXPECT_EQ(error_of("a.off", "OFF\n"),
            "not a mesh format; known are .ply, .obj, .stl, .gltf and .glb");
  EXPECT_EQ(error_of("a.ply.gz", "\x1f\x8b\b"), "compressed with gzip: unpack it first");
  EXPECT_EQ(error_of("a", ""), "the file is empty");
  EXPECT_EQ(message_of(read_mesh("no such.ply")), "no such.ply: No such file or directory");
}

TEST(MeshFile, WritesByExtensionAndReportsFailures) {
  const TriangleMesh mesh = test::mesh_with_everything();
  const test::TemporaryFolder folder;
  for (const char* name : {"a.ply", "a.glb"}) {
    ASSERT_TRUE(write_mesh(mesh, folder.file(name)).has_value());
    VARIFOLD_ASSERT_VALUE(imported, read_mesh(folder.file(name)));
    test::expect_same_geometry(imported.mesh, mesh);
  }
  ASSERT_TRUE(write_mesh(mesh, folder.file("a.obj")).has_value());
  EXPECT_EQ(message_of(write_mesh(mesh, "a.stl")),
            "a.stl: cannot write this format; known are .ply, .obj and .glb");
  const fs::path missing = folder.file("none/a.ply");
  EXPECT_EQ(message_of(write_mesh(mesh, missing)),
            missing.string() + ": No such file or directory");
  // A link gives the device, which is always full, an extension.
  if (!fs::exists("/dev/full")) return;
  for (const char* name : {"full.ply", "full.obj", "full.glb"}) {
    fs::create_symlink("/dev/full", folder.file(name));
    EXPECT_EQ(message_of(write_mesh(mesh, folder.file(name))),
              folder.file(name).string() + ": No space left on device");
  }
}

TEST(MeshFile, TellsWhatAFormatCannotHold) {
  TriangleMesh mesh = test::mesh_with_everything();
  mesh.materials.resize(1);
  EXPECT_EQ(unwritten_parts(mesh, MeshFormat::kPly), std::vector<std::string>{"materials"});
  EXPECT_EQ(unwritten_parts(mesh, MeshFormat::kObj),
            std::vector<std::string>{"alpha of vertex colours"});
  EXPECT_TRUE(unwritten_parts(mesh, MeshFormat::kGlb).empty());
  mesh = test::with_random_rig(test::octahedron(), 1);
  for (const MeshFormat format : {MeshFormat::kPly, MeshFormat::kObj})
    EXPECT_EQ(unwritten_parts(mesh, format),
              (std::vector<std::string>{"poses", "skin", "animations"}));
  EXPECT_TRUE(unwritten_parts(mesh, MeshFormat::kGlb).empty());
}

struct RealMesh {
  const char* name;
  std::uint32_t positions;  ///< distinct where the format makes several vertices of one
  std::uint32_t triangles;
};

class RealMeshes : public testing::TestWithParam<RealMesh> {};

TEST_P(RealMeshes, HaveTheCountsThatAreKnown) {
  VARIFOLD_REAL_MESH_OR_SKIP(path, GetParam().name);
  VARIFOLD_ASSERT_VALUE(imported, read_mesh(path));
  test::expect_sound(imported.mesh);
  EXPECT_EQ(imported.mesh.triangle_count(), GetParam().triangles);
  const bool has_seams = imported.mesh.has_normals() || imported.mesh.has_texcoords();
  EXPECT_EQ(
      has_seams ? weld_exact(imported.mesh.positions).class_count : imported.mesh.vertex_count(),
      GetParam().positions);
}

INSTANTIATE_TEST_SUITE_P(
    MeshFile, RealMeshes,
    testing::Values(RealMesh{"bunny.ply", 35947, 69451}, RealMesh{"dragon.ply", 437645, 871414},
                    RealMesh{"armadillo.ply", 43243, 86482}, RealMesh{"horse.ply", 48485, 96966},
                    RealMesh{"igea.ply", 134345, 268686}, RealMesh{"cow.obj", 2903, 5804},
                    RealMesh{"fandisk.obj", 6475, 12946}, RealMesh{"spot.obj", 2930, 5856},
                    RealMesh{"beetle.obj", 19887, 38656},
                    RealMesh{"mengerSponge3.glb", 7983, 21598},
                    RealMesh{"motorbike.ply", 132871, 331653}, RealMesh{"58011.stl", 13215, 26430},
                    RealMesh{"camel.ply", 21887, 43814},
                    RealMesh{"horse_poses/horse_01.ply", 8431, 16843}),
    [](const auto& instance) {
      std::string name = instance.param.name;
      std::replace_if(
          name.begin(), name.end(), [](char c) { return !std::isalnum(c); }, '_');
      return name;
    });

TEST(MeshFile, ReadsTheTexturedHelmet) {
  VARIFOLD_REAL_MESH_OR_SKIP(path, "DamagedHelmet.glb");
  VARIFOLD_ASSERT_VALUE(imported, read_mesh(path));
  test::expect_sound(imported.mesh);
  EXPECT_EQ(imported.mesh.vertex_count(), 14556u);
  EXPECT_EQ(imported.mesh.triangle_count(), 15452u);
  EXPECT_EQ(imported.mesh.images.size(), 5u);
  ASSERT_EQ(imported.mesh.materials.size(), 1u);
  for (const std::uint32_t image : imported.mesh.materials[0].textures)
    EXPECT_FALSE(imported.mesh.images.at(image).bytes.empty());
}

TEST(MeshFile, ReadsEveryBadFileInTimeAsAMeshOrAnError) {
  const auto folder = test::real_mesh("bad");
  if (!folder) GTEST_SKIP() << "no folder of bad meshes here";
  std::size_t files = 0;
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(*folder)) {
    if (!entry.is_regular_file()) continue;
    SCOPED_TRACE(entry.path().string());
    ++files;
    const auto start = std::chrono::steady_clock::now();
    const auto result = read_mesh(entry.path());
    const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
    EXPECT_LT(seconds.count(), 10);
    if (result)
      test::expect_sound(result->mesh);
    else
      EXPECT_TRUE(message_of(result).starts_with(entry.path().string() + ": "));
  }
  EXPECT_GE(files, 285u);
}

/// Every format reader, given every bad file whatever its format.
TEST(MeshFile, ReadersStandFilesOfOtherFormats) {
  const auto folder = test::real_mesh("bad");
  if (!folder) GTEST_SKIP() << "no folder of bad meshes here";
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(*folder)) {
    if (!entry.is_regular_file()) continue;
    SCOPED_TRACE(entry.path().string());
    VARIFOLD_ASSERT_VALUE(file, MappedFile::open(entry.path()));
    for (const MeshFormat format :
         {MeshFormat::kPly, MeshFormat::kObj, MeshFormat::kStl, MeshFormat::kGltf}) {
      const auto result = decode_mesh(file.bytes(), format);
      if (result)
        test::expect_sound(result->mesh);
      else
        EXPECT_FALSE(message_of(result).empty());
    }
  }
}

// Strips over the same vertices come back as the same triangles, by material where there are some.
TEST(MeshFile, StripsAreReadAsTheirTriangles) {
  for (const auto& [name, mesh] : test::all_groups()) {
    const TriangleStrips made = stripify(mesh);
    const auto wanted = test::oriented_triangles(mesh);
    const auto plain = [](TriangleMesh read) {
      read.ranges.clear();
      return test::oriented_triangles(read);
    };
    for (const StripJoin join : {StripJoin::kRestart, StripJoin::kDegenerate}) {
      const JoinedStrips strips = join_strips(made, mesh, join);
      for (const bool ascii : {false, true}) {
        VARIFOLD_ASSERT_VALUE(ply, read_ply(write_ply(mesh, {.ascii = ascii, .strips = &strips})));
        EXPECT_EQ(ply.mesh.positions, mesh.positions) << name;
        EXPECT_EQ(test::oriented_triangles(ply.mesh), plain(mesh)) << name;
      }
      if (join == StripJoin::kRestart || wanted.empty()) continue;
      VARIFOLD_ASSERT_VALUE(bytes, write_glb(mesh, &strips));
      EXPECT_NE(as_text(bytes).find("\"mode\":5"), std::string_view::npos) << name;
      VARIFOLD_ASSERT_VALUE(glb, read_gltf(bytes));
      EXPECT_EQ(glb.mesh.positions, mesh.positions) << name;
      EXPECT_EQ(test::oriented_triangles(glb.mesh), wanted) << name;
    }
  }
}

TEST(MeshFile, ObjHasNoStrips) {
  const TriangleMesh mesh = test::cube();
  const JoinedStrips strips = join_strips(stripify(mesh), mesh, StripJoin::kDegenerate);
  const test::TemporaryFolder folder;
  EXPECT_EQ(message_of(write_mesh(mesh, folder.file("a.obj"), &strips)),
            folder.file("a.obj").string() + ": the format has no strips");
  EXPECT_FALSE(fs::exists(folder.file("a.obj")));
}

}  // namespace
}  // namespace varifold
