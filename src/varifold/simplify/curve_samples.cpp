#include <varifold/simplify/curve_samples.h>

#include <varifold/simplify/classify.h>
#include <algorithm>
#include <limits>

namespace varifold {

namespace {

bool is_curve_kind(VertexKind kind) {
  return kCollapseAlong[static_cast<int>(kind)] == CollapseAlong::kFeatureEdge;
}

}  // namespace

CurveSamples::CurveSamples(WorkingSurface& surface) {
  find_slots(surface);
  number_edges(surface);
}

void CurveSamples::find_slots(WorkingSurface& surface) {
  const std::uint32_t count = surface.point_count();
  const bool any = std::any_of(surface.points.begin(), surface.points.end(),
                               [](const PointState& p) { return is_curve_kind(p.kind); });
  if (!any) return;
  slot_of_.assign(count, kNone);
  for (std::uint32_t p = 0; p < count; ++p) {
    if (!is_curve_kind(surface.points[p].kind)) continue;
    Slot slot;
    std::size_t found = 0;
    for (const RingEntry& entry : surface.ring_span(p)) {
      const std::uint32_t q = entry.neighbor;
      if (found == 2 || slot.neighbor[0] == q) continue;
      if (edge_use(surface, p, q).is_feature()) slot.neighbor[found++] = q;
    }
    slot_of_[p] = static_cast<std::uint32_t>(slots_.size());
    slots_.push_back(slot);
  }
}

void CurveSamples::number_edges(const WorkingSurface& surface) {
  const auto position = [&](std::uint32_t p) { return surface.points[p].position; };
  for (std::uint32_t p = 0; !slots_.empty() && p < surface.point_count(); ++p) {
    if (!contains(p)) continue;
    Slot& own = slots_[slot_of_[p]];
    for (std::size_t k = 0; k < 2; ++k) {
      const std::uint32_t q = own.neighbor[k];
      if (q == kNone) continue;
      if (q < p && contains(q)) {  // numbered by the other end
        const Slot& other = slots_[slot_of_[q]];
        own.edge[k] = other.edge[other.neighbor[0] == p ? 0 : 1];
        continue;
      }
      own.edge[k] = samples_.add_owner();
      samples_.add(own.edge[k], {0.5f * (position(p) + position(q)), 0, kNone});
    }
    if (own.edge[0] != kNone) samples_.add(own.edge[0], {position(p), 0, kNone});
  }
}

CurveSamples::Stretch CurveSamples::stretch(std::uint32_t from, std::uint32_t onto,
                                            bool moves) const {
  Stretch result;
  const Slot* own = slot(from);
  if (!own) return result;
  const std::size_t along = own->neighbor[0] == onto ? 0 : 1;
  if (own->neighbor[along] != onto) return result;
  result.far = own->neighbor[1 - along];
  result.edges[0] = own->edge[1 - along];
  result.edges[1] = own->edge[along];
  const Slot* other = moves ? slot(onto) : nullptr;
  if (!other) return result;
  const std::size_t beyond = other->neighbor[0] == from ? 1 : 0;
  result.next = other->neighbor[beyond];
  result.edges[2] = other->edge[beyond];
  return result;
}

double CurveSamples::energy(const Stretch& stretch) const {
  double sum = 0;
  for (const std::uint32_t edge : stretch.edges)
    if (edge != kNone)
      for (const EnergySample& sample : samples_.of(edge)) sum += sample.energy;
  return sum;
}

CurveSamples::Foot CurveSamples::foot(const WorkingSurface& surface, const Stretch& stretch,
                                      const Vec3& place, const Vec3& sample) {
  Foot best{std::numeric_limits<float>::max(), 1, Vec3(0), true};
  for (const std::uint32_t end : {stretch.far, stretch.next}) {
    if (end == kNone) continue;
    const Vec3 other = surface.points[end].position;
    const Vec3 edge = other - place;
    const float length = glm::dot(edge, edge);
    const float t =
        length > 0 ? std::clamp(glm::dot(sample - place, edge) / length, 0.0f, 1.0f) : 0.0f;
    const Vec3 off = sample - place - t * edge;
    const float squared = glm::dot(off, off);
    if (squared < best.squared) best = {squared, 1 - t, off, end == stretch.far};
  }
  return best;
}

double CurveSamples::energy_at(const WorkingSurface& surface, const Stretch& stretch,
                               const Vec3& place) const {
  double sum = 0;
  for (const std::uint32_t edge : stretch.edges)
    if (edge != kNone)
      for (const EnergySample& sample : samples_.of(edge))
        sum += foot(surface, stretch, place, sample.position).squared;
  return sum;
}

void CurveSamples::add_to_fit(const WorkingSurface& surface, const Stretch& stretch,
                              const Vec3& place, double& weight, DVec3& sum) const {
  for (const std::uint32_t edge : stretch.edges) {
    if (edge == kNone) continue;
    for (const EnergySample& sample : samples_.of(edge)) {
      const Foot at = foot(surface, stretch, place, sample.position);
      weight += double{at.at_place} * at.at_place;
      sum += double{at.at_place} * DVec3(at.off);
    }
  }
}

void CurveSamples::replace_neighbor(std::uint32_t point, std::uint32_t old, std::uint32_t neighbor,
                                    std::uint32_t edge) {
  if (!contains(point)) return;
  Slot& own = slots_[slot_of_[point]];
  const std::size_t k = own.neighbor[0] == old ? 0 : 1;
  if (own.neighbor[k] != old) return;
  own.neighbor[k] = neighbor;
  own.edge[k] = edge;
}

void CurveSamples::collapse(const WorkingSurface& surface, std::uint32_t from, std::uint32_t onto,
                            const Stretch& stretch, const Vec3& place) {
  if (stretch.far == kNone) return;
  std::vector<EnergySample> moved;
  for (const std::uint32_t edge : stretch.edges) {
    if (edge == kNone) continue;
    const auto samples = samples_.of(edge);
    moved.insert(moved.end(), samples.begin(), samples.end());
    samples_.clear(edge);
  }
  for (EnergySample& sample : moved) {
    const Foot at = foot(surface, stretch, place, sample.position);
    sample.energy = at.squared;
    samples_.add(stretch.edges[at.is_far ? 0 : 2], sample);
  }
  replace_neighbor(onto, from, stretch.far, stretch.edges[0]);
  replace_neighbor(stretch.far, from, onto, stretch.edges[0]);
  slot_of_[from] = kNone;
}

std::span<const EnergySample> CurveSamples::on_edge(std::uint32_t a, std::uint32_t b) const {
  for (const auto& [point, other] : {std::pair{a, b}, std::pair{b, a}})
    if (const Slot* own = slot(point))
      for (std::size_t k = 0; k < 2; ++k)
        if (own->neighbor[k] == other) return samples_.of(own->edge[k]);
  return {};
}

std::size_t CurveSamples::bytes() const {
  return slot_of_.capacity() * sizeof(std::uint32_t) + slots_.capacity() * sizeof(Slot) +
         samples_.bytes();
}

}  // namespace varifold
