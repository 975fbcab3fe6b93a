// fuzz_seeds FOLDER: writes a few small files of every format, one folder per target.
#include <varifold/base/bytes.h>
#include <varifold/io/any_model.h>
#include <varifold/io/camera_path_file.h>
#include <varifold/io/container.h>
#include <varifold/io/gltf.h>
#include <varifold/io/obj.h>
#include <varifold/io/output_file.h>
#include <varifold/io/ply.h>
#include <varifold/mesh/generators.h>
#include <varifold/mesh/rig.h>
#include <varifold/models/lodstrips/build.h>
#include <varifold/models/lodstrips/frame_build.h>
#include <varifold/models/mts/build.h>
#include <varifold/models/patch_tree/build.h>
#include <varifold/models/patch_tree/encoding.h>
#include <varifold/models/pm/build.h>
#include <varifold/models/pm/deformation.h>
#include <varifold/models/pm/encoding.h>
#include <varifold/models/strips/build.h>
#include <varifold/models/vdpm/build.h>
#include <varifold/simplify/simplify.h>
#include <varifold/strip/stripify.h>
#include <varifold/view/known_paths.h>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>

using namespace varifold;

namespace {

TriangleMesh two_triangles() {
  TriangleMesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  mesh.indices = {0, 1, 2, 0, 2, 3};
  return mesh;
}

TriangleMesh with_everything() {
  TriangleMesh mesh = two_triangles();
  mesh.normals.assign(4, {0, 0, 1});
  mesh.texcoords = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  mesh.colors.assign(4, {1, 2, 3, 4});
  mesh.images.push_back({"skin", "image/png", "", {1, 2, 3}});
  mesh.materials.resize(2);
  mesh.materials[0].textures[0] = 0;
  mesh.ranges = {{0, 0, 1}, {1, 1, 1}};
  return mesh;
}

/// With a pose, joints, and an animation of every interpolation.
TriangleMesh moving() {
  TriangleMesh mesh = with_everything();
  mesh.poses = {{"a", mesh.positions, mesh.normals}, {"b", mesh.positions, {}}};
  for (Vec3& position : mesh.poses[0].positions) position.z += 1;
  mesh.poses[1].positions[2].x = 2;
  mesh.skin.assign(4, {{0, 1, 0, 0}, {0.5f, 0.5f, 0, 0}});
  Rig rig;
  rig.nodes.resize(3);
  rig.nodes[1].parent = 0;
  rig.nodes[2] = {.name = "m", .parent = 1, .has_matrix = true};
  rig.joints = {{1, Mat4(1)}, {2, Mat4(1)}};
  rig.pose_weights = {0.5f, 0};
  rig.animations = {
      {"walk",
       {{ChannelTarget::kTranslation, 0, 3, Interpolation::kLinear, {0, 1}, {0, 0, 0, 1, 2, 3}},
        {ChannelTarget::kRotation, 1, 4, Interpolation::kLinear, {0, 1}, {0, 0, 0, 1, 1, 0, 0, 0}},
        {ChannelTarget::kScale, 1, 3, Interpolation::kStep, {0.5f}, {1, 2, 1}},
        {ChannelTarget::kPoseWeights,
         0,
         2,
         Interpolation::kCubicSpline,
         {0, 2},
         std::vector<float>(12, 0.25f)}}}};
  mesh.rig = std::make_shared<const Rig>(std::move(rig));
  return mesh;
}

constexpr std::string_view kPolygonsPly =
    "ply\nformat ascii 1.0\nelement vertex 5\nproperty float x\nproperty double y\n"
    "property list uchar int t\nproperty short z\nelement face 2\nproperty list uchar int "
    "vertex_index\nelement tristrips 1\nproperty list int int vertex_indices\nend_header\n"
    "0 0 0 0\n1 0 1 7 0\n1 1 0 0\n0.5 0.2 0 0\n0 1 0 0\n5 0 1 2 3 4\n3 0 1 2\n6 0 1 2 -1 3 4\n";

constexpr std::string_view kAllOfObj =
    "mtllib a.mtl\nv 0 0 0 1 0 0\nv 1 0 0\nv 1 1 0\nv .2 .1 0\nv 0 1 0\nvt 0 0\nvn 0 0 1\nusemtl "
    "x\nf 1/1/1 2//1 3/1 -2 \\\n 5\nl 1 2\ng a\nf 1 2 3 # end\n";

constexpr std::string_view kAsciiStl =
    "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 "
    "0\nendloop\nendfacet\nendsolid a\n";

constexpr std::string_view kAllOfACameraPath =
    R"({"varifold_camera_path":1,"name":"a","units":"model","interpolation":"linear",)"
    R"("closed":true,"frames":9,"size":[64,48],"target":[0,0,0],"up":[0,1,0],"fovy_degrees":40,)"
    R"("keys":[{"eye":[0,0,2]},{"frame":5,"eye":[1,0,2],"target":[0,1,0],"up":[1,1,0],)"
    R"("fovy_degrees":1e1}]})";

constexpr std::string_view kSceneGltf =
    R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"children":[1],)"
    R"("rotation":[0,0,1,0],"scale":[1,-1,1],"translation":[1,2,3]},{"mesh":0,"matrix":)"
    R"([1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1]}],"buffers":[{"byteLength":36,"uri":)"
    R"("data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"}],)"
    R"("bufferViews":[{"buffer":0,"byteLength":36,"byteStride":12}],"accessors":[{"bufferView":0,)"
    R"("componentType":5126,"count":3,"type":"VEC3","sparse":{"count":1,"indices":{"bufferView":0,)"
    R"("componentType":5121},"values":{"bufferView":0}}}],"meshes":[{"primitives":[{"attributes":)"
    R"({"POSITION":0},"mode":5,"material":0}]}],"materials":[{"alphaMode":"MASK",)"
    R"("pbrMetallicRoughness":{"baseColorTexture":{"index":0}}}],"textures":[{"source":0}],)"
    R"("images":[{"uri":"data:image/png;base64,AQID"}]})";

bool put(const std::filesystem::path& path, std::span<const std::byte> bytes) {
  std::error_code ignored;
  std::filesystem::create_directories(path.parent_path(), ignored);
  const auto written = write_file(path, bytes);
  if (!written) std::fprintf(stderr, "%s\n", written.error().message.c_str());
  return written.has_value();
}

/// A GLB as the target fuzz_glb takes it: JSON, 0xff, binary chunk.
std::vector<std::byte> json_and_binary(const std::vector<std::byte>& glb) {
  const std::size_t json_size = load<std::uint32_t>(glb.data() + 12);
  std::vector<std::byte> seed(glb.begin() + 20,
                              glb.begin() + 20 + static_cast<std::ptrdiff_t>(json_size));
  seed.push_back(std::byte{0xff});
  seed.insert(seed.end(), glb.begin() + 28 + static_cast<std::ptrdiff_t>(json_size), glb.end());
  return seed;
}

std::vector<std::byte> progressive(const TriangleMesh& mesh, Placement placement, int bits) {
  SimplifyOptions options;
  options.placement = placement;
  return encode_progressive_mesh(build_progressive_mesh(simplify(mesh, options)->detailed),
                                 {bits, bits, bits});
}

bool put_progressive_meshes(const std::filesystem::path& folder) {
  const TriangleMesh sphere = seamed_sphere({.triangles = 80});
  bool done = put(folder / "kept", progressive(sphere, Placement::kKept, 0));
  done = put(folder / "grid", progressive(sphere, Placement::kKept, 8)) && done;
  done = put(folder / "optimal", progressive(sphere, Placement::kOptimal, 8)) && done;
  done = put(folder / "planet",
             progressive(planet({{.triangles = 80}, 0.12f, false}), Placement::kKept, 10)) &&
         done;
  done = put(folder.parent_path() / "deformation" / "moving",
             encode_deformation(build_progressive_mesh(simplify(moving())->detailed))) &&
         done;
  return put(folder / "all", progressive(with_everything(), Placement::kKept, 0)) && done;
}

bool put_view_dependent_meshes(const std::filesystem::path& folder) {
  bool done = true;
  for (const Placement placement : {Placement::kKept, Placement::kOptimal}) {
    SimplifyOptions options;
    options.placement = placement;
    const std::string ending = placement == Placement::kOptimal ? "_optimal" : "";
    for (const auto& [name, mesh] :
         {std::pair("sphere", seamed_sphere({.triangles = 60})),
          std::pair("all", with_everything()), std::pair("plane", plane({.triangles = 18}))})
      done = put(folder / (name + ending), encode_view_dependent_mesh(build_view_dependent_mesh(
                                               simplify(mesh, options)->detailed))) &&
             done;
  }
  return done;
}

bool put_patch_trees(const std::filesystem::path& folder) {
  bool done = true;
  for (const auto& [name, mesh] :
       {std::pair("sphere", seamed_sphere({.triangles = 200})), std::pair("all", with_everything()),
        std::pair("moving", moving()),
        std::pair("planet", planet({{.triangles = 320}, 0.12f, false})),
        std::pair("plane", plane({.triangles = 72}))}) {
    PatchTreeOptions options;
    options.triangles_per_patch = 12;
    const auto built = build_patch_tree(mesh, options);
    done = built && put(folder / name, encode_patch_tree(built->tree)) && done;
  }
  return done;
}

// Small, so that a fuzzer gets far in a second.
bool put_strips(const std::filesystem::path& folder) {
  bool done = true;
  for (const auto& [name, mesh] :
       {std::pair("sphere", seamed_sphere({.triangles = 60})), std::pair("all", with_everything()),
        std::pair("planet", planet({{.triangles = 80}, 0.12f, false})),
        std::pair("plane", plane({.triangles = 18})), std::pair("moving", moving())}) {
    const DetailedMesh detailed = simplify(mesh)->detailed;
    const TriangleStrips strips = stripify(detailed.mesh);
    done = put(folder / "mts" / name, encode_mts(build_mts(detailed, strips))) && done;
    for (const LodStripsForm form : kLodStripsForms)
      done = put(folder / "lodstrips" / (name + std::string("_") + std::string(form_name(form))),
                 encode_lod_strips(build_lod_strips(detailed, form, strips))) &&
             done;
    const auto frames = build_frame_strips(mesh);
    done = frames && put(folder / "framestrips" / name, encode_frame_strips(frames->model)) && done;
    done = put(folder / "strips" / name,
               encode_strip_framework(build_strip_framework(detailed, strips))) &&
           done;
  }
  return done;
}

bool put_camera_paths(const std::filesystem::path& folder) {
  bool done = put(folder / "members", as_bytes(kAllOfACameraPath));
  for (const std::string_view name : known_path_names()) {
    const std::string text = format_camera_path(*known_path(name, {.frames = 5}));
    done = put(folder / name, as_bytes(text)) && done;
  }
  return done;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fprintf(stderr, "usage: fuzz_seeds FOLDER\n");
    return 2;
  }
  const std::filesystem::path folder = argv[1];
  const std::vector<Chunk> chunks{{fourcc("ABCD"), std::vector<std::byte>(300), true},
                                  {fourcc("EFGH"), {std::byte{1}, std::byte{2}}, false},
                                  {fourcc("NONE"), {}, false}};
  std::vector<std::byte> stl(80);
  append_little(stl, std::uint32_t{1});
  stl.resize(stl.size() + 50);
  bool done = true;
  for (const auto& [name, mesh] :
       {std::pair("plain", two_triangles()), std::pair("all", with_everything()),
        std::pair("moving", moving())}) {
    done = put(folder / "ply" / (std::string(name) + "_ascii"), write_ply(mesh, {.ascii = true})) &&
           done;
    done = put(folder / "ply" / name, write_ply(mesh)) && done;
    done = put(folder / "obj" / name, write_obj(mesh, "a").obj) && done;
    done = put(folder / "gltf" / name, *write_glb(mesh)) && done;
    done = put(folder / "glb" / name, json_and_binary(*write_glb(mesh))) && done;
  }
  done = put(folder / "ply" / "polygons", as_bytes(kPolygonsPly)) && done;
  done = put(folder / "obj" / "forms", as_bytes(kAllOfObj)) && done;
  done = put(folder / "stl" / "ascii", as_bytes(kAsciiStl)) && done;
  done = put(folder / "stl" / "binary", stl) && done;
  done = put(folder / "gltf" / "scene", as_bytes(kSceneGltf)) && done;
  done = put(folder / "glb" / "scene", as_bytes(kSceneGltf)) && done;
  done = put(folder / "container" / "three", *encode_container(fourcc("KIND"), chunks)) && done;
  done = put(folder / "container" / "none", *encode_container(fourcc("KIND"), {})) && done;
  done = put_progressive_meshes(folder / "progressive_mesh") && done;
  done = put_view_dependent_meshes(folder / "vdpm") && done;
  done = put_patch_trees(folder / "patch_tree") && done;
  done = put_strips(folder) && done;
  done = put_camera_paths(folder / "camera_path") && done;
  return done ? 0 : 1;
}
