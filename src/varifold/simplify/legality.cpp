#include <varifold/simplify/legality.h>

#include <varifold/simplify/classify.h>
#include <varifold/simplify/packed_normal.h>
#include <algorithm>
#include <cmath>

namespace varifold {

namespace {

// Edges of more sheets than this stay as they are.
constexpr std::uint32_t kMaxEdgeFaces = 64;

// Neighbours common to both rings, each once. A 64-bit filter settles most of them without a
// search.
std::uint32_t count_common(std::span<const RingEntry> a, std::span<const RingEntry> b) {
  std::uint64_t filter = 0;
  for (const RingEntry& entry : a) filter |= std::uint64_t{1} << (entry.neighbor & 63);
  std::uint32_t common = 0;
  for (std::size_t i = 0; i < b.size(); ++i) {
    const std::uint32_t candidate = b[i].neighbor;
    if (!(filter >> (candidate & 63) & 1)) continue;
    const auto is_candidate = [&](const RingEntry& e) { return e.neighbor == candidate; };
    if (std::none_of(a.begin(), a.end(), is_candidate)) continue;
    if (std::any_of(b.begin(), b.begin() + i, is_candidate)) continue;
    ++common;
  }
  return common;
}

// Whether two points that are both common neighbours are joined by a face of `from` and by one of
// `onto`: the two faces would fall together.
bool would_double_face(std::span<const RingEntry> ring, std::span<const RingEntry> onto_ring,
                       std::span<const std::uint32_t> apexes) {
  const auto joins = [](std::span<const RingEntry> entries, std::uint32_t a, std::uint32_t b) {
    for (std::size_t i = 0; i < entries.size(); ++i) {
      const std::uint32_t m = entries[i].neighbor;
      const std::uint32_t n = entries[i + 1 == entries.size() ? 0 : i + 1].neighbor;
      if (entries[i].face != kNone && ((m == a && n == b) || (m == b && n == a))) return true;
    }
    return false;
  };
  for (std::size_t i = 0; i < apexes.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      if (joins(ring, apexes[i], apexes[j]) && joins(onto_ring, apexes[i], apexes[j])) return true;
  return false;
}

// Two plain rings: the edge has the neighbours before and after `onto` as its apexes.
Refusal test_plain_topology(WorkingSurface& surface, std::uint32_t from, std::uint32_t onto,
                            const LegalityOptions& options) {
  const auto ring = surface.ring_span(from);
  const auto onto_ring = surface.ring_span(onto);
  const std::size_t size = ring.size();
  std::size_t at = 0;
  while (at < size && ring[at].neighbor != onto) ++at;
  if (at == size) return Refusal::kTopology;
  if (count_common(ring, onto_ring) != 2) return Refusal::kTopology;
  const std::uint32_t apexes[2] = {ring[at + 1 == size ? 0 : at + 1].neighbor,
                                   ring[at == 0 ? size - 1 : at - 1].neighbor};
  if (size == 3 && would_double_face(ring, onto_ring, apexes)) return Refusal::kTopology;
  const std::size_t valence = size + onto_ring.size() - 4;
  return valence <= std::max<std::size_t>(options.max_valence, onto_ring.size())
             ? Refusal::kLegal
             : Refusal::kValence;
}

// The link of the edge must be the intersection of the links of its ends: the third corners of its
// faces are the only common neighbours, and no edge is common.
Refusal test_topology(WorkingSurface& surface, std::uint32_t from, std::uint32_t onto,
                      const LegalityOptions& options) {
  if (surface.points[from].kind == VertexKind::kManifold &&
      !((surface.points[from].flags | surface.points[onto].flags) & PointState::kIrregular))
    return test_plain_topology(surface, from, onto, options);
  const auto ring = surface.ring_span(from);
  const auto onto_ring = surface.ring_span(onto);
  std::uint32_t edge_faces = 0;
  std::uint32_t apexes[kMaxEdgeFaces];
  for (std::size_t i = 0; i < ring.size(); ++i) {
    if (ring[i].face == kNone) continue;
    const std::uint32_t next = ring[i + 1 == ring.size() ? 0 : i + 1].neighbor;
    if (ring[i].neighbor != onto && next != onto) continue;
    if (edge_faces == kMaxEdgeFaces) return Refusal::kTopology;
    apexes[edge_faces++] = ring[i].neighbor == onto ? next : ring[i].neighbor;
  }
  if (edge_faces == 0 || count_common(ring, onto_ring) != edge_faces) return Refusal::kTopology;
  if (would_double_face(ring, onto_ring, {apexes, edge_faces})) return Refusal::kTopology;

  const auto valence = static_cast<std::uint32_t>(ring.size() + onto_ring.size()) - 2 - edge_faces;
  const auto before = static_cast<std::uint32_t>(onto_ring.size());
  return valence <= std::max(options.max_valence, before) ? Refusal::kLegal : Refusal::kValence;
}

// The far feature edges of `from`: sliding along one must not lay the other onto a feature.
Refusal test_features(WorkingSurface& surface, std::uint32_t from, std::uint32_t onto) {
  const VertexKind kind = surface.points[from].kind;
  if (kind == VertexKind::kManifold) return Refusal::kLegal;
  if (kCollapseAlong[static_cast<int>(kind)] == CollapseAlong::kNothing) return Refusal::kFixed;
  if (!edge_use(surface, from, onto).is_feature()) return Refusal::kFixed;
  const auto ring = surface.ring_span(from);
  for (std::size_t i = 0; i < ring.size(); ++i) {
    if (ring[i].neighbor == onto || !edge_use_at(surface, from, i).is_feature()) continue;
    const EdgeUse closing = edge_use(surface, onto, ring[i].neighbor);
    if (closing.faces() > 0 && closing.is_feature()) return Refusal::kTopology;
  }
  return Refusal::kLegal;
}

float longest_squared(const Vec3& a, const Vec3& b, const Vec3& c) {
  return std::max({glm::dot(a, a), glm::dot(b, b), glm::dot(c, c)});
}

// Whether a face disagrees with the input at all of its corners. Those where the input has no
// normal, since all faces there have no area, have nothing to say.
template <class Places>
bool opposes_input(const Places& places, const Vec3& normal, const Vec3& at_apex, std::uint32_t m,
                   std::uint32_t n) {
  if (glm::dot(normal, at_apex) > 0 || normal == Vec3(0)) return false;
  bool is_judged = at_apex != Vec3(0);
  for (const std::uint32_t corner : {m, n}) {
    const Vec3 input_normal = unpack_normal(places.normal(corner));
    if (glm::dot(normal, input_normal) > 0) return false;
    is_judged = is_judged || input_normal != Vec3(0);
  }
  return is_judged;
}

// Whether a face would be more than the greatest turn away from the normal it was given.
bool turns_from_reference(const WorkingSurface& surface, std::uint32_t face, const Vec3& normal,
                          const LegalityOptions& options) {
  if (surface.reference_normal.empty()) return false;
  const Vec3 reference = unpack_normal(surface.reference_normal[face]);
  const float cosine = glm::dot(normal, reference);
  const float square = glm::dot(normal, normal), reference_square = glm::dot(reference, reference);
  if (!(square > 0 && reference_square > 0)) return false;
  const float limit = options.min_normal_cosine * options.min_normal_cosine;
  return cosine <= 0 || (cosine / square) * (cosine / reference_square) < limit;
}

// The faces that stay must neither turn too far nor become needles.
template <class Places>
Refusal test_faces_at(WorkingSurface& surface, const ApexMove& move, const LegalityOptions& options,
                      const Places& places) {
  const auto ring = surface.ring_span(move.point);
  const Vec3 old_apex = places.position(move.point);
  const Vec3 new_apex = move.position;
  const std::uint32_t onto = move.partner;
  const Vec3 input_normal = unpack_normal(move.input_normal);
  const float limit = options.min_normal_cosine * options.min_normal_cosine;
  const float shape_limit = options.min_shape * options.min_shape;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const std::uint32_t m = ring[i].neighbor;
    const std::uint32_t n = ring[i + 1 == ring.size() ? 0 : i + 1].neighbor;
    if (ring[i].face == kNone || m == onto || n == onto) continue;
    if (surface.points[m].ring_size == 0) return Refusal::kTopology;
    const Vec3 pm = places.position(m);
    const Vec3 pn = places.position(n);
    const Vec3 edge = pn - pm;
    const Vec3 old_normal = glm::cross(pm - old_apex, edge);
    const Vec3 new_normal = glm::cross(pm - new_apex, edge);
    const float old_square = glm::dot(old_normal, old_normal);
    const float new_square = glm::dot(new_normal, new_normal);
    const float cosine = glm::dot(old_normal, new_normal);
    // Products of squared areas can underflow on tiny triangles, so compare ratios by division.
    if (old_square > 0 && (cosine <= 0 || (cosine / old_square) * (cosine / new_square) < limit))
      return Refusal::kNormal;
    // Steps that are each small may turn a face right over, so it must agree with the input's
    // normal at one of its corners at least.
    if (opposes_input(places, new_normal, input_normal, m, n)) return Refusal::kNormal;
    if (Places::kIsRest && turns_from_reference(surface, ring[i].face, new_normal, options))
      return Refusal::kNormal;
    if (new_square == 0 && old_square == 0) continue;  // it had no area and has none
    const float longest = longest_squared(pm - new_apex, pn - new_apex, edge);
    const float shape = new_square / (longest * longest);
    if (shape >= shape_limit) continue;
    const float old_longest = longest_squared(pm - old_apex, pn - old_apex, edge);
    if (!(shape >= old_square / (old_longest * old_longest))) return Refusal::kShape;
  }
  return Refusal::kLegal;
}

}  // namespace

Refusal test_faces(WorkingSurface& surface, const ApexMove& move, const LegalityOptions& options) {
  return test_faces_at(surface, move, options, RestPlaces(surface));
}

Refusal test_faces(WorkingSurface& surface, const ApexMove& move, const LegalityOptions& options,
                   const PosePlaces& pose) {
  return test_faces_at(surface, move, options, pose);
}

Refusal test_connectivity(WorkingSurface& surface, std::uint32_t from, std::uint32_t onto,
                          const LegalityOptions& options) {
  if (surface.points[onto].ring_size == 0) return Refusal::kTopology;
  if (const Refusal refusal = test_features(surface, from, onto); refusal != Refusal::kLegal)
    return refusal;
  return test_topology(surface, from, onto, options);
}

Refusal test_collapse(WorkingSurface& surface, std::uint32_t from, std::uint32_t onto,
                      const LegalityOptions& options) {
  if (const Refusal refusal = test_connectivity(surface, from, onto, options);
      refusal != Refusal::kLegal)
    return refusal;
  const PointState& target = surface.points[onto];
  return test_faces(surface, {from, onto, target.position, target.normal}, options);
}

}  // namespace varifold
