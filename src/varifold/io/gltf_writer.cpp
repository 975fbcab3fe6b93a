#include <varifold/io/gltf.h>

#include <varifold/io/gltf_output.h>
#include <varifold/io/gltf_rig_writer.h>
#include <algorithm>
#include <cassert>

namespace varifold {
namespace {

using Json = gltf::OutputJson;
using gltf::finite_or;

/// Builds the file of a mesh part by part.
class GlbBuilder {
 public:
  GlbBuilder(const TriangleMesh& mesh, const JoinedStrips* strips) : mesh_(mesh), strips_(strips) {
    output_.document["asset"] = {{"version", "2.0"}, {"generator", "Varifold"}};
  }

  Result<std::vector<std::byte>> build() {
    output_.document["scene"] = 0;
    if (mesh_.positions.empty()) {
      output_.document["scenes"] = Json::array({Json::object()});
    } else {
      output_.document["meshes"] = Json::array({{{"primitives", primitives()}}});
      gltf::add_scene(mesh_, output_);
    }
    add_materials();
    add_images();
    return output_.assemble();
  }

 private:
  // --- geometry ---

  Json primitives() {
    const Json vertices = add_vertices();
    Json result = Json::array();
    if (mesh_.indices.empty() || (strips_ && strips_->ranges.empty())) {
      constexpr int kPoints = 0;
      result.push_back(vertices);
      result.back()["mode"] = kPoints;
    } else if (strips_) {
      add_strips(vertices, result);
    } else if (mesh_.ranges.empty()) {
      result.push_back(vertices);
      result.back()["indices"] = add_indices(mesh_.indices);
    } else {
      for (const MaterialRange& range : mesh_.ranges) {
        if (range.triangle_count == 0) continue;
        result.push_back(vertices);
        result.back()["indices"] = add_indices(std::span(mesh_.indices)
                                                   .subspan(3 * std::size_t{range.first_triangle},
                                                            3 * std::size_t{range.triangle_count}));
        result.back()["material"] = range.material;
      }
    }
    return result;
  }

  void add_strips(const Json& vertices, Json& result) {
    constexpr int kTriangleStrip = 5;
    for (const DrawRange& range : strips_->ranges) {
      const auto indices =
          std::span(strips_->indices).subspan(range.first_index, range.index_count);
      assert(std::find(indices.begin(), indices.end(), kStripRestart) == indices.end());
      result.push_back(vertices);
      result.back()["indices"] = add_indices(indices);
      result.back()["mode"] = kTriangleStrip;
      if (!mesh_.ranges.empty()) result.back()["material"] = range.material;
    }
  }

  std::size_t add_indices(std::span<const std::uint32_t> indices) {
    return output_.add_indices(indices, mesh_.positions.size());
  }

  /// What all primitives have: attributes and morph targets.
  Json add_vertices() {
    Json attributes;
    attributes["POSITION"] = output_.add_vectors(mesh_.positions, "VEC3");
    output_.set_bounds({&mesh_.positions[0][0], 3 * mesh_.positions.size()}, 3);
    if (mesh_.has_normals()) attributes["NORMAL"] = output_.add_vectors(mesh_.normals, "VEC3");
    if (mesh_.has_texcoords())
      attributes["TEXCOORD_0"] = output_.add_vectors(mesh_.texcoords, "VEC2");
    if (mesh_.has_colors())
      attributes["COLOR_0"] =
          output_.add_bytes({&mesh_.colors[0][0], 4 * mesh_.colors.size()}, "VEC4", 4, true);
    gltf::add_skin_attributes(mesh_, attributes, output_);
    Json vertices = {{"attributes", std::move(attributes)}};
    if (!mesh_.poses.empty()) vertices["targets"] = gltf::add_targets(mesh_, output_);
    return vertices;
  }

  // --- materials ---

  void add_materials() {
    for (const Material& material : mesh_.materials) {
      Json entry = {{"name", material.name}};
      const Vec4& color = material.base_color;
      Json& rough = entry["pbrMetallicRoughness"];
      rough["baseColorFactor"] = {finite_or(color.x, 1), finite_or(color.y, 1),
                                  finite_or(color.z, 1), finite_or(color.w, 1)};
      rough["metallicFactor"] = finite_or(material.metallic, 0);
      rough["roughnessFactor"] = finite_or(material.roughness, 1);
      add_texture(material, TextureUse::kBaseColor, "baseColorTexture", rough);
      add_texture(material, TextureUse::kMetallicRoughness, "metallicRoughnessTexture", rough);
      add_texture(material, TextureUse::kNormal, "normalTexture", entry);
      add_texture(material, TextureUse::kOcclusion, "occlusionTexture", entry);
      add_texture(material, TextureUse::kEmissive, "emissiveTexture", entry);
      const Vec3& emissive = material.emissive;
      entry["emissiveFactor"] = {finite_or(emissive.x, 0), finite_or(emissive.y, 0),
                                 finite_or(emissive.z, 0)};
      entry["alphaMode"] = material.alpha_mode;
      if (material.alpha_mode == "MASK")
        entry["alphaCutoff"] = finite_or(material.alpha_cutoff, 0.5f);
      entry["doubleSided"] = material.double_sided;
      output_.document["materials"].push_back(std::move(entry));
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
        entry["bufferView"] =
            output_.add_view(std::as_bytes(std::span(image.bytes)), gltf::Output::Target::kNone);
        // Required beside a buffer view.
        if (image.mime_type.empty()) entry["mimeType"] = guessed_type(image);
      }
      output_.document["images"].push_back(std::move(entry));
      output_.document["textures"].push_back({{"source", i}});
    }
  }

  static const char* guessed_type(const Image& image) {
    return !image.bytes.empty() && image.bytes[0] == 0xff ? "image/jpeg" : "image/png";
  }

  const TriangleMesh& mesh_;
  const JoinedStrips* strips_;
  gltf::Output output_;
};

}  // namespace

Result<std::vector<std::byte>> write_glb(const TriangleMesh& mesh, const JoinedStrips* strips) {
  return GlbBuilder(mesh, strips).build();
}

}  // namespace varifold
