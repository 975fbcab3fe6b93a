#include <varifold/io/pose_files.h>

#include <fmt/format.h>
#include <varifold/io/mesh_file.h>
#include <algorithm>
#include <optional>

namespace varifold {
namespace {

using std::filesystem::path;

/// The vertex of the file that a vertex of its mesh came from.
std::uint32_t file_vertex(const ImportedMesh& file, std::uint32_t vertex) {
  return file.file_vertices.empty() ? vertex : file.file_vertices[vertex];
}

bool same_numbering(const ImportedMesh& a, const ImportedMesh& b) {
  return a.mesh.vertex_count() == b.mesh.vertex_count() && a.mesh.indices == b.mesh.indices;
}

std::string triangle_text(const ImportedMesh& file, std::size_t first_corner) {
  const std::uint32_t* const corners = &file.mesh.indices[first_corner];
  return fmt::format("{} {} {}", file_vertex(file, corners[0]), file_vertex(file, corners[1]),
                     file_vertex(file, corners[2]));
}

/// Whether the triangles of two files, read as they are in them, name the same vertices.
Result<void> check_same_triangles(const ImportedMesh& rest, const path& rest_path,
                                  const ImportedMesh& pose) {
  const auto differ = [&](std::size_t count, std::size_t count_in_rest, const char* what) {
    return fail(ErrorKind::kInvalidInput,
                fmt::format("{} {}, in {} {}", count, what, rest_path.string(), count_in_rest));
  };
  const bool are_of_file = rest.file_vertices.empty() && pose.file_vertices.empty();
  if (are_of_file && pose.mesh.vertex_count() != rest.mesh.vertex_count())
    return differ(pose.mesh.vertex_count(), rest.mesh.vertex_count(), "vertices");
  if (pose.mesh.triangle_count() != rest.mesh.triangle_count())
    return differ(pose.mesh.triangle_count(), rest.mesh.triangle_count(), "triangles");
  for (std::size_t corner = 0; corner < rest.mesh.indices.size(); ++corner) {
    if (file_vertex(rest, rest.mesh.indices[corner]) ==
        file_vertex(pose, pose.mesh.indices[corner]))
      continue;
    const std::size_t first = corner - corner % 3;
    return fail(ErrorKind::kInvalidInput,
                fmt::format("triangle {} is {}, in {} {}", corner / 3, triangle_text(pose, first),
                            rest_path.string(), triangle_text(rest, first)));
  }
  return {};
}

/// `values` of a pose at the vertices of the mesh at rest, by the corners of triangles that both
/// share; `fallback` at vertices without triangles.
template <class T>
std::vector<T> by_corners(const TriangleMesh& rest, const TriangleMesh& pose,
                          const std::vector<T>& values, const std::vector<T>& fallback) {
  if (values.empty()) return {};
  std::vector<T> result = fallback;
  for (std::size_t corner = rest.indices.size(); corner-- > 0;)
    result[rest.indices[corner]] = values[pose.indices[corner]];
  return result;
}

/// Normals that corners of a vertex do not agree about become their mean.
void average_normals(const TriangleMesh& rest, const TriangleMesh& pose,
                     std::vector<Vec3>& normals) {
  std::vector<bool> is_mixed(normals.size(), false);
  std::vector<Vec3> sums(normals.size(), Vec3(0));
  for (std::size_t corner = 0; corner < rest.indices.size(); ++corner) {
    const std::uint32_t v = rest.indices[corner];
    const Vec3& normal = pose.normals[pose.indices[corner]];
    if (normal != normals[v]) is_mixed[v] = true;
    sums[v] += normal;
  }
  for (std::size_t v = 0; v < normals.size(); ++v)
    if (is_mixed[v]) normals[v] = normalize_or_zero(sums[v]);
}

/// The arrays of a pose numbered as the mesh at rest; both read as they are in their files.
TriangleMesh renumbered(const ImportedMesh& rest, const ImportedMesh& pose) {
  const TriangleMesh& from = pose.mesh;
  TriangleMesh result;
  const bool keeps_loose = rest.file_vertices.empty() && pose.file_vertices.empty();
  result.positions = by_corners(rest.mesh, from, from.positions,
                                keeps_loose ? from.positions : rest.mesh.positions);
  const std::size_t count = rest.mesh.vertex_count();
  result.normals = by_corners(rest.mesh, from, from.normals, std::vector(count, Vec3(0)));
  if (from.has_normals()) average_normals(rest.mesh, from, result.normals);
  result.texcoords = by_corners(rest.mesh, from, from.texcoords, std::vector(count, Vec2(0)));
  result.colors = by_corners(rest.mesh, from, from.colors, std::vector(count, Color(255)));
  return result;
}

bool same_materials(const TriangleMesh& a, const TriangleMesh& b) {
  const auto same_name = [](const Material& x, const Material& y) { return x.name == y.name; };
  return a.ranges == b.ranges && std::equal(a.materials.begin(), a.materials.end(),
                                            b.materials.begin(), b.materials.end(), same_name);
}

class PoseReader {
 public:
  explicit PoseReader(const path& rest) : path_(rest) {}

  Result<ImportedMesh> read(std::span<const path> poses) {
    auto rest = read_mesh(path_);
    if (!rest) return rest;
    rest_ = std::move(*rest);
    for (const path& pose : poses)
      if (auto added = add(pose); !added) return tl::unexpected(added.error());
    return std::move(rest_);
  }

 private:
  Result<void> add(const path& pose_path) {
    auto pose = read_mesh(pose_path);
    if (!pose) return tl::unexpected(pose.error());
    for (const std::string& warning : pose->warnings) warn(pose_path, warning);
    TriangleMesh arrays;
    if (same_numbering(rest_, *pose)) {
      arrays = std::move(pose->mesh);
      note_differences(pose_path, arrays, same_materials(rest_.mesh, arrays));
    } else {
      const bool have_same_materials = same_materials(rest_.mesh, pose->mesh);
      auto matched = read_by_corners(pose_path);
      if (!matched) return tl::unexpected(matched.error());
      arrays = std::move(*matched);
      note_differences(pose_path, arrays, have_same_materials);
    }
    const bool both = rest_.mesh.has_normals() && arrays.has_normals();
    rest_.mesh.poses.push_back({pose_path.stem().string(), std::move(arrays.positions),
                                both ? std::move(arrays.normals) : std::vector<Vec3>()});
    return {};
  }

  /// Numbers follow attributes and the cuts of polygons follow shapes; the file has neither.
  Result<TriangleMesh> read_by_corners(const path& pose_path) {
    if (!rest_as_in_file_) {
      auto again = read_mesh(path_, FaceReading::kAsInFile);
      if (!again) return tl::unexpected(again.error());
      rest_as_in_file_ = std::move(*again);
    }
    const auto pose = read_mesh(pose_path, FaceReading::kAsInFile);
    if (!pose) return tl::unexpected(pose.error());
    if (auto same = check_same_triangles(*rest_as_in_file_, path_, *pose); !same)
      return fail_in(pose_path.string(), std::move(same.error()));
    return renumbered(*rest_as_in_file_, *pose);
  }

  void note_differences(const path& pose_path, const TriangleMesh& arrays,
                        bool have_same_materials) {
    const TriangleMesh& rest = rest_.mesh;
    const auto note = [&](bool differs, const char* what) {
      if (differs)
        warn(pose_path,
             fmt::format("{} differ from those of {}, and were dropped", what, path_.string()));
    };
    note(arrays.has_texcoords() && arrays.texcoords != rest.texcoords, "texture coordinates");
    note(arrays.has_colors() && arrays.colors != rest.colors, "colours");
    note(!have_same_materials, "materials");
    if (arrays.has_normals() && !rest.has_normals())
      warn(pose_path, "normals were dropped: " + path_.string() + " has none");
  }
  void warn(const path& pose_path, const std::string& what) {
    rest_.warnings.push_back(pose_path.string() + ": " + what);
  }

  const path& path_;
  ImportedMesh rest_;
  std::optional<ImportedMesh> rest_as_in_file_;
};

}  // namespace

Result<ImportedMesh> read_pose_files(const path& rest, std::span<const path> poses) {
  return PoseReader(rest).read(poses);
}

}  // namespace varifold
