#include <varifold/io/gltf.h>

#include <tests/io/io_support.h>
#include <tests/support/test_files.h>
#include <varifold/io/mesh_file.h>
#include <varifold/io/output_file.h>

namespace varifold {
namespace {

using test::Binary;
using test::message_of;
using Indices = std::vector<std::uint32_t>;
using Warnings = std::vector<std::string>;

constexpr std::string_view kAsset = R"("asset":{"version":"2.0"})";

/// A GLB of this JSON (an object without its braces, to which the asset is added) and binary chunk.
std::vector<std::byte> glb(const std::string& members, const Binary& binary) {
  std::string json = "{" + std::string(kAsset) + "," + members + "}";
  json.resize((json.size() + 3) / 4 * 4, ' ');
  std::vector<std::byte> padded = binary.bytes();
  padded.resize((padded.size() + 3) / 4 * 4);
  Binary file("glTF");
  file.number(std::uint32_t{2})
      .number(static_cast<std::uint32_t>(28 + json.size() + padded.size()));
  file.number(static_cast<std::uint32_t>(json.size())).text("JSON").text(json);
  file.number(static_cast<std::uint32_t>(padded.size())).text(std::string_view("BIN\0", 4));
  file.text(as_text(padded));
  return file.bytes();
}

Binary& floats(Binary& binary, const std::vector<float>& values) {
  for (const float value : values) binary.number(value);
  return binary;
}

/// Positions (accessor 0), normals (1) and 16-bit indices (2) of a triangle, with room for nodes.
std::vector<std::byte> triangle_with(const std::string& members) {
  Binary binary;
  floats(binary, {0, 0, 0, 1, 0, 0, 0, 1, 0});
  floats(binary, {0, 0, 1, 0, 0, 1, 0.6f, 0, 0.8f});
  for (const std::uint16_t i : {0, 1, 2}) binary.number(i);
  return glb(R"("buffers":[{"byteLength":78}],
    "bufferViews":[{"buffer":0,"byteLength":72},{"buffer":0,"byteOffset":72,"byteLength":6}],
    "accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"},
                 {"bufferView":0,"byteOffset":36,"componentType":5126,"count":3,"type":"VEC3"},
                 {"bufferView":1,"componentType":5123,"count":3,"type":"SCALAR"}],
    "meshes":[{"primitives":[{"attributes":{"POSITION":0,"NORMAL":1},"indices":2}]}],)" +
                 members,
             binary);
}

TEST(Gltf, ReadsATriangle) {
  VARIFOLD_ASSERT_VALUE(imported, read_gltf(triangle_with(R"("nodes":[{"mesh":0}])")));
  EXPECT_EQ(imported.mesh.positions, (std::vector<Vec3>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}));
  EXPECT_EQ(imported.mesh.normals[2], Vec3(0.6f, 0, 0.8f));
  EXPECT_EQ(imported.mesh.indices, (Indices{0, 1, 2}));
  EXPECT_TRUE(imported.mesh.ranges.empty());
  EXPECT_TRUE(imported.warnings.empty());
}

TEST(Gltf, MovesMeshesByTheirNodes) {
  // The root turns by 90 degrees about z; its child scales by (2, 1, 1) and moves before.
  VARIFOLD_ASSERT_VALUE(imported, read_gltf(triangle_with(
                                      R"("scene":1,"scenes":[{},{"nodes":[0]}],
             "nodes":[{"children":[2],"matrix":[0,1,0,0, -1,0,0,0, 0,0,1,0, 0,0,0,1]},{"mesh":0},
                      {"mesh":0,"translation":[10,0,0],"scale":[2,1,1]}])")));
  EXPECT_EQ(imported.mesh.positions, (std::vector<Vec3>{{0, 10, 0}, {0, 12, 0}, {-1, 10, 0}}));
  // The inverse transpose halves x before the turn: (0.3, 0, 0.8) normalised.
  const Vec3 normal = glm::normalize(Vec3(0, 0.3f, 0.8f));
  EXPECT_LT(glm::distance(imported.mesh.normals[2], normal), 1e-6f);
  EXPECT_EQ(imported.mesh.indices, (Indices{0, 1, 2}));
}

TEST(Gltf, FlipsTheWindingOfMirroredMeshes) {
  VARIFOLD_ASSERT_VALUE(imported, read_gltf(triangle_with(R"("nodes":[{"mesh":0,"scale":[-1,1,1]},
                                           {"mesh":0,"rotation":[0,0,1,0]}])")));
  EXPECT_EQ(imported.mesh.indices, (Indices{0, 2, 1, 3, 4, 5}));
  EXPECT_EQ(imported.mesh.positions[1], Vec3(-1, 0, 0));
  EXPECT_EQ(imported.mesh.positions[4], Vec3(-1, 0, 0));
  EXPECT_LT(glm::distance(imported.mesh.normals[2], Vec3(-0.6f, 0, 0.8f)), 1e-6f);
  EXPECT_LT(glm::distance(imported.mesh.normals[5], Vec3(-0.6f, 0, 0.8f)), 1e-6f);
}

TEST(Gltf, RefusesCyclesAndSharedNodesAndBearsDepth) {
  EXPECT_EQ(message_of(read_gltf(triangle_with(
                R"("scenes":[{"nodes":[0]}],"nodes":[{"children":[1]},{"children":[0]}])"))),
            "nodes[0]: is reached twice: nodes form a cycle, or one has two parents");
  EXPECT_EQ(message_of(read_gltf(triangle_with(R"("scenes":[{"nodes":[0,7]}],"nodes":[{}])"))),
            "nodes[7]: no such element (there are 1)");
  std::string chain = R"("nodes":[)";
  constexpr int kDepth = 20000;
  for (int i = 1; i < kDepth; ++i)
    chain.append(R"({"children":[)").append(std::to_string(i)).append("]},");
  VARIFOLD_ASSERT_VALUE(imported, read_gltf(triangle_with(chain + R"({"mesh":0}])")));
  EXPECT_EQ(imported.mesh.triangle_count(), 1u);
}

TEST(Gltf, ReadsInterleavedAndNormalizedAttributes) {
  // position: 3 floats, texture coordinate: 2 normalized shorts, colour: 3 normalized bytes, pad.
  Binary binary;
  for (std::uint16_t v = 0; v < 3; ++v) {
    floats(binary, {static_cast<float>(v), 1, 2});
    binary.number(static_cast<std::uint16_t>(v == 0 ? 0 : 65535)).number(std::uint16_t{13107});
    binary.number(static_cast<std::uint8_t>(100 + v)).text("\x01\xff_");
  }
  VARIFOLD_ASSERT_VALUE(imported, read_gltf(glb(R"("buffers":[{"byteLength":60}],
    "bufferViews":[{"buffer":0,"byteLength":60,"byteStride":20}],
    "accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"},
      {"bufferView":0,"byteOffset":12,"componentType":5123,"normalized":true,"count":3,"type":"VEC2"},
      {"bufferView":0,"byteOffset":16,"componentType":5121,"normalized":true,"count":3,"type":"VEC3"}],
    "meshes":[{"primitives":[{"attributes":{"POSITION":0,"TEXCOORD_0":1,"COLOR_0":2}}]}])",
                                                binary)));
  EXPECT_EQ(imported.mesh.positions, (std::vector<Vec3>{{0, 1, 2}, {1, 1, 2}, {2, 1, 2}}));
  EXPECT_EQ(imported.mesh.texcoords, (std::vector<Vec2>{{0, 0.2f}, {1, 0.2f}, {1, 0.2f}}));
  EXPECT_EQ(imported.mesh.colors,
            (std::vector<Color>{{100, 1, 255, 255}, {101, 1, 255, 255}, {102, 1, 255, 255}}));
  EXPECT_EQ(imported.mesh.indices, (Indices{0, 1, 2}));
}

TEST(Gltf, ReadsQuantizedPositions) {
  Binary binary;
  for (const std::int16_t value : {-300, 0, 7, 1, 2, 3, 32767, -32768, 0}) binary.number(value);
  VARIFOLD_ASSERT_VALUE(imported, read_gltf(glb(R"("extensionsRequired":["KHR_mesh_quantization"],
    "buffers":[{"byteLength":18}],"bufferViews":[{"buffer":0,"byteLength":18}],
    "accessors":[{"bufferView":0,"componentType":5122,"count":3,"type":"VEC3"},
                 {"bufferView":0,"componentType":5122,"normalized":true,"count":3,"type":"VEC3"}],
    "meshes":[{"primitives":[{"attributes":{"POSITION":0}}]},
              {"primitives":[{"attributes":{"POSITION":1}}]}])",
                                                binary)));
  EXPECT_EQ(imported.mesh.positions[0], Vec3(-300, 0, 7));
  EXPECT_EQ(imported.mesh.positions[5], Vec3(1, -1, 0));
}

TEST(Gltf, ReadsStripsAndFansOfAllIndexTypes) {
  Binary binary;
  floats(binary, {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0, 2, 2, 0});  // 60 bytes
  for (const std::uint8_t i : {0, 1, 2, 3, 3, 4, 0, 0}) binary.number(i);
  for (const std::uint32_t i : {0, 1, 2, 3}) binary.number(i);
  VARIFOLD_ASSERT_VALUE(
      imported,
      read_gltf(glb(R"("buffers":[{"byteLength":84}],"bufferViews":[{"buffer":0,"byteLength":84}],
    "accessors":[{"bufferView":0,"componentType":5126,"count":5,"type":"VEC3"},
                 {"bufferView":0,"byteOffset":60,"componentType":5121,"count":6,"type":"SCALAR"},
                 {"bufferView":0,"byteOffset":68,"componentType":5125,"count":4,"type":"SCALAR"}],
    "meshes":[{"primitives":[{"attributes":{"POSITION":0},"indices":1,"mode":5},
                             {"attributes":{"POSITION":0},"indices":2,"mode":6},
                             {"attributes":{"POSITION":0},"indices":2},
                             {"attributes":{"POSITION":0},"mode":0}]}])",
                    binary)));
  EXPECT_EQ(imported.mesh.positions.size(), 5u) << "primitives share the vertices";
  EXPECT_EQ(imported.mesh.indices, (Indices{0, 1, 2, 2, 1, 3, 0, 1, 2, 0, 2, 3, 0, 1, 2}));
  EXPECT_EQ(imported.warnings, (Warnings{"1 primitives of points or lines were dropped",
                                         "1 primitives end in an incomplete triangle"}));
}

TEST(Gltf, ReadsSparseAccessors) {
  Binary binary;
  floats(binary, {0, 0, 0, 1, 0, 0, 0, 1, 0});  // base
  floats(binary, {5, 6, 7});                    // replacement, at byte 36
  binary.number(std::uint8_t{2});               // index, at byte 48
  const std::string sparse =
      R"("sparse":{"count":1,"indices":{"bufferView":0,"byteOffset":48,"componentType":5121},
                   "values":{"bufferView":0,"byteOffset":36}}})";
  const std::string start =
      R"("buffers":[{"byteLength":49}],"bufferViews":[{"buffer":0,"byteLength":49}],
         "meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],"accessors":[)";
  const std::string rest = R"("componentType":5126,"count":3,"type":"VEC3",)" + sparse + "]";
  VARIFOLD_ASSERT_VALUE(based, read_gltf(glb(start + R"({"bufferView":0,)" + rest, binary)));
  EXPECT_EQ(based.mesh.positions, (std::vector<Vec3>{{0, 0, 0}, {1, 0, 0}, {5, 6, 7}}));
  VARIFOLD_ASSERT_VALUE(zero, read_gltf(glb(start + "{" + rest, binary)));
  EXPECT_EQ(zero.mesh.positions, (std::vector<Vec3>{{0, 0, 0}, {0, 0, 0}, {5, 6, 7}}));

  std::vector<std::byte> bad = binary.bytes();
  bad.back() = std::byte{3};
  EXPECT_EQ(message_of(read_gltf(glb(start + "{" + rest, Binary(as_text(bad))))),
            "accessors[0].sparse.indices: index 3 is out of range (3 elements)");
}

TEST(Gltf, ReadsBuffersFromFilesAndDataUris) {
  Binary positions;
  floats(positions, {0, 0, 0, 1, 0, 0, 0, 1, 0});
  const test::TemporaryFolder folder;
  ASSERT_TRUE(write_file(folder.file("a b.bin"), positions.bytes()));
  // Base64 of floats 0 0 0 1 0 0 0 1 0.
  const std::string data =
      "data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA";
  for (const std::string& uri : {std::string("a%20b.bin"), data}) {
    const std::string json =
        "{" + std::string(kAsset) + R"(,"buffers":[{"byteLength":36,"uri":")" + uri + R"("}],
        "bufferViews":[{"buffer":0,"byteLength":36}],
        "accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"}],
        "meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}]})";
    ASSERT_TRUE(write_file(folder.file("a.gltf"), as_bytes(json)));
    VARIFOLD_ASSERT_VALUE(imported, read_mesh(folder.file("a.gltf")));
    EXPECT_EQ(imported.mesh.positions, (std::vector<Vec3>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}));
  }
  std::filesystem::remove(folder.file("a b.bin"));
  const std::string json = "{" + std::string(kAsset) +
                           R"(,"buffers":[{"byteLength":36,"uri":"gone.bin"}],
        "bufferViews":[{"buffer":0,"byteLength":36}],
        "accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"}],
        "meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}]})";
  ASSERT_TRUE(write_file(folder.file("a.gltf"), as_bytes(json)));
  EXPECT_EQ(message_of(read_mesh(folder.file("a.gltf"))),
            folder.file("a.gltf").string() + ": buffers[0]: file 'gone.bin' does not exist");
}

TEST(Gltf, ReadsMaterialsAndImages) {
  const std::vector<std::byte> file = triangle_with(R"(
    "nodes":[{"mesh":0}],
    "images":[{"uri":"skin.png"},{"uri":"data:image/png;base64,AQID"},
              {"bufferView":1,"mimeType":"image/jpeg","name":"x"}],
    "textures":[{"source":2},{"source":1},{"extensions":{"EXT_texture_webp":{"source":0}}}],
    "materials":[{"name":"skin","doubleSided":true,"alphaMode":"MASK","alphaCutoff":0.25,
      "emissiveFactor":[0,0.5,1],"normalTexture":{"index":1},"occlusionTexture":{"index":2},
      "pbrMetallicRoughness":{"baseColorFactor":[1,0.5,0.25,1],"metallicFactor":0.5,
                              "baseColorTexture":{"index":0,"texCoord":1}}}])");
  VARIFOLD_ASSERT_VALUE(imported, read_gltf(file));
  const TriangleMesh& mesh = imported.mesh;
  test::expect_sound(mesh);
  // The primitive names no material: it gets the default one, after those of the file.
  EXPECT_EQ(mesh.ranges, (std::vector<MaterialRange>{{1, 0, 1}}));
  ASSERT_EQ(mesh.materials.size(), 2u);
  const Material& material = mesh.materials[0];
  EXPECT_EQ(material.name, "skin");
  EXPECT_TRUE(material.double_sided);
  EXPECT_EQ(material.alpha_mode, "MASK");
  EXPECT_EQ(material.alpha_cutoff, 0.25f);
  EXPECT_EQ(material.emissive, Vec3(0, 0.5f, 1));
  EXPECT_EQ(material.base_color, Vec4(1, 0.5f, 0.25f, 1));
  EXPECT_EQ(material.metallic, 0.5f);
  EXPECT_EQ(material.roughness, 1);
  EXPECT_EQ(material.textures, (std::array<std::uint32_t, 5>{2, kNone, 1, 0, kNone}));
  ASSERT_EQ(mesh.images.size(), 3u);
  EXPECT_EQ(mesh.images[0].uri, "skin.png");
  EXPECT_EQ(mesh.images[1].mime_type, "image/png");
  EXPECT_EQ(mesh.images[1].bytes, (std::vector<std::uint8_t>{1, 2, 3}));
  EXPECT_EQ(mesh.images[2].bytes.size(), 6u);
  EXPECT_EQ(imported.warnings,
            Warnings{"1 textures use other texture coordinates than TEXCOORD_0, which were "
                     "dropped"});
}

TEST(Gltf, FillsAttributesThatOnlySomePrimitivesHave) {
  Binary binary;
  floats(binary, {0, 0, 0, 1, 0, 0, 0, 1, 0});
  floats(binary, {0, 1, 0, 0, 1, 0, 0, 1, 0});
  VARIFOLD_ASSERT_VALUE(
      imported,
      read_gltf(glb(R"("buffers":[{"byteLength":72}],"bufferViews":[{"buffer":0,"byteLength":72}],
    "accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"},
                 {"bufferView":0,"byteOffset":36,"componentType":5126,"count":3,"type":"VEC3"},
                 {"bufferView":0,"componentType":5126,"count":3,"type":"VEC4"},
                 {"bufferView":0,"componentType":5126,"count":3,"type":"VEC2"}],
    "meshes":[{"primitives":[{"attributes":{"POSITION":0,"TANGENT":2}},
                {"attributes":{"POSITION":0,"NORMAL":1,"COLOR_0":2,"TEXCOORD_0":3}}]}])",
                    binary)));
  test::expect_sound(imported.mesh);
  EXPECT_EQ(imported.mesh.normals,
            (std::vector<Vec3>{{0, 0, 1}, {0, 0, 1}, {0, 0, 1}, {0, 1, 0}, {0, 1, 0}, {0, 1, 0}}));
  EXPECT_EQ(imported.mesh.colors[0], Color(255, 255, 255, 255));
  EXPECT_EQ(imported.mesh.texcoords[4], Vec2(0, 1));
  EXPECT_EQ(imported.warnings, (Warnings{"3 vertices without normal got that of their triangles",
                                         "attribute 'TANGENT' was dropped"}));
}

TEST(Gltf, NamesTheElementOfEveryFault) {
  const auto error_of = [](const std::string& json) {
    return message_of(read_gltf(as_bytes("{" + std::string(kAsset) + "," + json + "}")));
  };
  EXPECT_EQ(message_of(read_gltf(as_bytes("{\"a\":\n[1,}"))), "line 2, byte 10: not valid JSON");
  EXPECT_EQ(message_of(read_gltf(as_bytes("[]"))), "the JSON is not an object");
  EXPECT_EQ(message_of(read_gltf(as_bytes("{\"a[\\\"[\":" + std::string(2000, '[')))),
            "line 1, byte 1008: the JSON is nested too deeply");
  EXPECT_EQ(message_of(read_gltf(as_bytes("{}"))), "asset: version '' is not 2.x");
  EXPECT_EQ(error_of(R"("nodes":3)"), "nodes: not an array");
  EXPECT_EQ(error_of(R"("nodes":[3])"), "nodes[0]: not an object");
  EXPECT_EQ(error_of(R"("nodes":[{"mesh":-1}])"),
            "nodes[0].mesh: not a whole number of at least 0");
  EXPECT_EQ(error_of(R"("nodes":[{"mesh":1e300}])"),
            "nodes[0].mesh: not a whole number of at least 0");
  EXPECT_EQ(error_of(R"("nodes":[{"mesh":0}])"), "meshes[0]: no such element (there are 0)");
  EXPECT_EQ(error_of(R"("nodes":[{"matrix":[1]}])"), "nodes[0].matrix: not an array of 16 numbers");
  EXPECT_EQ(error_of(R"("extensionsRequired":["KHR_draco_mesh_compression"])"),
            "extensionsRequired: 'KHR_draco_mesh_compression' is not supported");

  const std::string mesh = R"("meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],)";
  const std::string accessor =
      mesh + R"("accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"}],)";
  EXPECT_EQ(error_of(accessor + R"("bufferViews":[])"),
            "bufferViews[0]: no such element (there are 0)");
  const std::string buffer =
      R"("buffers":[{"byteLength":3,"uri":"data:;base64,AQID"}],"bufferViews":[{"buffer":0,)";
  EXPECT_EQ(error_of(accessor + buffer + R"("byteLength":3}])"),
            "accessors[0]: 33 bytes past the end of bufferViews[0]");
  EXPECT_EQ(error_of(accessor + buffer + R"("byteOffset":1,"byteLength":4}])"),
            "bufferViews[0]: 2 bytes past the end of buffers[0]");
  EXPECT_EQ(
      error_of(
          accessor +
          R"("bufferViews":[{"buffer":0,"byteLength":4}],"buffers":[{"byteLength":3,"uri":"data:;base64,AQ=ID"}])"),
      "buffers[0]: has a malformed data: URI");
  EXPECT_EQ(
      error_of(mesh + R"("accessors":[{"componentType":5126,"count":4000000000,"type":"VEC3"}])"),
      "accessors[0]: 4000000000 elements without a buffer view");
  EXPECT_EQ(error_of(mesh + R"("accessors":[{"componentType":5126,"count":4,"type":"VEC2"}])"),
            "meshes[0].primitives[0].attributes: POSITION has 2 components");
  EXPECT_EQ(error_of(R"("meshes":[{"primitives":[{"attributes":{"POSITION":0},
              "extensions":{"KHR_draco_mesh_compression":{}}}]}],
              "accessors":[{"componentType":5126,"count":4,"type":"VEC3"}])"),
            "meshes[0].primitives[0]: KHR_draco_mesh_compression is not supported");
  EXPECT_EQ(error_of(mesh + R"("accessors":[{"componentType":5126,"count":4,"type":"VEC9"}])"),
            "accessors[0]: unknown type 'VEC9'");
}

TEST(Gltf, NamesIndicesOutOfRange) {
  std::vector<std::byte> file = triangle_with(R"("nodes":[{"mesh":0}])");
  file[file.size() - 4] = std::byte{3};  // the third index, before 2 bytes of padding
  EXPECT_EQ(message_of(read_gltf(file)),
            "meshes[0].primitives[0]: index 3 at position 2 is out of range (3 vertices)");
}

TEST(Gltf, RefusesInstancesBeyondMeasure) {
  // 1 MiB of zeros, referred to by 4000 primitives of different accessors, would be 4 GB.
  std::string accessors;
  std::string primitives;
  for (int i = 0; i < 4000; ++i) {
    accessors += R"({"bufferView":0,"componentType":5126,"count":87000,"type":"VEC3"},)";
    primitives.append(R"({"attributes":{"POSITION":)").append(std::to_string(i)).append("}},");
  }
  accessors.pop_back();
  primitives.pop_back();
  const Binary zeros(std::string(1 << 20, '\0'));
  const std::string message = message_of(
      read_gltf(glb(R"("buffers":[{"byteLength":1048576}],
        "bufferViews":[{"buffer":0,"byteLength":1048576}],"accessors":[)" +
                        accessors + R"(],"meshes":[{"primitives":[)" + primitives + "]}]",
                    zeros)));
  EXPECT_NE(message.find("the instances of the meshes take many times the size of the file"),
            std::string::npos)
      << message;
}

TEST(Gltf, EveryTruncationOfAGlbIsAnError) {
  const std::vector<std::byte> whole = triangle_with(R"("nodes":[{"mesh":0}])");
  for (std::size_t size = 0; size < whole.size(); ++size)
    EXPECT_FALSE(read_gltf(std::span(whole).first(size)).has_value()) << size;
}

TEST(Gltf, ChecksTheChunksOfAGlb) {
  EXPECT_EQ(message_of(read_gltf(as_bytes("glTF1234"))), "byte 8: the file ends in the header");
  Binary version("glTF");
  version.number(std::uint32_t{1}).number(std::uint32_t{12});
  EXPECT_EQ(message_of(read_gltf(version.bytes())), "byte 4: version 1 of GLB, not 2");
  Binary order("glTF");
  order.number(std::uint32_t{2}).number(std::uint32_t{20}).number(std::uint32_t{0}).text("BIN_");
  EXPECT_EQ(message_of(read_gltf(order.bytes())), "byte 12: the first chunk is not JSON");
  Binary chunk("glTF");
  chunk.number(std::uint32_t{2}).number(std::uint32_t{20}).number(std::uint32_t{4}).text("JSON");
  EXPECT_EQ(message_of(read_gltf(chunk.bytes())),
            "byte 12: a chunk of 4 bytes goes past the end of the file");
}

TEST(Gltf, RoundTripsExactly) {
  TriangleMesh mesh = test::mesh_with_everything();
  mesh.images.push_back({"skin", "image/png", "", {1, 2, 3}});
  mesh.images.push_back({"", "", "far away.jpg", {}});
  mesh.materials.resize(3);
  mesh.materials[0].name = "first \"one\"";
  mesh.materials[0].base_color = {0.1f, 0.2f, 0.3f, 0.5f};
  mesh.materials[0].alpha_mode = "BLEND";
  mesh.materials[1].metallic = 0.7f;
  mesh.materials[1].roughness = 0.3f;
  mesh.materials[1].textures = {1, 0, kNone, 0, 1};
  mesh.materials[2].alpha_mode = "MASK";
  mesh.materials[2].alpha_cutoff = 0.1f;
  mesh.materials[2].emissive = {0.1f, 0.2f, 0.3f};
  mesh.materials[2].double_sided = true;
  mesh.ranges = {{0, 0, 1}, {2, 1, 1}};
  VARIFOLD_ASSERT_VALUE(bytes, write_glb(mesh));
  EXPECT_EQ(bytes.size() % 4, 0u);
  VARIFOLD_ASSERT_VALUE(imported, read_gltf(bytes));
  EXPECT_TRUE(imported.warnings.empty());
  test::expect_same_geometry(imported.mesh, mesh);
  EXPECT_EQ(imported.mesh.ranges, mesh.ranges);
  ASSERT_EQ(imported.mesh.materials.size(), 3u);
  for (std::size_t i = 0; i < 3; ++i) {
    const Material& a = mesh.materials[i];
    const Material& b = imported.mesh.materials[i];
    EXPECT_EQ(std::tie(a.name, a.base_color, a.emissive, a.metallic, a.roughness, a.double_sided,
                       a.alpha_mode, a.textures),
              std::tie(b.name, b.base_color, b.emissive, b.metallic, b.roughness, b.double_sided,
                       b.alpha_mode, b.textures));
  }
  EXPECT_EQ(imported.mesh.materials[2].alpha_cutoff, 0.1f);
  EXPECT_EQ(imported.mesh.images[0].bytes, mesh.images[0].bytes);
  EXPECT_EQ(imported.mesh.images[1].uri, "far away.jpg");
}

TEST(Gltf, RoundTripsManyVerticesAndNone) {
  TriangleMesh mesh;
  for (int i = 0; i < 70000; ++i) mesh.positions.emplace_back(i, -i, 0.1f * static_cast<float>(i));
  mesh.indices = {0, 69999, 35000};
  VARIFOLD_ASSERT_VALUE(large, read_gltf(*write_glb(mesh)));
  test::expect_same_geometry(large.mesh, mesh);
  VARIFOLD_ASSERT_VALUE(empty, read_gltf(*write_glb({})));
  EXPECT_TRUE(empty.mesh.positions.empty());
}

}  // namespace
}  // namespace varifold
