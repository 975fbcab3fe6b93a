#include <varifold/io/import_check.h>

#include <fmt/format.h>
#include <varifold/mesh/rig.h>
#include <algorithm>
#include <cmath>
#include <limits>

namespace varifold {
namespace {

bool is_finite(const Vec2& v) { return std::isfinite(v.x) && std::isfinite(v.y); }
bool is_finite(const Vec3& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

/// Zeroes the entries that are not finite and returns their number.
template <class T>
std::size_t repair(std::vector<T>& values) {
  std::size_t repaired = 0;
  for (T& value : values) {
    if (is_finite(value)) continue;
    value = T(0);
    ++repaired;
  }
  return repaired;
}

Result<void> check_sizes(const TriangleMesh& mesh) {
  constexpr std::size_t kMost = std::numeric_limits<std::uint32_t>::max() - 1;
  if (mesh.positions.size() > kMost || mesh.indices.size() > kMost)
    return fail(ErrorKind::kUnsupported, "more vertices or corners than 32 bits can count");
  const auto fits = [&](std::size_t size) { return size == 0 || size == mesh.positions.size(); };
  if (!fits(mesh.normals.size()) || !fits(mesh.texcoords.size()) || !fits(mesh.colors.size()) ||
      !fits(mesh.skin.size()) || mesh.indices.size() % 3 != 0)
    return fail(ErrorKind::kInvalidInput, "attributes do not fit the vertices");
  for (const Pose& pose : mesh.poses)
    if (pose.positions.size() != mesh.positions.size() || !fits(pose.normals.size()))
      return fail(ErrorKind::kInvalidInput, "a pose does not fit the vertices");
  return {};
}

Result<void> check_contents(const TriangleMesh& mesh) {
  if (auto positions = check_positions(mesh); !positions) return positions;
  for (const Pose& pose : mesh.poses) {
    const auto bad = std::find_if_not(pose.positions.begin(), pose.positions.end(),
                                      [](const Vec3& p) { return is_finite(p); });
    if (bad != pose.positions.end())
      return fail(ErrorKind::kInvalidInput,
                  fmt::format("pose {}: vertex {}: position is not finite", in_quotes(pose.name),
                              bad - pose.positions.begin()));
  }
  const std::size_t joints = mesh.rig ? mesh.rig->joints.size() : 0;
  for (const JointWeights& followed : mesh.skin)
    for (const std::uint16_t joint : followed.joints)
      if (joint >= joints)
        return fail(ErrorKind::kInvalidInput, "the skin does not fit the joints");
  for (std::size_t i = 0; i < mesh.indices.size(); ++i)
    if (mesh.indices[i] >= mesh.positions.size())
      return fail(ErrorKind::kInvalidInput,
                  fmt::format("triangle {}: vertex index {} is out of range ({} vertices)", i / 3,
                              mesh.indices[i], mesh.positions.size()));
  std::uint64_t covered = 0;
  for (const MaterialRange& range : mesh.ranges) {
    if (range.first_triangle != covered || range.material >= mesh.materials.size())
      return fail(ErrorKind::kInvalidInput, "material ranges do not fit the triangles");
    covered += range.triangle_count;
  }
  if (!mesh.ranges.empty() && covered != mesh.triangle_count())
    return fail(ErrorKind::kInvalidInput, "material ranges do not cover the triangles");
  return {};
}

}  // namespace

Result<void> check_positions(const TriangleMesh& mesh) {
  for (std::size_t v = 0; v < mesh.positions.size(); ++v)
    if (!is_finite(mesh.positions[v]))
      return fail(ErrorKind::kInvalidInput, fmt::format("vertex {}: position is not finite", v));
  return {};
}

Result<ImportedMesh> finish_import(ImportedMesh imported) {
  TriangleMesh& mesh = imported.mesh;
  if (auto sizes = check_sizes(mesh); !sizes) return tl::unexpected(std::move(sizes.error()));
  if (auto contents = check_contents(mesh); !contents)
    return tl::unexpected(std::move(contents.error()));
  std::size_t normals = repair(mesh.normals);
  for (Pose& pose : mesh.poses) normals += repair(pose.normals);
  warn_count(imported, normals, "normals that are not finite were set to zero");
  warn_count(imported, repair(mesh.texcoords),
             "texture coordinates that are not finite were set to zero");
  if (mesh.indices.empty()) imported.warnings.emplace_back("no triangles");
  return imported;
}

void fill_missing_normals(TriangleMesh& mesh, const std::vector<bool>& is_missing) {
  std::vector<DVec3> sums(mesh.positions.size(), DVec3(0));
  for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
    const DVec3 a = mesh.positions[mesh.indices[i]];
    const DVec3 b = mesh.positions[mesh.indices[i + 1]];
    const DVec3 c = mesh.positions[mesh.indices[i + 2]];
    const DVec3 area = glm::cross(b - a, c - a);
    for (std::size_t corner = i; corner < i + 3; ++corner) sums[mesh.indices[corner]] += area;
  }
  for (std::size_t v = 0; v < sums.size(); ++v) {
    if (!is_missing[v]) continue;
    const double length = glm::length(sums[v]);
    mesh.normals[v] = length > 0 ? Vec3(sums[v] / length) : Vec3(0);
  }
}

void warn_count(ImportedMesh& imported, std::size_t count, std::string_view what) {
  if (count > 0) imported.warnings.push_back(fmt::format("{} {}", count, what));
}

std::string in_quotes(std::string_view text) {
  constexpr std::size_t kLongest = 60;
  std::string result = "'";
  for (const char c : text.substr(0, kLongest)) {
    const auto code = static_cast<unsigned char>(c);
    result += code < 0x20 || code == 0x7f ? '?' : c;
  }
  return result + (text.size() > kLongest ? "...'" : "'");
}

}  // namespace varifold
