#include <varifold/mesh/topology.h>
#include <varifold/mesh/validation.h>
#include <varifold/morph/sphere_surface.h>
#include <varifold/morph/sphere_triangulation.h>
#include <algorithm>

namespace varifold {
namespace {

std::string counted(std::uint64_t count, const std::string& one) {
  return std::to_string(count).append(" ").append(one).append(count == 1 ? "" : "s");
}

// " (edge 12-15, ...)" of a kind of fault, or nothing.
std::string place_of(const std::vector<Fault>& faults, const std::string& kind) {
  for (const Fault& fault : faults)
    if (fault.kind == kind && !fault.where.empty()) return std::string(" (") + fault.where + ')';
  return "";
}

// What keeps a surface from being a sphere or a disc; empty where nothing does.
std::string fault_of(const TopologyReport& report, const std::vector<Fault>& faults) {
  if (report.triangles == 0) return "has no triangles";
  if (report.nonmanifold_edges > 0)
    return counted(report.nonmanifold_edges, "non-manifold edge") +
           place_of(faults, "nonmanifold_edge");
  if (report.nonmanifold_vertices > 0)
    return std::to_string(report.nonmanifold_vertices) +
           (report.nonmanifold_vertices == 1 ? " non-manifold vertex" : " non-manifold vertices") +
           place_of(faults, "nonmanifold_vertex");
  if (report.misoriented_edges > 0)
    return counted(report.misoriented_edges, "edge") + " between triangles of opposite sides" +
           place_of(faults, "misoriented_edge");
  if (report.components != 1)
    return counted(report.components, "component") + " where there must be one";
  if (!report.closed && report.boundary_loops != 1)
    return "open, with " + counted(report.boundary_loops, "hole") +
           place_of(faults, "boundary_edge");
  if (!report.closed && report.euler_characteristic != 1)
    return "open, with 1 hole and " +
           counted(static_cast<std::uint64_t>((1 - report.euler_characteristic) / 2), "handle");
  if (report.closed && report.genus() != 0)
    return "of genus " + std::to_string(report.genus().value_or(-1)) + ", not a sphere";
  return "";
}

}  // namespace

std::vector<std::uint32_t> find_boundary(const SphereSurface& surface) {
  const auto count = static_cast<std::uint32_t>(surface.positions.size());
  const SphereTriangulation triangles(surface.indices, std::vector<SpherePoint>(count));
  std::vector<std::uint32_t> next(count, kNone), loop;
  std::uint32_t first = kNone;
  for (std::uint32_t h = 0; h < surface.indices.size(); ++h)
    if (triangles.opposite[h] == kNone) {
      next[triangles.from(h)] = triangles.to(h);
      first = std::min(first, triangles.from(h));
    }
  for (std::uint32_t point = first; point != kNone && loop.size() < count; point = next[point]) {
    loop.push_back(point);
    if (next[point] == first) break;
  }
  return loop;
}

Result<SphereSurface> as_sphere(const TriangleMesh& mesh, const std::string& name, int threads) {
  auto surface = as_sphere_or_disc(mesh, name, threads);
  if (surface && surface->is_disc())
    return fail(ErrorKind::kInvalidInput,
                name + ": open, with 1 hole" + place_of(validate(mesh, threads), "boundary_edge"));
  return surface;
}

Result<SphereSurface> as_sphere_or_disc(const TriangleMesh& mesh, const std::string& name,
                                        int threads) {
  const std::vector<Fault> faults = validate(mesh, threads);
  for (const Fault& fault : faults)
    if (fault.severity == Severity::kBroken)
      return fail(ErrorKind::kInvalidInput, name + ": " + fault.kind + " " + fault.where);
  const WeldMap weld = weld_exact(mesh.positions);
  const TopologyReport report = analyze_topology(mesh, weld, threads);
  const std::string fault = fault_of(report, faults);
  if (!fault.empty()) return fail(ErrorKind::kInvalidInput, name + ": " + fault);

  SphereSurface surface;
  std::vector<std::uint32_t> point_of(weld.class_count, kNone);
  surface.point_of_vertex.resize(mesh.vertex_count(), kNone);
  for (std::uint32_t t = 0; t < mesh.triangle_count(); ++t) {
    const std::uint32_t* const corner = &mesh.indices[3 * std::size_t{t}];
    const std::uint32_t classes[3] = {weld.class_of[corner[0]], weld.class_of[corner[1]],
                                      weld.class_of[corner[2]]};
    if (classes[0] == classes[1] || classes[1] == classes[2] || classes[2] == classes[0]) continue;
    surface.triangles.push_back(t);
    for (int k = 0; k < 3; ++k) {
      std::uint32_t& point = point_of[classes[k]];
      if (point == kNone) {
        point = static_cast<std::uint32_t>(surface.positions.size());
        surface.positions.push_back(mesh.positions[corner[k]]);
      }
      surface.indices.push_back(point);
    }
  }
  for (std::uint32_t v = 0; v < mesh.vertex_count(); ++v)
    surface.point_of_vertex[v] = point_of[weld.class_of[v]];
  if (!report.closed) surface.boundary = find_boundary(surface);
  return surface;
}

}  // namespace varifold
