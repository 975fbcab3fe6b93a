#include <varifold/io/import_check.h>
#include <varifold/io/ply.h>
#include <varifold/io/text_writer.h>

namespace varifold {
namespace {

/// The uri of the one texture file that MeshLab's comment can name; or empty.
std::string texture_file(const TriangleMesh& mesh) {
  if (mesh.materials.size() != 1 || !mesh.has_texcoords()) return {};
  const std::uint32_t image =
      mesh.materials[0].textures[static_cast<std::size_t>(TextureUse::kBaseColor)];
  if (image >= mesh.images.size()) return {};
  const std::string& uri = mesh.images[image].uri;
  return uri.find_first_of("\r\n") == std::string::npos ? uri : std::string();
}

/// What "tristrips" holds: -1 is a restart.
std::vector<std::int32_t> strip_row(const JoinedStrips& strips) {
  std::vector<std::int32_t> row;
  row.reserve(strips.indices.size() + strips.ranges.size());
  for (const DrawRange& range : strips.ranges) {
    if (!row.empty()) row.push_back(-1);
    for (std::uint32_t i = 0; i < range.index_count; ++i)
      row.push_back(static_cast<std::int32_t>(strips.indices[range.first_index + i]));
  }
  return row;
}
static_assert(static_cast<std::int32_t>(kStripRestart) == -1);

void write_header(const TriangleMesh& mesh, const std::string& texture, const PlyOptions& options,
                  TextWriter& out) {
  out.write("ply\nformat ", options.ascii ? "ascii" : "binary_little_endian", " 1.0\n");
  if (!texture.empty()) out.write("comment TextureFile ", texture, '\n');
  out.write("element vertex ", mesh.positions.size(), '\n');
  out.write("property float x\nproperty float y\nproperty float z\n");
  if (mesh.has_normals()) out.write("property float nx\nproperty float ny\nproperty float nz\n");
  if (mesh.has_texcoords()) out.write("property float s\nproperty float t\n");
  if (mesh.has_colors())
    out.write("property uchar red\nproperty uchar green\nproperty uchar blue\n",
              "property uchar alpha\n");
  if (options.strips) {
    out.write("element tristrips 1\nproperty list int int vertex_indices\nend_header\n");
    return;
  }
  out.write("element face ", mesh.indices.size() / 3, '\n');
  out.write("property list uchar uint vertex_indices\nend_header\n");
}

/// With a texture file, images begin at the lower left.
Vec2 texcoord(const TriangleMesh& mesh, std::size_t vertex, bool flip) {
  const Vec2& t = mesh.texcoords[vertex];
  return flip ? Vec2(t.x, 1 - t.y) : t;
}

void write_vertices_ascii(const TriangleMesh& mesh, bool flip, TextWriter& out) {
  for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
    const Vec3& p = mesh.positions[v];
    out.write(p.x, ' ', p.y, ' ', p.z);
    if (mesh.has_normals()) {
      const Vec3& n = mesh.normals[v];
      out.write(' ', n.x, ' ', n.y, ' ', n.z);
    }
    if (mesh.has_texcoords()) {
      const Vec2 t = texcoord(mesh, v, flip);
      out.write(' ', t.x, ' ', t.y);
    }
    if (mesh.has_colors())
      for (int i = 0; i < 4; ++i) out.write(' ', static_cast<int>(mesh.colors[v][i]));
    out.write('\n');
  }
}

void write_faces_ascii(const TriangleMesh& mesh, const JoinedStrips* strips, TextWriter& out) {
  if (strips) {
    const std::vector<std::int32_t> row = strip_row(*strips);
    out.write(row.size());
    for (const std::int32_t index : row) out.write(' ', index);
    out.write('\n');
    return;
  }
  for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3)
    out.write("3 ", mesh.indices[i], ' ', mesh.indices[i + 1], ' ', mesh.indices[i + 2], '\n');
}

template <class T>
std::byte* put(std::byte* at, T value) {
  store_little(at, value);
  return at + sizeof(T);
}

void write_vertices_binary(const TriangleMesh& mesh, bool flip, std::vector<std::byte>& bytes) {
  const std::size_t vertex_bytes = 12 + (mesh.has_normals() ? 12 : 0) +
                                   (mesh.has_texcoords() ? 8 : 0) + (mesh.has_colors() ? 4 : 0);
  const std::size_t header_bytes = bytes.size();
  bytes.resize(header_bytes + mesh.positions.size() * vertex_bytes);
  std::byte* at = bytes.data() + header_bytes;
  for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
    for (int i = 0; i < 3; ++i) at = put(at, mesh.positions[v][i]);
    if (mesh.has_normals())
      for (int i = 0; i < 3; ++i) at = put(at, mesh.normals[v][i]);
    if (mesh.has_texcoords())
      for (int i = 0; i < 2; ++i) at = put(at, texcoord(mesh, v, flip)[i]);
    if (mesh.has_colors())
      for (int i = 0; i < 4; ++i) at = put(at, mesh.colors[v][i]);
  }
}

void write_faces_binary(const TriangleMesh& mesh, const JoinedStrips* strips,
                        std::vector<std::byte>& bytes) {
  const std::size_t first = bytes.size();
  if (strips) {
    const std::vector<std::int32_t> row = strip_row(*strips);
    bytes.resize(first + 4 + 4 * row.size());
    std::byte* at = put(bytes.data() + first, static_cast<std::int32_t>(row.size()));
    for (const std::int32_t index : row) at = put(at, index);
    return;
  }
  bytes.resize(first + mesh.indices.size() / 3 * 13);
  std::byte* at = bytes.data() + first;
  for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
    at = put(at, std::uint8_t{3});
    for (int corner = 0; corner < 3; ++corner) at = put(at, mesh.indices[i + corner]);
  }
}

}  // namespace

std::vector<std::byte> write_ply(const TriangleMesh& mesh, const PlyOptions& options) {
  TextWriter out;
  const std::string texture = texture_file(mesh);
  write_header(mesh, texture, options, out);
  if (options.ascii) {
    write_vertices_ascii(mesh, !texture.empty(), out);
    write_faces_ascii(mesh, options.strips, out);
    return out.take();
  }
  std::vector<std::byte> bytes = out.take();
  write_vertices_binary(mesh, !texture.empty(), bytes);
  write_faces_binary(mesh, options.strips, bytes);
  return bytes;
}

}  // namespace varifold
