// Based on: the glTF 2.0 specification (Khronos, ISO/IEC 12113:2022).
#include <varifold/io/gltf.h>

#include <fmt/format.h>
#include <varifold/base/bytes.h>
#include <varifold/io/gltf_buffers.h>
#include <varifold/io/gltf_materials.h>
#include <varifold/io/gltf_scene.h>
#include <varifold/io/import_check.h>
#include <algorithm>
#include <array>
#include <cmath>
#include <glm/mat3x3.hpp>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

namespace varifold {
namespace {

using gltf::Accessor;
using gltf::ComponentType;
using gltf::Instance;

constexpr std::array<std::string_view, 4> kAttributes{"POSITION", "NORMAL", "TEXCOORD_0",
                                                      "COLOR_0"};

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

/// Moves points and directions; leaves them as they are, bit by bit, where it is the identity.
class Mover {
 public:
  explicit Mover(const glm::dmat4& transform)
      : matrix_(transform), is_identity_(transform == glm::dmat4(1)) {
    const glm::dmat3 linear(transform);
    // The matrix of cofactors is the inverse transpose times the determinant, and always exists.
    for (int i = 0; i < 3; ++i)
      cofactors_[i] = glm::cross(linear[(i + 1) % 3], linear[(i + 2) % 3]);
    mirrors_ = glm::dot(linear[0], cofactors_[0]) < 0;
    if (mirrors_) cofactors_ = -cofactors_;
  }
  [[nodiscard]] bool mirrors() const { return mirrors_; }
  [[nodiscard]] Vec3 point(const Vec3& p) const {
    return is_identity_ ? p : Vec3(matrix_ * glm::dvec4(p, 1));
  }
  [[nodiscard]] Vec3 normal(const Vec3& n) const {
    return is_identity_ ? n : normalize_or_zero(Vec3(glm::normalize(cofactors_ * DVec3(n))));
  }

 private:
  glm::dmat4 matrix_;
  glm::dmat3 cofactors_{1};
  bool is_identity_;
  bool mirrors_ = false;
};

class GltfReader {
 public:
  GltfReader(const nlohmann::json& document, const gltf::Parts& parts,
             const std::filesystem::path& folder)
      : root_(&document, "", fault_), buffers_(root_, parts, folder, fault_), budget_(buffers_) {}

  Result<ImportedMesh> read() {
    check_asset();
    const std::vector<Instance> instances = gltf::collect_instances(root_);
    if (fault_.any()) return fault_.take();
    gltf::read_images(root_, buffers_, budget_, imported_);
    gltf::read_materials(root_, imported_);
    for (const Instance& instance : instances) {
      read_instance(instance);
      if (fault_.any()) return fault_.take();
    }
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
    for (const char* dropped : {"animations", "skins"})
      if (root_.array(dropped).size() > 0)
        imported_.warnings.push_back(std::string(dropped) + " were dropped");
  }

  // --- meshes ---

  /// Vertices that a primitive of this instance has already brought, by their accessors.
  struct VertexBlock {
    std::uint32_t first = 0;
    std::uint32_t count = 0;
  };
  using Accessors = std::array<std::uint64_t, kAttributes.size()>;

  void read_instance(const Instance& instance) {
    const JsonElement mesh = root_.array("meshes").item(instance.mesh);
    const JsonElement primitives = mesh.array("primitives");
    const Mover mover(instance.transform);
    std::map<Accessors, VertexBlock> blocks;
    for (std::size_t i = 0; i < primitives.size() && !fault_.any(); ++i)
      read_primitive(primitives.item(i), mover, blocks);
  }

  void read_primitive(const JsonElement& primitive, const Mover& mover,
                      std::map<Accessors, VertexBlock>& blocks) {
    const std::uint64_t mode = primitive.whole("mode", kTriangles);
    const JsonElement attributes = primitive.object("attributes");
    if (mode > kTriangleFan) primitive.fault(fmt::format("unknown mode {}", mode));
    if (mode < kTriangles) {
      ++points_and_lines_;
      return;
    }
    if (primitive.array("targets").size() > 0) ++morphed_;
    if (!attributes.has("POSITION")) {
      ++without_positions_;
      return;
    }
    Accessors accessors{};
    for (std::size_t i = 0; i < kAttributes.size(); ++i)
      accessors[i] = attributes.whole(kAttributes[i], kNone);
    for (const std::string& name : attributes.keys())
      if (std::find(kAttributes.begin(), kAttributes.end(), name) == kAttributes.end())
        dropped_attributes_.insert(name);
    check_compression(primitive, accessors[0]);
    if (fault_.any()) return;

    auto found = blocks.find(accessors);
    if (found == blocks.end())
      found = blocks.emplace(accessors, read_vertices(attributes, accessors, mover)).first;
    if (fault_.any()) return;
    const std::vector<std::uint32_t> corners = read_corners(primitive, found->second);
    if (fault_.any()) return;
    add_triangles(corners, mode, found->second.first, mover.mirrors());
    set_material(primitive);
  }

  /// Where a compressed primitive has no plain data beside it, its accessors would read as zeros.
  void check_compression(const JsonElement& primitive, std::uint64_t position) {
    constexpr const char* kCompression = "KHR_draco_mesh_compression";
    if (primitive.object("extensions").has(kCompression) &&
        !root_.array("accessors").item(position).has("bufferView"))
      primitive.fault(std::string(kCompression) + " is not supported", ErrorKind::kUnsupported);
  }

  // --- vertices ---

  VertexBlock read_vertices(const JsonElement& attributes, const Accessors& accessors,
                            const Mover& mover) {
    TriangleMesh& mesh = imported_.mesh;
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    std::array<std::vector<float>, kAttributes.size()> values;
    std::size_t count = 0;
    unsigned color_components = 4;
    for (std::size_t i = 0; i < kAttributes.size(); ++i) {
      if (accessors[i] == kNone) continue;
      const Accessor accessor = buffers_.accessor(accessors[i]);
      if (fault_.any()) return {};
      check_attribute(attributes, i, accessor);
      if (i == 0) count = accessor.elements.count;
      if (accessor.elements.count != count)
        attributes.fault(fmt::format("{} has {} elements, POSITION has {}", kAttributes[i],
                                     accessor.elements.count, count));
      spend(attributes, count * accessor.components * sizeof(float));
      if (fault_.any()) return {};
      if (i == 3) color_components = accessor.components;
      values[i] = decode_floats(accessor);
    }
    if (first + count >= kNone) {
      attributes.fault("more vertices than 32 bits can count", ErrorKind::kUnsupported);
      return {};
    }
    append_vertices(values, count, color_components, mover);
    return {first, static_cast<std::uint32_t>(count)};
  }

  void check_attribute(const JsonElement& attributes, std::size_t attribute,
                       const Accessor& accessor) {
    static constexpr std::array<unsigned, kAttributes.size()> kComponents{3, 3, 2, 4};
    const bool fits = accessor.components == kComponents[attribute] ||
                      (attribute == 3 && accessor.components == 3);
    if (!fits)
      attributes.fault(
          fmt::format("{} has {} components", kAttributes[attribute], accessor.components));
    if (accessor.elements.type == ComponentType::kUint32)
      attributes.fault(fmt::format("{} has components of 32-bit integers", kAttributes[attribute]));
  }

  void append_vertices(const std::array<std::vector<float>, kAttributes.size()>& values,
                       std::size_t count, unsigned color_components, const Mover& mover) {
    TriangleMesh& mesh = imported_.mesh;
    const std::size_t first = mesh.positions.size();
    const auto& [positions, normals, texcoords, colors] = values;
    reserve_more(mesh.positions, count);
    for (std::size_t i = 0; i < count; ++i)
      mesh.positions.push_back(
          mover.point({positions[3 * i], positions[3 * i + 1], positions[3 * i + 2]}));
    if (!normals.empty()) {
      mesh.normals.resize(first, Vec3(0));
      for (std::size_t i = 0; i < count; ++i)
        mesh.normals.push_back(
            mover.normal({normals[3 * i], normals[3 * i + 1], normals[3 * i + 2]}));
    } else if (count > 0) {
      without_normals_.push_back(
          {static_cast<std::uint32_t>(first), static_cast<std::uint32_t>(count)});
    }
    if (!texcoords.empty()) {
      mesh.texcoords.resize(first, Vec2(0));
      for (std::size_t i = 0; i < count; ++i)
        mesh.texcoords.emplace_back(texcoords[2 * i], texcoords[2 * i + 1]);
    }
    if (!colors.empty()) {
      colors_not_finite_ += static_cast<std::size_t>(std::count_if(
          colors.begin(), colors.end(), [](float value) { return !std::isfinite(value); }));
      mesh.colors.resize(first, kWhite);
      for (std::size_t i = 0; i < count; ++i)
        mesh.colors.push_back(to_color(&colors[color_components * i], color_components));
    }
  }

  static Color to_color(const float* values, unsigned components) {
    Color color = kWhite;
    for (unsigned i = 0; i < components; ++i) color[static_cast<int>(i)] = color_byte(values[i]);
    return color;
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
      reserve_more(imported_.mesh.indices, corners.size());
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
    TriangleMesh& mesh = imported_.mesh;
    const std::size_t count = mesh.positions.size();
    if (mesh.has_texcoords()) mesh.texcoords.resize(count, Vec2(0));
    if (mesh.has_colors()) mesh.colors.resize(count, kWhite);
    if (mesh.has_normals()) mesh.normals.resize(count, Vec3(0));
    if (auto checked = check_positions(mesh); !checked) return tl::unexpected(checked.error());
    fill_normals();
    set_ranges();
    for (const std::string& name : dropped_attributes_)
      imported_.warnings.push_back("attribute " + in_quotes(name) + " was dropped");
    warn_count(imported_, colors_not_finite_, "components of colours that are not finite became 0");
    warn_count(imported_, morphed_, "primitives have morph targets, which were dropped");
    warn_count(imported_, points_and_lines_, "primitives of points or lines were dropped");
    warn_count(imported_, without_positions_, "primitives without positions were dropped");
    warn_count(imported_, incomplete_, "primitives end in an incomplete triangle");
    return finish_import(std::move(imported_));
  }

  void fill_normals() {
    TriangleMesh& mesh = imported_.mesh;
    if (!mesh.has_normals() || without_normals_.empty()) return;
    std::vector<bool> is_missing(mesh.positions.size(), false);
    std::size_t missing = 0;
    for (const VertexBlock& block : without_normals_) {
      std::fill_n(is_missing.begin() + block.first, block.count, true);
      missing += block.count;
    }
    fill_missing_normals(mesh, is_missing);
    warn_count(imported_, missing, "vertices without normal got that of their triangles");
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

  static constexpr Color kWhite{255, 255, 255, 255};

  FirstFault fault_;
  JsonElement root_;
  gltf::BufferStore buffers_;
  gltf::Budget budget_;
  ImportedMesh imported_;
  std::vector<std::uint32_t> material_of_;
  std::vector<VertexBlock> without_normals_;
  std::set<std::string> dropped_attributes_;
  std::size_t points_and_lines_ = 0;
  std::size_t without_positions_ = 0;
  std::size_t morphed_ = 0;
  std::size_t colors_not_finite_ = 0;
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
