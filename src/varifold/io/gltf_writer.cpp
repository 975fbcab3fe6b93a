#include <varifold/io/gltf.h>

#include <varifold/base/bytes.h>
#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

namespace varifold {
namespace {

using Json = nlohmann::ordered_json;

constexpr int kUint8 = 5121;
constexpr int kUint16 = 5123;
constexpr int kUint32 = 5125;
constexpr int kFloat32 = 5126;
constexpr int kArrayBuffer = 34962;
constexpr int kElementArrayBuffer = 34963;
constexpr std::uint32_t kJsonChunk = 0x4e4f534a;    // "JSON"
constexpr std::uint32_t kBinaryChunk = 0x004e4942;  // "BIN\0"

void pad(std::vector<std::byte>& bytes, char filler) {
  while (bytes.size() % 4 != 0) bytes.push_back(static_cast<std::byte>(filler));
}

/// JSON has no infinities.
float finite(float value, float fallback) { return std::isfinite(value) ? value : fallback; }

/// Builds the JSON and the binary chunk side by side.
class GlbBuilder {
 public:
  GlbBuilder(const TriangleMesh& mesh, const JoinedStrips* strips) : mesh_(mesh), strips_(strips) {
    document_["asset"] = {{"version", "2.0"}, {"generator", "Varifold"}};
  }

  Result<std::vector<std::byte>> build() {
    document_["scene"] = 0;
    if (mesh_.positions.empty()) {
      document_["scenes"] = Json::array({Json::object()});
    } else {
      document_["scenes"] = Json::array({{{"nodes", {0}}}});
      document_["nodes"] = Json::array({{{"mesh", 0}}});
      document_["meshes"] = Json::array({{{"primitives", primitives()}}});
    }
    add_materials();
    add_images();
    if (!binary_.empty()) document_["buffers"] = Json::array({{{"byteLength", binary_.size()}}});
    return assemble();
  }

 private:
  // --- geometry ---

  Json primitives() {
    const Json attributes = add_attributes();
    Json result = Json::array();
    if (mesh_.indices.empty() || (strips_ && strips_->ranges.empty())) {
      constexpr int kPoints = 0;
      result.push_back({{"attributes", attributes}, {"mode", kPoints}});
      return result;
    }
    if (strips_) return strip_primitives(attributes);
    if (mesh_.ranges.empty()) {
      result.push_back({{"attributes", attributes}, {"indices", add_indices(mesh_.indices)}});
      return result;
    }
    for (const MaterialRange& range : mesh_.ranges) {
      if (range.triangle_count == 0) continue;
      result.push_back(
          {{"attributes", attributes},
           {"indices", add_indices(std::span(mesh_.indices)
                                       .subspan(3 * std::size_t{range.first_triangle},
                                                3 * std::size_t{range.triangle_count}))},
           {"material", range.material}});
    }
    return result;
  }

  Json strip_primitives(const Json& attributes) {
    constexpr int kTriangleStrip = 5;
    Json result = Json::array();
    for (const DrawRange& range : strips_->ranges) {
      const auto indices =
          std::span(strips_->indices).subspan(range.first_index, range.index_count);
      assert(std::find(indices.begin(), indices.end(), kStripRestart) == indices.end());
      Json primitive = {
          {"attributes", attributes}, {"indices", add_indices(indices)}, {"mode", kTriangleStrip}};
      if (!mesh_.ranges.empty()) primitive["material"] = range.material;
      result.push_back(std::move(primitive));
    }
    return result;
  }

  Json add_attributes() {
    Json attributes;
    attributes["POSITION"] = add_floats<3>(mesh_.positions, "VEC3");
    Vec3 lower = mesh_.positions[0];
    Vec3 upper = lower;
    for (const Vec3& p : mesh_.positions) {
      lower = glm::min(lower, p);
      upper = glm::max(upper, p);
    }
    Json& accessor = document_["accessors"].back();
    accessor["min"] = {lower.x, lower.y, lower.z};
    accessor["max"] = {upper.x, upper.y, upper.z};
    if (mesh_.has_normals()) attributes["NORMAL"] = add_floats<3>(mesh_.normals, "VEC3");
    if (mesh_.has_texcoords()) attributes["TEXCOORD_0"] = add_floats<2>(mesh_.texcoords, "VEC2");
    if (mesh_.has_colors()) attributes["COLOR_0"] = add_colors();
    return attributes;
  }

  template <int kCount, class T>
  std::size_t add_floats(const std::vector<T>& values, const char* type) {
    const std::size_t first = binary_.size();
    binary_.resize(first + values.size() * kCount * sizeof(float));
    std::byte* at = binary_.data() + first;
    for (const T& value : values)
      for (int i = 0; i < kCount; ++i, at += sizeof(float)) store_little(at, value[i]);
    return add_accessor(kFloat32, type, values.size(), add_view(first, kArrayBuffer));
  }

  std::size_t add_colors() {
    const std::size_t first = binary_.size();
    for (const Color& color : mesh_.colors)
      for (int i = 0; i < 4; ++i) binary_.push_back(static_cast<std::byte>(color[i]));
    const std::size_t accessor =
        add_accessor(kUint8, "VEC4", mesh_.colors.size(), add_view(first, kArrayBuffer));
    document_["accessors"].back()["normalized"] = true;
    return accessor;
  }

  /// The largest value of a type would restart a strip, so that it is no index.
  std::size_t add_indices(std::span<const std::uint32_t> indices) {
    const bool is_short = mesh_.positions.size() <= std::numeric_limits<std::uint16_t>::max();
    const std::size_t first = binary_.size();
    binary_.resize(first + indices.size() * (is_short ? 2 : 4));
    std::byte* const at = binary_.data() + first;
    for (std::size_t i = 0; i < indices.size(); ++i) {
      if (is_short)
        store_little(at + 2 * i, static_cast<std::uint16_t>(indices[i]));
      else
        store_little(at + 4 * i, indices[i]);
    }
    return add_accessor(is_short ? kUint16 : kUint32, "SCALAR", indices.size(),
                        add_view(first, kElementArrayBuffer));
  }

  /// A buffer view from `first` to the end of what has been written; target 0: none.
  std::size_t add_view(std::size_t first, int target) {
    Json view = {{"buffer", 0}, {"byteOffset", first}, {"byteLength", binary_.size() - first}};
    if (target != 0) view["target"] = target;
    document_["bufferViews"].push_back(std::move(view));
    pad(binary_, '\0');
    return document_["bufferViews"].size() - 1;
  }

  std::size_t add_accessor(int component_type, const char* type, std::size_t count,
                           std::size_t view) {
    document_["accessors"].push_back({{"bufferView", view},
                                      {"componentType", component_type},
                                      {"count", count},
                                      {"type", type}});
    return document_["accessors"].size() - 1;
  }

  // --- materials ---

  void add_materials() {
    for (const Material& material : mesh_.materials) {
      Json entry = {{"name", material.name}};
      const Vec4& color = material.base_color;
      Json& rough = entry["pbrMetallicRoughness"];
      rough["baseColorFactor"] = {finite(color.x, 1), finite(color.y, 1), finite(color.z, 1),
                                  finite(color.w, 1)};
      rough["metallicFactor"] = finite(material.metallic, 0);
      rough["roughnessFactor"] = finite(material.roughness, 1);
      add_texture(material, TextureUse::kBaseColor, "baseColorTexture", rough);
      add_texture(material, TextureUse::kMetallicRoughness, "metallicRoughnessTexture", rough);
      add_texture(material, TextureUse::kNormal, "normalTexture", entry);
      add_texture(material, TextureUse::kOcclusion, "occlusionTexture", entry);
      add_texture(material, TextureUse::kEmissive, "emissiveTexture", entry);
      const Vec3& emissive = material.emissive;
      entry["emissiveFactor"] = {finite(emissive.x, 0), finite(emissive.y, 0),
                                 finite(emissive.z, 0)};
      entry["alphaMode"] = material.alpha_mode;
      if (material.alpha_mode == "MASK") entry["alphaCutoff"] = finite(material.alpha_cutoff, 0.5f);
      entry["doubleSided"] = material.double_sided;
      document_["materials"].push_back(std::move(entry));
    }
  }

  /// Every image has one texture of the same index.
  void add_texture(const Material& material, TextureUse use, const char* key, Json& owner) const {
    const std::uint32_t image = material.textures[static_cast<std::size_t>(use)];
    if (image < mesh_.images.size()) owner[key] = {{"index", image}};
  }

  void add_images() {
    for (std::size_t i = 0; i < mesh_.images.size(); ++i) {
      const Image& image = mesh_.images[i];
      Json entry = Json::object();
      if (!image.name.empty()) entry["name"] = image.name;
      if (!image.mime_type.empty()) entry["mimeType"] = image.mime_type;
      if (image.bytes.empty()) {
        entry["uri"] = image.uri;
      } else {
        const std::size_t first = binary_.size();
        const auto bytes = std::as_bytes(std::span(image.bytes));
        binary_.insert(binary_.end(), bytes.begin(), bytes.end());
        entry["bufferView"] = add_view(first, 0);
        // Required beside a buffer view.
        if (image.mime_type.empty()) entry["mimeType"] = guessed_type(image);
      }
      document_["images"].push_back(std::move(entry));
      document_["textures"].push_back({{"source", i}});
    }
  }

  static const char* guessed_type(const Image& image) {
    return !image.bytes.empty() && image.bytes[0] == 0xff ? "image/jpeg" : "image/png";
  }

  // --- the file ---

  Result<std::vector<std::byte>> assemble() {
    constexpr std::size_t kHeaders = 12 + 8 + 8;
    const std::string text =
        document_.dump(-1, ' ', false, Json::error_handler_t::replace);  // never throws
    std::vector<std::byte> json(as_bytes(text).begin(), as_bytes(text).end());
    pad(json, ' ');
    const std::size_t size = kHeaders - (binary_.empty() ? 8 : 0) + json.size() + binary_.size();
    if (size > std::numeric_limits<std::uint32_t>::max())
      return fail(ErrorKind::kFailed, "the file would be longer than the 4 GiB of a GLB");

    std::vector<std::byte> file;
    file.reserve(size);
    append_text(file, "glTF");
    append_little(file, std::uint32_t{2});
    append_little(file, static_cast<std::uint32_t>(size));
    append_chunk(file, kJsonChunk, json);
    if (!binary_.empty()) append_chunk(file, kBinaryChunk, binary_);
    return file;
  }
  static void append_chunk(std::vector<std::byte>& file, std::uint32_t type,
                           const std::vector<std::byte>& bytes) {
    append_little(file, static_cast<std::uint32_t>(bytes.size()));
    append_little(file, type);
    file.insert(file.end(), bytes.begin(), bytes.end());
  }

  const TriangleMesh& mesh_;
  const JoinedStrips* strips_;
  Json document_;
  std::vector<std::byte> binary_;
};

}  // namespace

Result<std::vector<std::byte>> write_glb(const TriangleMesh& mesh, const JoinedStrips* strips) {
  return GlbBuilder(mesh, strips).build();
}

}  // namespace varifold
