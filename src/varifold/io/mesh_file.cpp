#include <varifold/io/mesh_file.h>

#include <varifold/base/bytes.h>
#include <varifold/io/gltf.h>
#include <varifold/io/mapped_file.h>
#include <varifold/io/obj.h>
#include <varifold/io/output_file.h>
#include <varifold/io/ply.h>
#include <varifold/io/stl.h>
#include <varifold/mesh/rig.h>
#include <algorithm>
#include <cctype>

namespace varifold {
namespace {

constexpr const char* kKnownFormats = "known are .ply, .obj, .stl, .gltf and .glb";

std::string lower_extension(const std::filesystem::path& path) {
  std::string extension = path.extension().string();
  for (char& c : extension) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return extension;
}

std::optional<MeshFormat> format_of_extension(const std::filesystem::path& path) {
  const std::string extension = lower_extension(path);
  if (extension == ".ply") return MeshFormat::kPly;
  if (extension == ".obj") return MeshFormat::kObj;
  if (extension == ".stl") return MeshFormat::kStl;
  if (extension == ".gltf") return MeshFormat::kGltf;
  if (extension == ".glb") return MeshFormat::kGlb;
  return std::nullopt;
}

std::optional<MeshFormat> format_of_content(std::span<const std::byte> file) {
  const std::string_view text = as_text(file.first(std::min<std::size_t>(file.size(), 4096)));
  if (text.starts_with("ply\n") || text.starts_with("ply\r")) return MeshFormat::kPly;
  if (text.starts_with("glTF")) return MeshFormat::kGlb;
  if (has_binary_stl_size(file)) return MeshFormat::kStl;
  std::string_view start = text;
  if (start.starts_with("\xEF\xBB\xBF")) start.remove_prefix(3);
  start.remove_prefix(std::min(start.find_first_not_of(" \t\r\n"), start.size()));
  if (start.starts_with("{")) return MeshFormat::kGltf;
  if (start.starts_with("solid") &&
      (text.find("facet") != text.npos || text.find("endsolid") != text.npos))
    return MeshFormat::kStl;
  return std::nullopt;
}

tl::unexpected<Error> unknown_format(std::span<const std::byte> file) {
  const std::string_view text = as_text(file.first(std::min<std::size_t>(file.size(), 8)));
  if (file.empty()) return fail(ErrorKind::kInvalidInput, "the file is empty");
  if (text.starts_with("\x1f\x8b"))
    return fail(ErrorKind::kUnsupported, "compressed with gzip: unpack it first");
  return fail(ErrorKind::kUnsupported, std::string("not a mesh format; ") + kKnownFormats);
}

/// The files beside the OBJ come first, so that an OBJ never names a file that is not there.
Result<void> write_obj_files(const TriangleMesh& mesh, const std::filesystem::path& path) {
  const ObjFiles files = write_obj(mesh, path.stem().string());
  for (const ObjFiles::ImageFile& image : files.images)
    if (auto written = write_file(path.parent_path() / image.name,
                                  std::as_bytes(std::span(mesh.images[image.image].bytes)));
        !written)
      return written;
  if (!files.materials.empty())
    if (auto written =
            write_file(std::filesystem::path(path).replace_extension(".mtl"), files.materials);
        !written)
      return written;
  return write_file(path, files.obj);
}

}  // namespace

std::optional<MeshFormat> mesh_format(std::span<const std::byte> file,
                                      const std::filesystem::path& path) {
  if (const auto format = format_of_content(file)) return format;
  return format_of_extension(path);
}

Result<ImportedMesh> decode_mesh(std::span<const std::byte> file, MeshFormat format,
                                 const std::filesystem::path& folder, FaceReading faces) {
  switch (format) {
    case MeshFormat::kPly:
      return read_ply(file, faces);
    case MeshFormat::kObj:
      return read_obj(file, folder, faces);
    case MeshFormat::kStl:
      return read_stl(file);
    case MeshFormat::kGltf:
    case MeshFormat::kGlb:
      return read_gltf(file, folder);
  }
  return fail(ErrorKind::kUnsupported, "no such format");
}

Result<ImportedMesh> read_mesh(const std::filesystem::path& path, FaceReading faces) {
  const auto file = MappedFile::open(path);
  if (!file) return tl::unexpected(file.error());
  const auto format = mesh_format(file->bytes(), path);
  const auto folder = path.has_parent_path() ? path.parent_path() : ".";
  auto result = format ? decode_mesh(file->bytes(), *format, folder, faces)
                       : Result<ImportedMesh>(unknown_format(file->bytes()));
  if (!result) return fail_in(path.string(), std::move(result.error()));
  return result;
}

Result<void> write_mesh(const TriangleMesh& mesh, const std::filesystem::path& path,
                        const JoinedStrips* strips) {
  const auto format = format_of_extension(path);
  if (format == MeshFormat::kPly) return write_file(path, write_ply(mesh, {.strips = strips}));
  if (format == MeshFormat::kObj && strips)
    return fail(ErrorKind::kUnsupported, path.string() + ": the format has no strips");
  if (format == MeshFormat::kObj) return write_obj_files(mesh, path);
  if (format == MeshFormat::kGlb) {
    const auto bytes = write_glb(mesh, strips);
    if (!bytes) return fail_in(path.string(), bytes.error());
    return write_file(path, *bytes);
  }
  return fail(ErrorKind::kFailed,
              path.string() + ": cannot write this format; known are .ply, .obj and .glb");
}

std::vector<std::string> unwritten_parts(const TriangleMesh& mesh, MeshFormat format) {
  std::vector<std::string> parts;
  if (format == MeshFormat::kPly || format == MeshFormat::kObj) {
    if (!mesh.poses.empty()) parts.emplace_back("poses");
    if (mesh.has_skin()) parts.emplace_back("skin");
    if (mesh.rig && !mesh.rig->animations.empty()) parts.emplace_back("animations");
  }
  if (format == MeshFormat::kPly && !mesh.materials.empty()) parts.emplace_back("materials");
  if (format != MeshFormat::kObj) return parts;
  const auto has_alpha = [](const Color& color) { return color.a != 255; };
  if (std::any_of(mesh.colors.begin(), mesh.colors.end(), has_alpha))
    parts.emplace_back("alpha of vertex colours");
  const auto has_other_textures = [](const Material& material) {
    return material.textures[static_cast<std::size_t>(TextureUse::kMetallicRoughness)] != kNone ||
           material.textures[static_cast<std::size_t>(TextureUse::kOcclusion)] != kNone;
  };
  if (std::any_of(mesh.materials.begin(), mesh.materials.end(), has_other_textures))
    parts.emplace_back("metallic-roughness and occlusion textures");
  return parts;
}

}  // namespace varifold
