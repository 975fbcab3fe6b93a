#include <varifold/models/vdpm/active_surface.h>

#include <varifold/mesh/vertex_arrays.h>
#include <varifold/view/draw_vertices.h>
#include <algorithm>

namespace varifold {

ActiveSurface::ActiveSurface(const ViewDependentMesh& model)
    : model_(&model),
      vertices_(model.attributes()),
      triangles_(model.triangle_count(model.finest_level()), model.attributes().ranges) {
  const ViewDependentMeshData& data = model.data();
  reserve(model.vertex_count(0), model.triangle_count(0));
  for (std::uint32_t v = 0; v < model.vertex_count(0); ++v) add_vertex(v);
  for (std::size_t i = 0; i < data.base_triangles.size(); ++i) {
    const std::uint32_t* const corners = data.base_corners.data() + 3 * i;
    triangles_.add(
        data.base_triangles[i], model.range_of(data.base_triangles[i]),
        {vertices_.slot(corners[0]), vertices_.slot(corners[1]), vertices_.slot(corners[2])});
  }
}

void ActiveSurface::reserve(std::uint32_t vertices, std::uint32_t triangles) {
  vertices_.reserve(vertices);
  triangles_.reserve(triangles);
}

void ActiveSurface::add_vertex(std::uint32_t vertex) {
  const ViewDependentMeshData& data = model_->data();
  const std::uint32_t look = data.first_look.empty() ? kNone : data.first_look[vertex];
  if (look == kNone)
    vertices_.add(vertex, data.mesh, vertex);
  else
    vertices_.add(vertex, data.placed, look);
}

void ActiveSurface::split(std::uint32_t step) {
  split_connectivity(step);
  if (model_->moves_vertices()) write_finer(step);
}

void ActiveSurface::collapse(std::uint32_t step) {
  collapse_connectivity(step);
  if (model_->moves_vertices()) write_coarser(step);
}

void ActiveSurface::split_connectivity(std::uint32_t step) {
  const LevelTable& levels = model_->levels();
  const StepRecords& records = model_->data().records;
  const std::uint32_t vertex = model_->first_vertex(step);
  const StepRecords::View record = records.find(step);
  const std::uint32_t vertices = record.is_short ? 1 : levels.step(step).vertices;
  for (std::uint32_t i = 0; i < vertices; ++i) add_vertex(vertex + i);
  records.for_each_changed(record, vertex,
                           [&](std::uint32_t triangle, std::uint32_t corner, std::uint32_t v) {
                             triangles_.set_corner(triangle, corner, vertices_.slot(v));
                           });
  records.for_each_added(record, vertex, levels.target(vertex), levels.triangle_count(step),
                         [&](std::uint32_t triangle, const std::array<std::uint32_t, 3>& corners) {
                           triangles_.add(triangle, model_->range_of(triangle),
                                          {vertices_.slot(corners[0]), vertices_.slot(corners[1]),
                                           vertices_.slot(corners[2])});
                         });
}

void ActiveSurface::collapse_connectivity(std::uint32_t step) {
  const LevelTable& levels = model_->levels();
  const StepRecords& records = model_->data().records;
  const std::uint32_t vertex = model_->first_vertex(step);
  const StepRecords::View record = records.find(step);
  records.for_each_changed(
      record, vertex, [&](std::uint32_t triangle, std::uint32_t corner, std::uint32_t v) {
        triangles_.set_corner(triangle, corner, vertices_.slot(levels.target(v)));
      });
  records.for_each_added(record, vertex, levels.target(vertex), levels.triangle_count(step),
                         [&](std::uint32_t triangle, const std::array<std::uint32_t, 3>&) {
                           triangles_.remove(triangle);
                         });
  const std::uint32_t vertices = record.is_short ? 1 : levels.step(step).vertices;
  for (std::uint32_t i = vertices; i-- > 0;) vertices_.remove(vertex + i);
}

// The vertices that stay, as they were before the step's collapse.
void ActiveSurface::write_finer(std::uint32_t step) {
  const ViewDependentMeshData& data = model_->data();
  for (std::uint32_t j = data.first_placed[step]; j < data.first_placed[step + 1]; ++j) {
    const std::uint32_t vertex = data.placed_vertex[j];
    if (data.finer[j] == kNone)
      vertices_.write(vertices_.slot(vertex), data.mesh, vertex);
    else
      vertices_.write(vertices_.slot(vertex), data.placed, data.finer[j]);
  }
}

void ActiveSurface::write_coarser(std::uint32_t step) {
  const ViewDependentMeshData& data = model_->data();
  for (std::uint32_t j = data.first_placed[step]; j < data.first_placed[step + 1]; ++j)
    vertices_.write(vertices_.slot(data.placed_vertex[j]), data.placed, j);
}

DrawList ActiveSurface::draw_list() {
  const TriangleMesh& full = model_->attributes();
  const std::uint32_t base = model_->vertex_count(0);
  const std::uint32_t more = full.vertex_count() - base;
  const float level =
      more > 0 ? static_cast<float>(vertex_count() - base) / static_cast<float>(more) : 1;
  DrawList list = draw_vertices(vertices_.buffer());
  list.indices = triangles_.indices();
  list.ranges = triangles_.ranges(level);
  list.changed_vertices = vertices_.take_changed();
  list.changed_indices = triangles_.take_changed();
  return list;
}

TriangleMesh ActiveSurface::extract() const {
  const TriangleMesh& full = model_->attributes();
  const TriangleMesh& buffer = vertices_.buffer();
  TriangleMesh mesh;
  copy_pose_names(full, mesh);
  mesh.materials = full.materials;
  mesh.images = full.images;
  std::vector<std::uint32_t> number(vertices_.slots(), kNone);  // per slot
  for (std::uint32_t v = 0; v < full.vertex_count(); ++v) {
    if (!vertices_.is_active(v)) continue;
    const std::uint32_t slot = vertices_.slot(v);
    number[slot] = mesh.vertex_count();
    for_each_vertex_array(buffer, mesh, [&](const auto& values, auto& kept) {
      if (!values.empty()) kept.push_back(values[slot]);
    });
  }
  const auto append = [&](std::uint32_t first, std::uint32_t count) {
    for (std::uint32_t t = first; t < first + count; ++t) {
      if (!triangles_.is_shown(t)) continue;
      for (const std::uint32_t slot : triangles_.corners(t)) mesh.indices.push_back(number[slot]);
    }
  };
  if (full.ranges.empty()) append(0, model_->triangle_count(model_->finest_level()));
  for (const MaterialRange& range : full.ranges) {
    const std::uint32_t before = mesh.triangle_count();
    append(range.first_triangle, range.triangle_count);
    const std::uint32_t shown = mesh.triangle_count() - before;
    if (shown > 0) mesh.ranges.push_back({range.material, before, shown});
  }
  return mesh;
}

}  // namespace varifold
