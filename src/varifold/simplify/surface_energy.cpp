#include <varifold/simplify/surface_energy.h>

#include <varifold/simplify/closest_on_triangle.h>
#include <varifold/simplify/placement_recorder.h>
#include <algorithm>
#include <cmath>
#include <limits>

namespace varifold {

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
// Steps of projecting and fitting; a step must gain this part of the energy for another to follow.
constexpr int kMaxFits = 4;
constexpr double kWorthwhile = 0.02;
// A place farther from the middle of the edge, in squared lengths of it, is a spike between
// samples.
constexpr double kReach = 1;

// Neighbours, each once: rings of several fans repeat some.
template <class Visit>
void for_each_neighbor(const WorkingSurface& surface, std::uint32_t point, const Visit& visit) {
  const RingEntry* ring = surface.ring(point);
  const std::uint32_t size = surface.points[point].ring_size;
  const bool may_repeat = surface.points[point].flags & PointState::kIrregular;
  for (std::uint32_t i = 0; i < size; ++i) {
    const std::uint32_t neighbor = ring[i].neighbor;
    const auto is_same = [&](const RingEntry& entry) { return entry.neighbor == neighbor; };
    if (may_repeat && std::any_of(ring, ring + i, is_same)) continue;
    visit(neighbor);
  }
}

bool is_neighbor(const WorkingSurface& surface, std::uint32_t point, std::uint32_t other) {
  const RingEntry* ring = surface.ring(point);
  return std::any_of(ring, ring + surface.points[point].ring_size,
                     [&](const RingEntry& entry) { return entry.neighbor == other; });
}

double squared_length(const Vec3& a, const Vec3& b) {
  const DVec3 d = DVec3(a) - DVec3(b);
  return glm::dot(d, d);
}

}  // namespace

SurfaceEnergy::SurfaceEnergy(const EnergyInput& input, const EnergyOptions& options)
    : surface_(input.surface),
      field_(input.attributes && !input.attributes->empty() ? input.attributes : nullptr),
      options_(options),
      samples_(
          make_samples(input.surface, input.mesh, field_ ? *field_ : AttributeField(), options)),
      curves_(input.surface) {}

double SurfaceEnergy::spring_constant(std::size_t samples, std::size_t faces) const {
  const double constant = samples < 4 * faces ? 1e-2 : samples < 8 * faces ? 1e-4 : 1e-8;
  return constant * options_.spring;
}

void SurfaceEnergy::add_samples_of(EnergyScratch& scratch, std::uint32_t face) const {
  for (const EnergySample& sample : samples_.blocks.of(face)) {
    scratch.distances.add(sample.position);
    scratch.before += sample.energy;
    if (field_) scratch.attributes.push_back(sample.attributes);
  }
}

void SurfaceEnergy::look_at(EnergyScratch& scratch, std::uint32_t from) const {
  scratch.star = from;
  scratch.before = 0;
  scratch.faces.clear();
  scratch.attributes.clear();
  scratch.distances.clear();
  changed_faces(surface_, {from, kNone, false}, scratch.faces);
  for (const std::uint32_t face : scratch.faces) add_samples_of(scratch, face);
  scratch.star_faces = scratch.faces.size();
  scratch.star_samples = scratch.distances.size();
  scratch.star_before = scratch.before;
}

// The samples of the collapse: those of the star of `from` are there already.
void SurfaceEnergy::look_at(EnergyScratch& scratch, const FanEdge& edge) const {
  make_fan(surface_, edge, scratch.fan);
  scratch.faces.resize(scratch.star_faces);
  scratch.distances.cut(scratch.star_samples);
  if (field_) scratch.attributes.resize(scratch.star_samples);
  scratch.before = scratch.star_before;
  if (!edge.moves) return;
  scratch.faces.clear();
  changed_faces(surface_, edge, scratch.faces);
  for (std::size_t i = scratch.star_faces; i < scratch.faces.size(); ++i)
    add_samples_of(scratch, scratch.faces[i]);
}

double SurfaceEnergy::spring_change(const EnergyScratch& scratch, const FanEdge& edge,
                                    const Vec3& place) const {
  const auto position = [&](std::uint32_t p) { return surface_.points[p].position; };
  double change = 0;
  for_each_neighbor(surface_, edge.from, [&](std::uint32_t x) {
    change -= squared_length(position(x), position(edge.from));
    if (x != edge.onto && !is_neighbor(surface_, edge.onto, x))
      change += squared_length(position(x), place);
  });
  if (edge.moves)
    for_each_neighbor(surface_, edge.onto, [&](std::uint32_t x) {
      if (x == edge.from) return;
      change +=
          squared_length(position(x), place) - squared_length(position(x), position(edge.onto));
    });
  return spring_constant(scratch.distances.size(), scratch.faces.size()) * change;
}

// The attribute values at the corners of all faces of the fan, as they would be.
void SurfaceEnergy::gather_values(EnergyScratch& scratch, const FanEdge& edge,
                                  const Vec3& place) const {
  const WedgeTables& wedge = surface_.wedge;
  const auto& moved_from = scratch.merge.moved_from;
  const auto& moved_onto = scratch.merge.moved_onto;
  const Vec3 start = surface_.points[edge.from].position;
  const Vec3 end = surface_.points[edge.onto].position;
  const float t = edge.moves ? edge_parameter(start, end, place) : 1.0f;
  const auto wedge_at = [&](std::uint32_t face, std::uint32_t point) {
    return wedge.has_seams() ? wedge.at_corner(face, point) : point;
  };
  const auto apex_values = [&](const FanFace& face) {
    std::uint32_t onto = wedge_at(face.face, face.was_from ? edge.from : edge.onto);
    if (face.was_from)
      onto = moved_onto[std::find(moved_from.begin(), moved_from.end(), onto) - moved_from.begin()];
    const auto pair = std::find(moved_onto.begin(), moved_onto.end(), onto);
    if (!edge.moves || pair == moved_onto.end()) return field_->values(onto);
    return field_->blended({moved_from[pair - moved_onto.begin()], onto, t, {}, {}});
  };
  scratch.values.clear();
  for (const FanFace& face : scratch.fan)
    scratch.values.push_back({apex_values(face), field_->values(wedge_at(face.face, face.m)),
                              field_->values(wedge_at(face.face, face.n))});
}

// Of a sample whose nearest face is known.
float SurfaceEnergy::attribute_error(const EnergyScratch& scratch, const Vec3& place,
                                     std::size_t sample) const {
  const std::uint32_t row = scratch.attributes[sample];
  if (row == kNone) return 0;
  const std::uint32_t at = scratch.distances.nearest(sample);
  const FanFace& face = scratch.fan[at];
  const Vec3 p = scratch.distances[sample];
  const TrianglePoint foot = closest_on_triangle(place - p, surface_.points[face.m].position - p,
                                                 surface_.points[face.n].position - p);
  const auto& [a, m, n] = scratch.values[at];
  const float* wanted = &samples_.values[std::size_t{row} * samples_.channel_count];
  float sum = 0;
  for (std::size_t c = 0; c < samples_.channel_count; ++c) {
    const float is = a[c] + foot.along_b * (m[c] - a[c]) + foot.along_c * (n[c] - a[c]);
    sum += (is - wanted[c]) * (is - wanted[c]);
  }
  return sum;
}

// Finds the nearest faces and sums everything up.
double SurfaceEnergy::nearest_energy(EnergyScratch& scratch, const FanEdge& edge,
                                     const Vec3& place) const {
  if (field_) gather_values(scratch, edge, place);
  scratch.distances.find_nearest(surface_, scratch.fan, place);
  double sum = 0;
  for (std::size_t i = 0; i < scratch.distances.size(); ++i) {
    sum += scratch.distances.squared(i);
    if (field_) sum += attribute_error(scratch, place, i);
  }
  return sum;
}

EnergyChange SurfaceEnergy::spring_and_curve_change(EnergyScratch& scratch, const FanEdge& edge,
                                                    const Vec3& place) const {
  EnergyChange change;
  change.spring = spring_change(scratch, edge, place);
  if (curves_.contains(edge.from)) {
    const auto stretch = curves_.stretch(edge.from, edge.onto, edge.moves);
    change.curve = curves_.energy_at(surface_, stretch, place) - curves_.energy(stretch);
  }
  return change;
}

EnergyChange SurfaceEnergy::change_at(EnergyScratch& scratch, const FanEdge& edge,
                                      const Vec3& place, double limit) const {
  if (field_) return change_with_nearest(scratch, edge, place);
  // Nothing would be left that samples could go to.
  if (scratch.fan.empty()) return {kInfinity, 0, 0};
  EnergyChange change = spring_and_curve_change(scratch, edge, place);
  const double left = limit - change.spring - change.curve + scratch.before;
  change.surface = scratch.distances.sum(surface_, scratch.fan, place, left) - scratch.before;
  return change;
}

// Afterwards the nearest faces are known.
EnergyChange SurfaceEnergy::change_with_nearest(EnergyScratch& scratch, const FanEdge& edge,
                                                const Vec3& place) const {
  if (scratch.fan.empty()) return {kInfinity, 0, 0};
  EnergyChange change = spring_and_curve_change(scratch, edge, place);
  change.surface = nearest_energy(scratch, edge, place) - scratch.before;
  return change;
}

SurfaceEnergy::Collapse SurfaceEnergy::kept(EnergyScratch& scratch, std::uint32_t onto,
                                            double limit) const {
  const FanEdge edge{scratch.star, onto, false};
  look_at(scratch, edge);
  const Vec3 place = surface_.points[onto].position;
  return {edge.from, onto, false, place, change_at(scratch, edge, place, limit)};
}

SurfaceEnergy::Collapse SurfaceEnergy::middle(EnergyScratch& scratch, std::uint32_t onto,
                                              double limit) const {
  const FanEdge edge{scratch.star, onto, true};
  look_at(scratch, edge);
  const Vec3 place = 0.5f * (surface_.points[edge.from].position + surface_.points[onto].position);
  return {edge.from, onto, true, place, change_at(scratch, edge, place, limit)};
}

SurfaceEnergy::Collapse SurfaceEnergy::started(EnergyScratch& scratch, std::uint32_t onto) const {
  const FanEdge edge{scratch.star, onto, true};
  Collapse best = middle(scratch, onto, kInfinity);
  for (const std::uint32_t end : {edge.from, onto}) {
    const Vec3 place = surface_.points[end].position;
    const EnergyChange change = change_at(scratch, edge, place, best.change.total());
    if (change.total() < best.change.total()) best.place = place, best.change = change;
  }
  return best;
}

SurfaceEnergy::Collapse SurfaceEnergy::fitted(EnergyScratch& scratch, const Collapse& start) const {
  const FanEdge edge{start.from, start.onto, true};
  look_at(scratch, edge);
  if (scratch.fan.empty()) return start;
  const Vec3 from = surface_.points[edge.from].position, onto = surface_.points[edge.onto].position;
  const Vec3 middle = 0.5f * (from + onto);
  const double length = squared_length(from, onto);
  Collapse best = start;
  best.change = change_with_nearest(scratch, edge, start.place);
  for (int i = 0; i < kMaxFits; ++i) {
    const Vec3 place = fit(scratch, edge, best.place);
    if (!(squared_length(place, middle) < kReach * length)) break;
    const EnergyChange change = change_with_nearest(scratch, edge, place);
    const double gain = best.change.total() - change.total();
    if (!(gain > 0)) break;
    best.place = place, best.change = change;
    if (gain < kWorthwhile * (scratch.before + std::abs(best.change.total()))) break;
  }
  return best;
}

// With every sample at a fixed point of its nearest face, which must be known for `place`, where is
// the sum of squares least? A sample then wants its part of the vertex at what the others leave.
Vec3 SurfaceEnergy::fit(EnergyScratch& scratch, const FanEdge& edge, const Vec3& place) const {
  const FanDistances& distances = scratch.distances;
  // About `place`, so that little is lost to rounding.
  double weight = 0;
  DVec3 sum(0);
  for (std::size_t i = 0; i < distances.size(); ++i) {
    const FanFace& face = scratch.fan[distances.nearest(i)];
    const Vec3 p = distances[i];
    const TrianglePoint foot = closest_on_triangle(place - p, surface_.points[face.m].position - p,
                                                   surface_.points[face.n].position - p);
    // With `own` of the vertex in its foot, the sample wants it to move by -foot / own.
    const double own = 1.0 - foot.along_b - foot.along_c;
    weight += own * own;
    sum -= own * DVec3(foot.position);
  }
  const double spring = spring_constant(distances.size(), scratch.faces.size());
  const auto pull = [&](std::uint32_t x) {
    if (x == edge.from || x == edge.onto) return;
    weight += spring;
    sum += spring * (DVec3(surface_.points[x].position) - DVec3(place));
  };
  for_each_neighbor(surface_, edge.onto, pull);
  for_each_neighbor(surface_, edge.from, [&](std::uint32_t x) {
    if (!is_neighbor(surface_, edge.onto, x)) pull(x);
  });
  if (curves_.contains(edge.from)) {
    const auto stretch = curves_.stretch(edge.from, edge.onto, true);
    curves_.add_to_fit(surface_, stretch, place, weight, sum);
  }
  return weight > 0 ? place + Vec3(sum / weight) : place;
}

float SurfaceEnergy::collapse(EnergyScratch& scratch, const Collapse& collapse) {
  const FanEdge edge{collapse.from, collapse.onto, collapse.moves};
  look_at(scratch, collapse.from);
  look_at(scratch, edge);
  FanDistances& distances = scratch.distances;
  if (field_) gather_values(scratch, edge, collapse.place);
  distances.find_nearest(surface_, scratch.fan, collapse.place);
  const auto stretch = curves_.contains(edge.from)
                           ? curves_.stretch(edge.from, edge.onto, edge.moves)
                           : CurveSamples::Stretch{};
  curves_.collapse(surface_, edge.from, edge.onto, stretch, collapse.place);
  for (const std::uint32_t face : scratch.faces) samples_.blocks.clear(face);
  float greatest = 0;
  for (std::size_t i = 0; i < distances.size(); ++i) {
    const float squared = distances.squared(i);
    const float error = field_ ? attribute_error(scratch, collapse.place, i) : 0.0f;
    samples_.blocks.add(scratch.fan[distances.nearest(i)].face,
                        {distances[i], squared + error, field_ ? scratch.attributes[i] : kNone});
    greatest = std::max(greatest, squared);
  }
  samples_.blocks.tidy();
  if (field_ && edge.moves) {
    const auto& from = scratch.merge.moved_from;
    const auto& onto = scratch.merge.moved_onto;
    const float t = edge_parameter(surface_.points[edge.from].position,
                                   surface_.points[edge.onto].position, collapse.place);
    for (std::size_t i = 0; i < onto.size(); ++i)
      if (std::find(onto.begin(), onto.end(), onto[i]) == onto.begin() + std::ptrdiff_t(i))
        field_->merge({from[i], onto[i], t, {}, {}});
  }
  return std::sqrt(greatest);
}

}  // namespace varifold
