#include <varifold/models/common/level_table_bytes.h>
#include <varifold/models/common/mesh_bytes.h>
#include <varifold/models/vdpm/connectivity_code.h>
#include <varifold/models/vdpm/encoding.h>
#include <varifold/models/vdpm/encoding_parts.h>
#include <algorithm>

namespace varifold {

namespace {

using vdpm::GrowingSurface;
using vdpm::NewTriangle;
using vdpm::SplitFrame;

std::vector<std::byte> encode_steps(const ViewDependentMesh& model) {
  const ViewDependentMeshData& data = model.data();
  const std::uint32_t triangles = model.triangle_count(model.finest_level());
  GrowingSurface surface(data.mesh.vertex_count(), triangles);
  for (std::size_t i = 0; i < data.base_triangles.size(); ++i)
    surface.add(data.base_triangles[i], {data.base_corners[3 * i], data.base_corners[3 * i + 1],
                                         data.base_corners[3 * i + 2]});
  BitWriter bits;
  SplitFrame frame;
  frame.target = model.levels().targets();
  frame.ranges = std::max(1u, static_cast<std::uint32_t>(data.mesh.ranges.size()));
  for (std::uint32_t k = 0; k < model.step_count(); ++k) {
    frame.first_vertex = model.first_vertex(k);
    frame.end_vertex = model.first_vertex(k + 1);
    constexpr std::uint32_t kAhead = 16;
    if (k + kAhead < model.step_count())
      model.for_each_changed(k + kAhead,
                             [&](std::uint32_t triangle, std::uint32_t corner, std::uint32_t) {
                               surface.prefetch(3 * triangle + corner);
                             });
    model.for_each_changed(k, [&](std::uint32_t triangle, std::uint32_t corner, std::uint32_t v) {
      surface.mark(3 * triangle + corner, v);
    });
    vdpm::write_division(frame, surface, bits);
    model.for_each_added(
        k, [&](std::uint32_t triangle, const std::array<std::uint32_t, 3>& corners) {
          vdpm::write_triangle(frame, {corners, model.range_of(triangle)}, surface, bits);
          surface.add(triangle, corners);
        });
    if (model.moves_vertices()) {
      const std::uint32_t first = data.first_placed[k];
      vdpm::write_moved(
          frame, std::span(data.placed_vertex).subspan(first, data.first_placed[k + 1] - first),
          bits);
    }
  }
  return bits.take();
}

void append_ranges(const ViewDependentMesh& model, std::vector<std::byte>& bytes) {
  const ViewDependentMeshData& data = model.data();
  std::vector<std::uint32_t> base(data.mesh.ranges.size(), 0);
  for (const std::uint32_t t : data.base_triangles)
    if (!base.empty()) ++base[model.range_of(t)];
  append_little(bytes, static_cast<std::uint32_t>(base.size()));
  for (std::size_t r = 0; r < base.size(); ++r) {
    append_little(bytes, data.mesh.ranges[r].material);
    append_little(bytes, data.mesh.ranges[r].triangle_count);
    append_little(bytes, base[r]);
  }
}

// One array for each member.
void append_bounds(const std::vector<PackedBounds>& bounds, std::vector<std::byte>& bytes) {
  for (const PackedBounds& b : bounds) append_little(bytes, b.cone);
  for (const auto member : vdpm::kShortBounds)
    for (const PackedBounds& b : bounds) append_little(bytes, b.*member);
}

}  // namespace

std::vector<std::byte> encode_view_dependent_mesh(const ViewDependentMesh& model) {
  const ViewDependentMeshData& data = model.data();
  std::vector<std::byte> bytes;
  append_text(bytes, vdpm::kTag);
  append_attributes(data.mesh, bytes);
  append_materials(data.mesh.materials, bytes);
  append_images(data.mesh.images, bytes);
  LevelTableCoder::append(data.levels, bytes);
  append_ranges(model, bytes);
  append_array<std::uint32_t>(bytes, data.base_corners);
  append_little(bytes, (model.moves_vertices() ? vdpm::kMovesVertices : 0u) |
                           (data.centers.empty() ? 0u : vdpm::kHasCenters));
  const std::vector<std::byte> steps = encode_steps(model);
  append_little(bytes, static_cast<std::uint64_t>(steps.size()));
  bytes.insert(bytes.end(), steps.begin(), steps.end());
  if (model.moves_vertices()) append_attributes(data.placed, bytes, false);
  append_bounds(data.bounds, bytes);
  for (const Vec3& center : data.centers) append_vector(bytes, center, 3);
  return bytes;
}

}  // namespace varifold
