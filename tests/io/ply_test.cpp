#include <varifold/io/ply.h>

#include <tests/io/io_support.h>
#include <tests/support/test_files.h>
#include <varifold/io/mapped_file.h>
#include <chrono>
#include <limits>

namespace varifold {
namespace {

using test::Binary;
using test::message_of;

Result<ImportedMesh> read_text(std::string_view text) { return read_ply(as_bytes(text)); }

using Indices = std::vector<std::uint32_t>;

TEST(Ply, ReadsAsciiWithAnyPropertyOrderAndUnknownParts) {
  VARIFOLD_ASSERT_VALUE(imported, read_text("ply\n"
                                            "format ascii 1.0\n"
                                            "comment made by hand\n"
                                            "element material 1\n"
                                            "property list uchar int ids\n"
                                            "property float gloss\n"
                                            "element vertex 3\n"
                                            "property double z\n"
                                            "property list uchar uchar tags\n"
                                            "property float x\n"
                                            "property short y\n"
                                            "element face 1\n"
                                            "property uchar flags\n"
                                            "property list uchar int vertex_index\n"
                                            "end_header\n"
                                            "2 7 8 0.5\n"
                                            "1 0 2 3\n"
                                            "4 2 9 9 5 6\n"
                                            "7 0 +8e0 9\n"
                                            "0 3 2 1 0\n"));
  EXPECT_EQ(imported.mesh.positions, (std::vector<Vec3>{{2, 3, 1}, {5, 6, 4}, {8, 9, 7}}));
  EXPECT_EQ(imported.mesh.indices, (Indices{2, 1, 0}));
  EXPECT_EQ(imported.warnings,
            (std::vector<std::string>{"element 'material' was dropped",
                                      "1 properties of the vertices were dropped: 'tags'"}));
}

constexpr std::string_view kFullHeader =
    "element vertex 3\n"
    "property float x\nproperty float y\nproperty float z\n"
    "property float nx\nproperty float ny\nproperty float nz\n"
    "property float texture_u\nproperty float texture_v\n"
    "property uchar red\nproperty uchar green\nproperty uchar blue\n"
    "element face 1\nproperty list uchar int vertex_indices\nend_header\n";

std::string full_header(std::string_view format) {
  return "ply\nformat " + std::string(format) + " 1.0\n" + std::string(kFullHeader);
}

void expect_full(const Result<ImportedMesh>& result) {
  ASSERT_TRUE(result.has_value()) << result.error().message;
  const TriangleMesh& mesh = result->mesh;
  EXPECT_EQ(mesh.positions, (std::vector<Vec3>{{0, 1, 2}, {1, 2, 3}, {2, 3, 4}}));
  EXPECT_EQ(mesh.normals, (std::vector<Vec3>{{0, 0, 1}, {0, 1, 0}, {1, 0, 0}}));
  EXPECT_EQ(mesh.texcoords, (std::vector<Vec2>{{0, 0.5f}, {0.25f, 0.5f}, {0.5f, 0.5f}}));
  EXPECT_EQ(mesh.colors,
            (std::vector<Color>{{0, 1, 2, 255}, {10, 11, 12, 255}, {20, 21, 22, 255}}));
  EXPECT_EQ(mesh.indices, (Indices{0, 1, 2}));
  EXPECT_TRUE(result->warnings.empty());
}

TEST(Ply, ReadsAllAttributesFromAscii) {
  expect_full(read_text(full_header("ascii") +
                        "0 1 2 0 0 1 0 .5 0 1 2\n1 2 3 0 1 0 .25 .5 10 11 12\n"
                        "2 3 4 1 0 0 .5 .5 20 21 22\n3 0 1 2\n"));
}

TEST(Ply, ReadsAllAttributesFromBothByteOrders) {
  Binary little(full_header("binary_little_endian"));
  Binary big(full_header("binary_big_endian"));
  const auto number = [&](auto value) {
    little.number(value);
    big.big(value);
  };
  for (int v = 0; v < 3; ++v) {
    for (const int i : {0, 1, 2}) number(static_cast<float>(v + i));
    for (const int i : {0, 1, 2}) number(i == 2 - v ? 1.0f : 0.0f);
    number(0.25f * static_cast<float>(v));
    number(0.5f);
    for (const int i : {0, 1, 2}) number(static_cast<std::uint8_t>(10 * v + i));
  }
  number(std::uint8_t{3});
  for (const std::int32_t i : {0, 1, 2}) number(i);
  expect_full(read_ply(little.bytes()));
  expect_full(read_ply(big.bytes()));
}

TEST(Ply, ReadsEveryScalarTypeInBinary) {
  Binary file(
      "ply\nformat binary_big_endian 1.0\nelement vertex 3\n"
      "property int8 a\nproperty uint8 b\nproperty int16 x\nproperty uint16 y\nproperty int32 c\n"
      "property uint32 d\nproperty float32 e\nproperty float64 z\n"
      "element face 1\nproperty list uint16 int16 vertex_indices\nend_header\n");
  for (int v = 0; v < 3; ++v) {
    file.number(std::int8_t{1}).number(std::uint8_t{2});
    file.big(static_cast<std::int16_t>(-v)).big(static_cast<std::uint16_t>(40000 + v));
    file.big(std::int32_t{5}).big(std::uint32_t{6}).big(7.0f).big(0.125 * v);
  }
  file.big(std::uint16_t{3});
  for (const std::int16_t i : {2, 0, 1}) file.big(i);
  VARIFOLD_ASSERT_VALUE(imported, read_ply(file.bytes()));
  EXPECT_EQ(imported.mesh.positions,
            (std::vector<Vec3>{{0, 40000, 0}, {-1, 40001, .125f}, {-2, 40002, .25f}}));
  EXPECT_EQ(imported.mesh.indices, (Indices{2, 0, 1}));
}

TEST(Ply, ReadsBinaryListsInTheVertexRow) {
  Binary file(
      "ply\nformat binary_little_endian 1.0\nelement vertex 3\nproperty float x\n"
      "property list uchar short extra\nproperty float y\nproperty float z\n"
      "element face 1\nproperty list int uchar other\nproperty list uchar uchar vertex_indices\n"
      "property short tail\nend_header\n");
  for (std::uint8_t v = 0; v < 3; ++v) {
    file.number(1.0f + v).number(v);
    for (int i = 0; i < v; ++i) file.number(std::int16_t{77});
    file.number(2.0f).number(3.0f);
  }
  file.number(std::int32_t{2}).text("ab").text(std::string_view("\3\0\1\2", 4)).text("xy");
  VARIFOLD_ASSERT_VALUE(imported, read_ply(file.bytes()));
  EXPECT_EQ(imported.mesh.positions, (std::vector<Vec3>{{1, 2, 3}, {2, 2, 3}, {3, 2, 3}}));
  EXPECT_EQ(imported.mesh.indices, (Indices{0, 1, 2}));
}

TEST(Ply, ScalesColoursOf16BitsAndFloats) {
  VARIFOLD_ASSERT_VALUE(
      shorts, read_text("ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float "
                        "y\nproperty float z\nproperty ushort red\nproperty ushort green\n"
                        "property ushort blue\nproperty ushort alpha\nend_header\n"
                        "0 0 0 0 32896 65535 257\n"));
  EXPECT_EQ(shorts.mesh.colors, (std::vector<Color>{{0, 128, 255, 1}}));
  VARIFOLD_ASSERT_VALUE(
      floats, read_text("ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float "
                        "y\nproperty float z\nproperty float red\nproperty float green\n"
                        "property float blue\nproperty float alpha\nend_header\n"
                        "0 0 0 -1 0.5 7 nan\n"));
  EXPECT_EQ(floats.mesh.colors, (std::vector<Color>{{0, 128, 255, 0}}));
  EXPECT_EQ(floats.warnings[0], "1 components of colours that are not finite became 0");
}

constexpr std::string_view kFourPoints =
    "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\n"
    "property float z\n";

std::string with_faces(std::string_view rest) {
  return std::string(kFourPoints) + std::string(rest);
}

TEST(Ply, CutsPolygonsAndDropsDegenerateOnes) {
  VARIFOLD_ASSERT_VALUE(
      imported, read_text(with_faces("element face 4\nproperty list uchar int vertex_indices\n"
                                     "end_header\n0 0 0 1 0 0 1 1 0 0 1 0\n"
                                     "4 0 1 2 3\n2 0 1\n0\n3 0 1 2\n")));
  EXPECT_EQ(imported.mesh.indices, (Indices{0, 1, 2, 0, 2, 3, 0, 1, 2}));
  EXPECT_EQ(imported.warnings,
            (std::vector<std::string>{"1 polygons with more than 3 corners were cut into triangles",
                                      "2 polygons with fewer than 3 corners were dropped"}));
}

TEST(Ply, CutsConcavePolygonsInside) {
  // An arrowhead: the fan around corner 0 would leave it at corner 2.
  //   1       3
  //    \ \ / /
  //     \ 2 /
  //       0
  VARIFOLD_ASSERT_VALUE(
      imported, read_text(with_faces("element face 1\nproperty list uchar int vertex_indices\n"
                                     "end_header\n-1 2 0 0 1 0 1 2 0 0 0 0\n4 0 3 2 1\n")));
  const TriangleMesh& mesh = imported.mesh;
  ASSERT_EQ(mesh.triangle_count(), 2u);
  for (int t = 0; t < 2; ++t) {
    const Vec3 a = mesh.positions[mesh.indices[3 * t]];
    const Vec3 b = mesh.positions[mesh.indices[3 * t + 1]];
    const Vec3 c = mesh.positions[mesh.indices[3 * t + 2]];
    EXPECT_GT(glm::cross(b - a, c - a).z, 0);
  }
}

TEST(Ply, ReadsTristripsWithRestartsAndDegenerates) {
  Binary file(
      "ply\nformat binary_little_endian 1.0\nelement vertex 5\nproperty float x\n"
      "property float y\nproperty float z\nelement tristrips 1\n"
      "property list int int vertex_indices\nend_header\n");
  for (int i = 0; i < 15; ++i) file.number(static_cast<float>(i));
  const std::vector<std::int32_t> strip{0, 1, 2, 3, 3, 4, -1, 2, 3, 4, -1, 1, 2};
  file.number(static_cast<std::int32_t>(strip.size()));
  for (const std::int32_t i : strip) file.number(i);
  VARIFOLD_ASSERT_VALUE(imported, read_ply(file.bytes()));
  EXPECT_EQ(imported.mesh.indices, (Indices{0, 1, 2, 2, 1, 3, 2, 3, 4}));
}

TEST(Ply, AllowsPointCloudsWithAWarning) {
  VARIFOLD_ASSERT_VALUE(imported, read_text(with_faces("end_header\n0 0 0 1 1 1 2 2 2 3 3 3\n")));
  EXPECT_EQ(imported.mesh.positions.size(), 4u);
  EXPECT_EQ(imported.warnings, std::vector<std::string>{"no triangles"});
}

TEST(Ply, ReadsAllLineEnds) {
  std::string text = with_faces("end_header\n0 0 0\n1 1 1\n2 2 2\n3 3 3\n");
  std::string crlf;
  for (const char c : text) crlf += c == '\n' ? std::string("\r\n") : std::string(1, c);
  EXPECT_EQ(read_text(crlf)->mesh.positions.size(), 4u);

  // With lines that end in CR alone, a body that begins with the byte of LF belongs to the body.
  std::string header =
      "ply\rformat binary_little_endian 1.0\relement vertex 1\rproperty uchar x\r"
      "property uchar y\rproperty uchar z\rend_header\r";
  EXPECT_EQ(read_text(header + "\n\1\2")->mesh.positions[0], Vec3(10, 1, 2));
}

TEST(Ply, NamesThePlaceOfEveryFault) {
  EXPECT_EQ(message_of(read_text("")), "line 1: does not begin with 'ply'");
  EXPECT_EQ(message_of(read_text("ply\nformat ascii 1.0\nelement vertex x\n")),
            "line 3: 'element' needs a name and a count");
  EXPECT_EQ(message_of(read_text("ply\nformat ascii 1.0\nelement vertex 1\nproperty real x\n")),
            "line 4: unknown type 'real'");
  EXPECT_EQ(message_of(read_text("ply\nformat ascii 1.0\nend_header\n")), "no element 'vertex'");
  EXPECT_EQ(message_of(read_text(with_faces("end_header\n0 0 0\n1 1 1\n2 x 2\n3 3 3\n"))),
            "line 10: expected a number instead of 'x'");
  EXPECT_EQ(message_of(read_text(with_faces("end_header\n0 0 0\n1 1 1\n2 nan 2\n3 3 3\n"))),
            "vertex 2: position is not finite");
  EXPECT_EQ(message_of(read_text(with_faces("element face 1\nproperty list uchar int vertex_index\n"
                                            "end_header\n0 0 0\n1 1 1\n2 2 2\n3 3 3\n3 0 1 4\n"))),
            "line 14: vertex index 4 is out of range (4 vertices)");
  EXPECT_EQ(message_of(read_text("ply\nformat ascii 1.0\nelement vertex 4000000000\n"
                                 "property float x\nproperty float y\nproperty float z\n"
                                 "end_header\n0 0 0\n")),
            "line 8: element 'vertex' has 4000000000 rows, but there are only 6 bytes left");
  EXPECT_EQ(message_of(read_text("ply\nformat binary_little_endian 1.0\nelement vertex 2\n"
                                 "property uchar x\nproperty uchar y\nproperty uchar z\n"
                                 "end_header\n12345")),
            "byte 115: element 'vertex' has 2 rows, but there are only 5 bytes left");
}

TEST(Ply, EveryTruncationIsAnErrorOrSound) {
  const TriangleMesh mesh = test::mesh_with_everything();
  for (const bool ascii : {false, true}) {
    const std::vector<std::byte> whole = write_ply(mesh, {.ascii = ascii});
    for (std::size_t size = 0; size + 2 < whole.size(); ++size) {
      const auto result = read_ply(std::span(whole).first(size));
      EXPECT_FALSE(result.has_value()) << size;
    }
  }
}

TEST(Ply, RoundTripsExactly) {
  TriangleMesh mesh = test::mesh_with_everything();
  for (const bool ascii : {false, true}) {
    VARIFOLD_ASSERT_VALUE(imported, read_ply(write_ply(mesh, {.ascii = ascii})));
    test::expect_same_geometry(imported.mesh, mesh);
  }
  mesh.normals.clear();
  mesh.texcoords.clear();
  mesh.colors.clear();
  VARIFOLD_ASSERT_VALUE(imported, read_ply(write_ply(mesh)));
  test::expect_same_geometry(imported.mesh, mesh);
}

TEST(Ply, KeepsOneTextureFile) {
  TriangleMesh mesh = test::mesh_with_everything();
  mesh.images.push_back({"", "", "skin of the cow.png", {}});
  mesh.materials.emplace_back();
  mesh.materials[0].textures[0] = 0;
  mesh.ranges = {{0, 0, 2}};
  VARIFOLD_ASSERT_VALUE(imported, read_ply(write_ply(mesh)));
  ASSERT_EQ(imported.mesh.images.size(), 1u);
  EXPECT_EQ(imported.mesh.images[0].uri, "skin of the cow.png");
  EXPECT_EQ(imported.mesh.ranges, mesh.ranges);
  EXPECT_EQ(imported.mesh.texcoords[1], mesh.texcoords[1]);
  // In the file, images begin at the lower left.
  const std::vector<std::byte> text = write_ply(mesh, {.ascii = true});
  EXPECT_NE(as_text(text).find("\n1 0 0 0 1 0 1 1 "), std::string::npos) << as_text(text);
}

TEST(Ply, ReadsTheDragonFast) {
  VARIFOLD_REAL_MESH_OR_SKIP(path, "dragon.ply");
  const auto start = std::chrono::steady_clock::now();
  VARIFOLD_ASSERT_VALUE(file, MappedFile::open(path));
  VARIFOLD_ASSERT_VALUE(imported, read_ply(file.bytes()));
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
  EXPECT_EQ(imported.mesh.vertex_count(), 437645u);
  EXPECT_EQ(imported.mesh.triangle_count(), 871414u);
  RecordProperty("megabytes_per_second",
                 std::to_string(static_cast<double>(file.bytes().size()) / seconds.count() / 1e6));
}

}  // namespace
}  // namespace varifold
