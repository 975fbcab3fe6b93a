#include <varifold/models/patch_tree/component_removal.h>

#include <varifold/base/disjoint_sets.h>
#include <algorithm>
#include <limits>
#include <span>
#include <tuple>

namespace varifold {

namespace {

struct Component {
  std::uint32_t region = kNone;
  bool is_inside = true;  // of one region
  bool is_gone = false;
  std::uint32_t corners = 0;  // three per face
  float extent = 0;
  Box box;
  std::vector<std::uint32_t> points;
};

std::vector<Component> find_components(const WorkingSurface& surface) {
  DisjointSets sets(surface.point_count());
  const auto is_live = [&](std::uint32_t p) {
    return !(surface.points[p].flags & PointState::kDead) && surface.points[p].ring_size > 0;
  };
  const auto ring_of = [&](std::uint32_t p) {
    return std::span(surface.ring(p), surface.points[p].ring_size);
  };
  for (std::uint32_t p = 0; p < surface.point_count(); ++p)
    if (is_live(p))
      for (const RingEntry& entry : ring_of(p)) sets.unite(p, entry.neighbor);
  std::vector<std::uint32_t> number(surface.point_count(), kNone);
  std::vector<Component> components;
  for (std::uint32_t p = 0; p < surface.point_count(); ++p) {
    if (!is_live(p)) continue;
    std::uint32_t& n = number[sets.find(p)];
    if (n == kNone) {
      n = static_cast<std::uint32_t>(components.size());
      components.emplace_back();
    }
    Component& component = components[n];
    component.points.push_back(p);
    component.box.add(surface.points[p].position);
    for (const RingEntry& entry : ring_of(p)) {
      if (entry.face == kNone) continue;
      ++component.corners;
      const std::uint32_t region = surface.region_of[entry.face];
      component.is_inside &= component.region == kNone || component.region == region;
      component.region = region;
    }
  }
  for (Component& component : components) component.extent = component.box.diagonal();
  return components;
}

std::uint32_t nearest_point(const WorkingSurface& surface, const std::vector<Component>& components,
                            std::uint32_t region, const Vec3& place) {
  std::uint32_t nearest = kNone;
  float least = std::numeric_limits<float>::infinity();
  for (const Component& component : components) {
    if (component.is_gone || (component.is_inside && component.region != region)) continue;
    for (const std::uint32_t p : component.points) {
      if (!component.is_inside) {
        const auto ring = std::span(surface.ring(p), surface.points[p].ring_size);
        if (std::none_of(ring.begin(), ring.end(), [&](const RingEntry& entry) {
              return entry.face != kNone && surface.region_of[entry.face] == region;
            }))
          continue;
      }
      const Vec3 way = surface.points[p].position - place;
      if (!(glm::dot(way, way) < least)) continue;
      least = glm::dot(way, way);
      nearest = p;
    }
  }
  return nearest;
}

}  // namespace

std::vector<std::pair<std::uint32_t, std::uint32_t>> remove_components(WorkingSurface& surface,
                                                                       std::uint32_t target_faces) {
  std::vector<Component> components = find_components(surface);
  std::sort(components.begin(), components.end(), [](const Component& a, const Component& b) {
    return std::tie(a.extent, a.points.front()) < std::tie(b.extent, b.points.front());
  });
  // Regions that a component reaches into keep that; others keep their greatest.
  std::uint32_t regions = 0;
  for (const std::uint32_t region : surface.region_of)
    if (region != kNone) regions = std::max(regions, region + 1);
  std::vector<std::uint32_t> left(regions, 0);
  for (const Component& component : components) {
    if (component.is_inside) {
      ++left[component.region];
      continue;
    }
    for (const std::uint32_t p : component.points)
      for (const RingEntry& entry : surface.ring_span(p))
        if (entry.face != kNone) left[surface.region_of[entry.face]] = kNone;
  }
  std::vector<const Component*> gone;
  for (Component& component : components) {
    if (surface.face_count <= target_faces) break;
    if (!component.is_inside || left[component.region] < 2) continue;
    if (left[component.region] != kNone) --left[component.region];
    component.is_gone = true;
    surface.face_count -= component.corners / 3;
    gone.push_back(&component);
  }
  std::vector<std::pair<std::uint32_t, std::uint32_t>> moved;
  for (const Component* component : gone) {
    const std::uint32_t onto =
        nearest_point(surface, components, component->region, component->box.center());
    for (const std::uint32_t p : component->points) moved.emplace_back(p, onto);
  }
  for (const auto& [p, onto] : moved) {
    surface.release_ring(p);
    surface.points[p].flags |= PointState::kDead;
  }
  return moved;
}

}  // namespace varifold
