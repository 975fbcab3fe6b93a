#include <varifold/simplify/point_quadric.h>

#include <varifold/simplify/classify.h>

namespace varifold {

namespace {

// Planes through the feature edges, at right angles to the faces there.
void add_constraints(WorkingSurface& surface, std::uint32_t point, const QuadricOptions& options,
                     Quadric& quadric) {
  const auto ring = surface.ring_span(point);
  const Vec3 origin = surface.points[point].position;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    if (ring[i].face == kNone) continue;
    const std::uint32_t ends[2] = {ring[i].neighbor, ring[i + 1 == ring.size() ? 0 : i + 1].neighbor};
    const Vec3 edges[2] = {surface.points[ends[0]].position - origin,
                           surface.points[ends[1]].position - origin};
    const Vec3 normal = normalize_or_zero(glm::cross(edges[0], edges[1]));
    for (int k = 0; k < 2; ++k) {
      const EdgeUse use = edge_use(surface, point, ends[k]);
      if (!use.is_feature()) continue;
      const float weight = use.seam ? options.seam_weight : options.border_weight;
      quadric.add_plane(normalize_or_zero(glm::cross(edges[k], normal)),
                        0.5f * weight * glm::dot(edges[k], edges[k]));
    }
  }
}

}  // namespace

PointQuadric point_quadric(WorkingSurface& surface, std::uint32_t point,
                           const QuadricOptions& options) {
  PointQuadric result;
  const auto ring = surface.ring_span(point);
  if (ring.empty()) return result;
  const Vec3 origin = surface.points[point].position;
  Vec3 edge = surface.points[ring[0].neighbor].position - origin;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const std::uint32_t next = ring[i + 1 == ring.size() ? 0 : i + 1].neighbor;
    const Vec3 next_edge = surface.points[next].position - origin;
    if (ring[i].face != kNone) result.weight += result.quadric.add_face(glm::cross(edge, next_edge));
    edge = next_edge;
  }
  if (surface.points[point].kind != VertexKind::kManifold)
    add_constraints(surface, point, options, result.quadric);
  result.quadric.add_point(options.tangential_weight * result.weight);
  return result;
}

void add_faces_to_attributes(WorkingSurface& surface, AttributeField& attributes) {
  for (std::uint32_t point = 0; point < surface.point_count(); ++point) {
    const auto ring = surface.ring_span(point);
    const Vec3 origin = surface.points[point].position;
    for (std::size_t i = 0; i < ring.size(); ++i) {
      if (ring[i].face == kNone) continue;
      const std::uint32_t next = ring[i + 1 == ring.size() ? 0 : i + 1].neighbor;
      const Vec3 edge_1 = surface.points[ring[i].neighbor].position - origin;
      const Vec3 edge_2 = surface.points[next].position - origin;
      attributes.add_face({corner_wedge(surface, ring[i].face, point),
                           corner_wedge(surface, ring[i].face, ring[i].neighbor),
                           corner_wedge(surface, ring[i].face, next)},
                          edge_1, edge_2, glm::length(glm::cross(edge_1, edge_2)) / 6);
    }
  }
}

}  // namespace varifold
