#include <varifold/io/obj.h>

#include <tests/io/io_support.h>
#include <tests/support/test_files.h>
#include <varifold/io/mesh_file.h>
#include <varifold/io/output_file.h>

namespace varifold {
namespace {

using test::message_of;
using Indices = std::vector<std::uint32_t>;
using Warnings = std::vector<std::string>;

Result<ImportedMesh> read_text(std::string_view text) { return read_obj(as_bytes(text)); }

TEST(Obj, KeepsTheVerticesOfPlainFiles) {
  VARIFOLD_ASSERT_VALUE(imported, read_text("# a comment\n"
                                            "o thing\r\n"
                                            "v 0 0 0\n"
                                            "v\t1 0 0 # the x axis\n"
                                            "  v 0 1 0\n"
                                            "v 9 9 9\n"
                                            "v 0 0 1 1.0\n"
                                            "g side\ns off\n"
                                            "f 1 2 3\n"
                                            "f -5 -4 \\\n -1\n"));
  EXPECT_EQ(imported.mesh.positions,
            (std::vector<Vec3>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {9, 9, 9}, {0, 0, 1}}));
  EXPECT_EQ(imported.mesh.indices, (Indices{0, 1, 2, 0, 1, 4}));
  EXPECT_FALSE(imported.mesh.has_colors());
  EXPECT_TRUE(imported.warnings.empty());
}

TEST(Obj, SplitsVerticesByTheirTriples) {
  // A square with a texture seam along its diagonal 1-3.
  VARIFOLD_ASSERT_VALUE(imported, read_text("v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n"
                                            "vt 0 0\nvt 1 0.25\nvt 0.5 1 0\n"
                                            "vn 0 0 1\n"
                                            "f 1/1/1 2/2/1 3/3/1\n"
                                            "f 1/1/1 3/2/1 4/-1/-1\n"));
  EXPECT_EQ(imported.mesh.indices, (Indices{0, 1, 2, 0, 3, 4}));
  EXPECT_EQ(imported.mesh.positions,
            (std::vector<Vec3>{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {1, 1, 0}, {0, 1, 0}}));
  EXPECT_EQ(imported.mesh.texcoords,
            (std::vector<Vec2>{{0, 1}, {1, 0.75f}, {0.5f, 0}, {1, 0.75f}, {0.5f, 0}}));
  EXPECT_EQ(imported.mesh.normals, std::vector<Vec3>(5, {0, 0, 1}));
}

TEST(Obj, FillsMissingAttributesOfCorners) {
  VARIFOLD_ASSERT_VALUE(imported, read_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nv 5 5 5\n"
                                            "vt 1 1\nvn 0 0 1\n"
                                            "f 1 2 3\nf 1//1 2/1 3/1/1\nf 1/ 2// 3\n"));
  EXPECT_EQ(imported.mesh.indices, (Indices{0, 1, 2, 3, 4, 5, 0, 1, 2}));
  EXPECT_EQ(imported.mesh.normals[3], Vec3(0, 0, 1));
  EXPECT_EQ(imported.mesh.normals[0], Vec3(0, 0, 1));
  EXPECT_EQ(imported.mesh.texcoords[4], Vec2(1, 0));
  EXPECT_EQ(imported.warnings, (Warnings{"1 vertices that no face uses were dropped",
                                         "4 vertices without texture coordinate got (0, 0)",
                                         "4 vertices without normal got that of their triangles"}));
}

TEST(Obj, ReadsVertexColours) {
  VARIFOLD_ASSERT_VALUE(imported,
                        read_text("v 0 0 0\nv 1 0 0 1 0.5 0\nv 0 1 0 0 0 1 0\nv 1 1 1\nf 1 2 3\n"));
  EXPECT_EQ(imported.mesh.colors,
            (std::vector<Color>{
                {255, 255, 255, 255}, {255, 128, 0, 255}, {0, 0, 255, 0}, {255, 255, 255, 255}}));
}

TEST(Obj, CutsConcavePolygons) {
  // An L of six corners, listed so that the fan around the first corner leaves it.
  VARIFOLD_ASSERT_VALUE(imported, read_text("v 2 0 0\nv 2 1 0\nv 1 1 0\nv 1 2 0\nv 0 2 0\n"
                                            "v 0 0 0\nf 1 2 3 4 5 6\n"));
  const TriangleMesh& mesh = imported.mesh;
  ASSERT_EQ(mesh.triangle_count(), 4u);
  float area = 0;
  for (std::size_t t = 0; t < 4; ++t) {
    const Vec3 a = mesh.positions[mesh.indices[3 * t]];
    const Vec3 b = mesh.positions[mesh.indices[3 * t + 1]];
    const Vec3 c = mesh.positions[mesh.indices[3 * t + 2]];
    EXPECT_GE(glm::cross(b - a, c - a).z, 0);
    area += glm::cross(b - a, c - a).z / 2;
  }
  EXPECT_EQ(area, 3);
}

TEST(Obj, CutsHugePolygonsInTime) {
  // A zigzag of 40000 teeth whose closing edge crosses them.
  std::string text;
  std::string face = "f";
  constexpr int kTeeth = 40000;
  for (int i = 0; i < kTeeth; ++i) {
    const std::string x = std::to_string(i);
    text.append("v ").append(x).append(" 0 0\nv ").append(x).append(".5 9 0\n");
    face.append(" ").append(std::to_string(2 * i + 1));
    face.append(" ").append(std::to_string(2 * i + 2));
  }
  VARIFOLD_ASSERT_VALUE(imported, read_text(text + face + "\n"));
  EXPECT_EQ(imported.mesh.triangle_count(), 2 * kTeeth - 2u);
}

TEST(Obj, ReadsMaterialsAndSortsTrianglesByThem) {
  const test::TemporaryFolder folder;
  ASSERT_TRUE(write_file(folder.file("paints.mtl"),
                         as_bytes("# paints\nnewmtl red paint\nKd 1 0 0.5\nd 0.25\n"
                                  "map_Kd -s 1 1 1 skin.png\nnewmtl dull\nKe 0 0 1\nPr 0.5\n")));
  const auto path = folder.file("a.obj");
  ASSERT_TRUE(write_file(path, as_bytes("mtllib paints.mtl missing.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\n"
                                        "f 1 2 3\nusemtl dull\nf 2 3 1\nusemtl red paint\n"
                                        "f 3 1 2\nusemtl dull\nf 1 2 3\nusemtl other\nf 1 2 3\n")));
  VARIFOLD_ASSERT_VALUE(imported, read_mesh(path));
  const TriangleMesh& mesh = imported.mesh;
  test::expect_sound(mesh);
  ASSERT_EQ(mesh.materials.size(), 4u);
  EXPECT_EQ(mesh.ranges, (std::vector<MaterialRange>{{0, 0, 1}, {1, 1, 2}, {2, 3, 1}, {3, 4, 1}}));
  EXPECT_EQ(mesh.indices, (Indices{0, 1, 2, 1, 2, 0, 0, 1, 2, 2, 0, 1, 0, 1, 2}));
  EXPECT_EQ(mesh.materials[0].name, "");
  EXPECT_EQ(mesh.materials[1].emissive, Vec3(0, 0, 1));
  EXPECT_EQ(mesh.materials[1].roughness, 0.5f);
  EXPECT_EQ(mesh.materials[2].name, "red paint");
  EXPECT_EQ(mesh.materials[2].base_color, Vec4(1, 0, 0.5f, 0.25f));
  EXPECT_EQ(mesh.materials[2].alpha_mode, "BLEND");
  ASSERT_EQ(mesh.images.size(), 1u);
  EXPECT_EQ(mesh.images[mesh.materials[2].textures[0]].uri, "skin.png");
  EXPECT_EQ(imported.warnings, (Warnings{"material file 'missing.mtl' does not exist",
                                         "1 materials are in no material file"}));
}

TEST(Obj, OpensNoFilesOutsideItsFolder) {
  const test::TemporaryFolder folder;
  const auto path = folder.file("a.obj");
  ASSERT_TRUE(write_file(path, as_bytes("mtllib ../secret.mtl /dev/zero\nv 0 0 0\n")));
  VARIFOLD_ASSERT_VALUE(imported, read_mesh(path));
  EXPECT_EQ(imported.warnings[0], "material file '../secret.mtl' leads out of the file's folder");
  EXPECT_EQ(imported.warnings[1], "material file '/dev/zero' leads out of the file's folder");
}

TEST(Obj, DropsWhatItDoesNotKnowWithWarnings) {
  VARIFOLD_ASSERT_VALUE(imported, read_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nl 1 2\np 1\ncurv2 1 2\n"
                                            "parm u 0 1\nf 1 2\nf 1 2 3\n"));
  EXPECT_EQ(imported.mesh.triangle_count(), 1u);
  EXPECT_EQ(imported.warnings, (Warnings{"1 polygons with fewer than 3 corners were dropped",
                                         "2 point and line elements were dropped",
                                         "2 lines were not understood, the first being 'curv2'"}));
}

TEST(Obj, NamesTheLineOfEveryFault) {
  EXPECT_EQ(message_of(read_text("hello\nworld\n")), "not a single OBJ statement");
  EXPECT_EQ(message_of(read_text("v 0 0 0\nv 1 x 0\n")),
            "line 2: expected a number instead of 'x'");
  EXPECT_EQ(message_of(read_text("v 0 0 0\r\nv 1 0\r\n")), "line 2: 'v' needs 3 numbers");
  EXPECT_EQ(message_of(read_text("\nv 0 inf 0\n")), "line 2: position is not finite");
  EXPECT_EQ(message_of(read_text("v 0 0 0\nf 1 0 1\n")),
            "line 2: vertex index 0 is out of range (1 so far)");
  EXPECT_EQ(message_of(read_text("v 0 0 0\nf 1 -2 1\n")),
            "line 2: vertex index -2 is out of range (1 so far)");
  EXPECT_EQ(message_of(read_text("v 0 0 0\nf 1 1 1\\\n 2\nf 1 1 1\n")),
            "line 3: vertex index 2 is out of range (the file has 1)");
  EXPECT_EQ(message_of(read_text("v 0 0 0\nvt 0 0\nf 1/1 1/2 1/1\n")),
            "line 3: texture coordinate index 2 is out of range (the file has 1)");
  EXPECT_EQ(message_of(read_text("v 0 0 0\nf 1/1/1/1 1 1\n")), "line 2: unexpected '/1' in a face");
  EXPECT_EQ(message_of(read_text("v 0 0 0\nf 99999999999999999999 1 1\n")),
            "line 2: expected an index instead of '99999999999999999999'");
}

TEST(Obj, RoundTripsExactly) {
  TriangleMesh mesh = test::mesh_with_everything();
  mesh.texcoords = {{0, 0}, {1, 0}, {1, 0.125f}, {0, 1}};
  for (Color& color : mesh.colors) color.a = 255;
  VARIFOLD_ASSERT_VALUE(all, read_obj(write_obj(mesh, "a").obj));
  test::expect_same_geometry(all.mesh, mesh);
  EXPECT_TRUE(write_obj(mesh, "a").materials.empty());

  mesh.normals.clear();
  VARIFOLD_ASSERT_VALUE(without_normals, read_obj(write_obj(mesh, "a").obj));
  test::expect_same_geometry(without_normals.mesh, mesh);

  // Without attributes that tell vertices apart, all stay, even doubles and unused ones.
  mesh.texcoords.clear();
  mesh.positions.push_back(mesh.positions[0]);
  mesh.colors.push_back(mesh.colors[0]);
  VARIFOLD_ASSERT_VALUE(plain, read_obj(write_obj(mesh, "a").obj));
  test::expect_same_geometry(plain.mesh, mesh);
}

TEST(Obj, SharesPositionsOfSeamsWhenWriting) {
  TriangleMesh mesh = test::mesh_with_everything();
  mesh.colors.clear();
  mesh.positions[3] = mesh.positions[0];
  const std::string text(as_text(write_obj(mesh, "a").obj));
  EXPECT_NE(text.find("f 1/1/1 3/3/3 1/4/4\n"), std::string::npos) << text;
}

TEST(Obj, RoundTripsMaterialsAndImages) {
  TriangleMesh mesh = test::mesh_with_everything();
  for (Color& color : mesh.colors) color.a = 255;
  mesh.images.push_back({"skin", "image/png", "", {1, 2, 3}});
  mesh.images.push_back({"", "", "glow map.jpg", {}});
  mesh.materials.resize(2);
  mesh.materials[0].name = "first one";
  mesh.materials[0].base_color = {0.1f, 0.2f, 0.3f, 0.5f};
  mesh.materials[0].textures[0] = 0;
  mesh.materials[1].metallic = 0.75f;
  mesh.materials[1].textures[static_cast<std::size_t>(TextureUse::kEmissive)] = 1;
  mesh.ranges = {{0, 0, 1}, {1, 1, 1}};
  const test::TemporaryFolder folder;
  ASSERT_TRUE(write_mesh(mesh, folder.file("b.obj")));
  VARIFOLD_ASSERT_VALUE(imported, read_mesh(folder.file("b.obj")));
  EXPECT_TRUE(imported.warnings.empty());
  EXPECT_EQ(imported.mesh.ranges, mesh.ranges);
  ASSERT_EQ(imported.mesh.materials.size(), 2u);
  EXPECT_EQ(imported.mesh.materials[0].name, "first_one");
  EXPECT_EQ(imported.mesh.materials[0].base_color, mesh.materials[0].base_color);
  EXPECT_EQ(imported.mesh.materials[1].metallic, 0.75f);
  EXPECT_EQ(imported.mesh.images[0].uri, "b_0.png");
  EXPECT_EQ(imported.mesh.images[1].uri, "glow map.jpg");
  EXPECT_EQ(std::filesystem::file_size(folder.file("b_0.png")), 3u);
}

}  // namespace
}  // namespace varifold
