#include <apps/cli/input.h>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <varifold/io/mesh_file.h>
#include <varifold/io/model_file.h>
#include <varifold/mesh/weld.h>
#include <algorithm>
#include <array>
#include <fstream>

namespace varifold::cli {

std::filesystem::path input_path(const std::string& argument) {
  return argument == "-" ? "/dev/stdin" : argument;
}

std::filesystem::path output_path(const std::string& argument) {
  return argument == "-" ? "/dev/stdout" : argument;
}

bool is_model_file(const std::filesystem::path& path) {
  if (path == "/dev/stdin") return true;
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(path, ignored)) return path.extension() == ".vfm";
  std::array<char, 4> magic{};
  std::ifstream(path, std::ios::binary).read(magic.data(), magic.size());
  const bool has_magic = magic == std::array<char, 4>{'\x89', 'V', 'F', 'M'};
  return has_magic || path.extension() == ".vfm";
}

void add_prepare_options(CLI::App& command, PrepareOptions& options) {
  command
      .add_option("--weld", options.weld,
                  "Before all else, weld vertices that are at most this far apart (model units)")
      ->check(CLI::NonNegativeNumber)
      ->check(finite_number())
      ->type_name("TOLERANCE");
  command
      .add_option("--ignore", options.ignore,
                  "Drop attributes: normals, texcoords, colors, materials")
      ->delimiter(',')
      ->check(CLI::IsMember({"normals", "texcoords", "colors", "materials"}))
      ->type_name("LIST");
}

namespace {

// All vertices of a class go to the place of its first.
void weld_places(const WeldMap& weld, std::vector<Vec3>& places) {
  std::vector<std::uint32_t> first(weld.class_count, kNone);
  for (std::uint32_t v = 0; v < places.size(); ++v) {
    std::uint32_t& of_class = first[weld.class_of[v]];
    if (of_class == kNone) of_class = v;
    places[v] = places[of_class];
  }
}

}  // namespace

void prepare_mesh(TriangleMesh& mesh, const PrepareOptions& options) {
  const auto ignored = [&](const char* name) {
    return std::find(options.ignore.begin(), options.ignore.end(), name) != options.ignore.end();
  };
  if (ignored("normals")) mesh.normals = {};
  if (ignored("texcoords")) mesh.texcoords = {};
  if (ignored("colors")) mesh.colors = {};
  if (ignored("materials")) {
    mesh.ranges = {};
    mesh.materials = {};
    mesh.images = {};
  }
  if (options.weld < 0) return;
  // Attributes stay apart: vertices of one position with different ones become a seam. Vertices
  // that a pose parts stay apart, too.
  WeldMap weld = weld_within(mesh.positions, options.weld);
  for (const Pose& pose : mesh.poses)
    weld = welded_by_both(weld, weld_within(pose.positions, options.weld));
  weld_places(weld, mesh.positions);
  for (Pose& pose : mesh.poses) weld_places(weld, pose.positions);
}

Result<ImportedMesh> read_mesh_loudly(const std::filesystem::path& path) {
  auto imported = read_mesh(path);
  if (!imported) return imported;
  for (const std::string& warning : imported->warnings)
    print_message(path.string() + ": warning: " + warning);
  return imported;
}

namespace {

// The first triangle, nearly always.
bool has_triangle_with_three_corners(const TriangleMesh& mesh) {
  for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
    const Vec3 a = mesh.positions[mesh.indices[i]], b = mesh.positions[mesh.indices[i + 1]],
               c = mesh.positions[mesh.indices[i + 2]];
    if (a != b && b != c && c != a) return true;
  }
  return false;
}

}  // namespace

Result<ImportedMesh> read_surface(const std::filesystem::path& path) {
  auto imported = read_mesh(path);
  if (!imported) return imported;
  if (imported->mesh.indices.empty())
    return fail(ErrorKind::kInvalidInput, path.string() + ": there are no triangles");
  if (!has_triangle_with_three_corners(imported->mesh))
    return fail(ErrorKind::kInvalidInput,
                fmt::format("{}: all {} triangles are degenerate: two corners at one position",
                            path.string(), format_count(imported->mesh.triangle_count())));
  for (const std::string& warning : imported->warnings)
    print_message(path.string() + ": warning: " + warning);
  return imported;
}

namespace {

std::optional<MeshFormat> written_format(const std::filesystem::path& path) {
  const std::string extension = small_extension(path);
  if (extension == ".ply") return MeshFormat::kPly;
  if (extension == ".obj") return MeshFormat::kObj;
  if (extension == ".glb") return MeshFormat::kGlb;
  return std::nullopt;
}

}  // namespace

Result<void> write_mesh_loudly(const TriangleMesh& mesh, const std::filesystem::path& path,
                               const JoinedStrips* strips) {
  if (auto done = check_interrupted(path); !done) return done;
  if (auto written = write_mesh(mesh, path, strips); !written) return written;
  if (const auto format = written_format(path))
    for (const std::string& part : unwritten_parts(mesh, *format))
      print_message(
          fmt::format("{}: warning: the format has no place for {}", path.string(), part));
  return {};
}

Result<void> check_mesh_output(const std::filesystem::path& path, const CommonOptions& options) {
  if (!written_format(path))
    wrong_usage(path.string() + ": cannot write this format; known are .ply, .obj and .glb");
  return check_output(path, options);
}

std::vector<std::string> attribute_names(const TriangleMesh& mesh) {
  std::vector<std::string> names;
  if (mesh.has_normals()) names.emplace_back("normals");
  if (mesh.has_texcoords()) names.emplace_back("texcoords");
  if (mesh.has_colors()) names.emplace_back("colors");
  if (mesh.has_skin()) names.emplace_back("skin");
  return names;
}

std::string joined(const std::vector<std::string>& names) {
  return names.empty() ? "none" : fmt::format("{}", fmt::join(names, ", "));
}

}  // namespace varifold::cli
