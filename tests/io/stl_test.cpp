#include <varifold/io/stl.h>

#include <tests/io/io_support.h>
#include <tests/support/test_files.h>
#include <varifold/io/mesh_file.h>
#include <limits>

namespace varifold {
namespace {

using test::Binary;
using test::message_of;
using Indices = std::vector<std::uint32_t>;
using Warnings = std::vector<std::string>;

Result<ImportedMesh> read_text(std::string_view text) { return read_stl(as_bytes(text)); }

/// A binary STL of two triangles that share an edge; the header may be any text.
Binary two_facets(std::string_view header, std::uint32_t announced) {
  Binary file(header);
  for (std::size_t i = header.size(); i < 80; ++i) file.number(std::uint8_t{0});
  file.number(announced);
  const std::vector<Vec3> corners{{0, 0, 0}, {1, 0, 0}, {1, 1, 0},
                                  {1, 1, 0}, {0, 1, 0}, {-0.f, 0, 0}};
  for (std::size_t facet = 0; facet < 2; ++facet) {
    for (int i = 0; i < 3; ++i) file.number(std::numeric_limits<float>::quiet_NaN());
    for (std::size_t corner = 0; corner < 3; ++corner)
      for (int i = 0; i < 3; ++i) file.number(corners[3 * facet + corner][i]);
    file.number(std::uint16_t{0});
  }
  return file;
}

TEST(Stl, ReadsBinaryAndWelds) {
  for (const std::string_view header : {"", "solid facet by a confused exporter"}) {
    VARIFOLD_ASSERT_VALUE(imported, read_stl(two_facets(header, 2).bytes()));
    EXPECT_EQ(imported.mesh.positions,
              (std::vector<Vec3>{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}));
    EXPECT_EQ(imported.mesh.indices, (Indices{0, 1, 2, 2, 3, 0}));
    EXPECT_TRUE(imported.warnings.empty());
  }
}

TEST(Stl, WarnsOfBytesThatAreDropped) {
  Binary file = two_facets("", 2);
  file.text("abc");
  VARIFOLD_ASSERT_VALUE(imported, read_stl(file.bytes()));
  EXPECT_EQ(imported.warnings, Warnings{"3 bytes after the last facet"});

  std::vector<std::byte> colored = two_facets("", 2).bytes();
  colored.back() = std::byte{0x80};
  VARIFOLD_ASSERT_VALUE(with_colors, read_stl(colored));
  EXPECT_EQ(with_colors.warnings, Warnings{"1 facets have attribute bytes, which were dropped"});
}

TEST(Stl, ReadsAsciiWithSeveralSolids) {
  VARIFOLD_ASSERT_VALUE(
      imported, read_text("solid first part\n"
                          "facet normal 0 0 1\n outer loop\n  vertex 0 0 0\n  vertex 1 0 0\n"
                          "  vertex 0 1e0 0\n endloop\nendfacet\n"
                          "endsolid first part\r\n"
                          "SOLID\r\n"
                          "FACET NORMAL nan - #\r\nOUTER LOOP\r\nVERTEX 1 0 0\r\nVERTEX 0 0 0\r\n"
                          "VERTEX 0 0 1\r\nENDLOOP\r\nENDFACET\r\nENDSOLID"));
  EXPECT_EQ(imported.mesh.positions,
            (std::vector<Vec3>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}));
  EXPECT_EQ(imported.mesh.indices, (Indices{0, 1, 2, 1, 0, 3}));
  EXPECT_TRUE(imported.warnings.empty());
}

TEST(Stl, NamesThePlaceOfEveryFault) {
  EXPECT_EQ(message_of(read_text("short")), "byte 5: the file ends in the header");
  EXPECT_EQ(message_of(read_stl(two_facets("", 3).bytes())),
            "byte 80: 3 facets are announced, but the file ends after 2");
  EXPECT_EQ(message_of(read_text("solid x\nfacet normal 0 0 1\nouter loop\nvertex 0 0 zero\n")),
            "line 4: expected a number instead of 'zero'");
  EXPECT_EQ(message_of(read_text("solid x\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\n")),
            "line 5: the file ends inside a facet");
  EXPECT_EQ(message_of(read_text("solid x\nfacet normal 0 0 1\nouter loop\nvertex 0 nan 0\n")),
            "line 4: position is not finite");
  EXPECT_EQ(message_of(read_text("solid x\nface\n")), "line 2: unexpected 'face'");

  std::vector<std::byte> bad = two_facets("", 2).bytes();
  store_little(bad.data() + 84 + 50 + 12, std::numeric_limits<float>::infinity());
  EXPECT_EQ(message_of(read_stl(bad)), "facet 1: position is not finite");
}

TEST(Stl, EveryTruncationOfABinaryFileIsAnError) {
  const std::vector<std::byte> whole = two_facets("", 2).bytes();
  for (std::size_t size = 0; size < whole.size(); ++size)
    EXPECT_FALSE(read_stl(std::span(whole).first(size)).has_value()) << size;
}

TEST(Stl, ReadsThePrintedPart) {
  VARIFOLD_REAL_MESH_OR_SKIP(path, "58011.stl");
  VARIFOLD_ASSERT_VALUE(imported, read_mesh(path));
  test::expect_sound(imported.mesh);
  EXPECT_EQ(imported.mesh.triangle_count(), 26430u);
}

}  // namespace
}  // namespace varifold
