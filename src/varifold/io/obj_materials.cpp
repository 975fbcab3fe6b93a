#include <varifold/io/obj_materials.h>

#include <varifold/io/text_scanner.h>
#include <varifold/io/text_writer.h>
#include <cmath>

namespace varifold::obj {
namespace {

struct TextureKeyword {
  std::string_view keyword;
  TextureUse use;
};
constexpr std::array<TextureKeyword, 3> kTextureKeywords{{{"map_Kd", TextureUse::kBaseColor},
                                                          {"map_Ke", TextureUse::kEmissive},
                                                          {"norm", TextureUse::kNormal}}};

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && TextScanner::is_space(text.front())) text.remove_prefix(1);
  while (!text.empty() && TextScanner::is_space(text.back())) text.remove_suffix(1);
  return text;
}

/// The file name after a texture keyword: all of the line, or its last word where options with
/// their arguments come first.
std::string texture_name(std::string_view rest) {
  rest = trimmed(rest);
  if (rest.starts_with("-")) rest.remove_prefix(rest.find_last_of(" \t") + 1);
  return std::string(rest);
}

/// Reads as many numbers as there are; the others keep their values.
void read_numbers(std::string_view rest, std::span<float> values) {
  TextScanner text(rest);
  for (float& value : values) {
    float number = 0;
    text.skip_space();
    if (!text.float_here(number) || !std::isfinite(number)) return;
    value = number;
  }
}

std::string image_extension(const Image& image) {
  if (image.mime_type == "image/png") return ".png";
  if (image.mime_type == "image/jpeg") return ".jpg";
  if (image.mime_type == "image/webp") return ".webp";
  return ".image";
}

}  // namespace

void MaterialLibrary::add(std::string_view file) {
  TextScanner text(file);
  Entry* current = nullptr;
  Entry ignored;
  while (!text.at_end()) {
    TextScanner line(text.line());
    const std::string_view keyword = line.token();
    const std::string_view rest = line.line();
    if (keyword == "newmtl") {
      std::string name(trimmed(rest));
      const auto [entry, is_new] = entries_.try_emplace(name);
      current = is_new ? &entry->second : &ignored;
      current->material.name = std::move(name);
    } else if (current) {
      read_line(keyword, rest, *current);
    }
  }
}

void MaterialLibrary::read_line(std::string_view keyword, std::string_view rest, Entry& entry) {
  Material& material = entry.material;
  if (keyword == "Kd") {
    read_numbers(rest, {&material.base_color.x, 3});
  } else if (keyword == "Ke") {
    read_numbers(rest, {&material.emissive.x, 3});
  } else if (keyword == "d" || keyword == "Tr") {
    float value = keyword == "d" ? 1.0f : 0.0f;
    read_numbers(rest, {&value, 1});
    material.base_color.w = keyword == "d" ? value : 1 - value;
    material.alpha_mode = material.base_color.w < 1 ? "BLEND" : "OPAQUE";
  } else if (keyword == "Pm") {
    read_numbers(rest, {&material.metallic, 1});
  } else if (keyword == "Pr") {
    read_numbers(rest, {&material.roughness, 1});
  }
  for (const TextureKeyword& texture : kTextureKeywords)
    if (keyword == texture.keyword)
      entry.textures[static_cast<std::size_t>(texture.use)] = texture_name(rest);
}

bool MaterialLibrary::append_to(TriangleMesh& mesh, const std::string& name) {
  Material material;
  material.name = name;
  const auto found = entries_.find(name);
  if (found != entries_.end()) {
    material = found->second.material;
    for (std::size_t use = 0; use < material.textures.size(); ++use) {
      const std::string& uri = found->second.textures[use];
      if (uri.empty()) continue;
      const auto [image, is_new] =
          images_.try_emplace(uri, static_cast<std::uint32_t>(mesh.images.size()));
      if (is_new) mesh.images.push_back({"", "", uri, {}});
      material.textures[use] = image->second;
    }
  }
  mesh.materials.push_back(std::move(material));
  return found != entries_.end();
}

std::vector<std::byte> write_materials(const TriangleMesh& mesh,
                                       const std::vector<std::string>& names, std::string_view stem,
                                       std::vector<ObjFiles::ImageFile>& images) {
  TextWriter out;
  std::vector<std::string> image_names;
  for (std::size_t i = 0; i < mesh.images.size(); ++i) {
    const Image& image = mesh.images[i];
    image_names.push_back(image.uri);
    if (image.bytes.empty()) continue;
    image_names.back() = std::string(stem) + '_' + std::to_string(i) + image_extension(image);
    images.push_back({image_names.back(), i});
  }
  for (std::size_t m = 0; m < mesh.materials.size(); ++m) {
    const Material& material = mesh.materials[m];
    const Vec4& color = material.base_color;
    const Vec3& emissive = material.emissive;
    out.write("newmtl ", names[m], "\nKd ", color.x, ' ', color.y, ' ', color.z, "\nd ", color.w);
    out.write("\nKe ", emissive.x, ' ', emissive.y, ' ', emissive.z);
    out.write("\nPm ", material.metallic, "\nPr ", material.roughness, '\n');
    for (const TextureKeyword& texture : kTextureKeywords) {
      const std::uint32_t image = material.textures[static_cast<std::size_t>(texture.use)];
      if (image < image_names.size() &&
          image_names[image].find_first_of("\r\n") == std::string::npos)
        out.write(texture.keyword, ' ', image_names[image], '\n');
    }
  }
  return out.take();
}

}  // namespace varifold::obj
