#include <varifold/base/disjoint_sets.h>
#include <varifold/mesh/topology.h>
#include <varifold/mesh/topology_scan.h>
#include <algorithm>

namespace varifold {

namespace {

/// Calls visit(position class, triangle) once for every class of every triangle.
template <class Visit>
void for_each_incidence(std::span<const std::uint32_t> indices, const WeldMap& weld,
                        const Visit& visit) {
  for (std::size_t corner = 0; corner + 2 < indices.size(); corner += 3) {
    const std::uint32_t a = weld.class_of[indices[corner]];
    const std::uint32_t b = weld.class_of[indices[corner + 1]];
    const std::uint32_t c = weld.class_of[indices[corner + 2]];
    const auto triangle = static_cast<std::uint32_t>(corner / 3);
    visit(a, triangle);
    if (b != a) visit(b, triangle);
    if (c != a && c != b) visit(c, triangle);
  }
}

std::uint32_t count_components(const TriangleMesh& mesh, const WeldMap& weld,
                               std::uint32_t used_classes) {
  DisjointSets sets(weld.class_count);
  for (std::size_t corner = 0; corner + 2 < mesh.indices.size(); corner += 3) {
    const std::uint32_t a = weld.class_of[mesh.indices[corner]];
    const std::uint32_t b = weld.class_of[mesh.indices[corner + 1]];
    const std::uint32_t c = weld.class_of[mesh.indices[corner + 2]];
    if (a == b || b == c || a == c) continue;
    sets.unite(a, b);
    sets.unite(b, c);
  }
  // An unused class is a set by itself.
  return static_cast<std::uint32_t>(sets.set_count() - (weld.class_count - used_classes));
}

std::uint32_t count_boundary_loops(detail::TopologyScan& scan) {
  std::vector<std::uint32_t>& ids = scan.boundary_ids;
  std::sort(ids.begin(), ids.end());
  const auto number = [&](std::uint32_t id) {
    return static_cast<std::uint32_t>(std::lower_bound(ids.begin(), ids.end(), id) - ids.begin());
  };
  DisjointSets sets(ids.size());
  for (const auto& [a, b] : scan.boundary_joints) sets.unite(number(a), number(b));
  return static_cast<std::uint32_t>(sets.set_count());
}

}  // namespace

VertexFaces::VertexFaces(std::span<const std::uint32_t> indices, const WeldMap& weld)
    : offsets_(std::size_t{weld.class_count} + 1, 0) {
  // Count one place ahead, so that filling moves each offset to where it belongs.
  for_each_incidence(indices, weld, [&](std::uint32_t c, std::uint32_t) { ++offsets_[c]; });
  std::uint32_t total = 0;
  for (std::uint32_t& offset : offsets_) {
    total += offset;
    offset = total;
  }
  triangles_.resize(total);

  // Fill from the back: each row ends up ascending, each offset at the start of its row.
  for (std::size_t corner = indices.size() / 3 * 3; corner > 0; corner -= 3) {
    const std::uint32_t a = weld.class_of[indices[corner - 3]];
    const std::uint32_t b = weld.class_of[indices[corner - 2]];
    const std::uint32_t c = weld.class_of[indices[corner - 1]];
    const auto triangle = static_cast<std::uint32_t>(corner / 3 - 1);
    triangles_[--offsets_[a]] = triangle;
    if (b != a) triangles_[--offsets_[b]] = triangle;
    if (c != a && c != b) triangles_[--offsets_[c]] = triangle;
  }
}

TopologyReport analyze_topology(const TriangleMesh& mesh, const WeldMap& weld, int threads) {
  detail::TopologyScan scan = detail::scan_topology(mesh, weld, threads);
  TopologyReport report;
  report.vertices = mesh.vertex_count();
  report.classes = weld.class_count;
  report.used_classes = scan.used_classes;
  report.degenerate_triangles = static_cast<std::uint32_t>(scan.degenerate_triangles.count);
  report.triangles = mesh.triangle_count() - report.degenerate_triangles;
  report.duplicate_triangles = static_cast<std::uint32_t>(scan.duplicate_triangles.count);
  report.edges = scan.edges;
  report.boundary_edges = scan.boundary_edges.count;
  report.nonmanifold_edges = scan.nonmanifold_edges.count;
  report.misoriented_edges = scan.misoriented_edges.count;
  report.nonmanifold_vertices = static_cast<std::uint32_t>(scan.nonmanifold_vertices.count);
  report.components = count_components(mesh, weld, scan.used_classes);
  report.boundary_loops = count_boundary_loops(scan);
  report.euler_characteristic = static_cast<std::int64_t>(report.used_classes) -
                                static_cast<std::int64_t>(report.edges) + report.triangles;
  report.closed = report.triangles > 0 && scan.odd_edges == 0;
  return report;
}

}  // namespace varifold
