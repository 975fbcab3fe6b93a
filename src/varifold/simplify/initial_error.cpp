// Based on: [GarlandHeckbert1997] sections 5 and 6.2 (boundary constraints), [Hoppe1999].
#include <varifold/base/parallel.h>
#include <varifold/simplify/initial_error.h>

#include <varifold/simplify/classify.h>

namespace varifold {

namespace {

struct PointError {
  WorkingSurface& surface;
  AttributeField* attributes;
  const ErrorOptions& options;

  void add_attributes(std::uint32_t point, const RingEntry& entry, std::uint32_t next,
                      float weight) const {
    PointState& state = surface.points[point];
    const Vec3 edge_1 = surface.points[entry.neighbor].position - state.position;
    const Vec3 edge_2 = surface.points[next].position - state.position;
    state.quadric += attributes->add_face(
        {corner_wedge(surface, entry.face, point), corner_wedge(surface, entry.face, entry.neighbor),
         corner_wedge(surface, entry.face, next)},
        edge_1, edge_2, weight);
  }

  // A plane through the edge to `neighbor`, at right angles to the face with normal `n`.
  void add_constraint(std::uint32_t point, std::uint32_t neighbor, const Vec3& n,
                      float weight) const {
    PointState& state = surface.points[point];
    const Vec3 edge = surface.points[neighbor].position - state.position;
    const Vec3 across = normalize_or_zero(glm::cross(edge, n));
    state.quadric.add_plane(across, weight * glm::dot(edge, edge) * 0.5f);
  }

  void set(std::uint32_t point) const {
    PointState& state = surface.points[point];
    const auto ring = surface.ring_span(point);
    const bool has_features = state.kind != VertexKind::kManifold;
    state.quadric = Quadric();
    state.weight = 0;
    for (std::size_t i = 0; i < ring.size(); ++i) {
      if (ring[i].face == kNone) continue;
      const std::uint32_t next = ring[i + 1 == ring.size() ? 0 : i + 1].neighbor;
      const Vec3 edge_1 = surface.points[ring[i].neighbor].position - state.position;
      const Vec3 edge_2 = surface.points[next].position - state.position;
      const Vec3 cross = glm::cross(edge_1, edge_2);
      const float twice_area = glm::length(cross);
      const Vec3 normal = twice_area > 0 ? cross / twice_area : Vec3(0);
      const float weight = twice_area / 6;
      state.quadric.add_plane(normal, weight);
      state.weight += weight;
      if (attributes && !attributes->empty()) add_attributes(point, ring[i], next, weight);
      if (!has_features) continue;
      for (const std::uint32_t end : {ring[i].neighbor, next}) {
        const EdgeUse use = edge_use(surface, point, end);
        if (use.is_feature())
          add_constraint(point, end, normal, use.seam ? options.seam_weight : options.border_weight);
      }
    }
    state.quadric.add_point(options.tangential_weight * state.weight);
  }
};

}  // namespace

void set_initial_error(WorkingSurface& surface, AttributeField* attributes,
                       const ErrorOptions& options) {
  const PointError error{surface, attributes, options};
  parallel_for(options.threads, surface.point_count(), 4096,
               [&](std::size_t begin, std::size_t end) {
                 for (std::size_t p = begin; p < end; ++p)
                   error.set(static_cast<std::uint32_t>(p));
               });
}

}  // namespace varifold
