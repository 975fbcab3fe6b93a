// Based on: the glTF 2.0 specification (Khronos, ISO/IEC 12113:2022).
#include <varifold/io/gltf.h>

#include <fmt/format.h>
#include <varifold/base/bytes.h>
#include <varifold/io/gltf_animations.h>
#include <varifold/io/gltf_buffers.h>
#include <varifold/io/gltf_materials.h>
#include <varifold/io/gltf_rig.h>
#include <varifold/io/gltf_scene.h>
#include <varifold/io/gltf_vertices.h>
#include <varifold/io/import_check.h>
#include <algorithm>
#include <array>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

namespace varifold {
namespace {

using gltf::Accessor;
using gltf::ComponentType;
using gltf::VertexBlock;

enum PrimitiveMode : std::uint64_t { kTriangles = 4, kTriangleStrip = 5, kTriangleFan = 6 };

/// Extensions that a reader may require without a change to the triangles, or that are read.
bool is_supported(const std::string& extension) {
  static constexpr std::array<std::string_view, 8> kSupported{
      "KHR_mesh_quantization", "KHR_lights_punctual",  "KHR_texture_basisu",
      "EXT_texture_webp",      "EXT_texture_avif",     "KHR_xmp",
      "KHR_xmp_json_ld",       "KHR_animation_pointer"};
  return extension.starts_with("KHR_materials_") ||
         std::find(kSupported.begin(), kSupported.end(), extension) != kSupported.end();
}

/// Room for `count` more values; at least doubles, so that many small additions stay linear.
template <class T>
void reserve_more(std::vector<T>& values, std::size_t count) {
  const std::size_t needed = values.size() + count;
  if (needed > values.capacity()) values.reserve(std::max(needed, 2 * values.capacity()));
}

class GltfReader {
 public:
  GltfReader(const nlohmann::json& document, const gltf::Parts& parts,
             const std::filesystem::path& folder)
      : root_(&document, "", fault_),
        buffers_(root_, parts, folder, fault_),
        budget_(buffers_),
        vertices_(buffers_, budget_, fault_, imported_) {}

  Result<ImportedMesh> read() {
    check_asset();
    scene_ = gltf::collect_scene(root_);
    if (fault_.any()) return fault_.take();
    gltf::read_images(root_, buffers_, budget_, imported_);
    gltf::read_materials(root_, imported_);
    rig_.emplace(root_, scene_, buffers_, budget_, fault_);
    poses_of_node_.resize(scene_.place_of.size());
    for (std::uint32_t place = 0; place < scene_.nodes.size() && !fault_.any(); ++place)
      if (scene_.nodes[place].has_mesh) read_instance(place);
    if (fault_.any()) return fault_.take();
    return finish();
  }

 private:
  // --- the document ---

  void check_asset() {
    const std::string version = root_.object("asset").text("version");
    if (!version.starts_with("2."))
      root_.object("asset").fault("version " + in_quotes(version) + " is not 2.x",
                                  ErrorKind::kUnsupported);
    const JsonElement required = root_.array("extensionsRequired");
    for (std::size_t i = 0; i < required.size(); ++i) {
      const std::string name = required.text_item(i);
      if (!is_supported(name))
        required.fault(in_quotes(name) + " is not supported", ErrorKind::kUnsupported);
    }
  }

  // --- meshes ---

  /// A primitive's vertices with a skin stay where they are; those without are moved by the node.
  void read_instance(std::uint32_t place) {
    const gltf::SceneNode& instance = scene_.nodes[place];
    const JsonElement mesh = root_.array("meshes").item(instance.mesh);
    const JsonElement node = instance.index == kNone ? JsonElement(nullptr, "", fault_)
                                                     : root_.array("nodes").item(instance.index);
    const JsonElement primitives = mesh.array("primitives");
    gltf::Placement placement{rig_->mover_of(place), {}, vertices_.targets().add_poses(mesh, node)};
    if (instance.index != kNone) poses_of_node_[instance.index] = placement.poses;
    gltf::Placement skinned{gltf::Mover(), {}, placement.poses};
    std::map<gltf::VertexReader::Key, VertexBlock> blocks;
    for (std::size_t i = 0; i < primitives.size() && !fault_.any(); ++i) {
      const JsonElement primitive = primitives.item(i);
      const bool has_skin = node.has("skin") && primitive.object("attributes").has("JOINTS_0");
      if (has_skin)
        skinned.binding = rig_->bind_to_skin(place);
      else
        placement.binding = rig_->bind_to_node(place);
      if (!fault_.any()) read_primitive(primitive, has_skin ? skinned : placement, blocks);
    }
  }

  void read_primitive(const JsonElement& primitive, const gltf::Placement& placement,
                      std::map<gltf::VertexReader::Key, VertexBlock>& blocks) {
    const std::uint64_t mode = primitive.whole("mode", kTriangles);
    const JsonElement attributes = primitive.object("attributes");
    if (mode > kTriangleFan) primitive.fault(fmt::format("unknown mode {}", mode));
    if (mode < kTriangles) {
      ++points_and_lines_;
      return;
    }
    if (!attributes.has("POSITION")) {
      ++without_positions_;
      return;
    }
    const gltf::VertexReader::Key key = vertices_.key_of(primitive);
    check_compression(primitive, attributes.whole("POSITION"));
    if (fault_.any()) return;

    auto found = blocks.find(key);
    if (found == blocks.end())
      found = blocks.emplace(key, vertices_.read(primitive, placement)).first;
    if (fault_.any()) return;
    const std::vector<std::uint32_t> corners = read_corners(primitive, found->second);
    if (fault_.any()) return;
    add_triangles(corners, mode, found->second.first, placement.mover.mirrors());
    set_material(primitive);
  }

  /// Where a compressed primitive has no plain data beside it, its accessors would read as zeros.
  void check_compression(const JsonElement& primitive, std::uint64_t position) {
    constexpr const char* kCompression = "KHR_draco_mesh_compression";
    if (primitive.object("extensions").has(kCompression) &&
        !root_.array("accessors").item(position).has("bufferView"))
      primitive.fault(std::string(kCompression) + " is not supported", ErrorKind::kUnsupported);
  }

  // --- triangles ---

  std::vector<std::uint32_t> read_corners(const JsonElement& primitive, const VertexBlock& block) {
    std::vector<std::uint32_t> corners;
    if (!primitive.has("indices")) {
      spend(primitive, block.count * sizeof(std::uint32_t));
      if (fault_.any()) return corners;
      for (std::uint32_t i = 0; i < block.count; ++i) corners.push_back(i);
      return corners;
    }
    const Accessor accessor = buffers_.accessor(primitive.whole("indices"));
    const ComponentType type = accessor.elements.type;
    if (accessor.components != 1 ||
        (type != ComponentType::kUint8 && type != ComponentType::kUint16 &&
         type != ComponentType::kUint32))
      primitive.fault("indices are not unsigned whole numbers");
    spend(primitive, accessor.elements.count * sizeof(std::uint32_t));
    if (fault_.any()) return corners;
    corners = decode_indices(accessor);
    const auto bad = std::find_if(corners.begin(), corners.end(),
                                  [&](std::uint32_t index) { return index >= block.count; });
    if (bad != corners.end())
      primitive.fault(fmt::format("index {} at position {} is out of range ({} vertices)", *bad,
                                  bad - corners.begin(), block.count));
    return corners;
  }

  void add_triangles(const std::vector<std::uint32_t>& corners, std::uint64_t mode,
                     std::uint32_t first, bool mirrored) {
    const auto add = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
      if (mirrored) std::swap(b, c);
      imported_.mesh.indices.insert(imported_.mesh.indices.end(),
                                    {first + a, first + b, first + c});
    };
    if (mode == kTriangles) {
      if (corners.size() % 3 != 0) ++incomplete_;
      std::vector<std::uint32_t>& indices = imported_.mesh.indices;
      // At least twice the room, so that many small additions stay linear.
      if (const std::size_t needed = indices.size() + corners.size(); needed > indices.capacity())
        indices.reserve(std::max(needed, 2 * indices.capacity()));
      for (std::size_t i = 0; i + 2 < corners.size(); i += 3)
        add(corners[i], corners[i + 1], corners[i + 2]);
      return;
    }
    for (std::size_t i = 2; i < corners.size(); ++i) {
      std::uint32_t a = mode == kTriangleFan ? corners[0] : corners[i - 2];
      std::uint32_t b = corners[i - 1];
      const std::uint32_t c = corners[i];
      if (mode == kTriangleStrip && i % 2 == 1) std::swap(a, b);
      // Triangles without area join strips to longer ones.
      if (a != b && b != c && c != a) add(a, b, c);
    }
  }

  void set_material(const JsonElement& primitive) {
    const std::uint64_t material = primitive.whole("material", kNone);
    const std::size_t material_count = root_.array("materials").size();
    if (material != kNone && material >= material_count)
      return primitive.fault(
          fmt::format("material {} does not exist ({} materials)", material, material_count));
    material_of_.resize(imported_.mesh.indices.size() / 3, static_cast<std::uint32_t>(material));
  }

  void spend(const JsonElement& element, std::size_t bytes) {
    if (!budget_.spend(bytes))
      element.fault("the instances of the meshes take many times the size of the file",
                    ErrorKind::kUnsupported);
  }

  // --- the end ---

  Result<ImportedMesh> finish() {
    if (auto checked = check_positions(imported_.mesh); !checked)
      return tl::unexpected(checked.error());
    set_ranges();
    vertices_.finish();
    add_rig();
    if (fault_.any()) return fault_.take();
    warn_count(imported_, points_and_lines_, "primitives of points or lines were dropped");
    warn_count(imported_, without_positions_, "primitives without positions were dropped");
    warn_count(imported_, incomplete_, "primitives end in an incomplete triangle");
    return finish_import(std::move(imported_));
  }

  void add_rig() {
    Rig rig = rig_->take();
    rig.pose_weights = vertices_.targets().weights();
    const gltf::AnimatedNodes nodes{rig, rig_->rig_node_of(), poses_of_node_};
    gltf::read_animations(root_, nodes, buffers_, budget_, fault_, imported_);
    if (!rig.joints.empty() || !rig.pose_weights.empty() || !rig.animations.empty())
      imported_.mesh.rig = std::make_shared<const Rig>(std::move(rig));
  }

  void set_ranges() {
    TriangleMesh& mesh = imported_.mesh;
    if (mesh.materials.empty()) return;
    if (std::find(material_of_.begin(), material_of_.end(), kNone) != material_of_.end()) {
      std::replace(material_of_.begin(), material_of_.end(), kNone,
                   static_cast<std::uint32_t>(mesh.materials.size()));
      mesh.materials.push_back(gltf::default_material());
    }
    set_triangle_materials(mesh, material_of_);
  }

  FirstFault fault_;
  JsonElement root_;
  gltf::BufferStore buffers_;
  gltf::Budget budget_;
  ImportedMesh imported_;
  gltf::VertexReader vertices_;
  gltf::Scene scene_;
  std::optional<gltf::RigBuilder> rig_;
  std::vector<gltf::PoseRange> poses_of_node_;
  std::vector<std::uint32_t> material_of_;
  std::size_t points_and_lines_ = 0;
  std::size_t without_positions_ = 0;
  std::size_t incomplete_ = 0;
};

}  // namespace

Result<ImportedMesh> read_gltf(std::span<const std::byte> file,
                               const std::filesystem::path& folder) {
  const auto parts = gltf::split_file(file);
  if (!parts) return tl::unexpected(parts.error());
  const auto document = parse_json(as_text(parts->json));
  if (!document) return tl::unexpected(document.error());
  if (!document->is_object()) return fail(ErrorKind::kInvalidInput, "the JSON is not an object");
  auto result = GltfReader(*document, *parts, folder).read();
  if (result)
    warn_count(*result, parts->trailing_bytes, "bytes after the end that the header tells");
  return result;
}

}  // namespace varifold
