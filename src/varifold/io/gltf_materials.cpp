#include <varifold/io/gltf_materials.h>

#include <varifold/base/bytes.h>
#include <varifold/io/base64.h>
#include <varifold/io/import_check.h>
#include <array>
#include <cmath>

namespace varifold::gltf {
namespace {

std::vector<std::uint8_t> copy_bytes(std::span<const std::byte> bytes) {
  const auto* const first = reinterpret_cast<const std::uint8_t*>(bytes.data());
  return {first, first + bytes.size()};
}

Image read_image(const JsonElement& element, BufferStore& buffers, Budget& budget) {
  Image image;
  image.name = element.text("name");
  image.mime_type = element.text("mimeType");
  std::string uri = element.text("uri");
  if (uri.starts_with("data:")) {
    auto decoded = decode_data_uri(uri);
    if (!decoded) {
      element.fault("has a malformed data: URI");
      return image;
    }
    if (image.mime_type.empty()) image.mime_type = decoded->media_type;
    image.bytes = copy_bytes(decoded->bytes);
  } else if (element.has("uri")) {
    image.uri = std::move(uri);
  } else if (element.has("bufferView")) {
    const auto bytes = buffers.view(element.whole("bufferView"));
    if (budget.spend(bytes.size()))
      image.bytes = copy_bytes(bytes);
    else
      element.fault("the images take many times the size of the file", ErrorKind::kUnsupported);
  } else {
    element.fault("has neither 'uri' nor 'bufferView'");
  }
  return image;
}

/// Reads one texture reference of a material.
class TextureReader {
 public:
  TextureReader(const JsonElement& root, ImportedMesh& imported)
      : textures_(root.array("textures")), imported_(imported) {}

  void read(const JsonElement& owner, std::string_view key, TextureUse use, Material& material) {
    if (!owner.has(key)) return;
    const JsonElement reference = owner.object(key);
    if (reference.whole("texCoord", 0) != 0) ++other_texcoords_;
    if (reference.object("extensions").has("KHR_texture_transform")) ++transforms_;
    const JsonElement texture = textures_.item(reference.whole("index"));
    const std::uint64_t image = source(texture);
    if (image == kNone) return;
    if (image >= imported_.mesh.images.size())
      return texture.fault("names image " + std::to_string(image) + ", but there are only " +
                           std::to_string(imported_.mesh.images.size()));
    material.textures[static_cast<std::size_t>(use)] = static_cast<std::uint32_t>(image);
  }

  void warn() {
    warn_count(imported_, other_texcoords_,
               "textures use other texture coordinates than TEXCOORD_0, which were dropped");
    warn_count(imported_, transforms_, "texture transforms were dropped");
  }

 private:
  /// The image of a texture; extensions for other image formats put it elsewhere.
  static std::uint64_t source(const JsonElement& texture) {
    const JsonElement extensions = texture.object("extensions");
    for (const char* extension : {"KHR_texture_basisu", "EXT_texture_webp", "EXT_texture_avif"})
      if (!texture.has("source") && extensions.has(extension))
        return extensions.object(extension).whole("source", kNone);
    return texture.whole("source", kNone);
  }

  JsonElement textures_;
  ImportedMesh& imported_;
  std::size_t other_texcoords_ = 0;
  std::size_t transforms_ = 0;
};

/// Components between 0 and 1; a colour that is not there stays.
template <std::size_t kCount>
void read_color(const JsonElement& element, std::string_view key, float* color) {
  std::array<double, kCount> numbers{};
  if (!element.numbers(key, numbers)) return;
  for (std::size_t i = 0; i < kCount; ++i) color[i] = static_cast<float>(numbers[i]);
}

Material read_material(const JsonElement& element, TextureReader& textures) {
  Material material = default_material();
  material.name = element.text("name");
  const JsonElement rough = element.object("pbrMetallicRoughness");
  read_color<4>(rough, "baseColorFactor", &material.base_color.x);
  material.metallic = static_cast<float>(rough.number("metallicFactor", 1));
  material.roughness = static_cast<float>(rough.number("roughnessFactor", 1));
  textures.read(rough, "baseColorTexture", TextureUse::kBaseColor, material);
  textures.read(rough, "metallicRoughnessTexture", TextureUse::kMetallicRoughness, material);
  textures.read(element, "normalTexture", TextureUse::kNormal, material);
  textures.read(element, "occlusionTexture", TextureUse::kOcclusion, material);
  textures.read(element, "emissiveTexture", TextureUse::kEmissive, material);
  read_color<3>(element, "emissiveFactor", &material.emissive.x);
  material.alpha_mode = element.text("alphaMode", "OPAQUE");
  if (material.alpha_mode != "MASK" && material.alpha_mode != "BLEND")
    material.alpha_mode = "OPAQUE";
  material.alpha_cutoff = static_cast<float>(element.number("alphaCutoff", 0.5));
  material.double_sided = element.boolean("doubleSided", false);
  return material;
}

}  // namespace

Material default_material() {
  Material material;
  material.metallic = 1;
  return material;
}

void read_images(const JsonElement& root, BufferStore& buffers, Budget& budget,
                 ImportedMesh& imported) {
  const JsonElement images = root.array("images");
  for (std::size_t i = 0; i < images.size(); ++i)
    imported.mesh.images.push_back(read_image(images.item(i), buffers, budget));
}

void read_materials(const JsonElement& root, ImportedMesh& imported) {
  const JsonElement materials = root.array("materials");
  TextureReader textures(root, imported);
  for (std::size_t i = 0; i < materials.size(); ++i)
    imported.mesh.materials.push_back(read_material(materials.item(i), textures));
  textures.warn();
}

}  // namespace varifold::gltf
