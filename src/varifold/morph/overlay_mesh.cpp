#include <varifold/mesh/vertex_arrays.h>
#include <varifold/morph/overlay_mesh.h>
#include <algorithm>
#include <array>
#include <cmath>

namespace varifold {
namespace {

// A point of a surface by the wedges around it: one, the two ends of an edge, or three corners.
struct SurfacePoint {
  std::array<std::uint32_t, 3> wedges{kNone, kNone, kNone};
  std::array<double, 3> weights{0, 0, 0};
};

template <class Vector>
Vector blend(const std::vector<Vector>& values, const SurfacePoint& point) {
  glm::vec<Vector::length(), double> sum(0);
  for (std::size_t k = 0; k < 3 && point.wedges[k] != kNone; ++k)
    sum += point.weights[k] * glm::vec<Vector::length(), double>(values[point.wedges[k]]);
  if constexpr (std::is_integral_v<typename Vector::value_type>) sum += 0.5;
  return Vector(sum);
}

// Where the nodes lie on one of the two surfaces.
class SurfaceNodes {
 public:
  enum class Kind { kVertex, kInside, kOnEdge };

  SurfaceNodes(const MappedSurface& self, const MappedSurface& other, const Crossings& crossings,
               bool is_a)
      : self_(self), other_(other), crossings_(crossings), is_a_(is_a) {}

  [[nodiscard]] SurfacePoint locate(std::uint32_t node, std::uint32_t triangle) const {
    const auto own = static_cast<std::uint32_t>(self_.sphere.points.size());
    const auto others = static_cast<std::uint32_t>(other_.sphere.points.size());
    const std::uint32_t first_own = is_a_ ? 0 : others, first_other = is_a_ ? own : 0;
    if (node >= own + others) return on_edge(node - own - others, triangle);
    const auto& in_b = crossings_.shared.in_b;
    if (!is_a_ && node < in_b.size() && in_b[node] != kNone) return at_vertex(in_b[node], triangle);
    if (node - first_own < own) return at_vertex(node - first_own, triangle);
    return inside(other_.sphere.points[node - first_other], triangle);
  }

 private:
  [[nodiscard]] std::uint32_t wedge(std::uint32_t triangle, std::uint32_t corner) const {
    return self_.mesh.indices[3 * self_.triangles[triangle] + corner];
  }
  [[nodiscard]] const SpherePoint& point(std::uint32_t half_edge) const {
    return self_.sphere.points[self_.sphere.from(half_edge)];
  }

  [[nodiscard]] SurfacePoint at_vertex(std::uint32_t vertex, std::uint32_t triangle) const {
    std::uint32_t corner = 0;
    while (corner < 2 && self_.sphere.indices[3 * triangle + corner] != vertex) ++corner;
    return {{wedge(triangle, corner), kNone, kNone}, {1, 0, 0}};
  }

  [[nodiscard]] SurfacePoint inside(const SpherePoint& p, std::uint32_t triangle) const {
    const SpherePoint &x = point(3 * triangle), &y = point(3 * triangle + 1),
                      &z = point(3 * triangle + 2);
    const double wx = determinant(y, z, p), wy = determinant(z, x, p), wz = determinant(x, y, p);
    const double scale = 1 / (wx + wy + wz);
    return {{wedge(triangle, 0), wedge(triangle, 1), wedge(triangle, 2)},
            {wx * scale, wy * scale, wz * scale}};
  }

  // Weights are taken along the first half-edge, so that they are the same from both sides.
  [[nodiscard]] SurfacePoint on_edge(std::uint32_t index, std::uint32_t triangle) const {
    const Crossing& crossing = crossings_.crossings[index];
    const std::uint32_t half = self_.sphere.edge_half[is_a_ ? crossing.edge_a : crossing.edge_b];
    const std::uint32_t cut = other_.sphere.edge_half[is_a_ ? crossing.edge_b : crossing.edge_a];
    const SpherePoint &p = other_.sphere.points[other_.sphere.from(cut)],
                      &q = other_.sphere.points[other_.sphere.to(cut)];
    const double at_from = determinant(p, q, self_.sphere.points[self_.sphere.from(half)]);
    const double at_to = determinant(p, q, self_.sphere.points[self_.sphere.to(half)]);
    const double weight = at_from / (at_from - at_to);
    const bool is_first = half / 3 == triangle;
    const std::uint32_t side = is_first ? half : self_.sphere.opposite[half];
    const std::uint32_t from = wedge(triangle, side % 3);
    const std::uint32_t to = wedge(triangle, next_half_edge(side) % 3);
    return is_first ? SurfacePoint{{from, to, kNone}, {1 - weight, weight, 0}}
                    : SurfacePoint{{to, from, kNone}, {1 - weight, weight, 0}};
  }

  const MappedSurface &self_, &other_;
  const Crossings& crossings_;
  bool is_a_;
};

// How far a triangle is from a needle: 1 for an equilateral one, 0 for one without area.
double shape_of(const Vec3& a, const Vec3& b, const Vec3& c) {
  const DVec3 u = DVec3(b) - DVec3(a), v = DVec3(c) - DVec3(a);
  const double longest = std::max({glm::dot(u, u), glm::dot(v, v), glm::dot(u - v, u - v)});
  return longest > 0 ? glm::length(glm::cross(u, v)) / longest : 0.0;
}

class OverlayMesh {
 public:
  OverlayMesh(const MappedSurface& a, const MappedSurface& b, const Crossings& crossings,
              const OverlayCells& cells)
      : a_(a),
        b_(b),
        cells_(cells),
        nodes_a_(a, b, crossings, true),
        nodes_b_(b, a, crossings, false),
        has_both_normals_(a.mesh.has_normals() && b.mesh.has_normals()),
        first_variant_(a.sphere.points.size() + b.sphere.points.size() + crossings.crossings.size(),
                       kNone) {}

  OverlayTriangles run() {
    mesh_.poses.push_back({"b", {}, {}});
    mesh_.materials = a_.mesh.materials;
    mesh_.images = a_.mesh.images;
    const std::vector<std::uint32_t> materials = triangle_materials(a_.mesh);
    std::vector<std::uint32_t> material_of;
    std::vector<std::uint32_t> corners;
    for (std::uint32_t cell = 0; cell < cells_.cell_count(); ++cell) {
      corners.clear();
      for (const std::uint32_t node : cells_.cell(cell)) corners.push_back(vertex_of(node, cell));
      add_fan(corners);
      material_of.resize(mesh_.triangle_count(), materials[a_.triangles[cells_.triangle_a[cell]]]);
    }
    if (!a_.mesh.ranges.empty()) set_triangle_materials(mesh_, material_of);
    OverlayTriangles result{std::move(mesh_), std::move(point_of_vertex_),
                            static_cast<std::uint32_t>(first_variant_.size())};
    close_with_fan(result);
    return result;
  }

 private:
  // A vertex at a node: where seams meet, one of several.
  struct Variant {
    std::array<std::uint32_t, 3> wedges_a, wedges_b;
    std::uint32_t next;
  };

  std::uint32_t vertex_of(std::uint32_t node, std::uint32_t cell) {
    const SurfacePoint on_a = nodes_a_.locate(node, cells_.triangle_a[cell]);
    const SurfacePoint on_b = nodes_b_.locate(node, cells_.triangle_b[cell]);
    for (std::uint32_t v = first_variant_[node]; v != kNone; v = variants_[v].next)
      if (variants_[v].wedges_a == on_a.wedges &&
          (!has_both_normals_ || variants_[v].wedges_b == on_b.wedges))
        return v;
    const auto vertex = static_cast<std::uint32_t>(variants_.size());
    point_of_vertex_.push_back(node);
    variants_.push_back({on_a.wedges, on_b.wedges, first_variant_[node]});
    // All variants of a node are at one place, bit by bit, whatever wedges they were found from.
    const std::uint32_t twin = first_variant_[node];
    first_variant_[node] = vertex;
    add_vertex(on_a, on_b, twin);
    return vertex;
  }

  void add_vertex(const SurfacePoint& on_a, const SurfacePoint& on_b, std::uint32_t twin) {
    Pose& pose = mesh_.poses[0];
    mesh_.positions.push_back(twin == kNone ? blend(a_.mesh.positions, on_a)
                                            : Vec3(mesh_.positions[twin]));
    pose.positions.push_back(twin == kNone ? blend(b_.mesh.positions, on_b)
                                           : Vec3(pose.positions[twin]));
    if (a_.mesh.has_normals())
      mesh_.normals.push_back(normalize_or_zero(blend(a_.mesh.normals, on_a)));
    if (has_both_normals_) pose.normals.push_back(normalize_or_zero(blend(b_.mesh.normals, on_b)));
    if (a_.mesh.has_texcoords()) mesh_.texcoords.push_back(blend(a_.mesh.texcoords, on_a));
    if (a_.mesh.has_colors()) mesh_.colors.push_back(blend(a_.mesh.colors, on_a));
  }

  // Of a disc: the fan of a, which is that of b, too. Nodes of the boundary are vertices of a.
  void close_with_fan(OverlayTriangles& overlay) const {
    const std::vector<std::uint32_t>& corners = a_.sphere.indices;
    std::vector<std::uint32_t> vertex_at(a_.sphere.points.size(), kNone);
    std::vector<std::uint32_t> copied, points;
    const std::size_t first = 3 * a_.triangles.size();
    for (std::size_t corner = first; corner < corners.size(); ++corner) {
      const std::uint32_t node = corners[corner];
      if (vertex_at[node] == kNone) {
        vertex_at[node] = overlay.mesh.vertex_count() + static_cast<std::uint32_t>(copied.size());
        // The pole, where nothing is, gets the place of its neighbour.
        const bool is_pole = first_variant_[node] == kNone;
        copied.push_back(first_variant_[is_pole ? corners[first] : node]);
        points.push_back(node);
        if (is_pole) overlay.pole = node;
      }
      overlay.mesh.indices.push_back(vertex_at[node]);
    }
    overlay.fan_triangles = static_cast<std::uint32_t>((corners.size() - first) / 3);
    for_each_vertex_array(overlay.mesh, [&]<class Value>(std::vector<Value>& values) {
      for (std::size_t i = 0; i < copied.size() && !values.empty(); ++i)
        values.push_back(Value(values[copied[i]]));
    });
    overlay.point_of_vertex.insert(overlay.point_of_vertex.end(), points.begin(), points.end());
  }

  // The worst shape of a triangle of the fan about a corner, on both surfaces.
  [[nodiscard]] double worst_shape(const std::vector<std::uint32_t>& corners,
                                   std::size_t apex) const {
    const std::size_t size = corners.size();
    double worst = 2;
    for (std::size_t i = 1; i + 1 < size; ++i) {
      const std::uint32_t p = corners[apex], q = corners[(apex + i) % size],
                          r = corners[(apex + i + 1) % size];
      const auto& moved = mesh_.poses[0].positions;
      worst = std::min({worst, shape_of(mesh_.positions[p], mesh_.positions[q], mesh_.positions[r]),
                        shape_of(moved[p], moved[q], moved[r])});
    }
    return worst;
  }

  void add_fan(const std::vector<std::uint32_t>& corners) {
    const std::size_t size = corners.size();
    std::size_t apex = 0;
    double best = -1;
    for (std::size_t i = 0; size > 3 && i < size; ++i) {
      const double shape = worst_shape(corners, i);
      if (shape > best) best = shape, apex = i;
    }
    for (std::size_t i = 1; i + 1 < size; ++i)
      mesh_.indices.insert(mesh_.indices.end(), {corners[apex], corners[(apex + i) % size],
                                                 corners[(apex + i + 1) % size]});
  }

  const MappedSurface &a_, &b_;
  const OverlayCells& cells_;
  SurfaceNodes nodes_a_, nodes_b_;
  bool has_both_normals_;
  std::vector<std::uint32_t> first_variant_;  // per node, the last one made
  std::vector<Variant> variants_;             // per vertex
  std::vector<std::uint32_t> point_of_vertex_;
  TriangleMesh mesh_;
};

}  // namespace

OverlayTriangles make_overlay_mesh(const MappedSurface& a, const MappedSurface& b,
                                   const Crossings& crossings, const OverlayCells& cells) {
  return OverlayMesh(a, b, crossings, cells).run();
}

}  // namespace varifold
