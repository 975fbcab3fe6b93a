#include <varifold/io/obj.h>
#include <varifold/io/obj_materials.h>
#include <varifold/io/text_writer.h>
#include <varifold/io/wedge_table.h>
#include <varifold/mesh/weld.h>
#include <unordered_set>

namespace varifold {
namespace {

/// Material names as OBJ can hold them: one line, not empty, each once.
std::vector<std::string> distinct_names(const TriangleMesh& mesh) {
  std::vector<std::string> names;
  std::unordered_set<std::string> taken;
  for (const Material& material : mesh.materials) {
    std::string name = material.name.empty() ? "material" : material.name;
    for (char& c : name)
      if (static_cast<unsigned char>(c) <= 0x20 || c == '\\' || c == '#') c = '_';
    for (std::size_t i = 2; !taken.insert(name).second; ++i) {
      if (i > 2) name.resize(name.rfind('_'));
      name += '_';
      name += std::to_string(i);
    }
    names.push_back(std::move(name));
  }
  return names;
}

/// Which `v` line every vertex has, from 0, and a vertex for every line.
struct PositionLines {
  std::vector<std::uint32_t> line_of;
  std::vector<std::uint32_t> vertex_of;
};

PositionLines position_lines(const TriangleMesh& mesh) {
  PositionLines lines;
  const bool can_share = mesh.has_normals() || mesh.has_texcoords();
  const WeldMap weld = can_share ? weld_exact(mesh.positions) : WeldMap{};
  WedgeTable table;
  for (std::uint32_t v = 0; v < mesh.vertex_count(); ++v) {
    const std::uint32_t color =
        mesh.has_colors() ? std::bit_cast<std::uint32_t>(mesh.colors[v]) : 0;
    const std::uint32_t line =
        table.find_or_add({can_share ? weld.class_of[v] : v, can_share ? color : 0, 0});
    if (line == lines.vertex_of.size()) lines.vertex_of.push_back(v);
    lines.line_of.push_back(line);
  }
  return lines;
}

void write_vertices(const TriangleMesh& mesh, const PositionLines& lines, TextWriter& out) {
  for (const std::uint32_t v : lines.vertex_of) {
    const Vec3& p = mesh.positions[v];
    out.write("v ", p.x, ' ', p.y, ' ', p.z);
    if (mesh.has_colors())
      for (int i = 0; i < 3; ++i) out.write(' ', static_cast<float>(mesh.colors[v][i]) / 255.0f);
    out.write('\n');
  }
  for (const Vec2& t : mesh.texcoords) out.write("vt ", t.x, ' ', 1 - t.y, '\n');
  for (const Vec3& n : mesh.normals) out.write("vn ", n.x, ' ', n.y, ' ', n.z, '\n');
}

void write_triangles(const TriangleMesh& mesh, const PositionLines& lines,
                     const MaterialRange& range, TextWriter& out) {
  for (std::uint32_t t = 0; t < range.triangle_count; ++t) {
    out.write('f');
    for (std::size_t corner = 0; corner < 3; ++corner) {
      const std::uint32_t v = mesh.indices[3 * (std::size_t{range.first_triangle} + t) + corner];
      out.write(' ', lines.line_of[v] + 1);
      if (mesh.has_texcoords()) out.write('/', v + 1);
      if (mesh.has_normals()) out.write(mesh.has_texcoords() ? "/" : "//", v + 1);
    }
    out.write('\n');
  }
}

}  // namespace

ObjFiles write_obj(const TriangleMesh& mesh, std::string_view stem) {
  ObjFiles files;
  const std::vector<std::string> names = distinct_names(mesh);
  TextWriter out;
  if (!mesh.ranges.empty()) {
    files.materials = obj::write_materials(mesh, names, stem, files.images);
    out.write("mtllib ", stem, ".mtl\n");
  }
  const PositionLines lines = position_lines(mesh);
  write_vertices(mesh, lines, out);
  if (mesh.ranges.empty()) write_triangles(mesh, lines, {0, 0, mesh.triangle_count()}, out);
  for (const MaterialRange& range : mesh.ranges) {
    out.write("usemtl ", names[range.material], '\n');
    write_triangles(mesh, lines, range, out);
  }
  files.obj = out.take();
  return files;
}

}  // namespace varifold
