#include <apps/cli/context.h>
#include <apps/cli/index_report.h>
#include <apps/cli/strip_mesh.h>
#include <varifold/strip/stripify.h>
#include <span>
#include <utility>
#include <vector>

namespace varifold::cli {
namespace {

template <class T>
std::vector<T> gather(std::span<const T> values, const std::vector<std::uint32_t>& kept) {
  std::vector<T> result;
  if (values.empty()) return result;
  result.reserve(kept.size());
  for (const std::uint32_t v : kept) result.push_back(values[v]);
  return result;
}

// Per vertex its number among those that are used, in their order; kept: these vertices.
std::vector<std::uint32_t> new_numbers(std::size_t vertices, std::span<const std::uint32_t> indices,
                                       std::vector<std::uint32_t>& kept) {
  std::vector<std::uint32_t> number(vertices, kNone);
  for (const std::uint32_t v : indices) number[v] = 0;
  for (std::uint32_t v = 0; v < vertices; ++v) {
    if (number[v] == kNone) continue;
    number[v] = static_cast<std::uint32_t>(kept.size());
    kept.push_back(v);
  }
  return number;
}

// The triangles by materials, as triangles_of() has them.
std::vector<MaterialRange> ranges_of(const TriangleStrips& strips) {
  std::vector<std::uint32_t> count;
  for (std::uint32_t s = 0; s < strips.count(); ++s) {
    const auto strip = strips.strip(s);
    if (strips.range[s] >= count.size()) count.resize(strips.range[s] + std::size_t{1}, 0);
    for (std::size_t i = 0; i + 2 < strip.size(); ++i)
      if (!is_degenerate(strip_triangle(strip, i))) ++count[strips.range[s]];
  }
  std::vector<MaterialRange> ranges;
  std::uint32_t first = 0;
  for (std::uint32_t m = 0; m < count.size(); ++m) {
    if (count[m] > 0) ranges.push_back({m, first, count[m]});
    first += count[m];
  }
  return ranges;
}

}  // namespace

void add_strips_option(CLI::App& command, std::string& how) {
  command
      .add_option("--strips", how,
                  "Write triangle strips, those of the model where it has some: restart: divided "
                  "by -1 (.ply); degenerate: joined by repeated indices (.ply, .glb)")
      ->check(CLI::IsMember({"restart", "degenerate"}))
      ->type_name("HOW");
}

std::optional<StripJoin> strip_join(const std::string& how, const std::filesystem::path& output) {
  if (how.empty()) return std::nullopt;
  const auto extension = CLI::detail::to_lower(output.extension().string());
  if (extension == ".obj") wrong_usage(output.string() + ": the format has no strips");
  if (extension == ".glb" && how == "restart")
    wrong_usage(output.string() + ": the format has no restarts; use --strips degenerate");
  return how == "restart" ? StripJoin::kRestart : StripJoin::kDegenerate;
}

StripMesh drawn_strips(const DrawList& list, const TriangleMesh& attributes, StripJoin join) {
  TriangleStrips strips = strips_of(list.indices, list.ranges);
  StripMesh result{{}, join_drawn(list, join)};
  std::vector<std::uint32_t> kept;
  const auto number = new_numbers(list.positions.size(), strips.indices, kept);
  for (std::uint32_t& v : strips.indices) v = number[v];
  for (std::uint32_t& v : result.strips.indices)
    if (v != kStripRestart) v = number[v];

  TriangleMesh& mesh = result.mesh;
  mesh.positions = gather(list.positions, kept);
  mesh.normals = gather(list.normals, kept);
  mesh.texcoords = gather(list.texcoords, kept);
  mesh.colors = gather(list.colors, kept);
  mesh.skin = gather(list.skin, kept);
  for (const Pose& pose : list.poses)
    mesh.poses.push_back({pose.name, gather(std::span(pose.positions), kept),
                          gather(std::span(pose.normals), kept)});
  mesh.rig = attributes.rig;
  mesh.indices = triangles_of(strips);
  mesh.materials = attributes.materials;
  mesh.images = attributes.images;
  if (!mesh.materials.empty()) mesh.ranges = ranges_of(strips);
  return result;
}

StripMesh new_strips(TriangleMesh mesh, StripJoin join) {
  JoinedStrips strips = join_strips(stripify(mesh), mesh, join);
  return {std::move(mesh), std::move(strips)};
}

}  // namespace varifold::cli
