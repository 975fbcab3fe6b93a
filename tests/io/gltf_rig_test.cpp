// Morph targets, skins and animations of glTF.
#include <fmt/format.h>
#include <tests/io/io_support.h>
#include <tests/support/meshes.h>
#include <tests/support/rigged_meshes.h>
#include <tests/support/test_files.h>
#include <varifold/io/base64.h>
#include <varifold/io/gltf.h>
#include <varifold/io/mesh_file.h>
#include <varifold/mesh/rig_pose.h>

namespace varifold {
namespace {

using test::Binary;
using test::message_of;
using Warnings = std::vector<std::string>;

/// A .gltf document built from accessors, each with a buffer view of its own.
class Document {
 public:
  template <class T>
  Document& accessor(int component_type, const char* type, std::size_t count,
                     const std::vector<T>& values, const std::string& more = {}) {
    const std::size_t first = binary_.bytes().size();
    for (const T value : values) binary_.number(value);
    views_ += fmt::format(R"({}{{"buffer":0,"byteOffset":{},"byteLength":{}}})",
                          views_.empty() ? "" : ",", first, values.size() * sizeof(T));
    accessors_ += fmt::format(
        R"({}{{"bufferView":{},"componentType":{},"count":{},"type":"{}"{}}})",
        accessors_.empty() ? "" : ",", view_count_++, component_type, count, type, more);
    return *this;
  }
  Document& floats(const char* type, std::size_t count, const std::vector<float>& values) {
    return accessor(5126, type, count, values);
  }
  /// An accessor by its JSON.
  Document& raw(const std::string& json) {
    accessors_ += "," + json;
    return *this;
  }
  [[nodiscard]] Result<ImportedMesh> read(const std::string& members) const {
    static constexpr std::string_view kDigits =
        "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string base64;
    const auto& bytes = binary_.bytes();
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
      std::uint32_t group = 0;
      for (std::size_t j = i; j < i + 3; ++j)
        group = group << 8 | (j < bytes.size() ? static_cast<std::uint32_t>(bytes[j]) : 0u);
      for (int digit = 3; digit >= 0; --digit) base64 += kDigits[(group >> (6 * digit)) & 63];
    }
    if (bytes.size() % 3 != 0) base64.replace(base64.size() - 1, 1, "=");
    if (bytes.size() % 3 == 1) base64.replace(base64.size() - 2, 1, "=");
    const std::string json =
        fmt::format(R"({{"asset":{{"version":"2.0"}},"buffers":[{{"byteLength":{},)"
                    R"("uri":"data:application/octet-stream;base64,{}"}}],)"
                    R"("bufferViews":[{}],"accessors":[{}],{}}})",
                    bytes.size(), base64, views_, accessors_, members);
    return read_gltf(as_bytes(json));
  }

 private:
  Binary binary_;
  std::string views_;
  std::string accessors_;
  std::size_t view_count_ = 0;
};

/// A triangle: positions are accessor 0, normals 1.
Document triangle() {
  Document document;
  document.floats("VEC3", 3, {0, 0, 0, 1, 0, 0, 0, 1, 0});
  document.floats("VEC3", 3, {0, 0, 1, 0, 0, 1, 0, 0, 1});
  return document;
}

using Places = std::vector<Vec3>;

TEST(GltfTargets, BecomePosesWithNamesAndWeights) {
  Document document = triangle();
  document.floats("VEC3", 3, {0, 0, 1, 0, 0, 2, 0, 0, 3});   // 2
  document.floats("VEC3", 3, {1, 0, 0, 1, 0, 0, 1, 0, -1});  // 3: normals
  document.accessor<std::int8_t>(5120, "VEC3", 3, {127, 0, 0, 0, 0, 0, -128, 0, 0, 0, 0, 0},
                                 R"(,"normalized":true)");                             // 4
  document.accessor<std::uint16_t>(5123, "SCALAR", 1, {1});                            // 5
  document.floats("VEC3", 1, {7, 8, 9});                                               // 6
  document.raw(R"({"componentType":5126,"count":3,"type":"VEC3","sparse":{"count":1,
      "indices":{"bufferView":5,"componentType":5123},"values":{"bufferView":6}}})");  // 7
  const std::string mesh = R"("meshes":[{"primitives":[{"attributes":{"POSITION":0,"NORMAL":1},
      "targets":[{"POSITION":2,"NORMAL":3},{"POSITION":4},{"POSITION":7}]}],
      "weights":[0.5,0,0.25],"extras":{"targetNames":["smile","frown"]}}],)";
  VARIFOLD_ASSERT_VALUE(found, document.read(mesh + R"("nodes":[{"mesh":0}])"));
  const TriangleMesh& m = found.mesh;
  EXPECT_TRUE(found.warnings.empty());
  ASSERT_EQ(m.poses.size(), 3u);
  EXPECT_EQ(m.positions, (Places{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}));
  EXPECT_EQ(m.poses[0],
            (Pose{"smile", {{0, 0, 1}, {1, 0, 2}, {0, 1, 3}}, {{1, 0, 1}, {1, 0, 1}, {1, 0, 0}}}));
  EXPECT_EQ(m.poses[1], (Pose{"frown", {{1, 0, 0}, {1, 0, 0}, {-1, 1, 0}}, {}}));
  EXPECT_EQ(m.poses[2], (Pose{"target 2", {{0, 0, 0}, {8, 8, 9}, {0, 1, 0}}, {}}));
  ASSERT_TRUE(m.rig);
  EXPECT_EQ(m.rig->pose_weights, (std::vector<float>{0.5f, 0, 0.25f}));
  EXPECT_TRUE(m.skin.empty());

  // A node has the last word on weights; without any there is no rig.
  VARIFOLD_ASSERT_VALUE(other, document.read(mesh + R"("nodes":[{"mesh":0,"weights":[1,2,3]}])"));
  EXPECT_EQ(other.mesh.rig->pose_weights, (std::vector<float>{1, 2, 3}));
  VARIFOLD_ASSERT_VALUE(none, document.read(mesh + R"("nodes":[{"mesh":0,"weights":[0,0,0]}])"));
  EXPECT_FALSE(none.mesh.rig);
}

TEST(GltfTargets, OfEveryInstanceAreTheirOwnAndMoveWithIt) {
  Document document = triangle();
  document.floats("VEC3", 3, {1, 0, 0, 0, 0, 0, 0, 2, 1});
  document.floats("VEC3", 3, {1, 0, 0, 0, 0, 0, 0, 0, 0});
  // The second node mirrors x, doubles y and moves; the third has a mesh without targets.
  VARIFOLD_ASSERT_VALUE(found, document.read(R"("meshes":[
      {"primitives":[{"attributes":{"POSITION":0,"NORMAL":1},
                      "targets":[{"POSITION":2,"NORMAL":3}]}]},
      {"primitives":[{"attributes":{"POSITION":0}}]}],
      "nodes":[{"mesh":0},{"mesh":0,"scale":[-1,2,1],"translation":[5,0,0]},{"mesh":1}])"));
  const TriangleMesh& m = found.mesh;
  ASSERT_EQ(m.poses.size(), 2u);
  const Places rest{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {5, 0, 0}, {4, 0, 0},
                    {5, 2, 0}, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  EXPECT_EQ(m.positions, rest);
  EXPECT_EQ(m.indices, (std::vector<std::uint32_t>{0, 1, 2, 3, 5, 4, 6, 7, 8}));
  Places first = rest;
  first[0] = {1, 0, 0};
  first[2] = {0, 3, 1};
  EXPECT_EQ(m.poses[0].positions, first);
  Places second = rest;
  second[3] = {4, 0, 0};
  second[5] = {5, 6, 1};
  EXPECT_EQ(m.poses[1].positions, second);
  // Cofactors of diag(-1, 2, 1) are those of the mirrored matrix: (-2, 1, 2) to |n| = 2.
  EXPECT_EQ(m.poses[1].normals[3], Vec3(-1, 0, 1));
  EXPECT_EQ(m.poses[1].normals[0], m.normals[0]);
}

TEST(GltfTargets, FaultsNameTheTarget) {
  Document document = triangle();
  document.floats("VEC3", 2, {0, 0, 1, 0, 0, 2});
  document.floats("VEC2", 3, {0, 0, 1, 0, 0, 2});
  document.floats("VEC3", 3, {0, 0, 1, 0, 0, std::numeric_limits<float>::infinity(), 0, 0, 0});
  const auto error_of = [&](const std::string& targets, const std::string& more = "") {
    return message_of(
        document.read(R"("meshes":[{"primitives":[{"attributes":{"POSITION":0},"targets":)" +
                      targets + "}]" + more + "}]"));
  };
  const std::string place = "meshes[0].primitives[0].targets";
  EXPECT_EQ(error_of(R"([{"POSITION":2}])"),
            place + "[0]: POSITION has 2 elements, POSITION of the primitive has 3");
  EXPECT_EQ(error_of(R"([{},{"POSITION":3}])"),
            place + "[1]: POSITION does not have three components of an offset");
  EXPECT_EQ(error_of(R"([{"POSITION":9}])"), "accessors[9]: no such element (there are 5)");
  EXPECT_EQ(error_of(R"([{"POSITION":4}])"), "pose 'target 0': vertex 1: position is not finite");
  EXPECT_EQ(error_of(R"({})"), place + ": not an array");
  EXPECT_EQ(error_of(R"([{"POSITION":1}])", R"(,"weights":[1,2])"),
            "meshes[0].weights: not an array of 1 numbers");
}

/// Two joints; node 0 holds both and is turned, node 3 the skinned mesh, which it does not move.
constexpr const char* kSkinned = R"("nodes":[
    {"name":"root","children":[1,3],"rotation":[0,0,1,0]},
    {"name":"hip","children":[2],"translation":[0,1,0]},
    {"name":"knee","translation":[0,2,0]},
    {"mesh":0,"skin":0,"translation":[100,0,0]}],
    "skins":[{"joints":[2,1],"inverseBindMatrices":2}],)";

Document skinned_triangle() {
  Document document = triangle();
  std::vector<float> matrices(32, 0);
  for (const std::size_t i : {0, 5, 10, 15, 16, 21, 26, 31}) matrices[i] = 1;
  matrices[13] = -3;
  matrices[29] = -1;
  document.floats("MAT4", 2, matrices);                                                    // 2
  document.accessor<std::uint8_t>(5121, "VEC4", 3, {0, 1, 0, 0, 1, 0, 0, 0, 0, 1, 9, 0});  // 3
  document.accessor<std::uint8_t>(5121, "VEC4", 3, {255, 0, 0, 0, 51, 204, 0, 0, 85, 170, 0, 0},
                                  R"(,"normalized":true)");  // 4
  return document;
}

constexpr const char* kSkinnedMesh = R"("meshes":[{"primitives":[{"attributes":{
    "POSITION":0,"NORMAL":1,"JOINTS_0":3,"WEIGHTS_0":4}}]}],)";

TEST(GltfSkins, BecomeJointsOfARig) {
  VARIFOLD_ASSERT_VALUE(found,
                        skinned_triangle().read(std::string(kSkinned) + kSkinnedMesh + R"("scene":0,
      "scenes":[{"nodes":[0]}])"));
  const TriangleMesh& m = found.mesh;
  EXPECT_TRUE(found.warnings.empty());
  EXPECT_EQ(m.positions, (Places{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}})) << "in the space of binding";
  ASSERT_EQ(m.skin.size(), 3u);
  const auto byte = [](int value) { return static_cast<float>(value) / 255; };
  EXPECT_EQ(m.skin[0], (JointWeights{{0, 0, 0, 0}, {1, 0, 0, 0}}));
  EXPECT_EQ(m.skin[1], (JointWeights{{1, 0, 0, 0}, {byte(51), byte(204), 0, 0}}));
  EXPECT_EQ(m.skin[2], (JointWeights{{0, 1, 0, 0}, {byte(85), byte(170), 0, 0}}));
  ASSERT_TRUE(m.rig);
  ASSERT_EQ(m.rig->nodes.size(), 3u);
  EXPECT_EQ(m.rig->nodes[0].name, "root");
  EXPECT_EQ(m.rig->nodes[1].parent, 0u);
  EXPECT_EQ(m.rig->nodes[2].parent, 1u);
  ASSERT_EQ(m.rig->joints.size(), 2u);
  EXPECT_EQ(m.rig->joints[0].node, 2u);
  EXPECT_EQ(m.rig->joints[0].inverse_bind[3], Vec4(0, -3, 0, 1));
  // Bound upright, at rest the root turns all by half a turn about z.
  const TriangleMesh rest = posed_mesh(m, kNone, 0);
  EXPECT_LT(glm::distance(rest.positions[1], Vec3(-1, 0, 0)), 1e-6f);
  EXPECT_LT(glm::distance(rest.positions[2], Vec3(0, -1, 0)), 1e-6f);
}

TEST(GltfSkins, KeepTheFourHeaviestJoints) {
  Document document = triangle();
  document.accessor<std::uint16_t>(5123, "VEC4", 3, {0, 1, 2, 3, 0, 1, 2, 3, 5, 1, 2, 3});  // 2
  document.floats("VEC4", 3, {0.1f, 0.2f, 0.1f, 0.1f, 1, 1, 0, 0, 0, 0, 0, 0});             // 3
  document.accessor<std::uint16_t>(5123, "VEC4", 3, {4, 5, 0, 0, 4, 5, 0, 0, 4, 5, 0, 0});  // 4
  document.floats("VEC4", 3, {0.3f, 0.2f, 0, 0, 0, 0, 0, 0, -1, 0, 0, 0});                  // 5
  VARIFOLD_ASSERT_VALUE(found, document.read(R"("meshes":[{"primitives":[{"attributes":{
      "POSITION":0,"JOINTS_0":2,"WEIGHTS_0":3,"JOINTS_1":4,"WEIGHTS_1":5}}]}],
      "nodes":[{"mesh":0,"skin":0},{},{},{},{},{},{}],"skins":[{"joints":[1,2,3,4,5,6]}])"));
  const std::vector<JointWeights>& skin = found.mesh.skin;
  EXPECT_EQ(skin[0].joints, (std::array<std::uint16_t, 4>{0, 1, 4, 5}));
  EXPECT_FLOAT_EQ(skin[0].weights[0], 0.1f / 0.8f);
  EXPECT_FLOAT_EQ(skin[0].weights[2], 0.3f / 0.8f);
  EXPECT_EQ(skin[1], (JointWeights{{0, 1, 0, 0}, {0.5f, 0.5f, 0, 0}}));
  EXPECT_EQ(skin[2], (JointWeights{{5, 0, 0, 0}, {1, 0, 0, 0}}));
  EXPECT_EQ(found.warnings,
            (Warnings{"1 vertices follow more than four joints, of which four were kept",
                      "2 vertices had weights of joints that do not sum up to 1",
                      "1 vertices without weights follow their first joint"}));
}

TEST(GltfSkins, ShareJointsAndLeaveTheRestStanding) {
  // Two skins with one joint in common; a mesh that an animated node moves; one that stands.
  Document document = skinned_triangle();
  document.floats("SCALAR", 2, {0, 1});            // 5
  document.floats("VEC3", 2, {0, 0, 0, 0, 0, 8});  // 6
  VARIFOLD_ASSERT_VALUE(found, document.read(R"("meshes":[
      {"primitives":[{"attributes":{"POSITION":0,"JOINTS_0":3,"WEIGHTS_0":4}}]},
      {"primitives":[{"attributes":{"POSITION":0}}]}],
      "nodes":[{"children":[1,2]},{},{},{"mesh":0,"skin":0},{"mesh":0,"skin":1},
               {"children":[6],"scale":[2,2,2]},{"mesh":1,"translation":[0,0,1]},
               {"mesh":1,"translation":[9,0,0]}],
      "skins":[{"joints":[1,2]},{"joints":[2,1]}],
      "animations":[{"channels":[{"sampler":0,"target":{"node":5,"path":"translation"}},
                                 {"sampler":0,"target":{"node":7,"path":"pointer"}}],
                     "samplers":[{"input":5,"output":6}]}])"));
  const TriangleMesh& m = found.mesh;
  ASSERT_EQ(m.vertex_count(), 12u);
  ASSERT_EQ(m.rig->joints.size(), 4u);
  EXPECT_EQ(m.skin[0].joints[0], 0);
  EXPECT_EQ(m.skin[3].joints[0], 1);
  EXPECT_EQ(m.skin[6], (JointWeights{{2, 0, 0, 0}, {1, 0, 0, 0}}));
  EXPECT_EQ(m.skin[9], (JointWeights{{3, 0, 0, 0}, {1, 0, 0, 0}}));
  EXPECT_EQ(m.positions[7], Vec3(2, 0, 2)) << "in the world at rest";
  const TriangleMesh moved = posed_mesh(m, 0, 1);
  EXPECT_EQ(moved.positions[7], Vec3(2, 0, 10));
  EXPECT_EQ(moved.positions[10], m.positions[10]);
  EXPECT_EQ(found.warnings, (Warnings{"1 channels of animations move nothing of the mesh, and "
                                      "were dropped"}));
}

TEST(GltfSkins, FaultsNameTheSkinOrTheAttributes) {
  const auto error_of = [](const std::string& attributes, const std::string& skins,
                           const std::string& node = R"({"mesh":0,"skin":0},{"children":[]})") {
    return message_of(skinned_triangle().read(
        R"("meshes":[{"primitives":[{"attributes":{"POSITION":0,)" + attributes +
        R"(}}]}],"nodes":[)" + node + R"(],"skins":[)" + skins + "]"));
  };
  const std::string good = R"("JOINTS_0":3,"WEIGHTS_0":4)";
  const std::string place = "meshes[0].primitives[0].attributes: ";
  EXPECT_EQ(error_of(good, R"({"joints":[1]})"), place + "vertex 1 follows joint 1 of 1");
  EXPECT_EQ(error_of(good, R"({"joints":[]})"), "skins[0]: has no joints");
  EXPECT_EQ(error_of(good, ""), "nodes[0]: skin 0 does not exist (0 skins)");
  EXPECT_EQ(error_of(good, R"({"joints":[1,7]})"), "skins[0]: joint 1: node 7 is not in the scene");
  EXPECT_EQ(error_of(good, R"({"joints":[1,0,1],"inverseBindMatrices":2})"),
            "skins[0]: 3 joints, but 2 inverseBindMatrices");
  EXPECT_EQ(error_of(good, R"({"joints":[1,0],"inverseBindMatrices":0})"),
            "skins[0]: inverseBindMatrices are not 4 x 4 floats");
  EXPECT_EQ(error_of(R"("JOINTS_0":3)", R"({"joints":[1]})"), place + "WEIGHTS_0 is missing");
  EXPECT_EQ(error_of(R"("JOINTS_0":0,"WEIGHTS_0":4)", R"({"joints":[1]})"),
            place + "JOINTS_0 does not have 4 components");
  EXPECT_EQ(error_of(R"("JOINTS_0":4,"WEIGHTS_0":3)", R"({"joints":[1,0]})"),
            place + "JOINTS_0 or WEIGHTS_0 have another type");
}

TEST(GltfAnimations, FaultsNameTheSampler) {
  Document document = skinned_triangle();
  document.floats("SCALAR", 2, {1, 0});            // 5
  document.floats("VEC3", 2, {0, 0, 0, 0, 0, 8});  // 6
  document.floats("SCALAR", 2, {0, 1});            // 7
  const auto error_of = [&](const std::string& sampler, const std::string& path = "translation",
                            const std::string& node = "1") {
    return message_of(document.read(std::string(kSkinned) + kSkinnedMesh +
                                    R"("animations":[{"channels":[{"sampler":0,"target":{"node":)" +
                                    node + R"(,"path":")" + path + R"("}}],"samplers":[)" +
                                    sampler + "]}]"));
  };
  const std::string place = "animations[0].samplers[0]: ";
  EXPECT_EQ(error_of(R"({"input":5,"output":6})"),
            place + "input: time 1 is not after the one before it");
  EXPECT_EQ(error_of(R"({"input":7,"output":6,"interpolation":"SPLINE"})"),
            place + "unknown interpolation 'SPLINE'");
  EXPECT_EQ(error_of(R"({"input":7,"output":6,"interpolation":"CUBICSPLINE"})"),
            place + "2 keys need 3 elements each, but output has 2");
  EXPECT_EQ(error_of(R"({"input":7,"output":6})", "rotation"), place + "output has 3 components");
  EXPECT_EQ(error_of(R"({"input":6,"output":6})"), place + "input is not one float a key");
  EXPECT_EQ(error_of(R"({"input":7,"output":60})"), "accessors[60]: no such element (there are 8)");
  EXPECT_EQ(error_of("", "translation", "44"),
            "animations[0].channels[0].target: node 44 does not exist (4 nodes)");
  EXPECT_EQ(error_of(""), "animations[0].samplers[0]: no such element (there are 0)");
}

void expect_same_poses(const TriangleMesh& found, const TriangleMesh& expected) {
  ASSERT_EQ(found.poses.size(), expected.poses.size());
  for (std::size_t k = 0; k < found.poses.size(); ++k) {
    EXPECT_EQ(found.poses[k].name, expected.poses[k].name);
    ASSERT_EQ(found.poses[k].normals.size(), expected.poses[k].normals.size());
    // An offset is rounded once, and once more when it is added.
    const auto check = [](const Vec3& a, const Vec3& b, const Vec3& rest) {
      for (int i = 0; i < 3; ++i)
        ASSERT_LE(std::abs(a[i] - b[i]), 1.2e-7f * (std::abs(b[i]) + std::abs(b[i] - rest[i])));
    };
    for (std::size_t v = 0; v < expected.positions.size(); ++v)
      check(found.poses[k].positions[v], expected.poses[k].positions[v], expected.positions[v]);
    for (std::size_t v = 0; v < expected.poses[k].normals.size(); ++v)
      check(found.poses[k].normals[v], expected.poses[k].normals[v], expected.normals[v]);
  }
}

void expect_round_trip(const TriangleMesh& mesh) {
  VARIFOLD_ASSERT_VALUE(file, write_glb(mesh));
  VARIFOLD_ASSERT_VALUE(found, read_gltf(file));
  test::expect_same_geometry(found.mesh, mesh);
  EXPECT_EQ(found.mesh.skin, mesh.skin);
  expect_same_poses(found.mesh, mesh);
  ASSERT_EQ(found.mesh.rig != nullptr, mesh.rig != nullptr);
  if (mesh.rig) {
    EXPECT_TRUE(*found.mesh.rig == *mesh.rig);
  }
  EXPECT_TRUE(found.warnings.empty());
}

TEST(GltfRig, RoundTrips) {
  std::uint64_t seed = 0;
  for (const test::NamedMesh& group : test::all_groups()) {
    SCOPED_TRACE(group.name);
    if (group.mesh.indices.empty()) continue;
    for (const test::RigOptions options :
         {test::RigOptions{3, 5, 2}, {0, 300, 1}, {4, 0, 1}, {0, 2, 0}, {2, 0, 0}}) {
      if (options.joints > 5 && seed > 20) continue;
      expect_round_trip(test::with_random_rig(group.mesh, ++seed, options));
    }
  }
}

TEST(GltfRig, JointsThatShareANodeStayApart) {
  TriangleMesh mesh = test::with_random_rig(test::octahedron(), 3);
  Rig rig = *mesh.rig;
  rig.joints[3].node = rig.joints[2].node;
  mesh.rig = std::make_shared<const Rig>(rig);
  VARIFOLD_ASSERT_VALUE(file, write_glb(mesh));
  VARIFOLD_ASSERT_VALUE(found, read_gltf(file));
  for (const float time : {0.0f, 0.5f, 2.0f})
    EXPECT_EQ(posed_mesh(found.mesh, 0, time).positions, posed_mesh(mesh, 0, time).positions);
}

TEST(GltfRig, ChannelsOfSomePosesBecomeOneOfAll) {
  for (const Interpolation first : {Interpolation::kStep, Interpolation::kLinear}) {
    TriangleMesh mesh = test::with_random_rig(test::octahedron(), 4, {4, 0, 0});
    Rig rig = *mesh.rig;
    const AnimationChannel a{ChannelTarget::kPoseWeights, 0, 2, first, {0, 1}, {0, 1, 2, 3}};
    const AnimationChannel b{
        ChannelTarget::kPoseWeights, 3, 1, first, {0.5f, 0.75f, 2}, {4, -1, 3}};
    rig.animations = {{"both", {a, b}}};
    mesh.rig = std::make_shared<const Rig>(rig);
    VARIFOLD_ASSERT_VALUE(file, write_glb(mesh));
    VARIFOLD_ASSERT_VALUE(found, read_gltf(file));
    for (float time = 0; time < 2.5f; time += 0.03125f) {
      const std::vector<float> weights = pose_rig(found.mesh, 0, time).weights;
      const std::vector<float> expected = pose_rig(mesh, 0, time).weights;
      for (std::size_t k = 0; k < 4; ++k) ASSERT_NEAR(weights[k], expected[k], 1e-6f) << time;
    }
  }
}

/// Where three.js (0.187.0, GLTFLoader and AnimationMixer) has a vertex.
struct KnownPlace {
  const char* name;
  std::uint32_t animation;
  float time;
  std::uint32_t vertex;
  Vec3 place;
};
constexpr KnownPlace kKnownPlaces[] = {
    {"CesiumMan.glb", 0, 1, 0, {0.108110669f, 0.929300716f, -0.0197255742f}},
    {"CesiumMan.glb", 0, 1, 1091, {-0.468605673f, 0.185142088f, 0.156710751f}},
    {"CesiumMan.glb", 0, 1, 3272, {-0.0543616988f, 1.41231664f, 0.0511287472f}},
    {"CesiumMan.glb", kNone, 0, 1091, {0.0785871460f, 0.0251755919f, 0.123560063f}},
    {"CesiumMan.glb", kNone, 0, 3272, {-0.130999764f, 1.43705990f, -0.0303956743f}},
    {"Fox.glb", 2, 0.5f, 0, {3.01368547f, 32.5079193f, -28.3519809f}},
    {"Fox.glb", 2, 0.5f, 576, {10.6938675f, 48.9714406f, 35.7643891f}},
    {"Fox.glb", 0, 1.75f, 576, {11.2963690f, 59.0801371f, 35.3526664f}},
    {"Fox.glb", 0, 1.75f, 1727, {7.60638362f, 53.6670645f, 67.6543636f}}};

TEST(GltfRig, PosesAsAnotherProgramDoes) {
  if (!test::real_mesh("Fox.glb")) GTEST_SKIP() << "no folder of real meshes here";
  for (const KnownPlace& known : kKnownPlaces) {
    VARIFOLD_ASSERT_VALUE(found, read_mesh(*test::real_mesh(known.name)));
    const TriangleMesh posed = posed_mesh(found.mesh, known.animation, known.time);
    EXPECT_LT(glm::distance(posed.positions.at(known.vertex), known.place),
              1e-6f * glm::length(known.place))
        << known.name << ", vertex " << known.vertex;
  }
}

struct RealRig {
  const char* name;
  std::size_t poses, joints, animations;
};
class RealRigs : public testing::TestWithParam<RealRig> {};

TEST_P(RealRigs, AreReadWholeAndRoundTrip) {
  VARIFOLD_REAL_MESH_OR_SKIP(path, GetParam().name);
  VARIFOLD_ASSERT_VALUE(found, read_mesh(path));
  EXPECT_EQ(found.mesh.poses.size(), GetParam().poses);
  ASSERT_TRUE(found.mesh.rig);
  EXPECT_EQ(found.mesh.rig->joints.size(), GetParam().joints);
  EXPECT_EQ(found.mesh.rig->animations.size(), GetParam().animations);
  for (const std::string& warning : found.warnings)
    EXPECT_TRUE(warning.starts_with("attribute") || warning.ends_with("that do not sum up to 1"))
        << warning;
  expect_round_trip(found.mesh);
}

INSTANTIATE_TEST_SUITE_P(
    GltfRig, RealRigs,
    testing::Values(RealRig{"CesiumMan.glb", 0, 19, 1}, RealRig{"Fox.glb", 0, 24, 3},
                    RealRig{"AnimatedMorphCube.glb", 2, 0, 1},
                    RealRig{"MorphPrimitivesTest/MorphPrimitivesTest.gltf", 1, 0, 0}),
    [](const auto& instance) { return std::to_string(instance.index); });

}  // namespace
}  // namespace varifold
