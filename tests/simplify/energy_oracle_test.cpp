// The change of energy that is computed against the difference of two energies, each summed by
// brute force over a plain list of faces, in double.
#include <varifold/simplify/surface_energy.h>

#include <gtest/gtest.h>
#include <tests/support/meshes.h>
#include <varifold/base/random.h>
#include <varifold/mesh/generators.h>
#include <varifold/simplify/edge_placement.h>
#include <varifold/simplify/legality.h>
#include <algorithm>
#include <array>
#include <limits>
#include <map>
#include <set>

namespace varifold {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

using Corners = std::array<std::uint32_t, 3>;

double squared_to_segment(const DVec3& p, const DVec3& a, const DVec3& b) {
  const DVec3 e = b - a;
  const double length = glm::dot(e, e);
  const double t = length > 0 ? std::clamp(glm::dot(p - a, e) / length, 0.0, 1.0) : 0.0;
  const DVec3 off = p - a - t * e;
  return glm::dot(off, off);
}

// The plane where the foot is on the inner side of all three edges, else the nearest edge.
double squared_to_triangle(const DVec3& p, const DVec3& a, const DVec3& b, const DVec3& c) {
  const DVec3 n = glm::cross(b - a, c - a);
  const bool inside = glm::dot(glm::cross(b - a, p - a), n) >= 0 &&
                      glm::dot(glm::cross(c - b, p - b), n) >= 0 &&
                      glm::dot(glm::cross(a - c, p - c), n) >= 0;
  if (inside && glm::dot(n, n) > 0) {
    const double h = glm::dot(p - a, n);
    return h * h / glm::dot(n, n);
  }
  return std::min(
      {squared_to_segment(p, a, b), squared_to_segment(p, b, c), squared_to_segment(p, c, a)});
}

struct Oracle {
  WorkingSurface& surface;
  const SurfaceEnergy& energy;
  std::map<std::uint32_t, Corners> faces;

  Oracle(WorkingSurface& s, const SurfaceEnergy& e) : surface(s), energy(e) {
    for (std::uint32_t p = 0; p < surface.point_count(); ++p) {
      const auto ring = surface.ring_span(p);
      for (std::size_t i = 0; i < ring.size(); ++i)
        if (ring[i].face != kNone)
          faces[ring[i].face] = {p, ring[i].neighbor, ring[(i + 1) % ring.size()].neighbor};
    }
  }

  // Where a point is; the vertex that stays may be elsewhere.
  struct Places {
    const WorkingSurface& surface;
    std::uint32_t moved = kNone;
    DVec3 place{0};
    DVec3 operator()(std::uint32_t p) const {
      return p == moved ? place : DVec3(surface.points[p].position);
    }
  };

  static bool has(const Corners& corners, std::uint32_t p) {
    return std::find(corners.begin(), corners.end(), p) != corners.end();
  }

  static double distance(const EnergySample& sample, const Corners& c, const Places& at) {
    return squared_to_triangle(sample.position, at(c[0]), at(c[1]), at(c[2]));
  }

  static std::set<std::pair<std::uint32_t, std::uint32_t>> edges_of(
      const std::map<std::uint32_t, Corners>& faces) {
    std::set<std::pair<std::uint32_t, std::uint32_t>> edges;
    for (const auto& [face, c] : faces)
      for (std::size_t k = 0; k < 3; ++k) edges.insert(std::minmax(c[k], c[(k + 1) % 3]));
    return edges;
  }

  static double spring(const std::map<std::uint32_t, Corners>& faces, const Places& at) {
    double sum = 0;
    for (const auto& [a, b] : edges_of(faces)) sum += glm::dot(at(a) - at(b), at(a) - at(b));
    return sum;
  }

  // Edges of one face.
  static std::set<std::pair<std::uint32_t, std::uint32_t>> border(
      const std::map<std::uint32_t, Corners>& faces) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, int> uses;
    for (const auto& [face, c] : faces)
      for (std::size_t k = 0; k < 3; ++k) ++uses[std::minmax(c[k], c[(k + 1) % 3])];
    std::set<std::pair<std::uint32_t, std::uint32_t>> edges;
    for (const auto& [edge, count] : uses)
      if (count == 1) edges.insert(edge);
    return edges;
  }

  [[nodiscard]] EnergyChange change(const EnergyCollapse& collapse) const {
    const auto [from, onto, moves, place, ignored] = collapse;
    std::map<std::uint32_t, Corners> after;
    std::set<std::uint32_t> apexes;
    for (const auto& [face, c] : faces) {
      if (has(c, from) && has(c, onto)) {
        for (const std::uint32_t p : c) apexes.insert(p);
        continue;
      }
      Corners renamed = c;
      std::replace(renamed.begin(), renamed.end(), from, onto);
      after[face] = renamed;
    }
    apexes.erase(from);
    apexes.erase(onto);

    const Places before_at{surface}, after_at{surface, onto, DVec3(place)};
    EnergyChange result;
    std::size_t samples = 0, changed = 0;
    for (const auto& [face, c] : faces) {
      if (!has(c, from) && !(moves && has(c, onto))) continue;
      ++changed;
      for (const EnergySample& sample : energy.samples().blocks.of(face)) {
        ++samples;
        double least = kInfinity;
        for (const auto& [other, d] : after) {
          if (!has(d, onto)) continue;
          const bool beside =
              std::any_of(d.begin(), d.end(), [&](std::uint32_t p) { return apexes.contains(p); });
          if (moves || has(faces.at(other), from) || beside)
            least = std::min(least, distance(sample, d, after_at));
        }
        result.surface += least - distance(sample, c, before_at);
      }
    }
    result.spring = energy.spring_constant(samples, changed) *
                    (spring(after, after_at) - spring(faces, before_at));
    result.curve = curve_change(collapse, after, after_at);
    return result;
  }

  [[nodiscard]] double curve_change(const EnergyCollapse& collapse,
                                    const std::map<std::uint32_t, Corners>& after,
                                    const Places& after_at) const {
    const auto [from, onto, moves, place, ignored] = collapse;
    const auto touches = [&, f = from, o = onto, m = moves](const auto& edge) {
      return edge.first == f || edge.second == f || (m && (edge.first == o || edge.second == o));
    };
    const auto old_border = border(faces);
    if (!old_border.contains(std::minmax(from, onto))) return 0;
    const auto new_border = border(after);
    double sum = 0;
    for (const auto& edge : old_border) {
      if (!touches(edge)) continue;
      for (const EnergySample& sample : energy.curves().on_edge(edge.first, edge.second)) {
        double least = kInfinity;
        for (const auto& [a, b] : new_border) {
          const bool is_new = (a == onto || b == onto) && (moves || !old_border.contains({a, b}));
          if (is_new)
            least = std::min(least, squared_to_segment(sample.position, after_at(a), after_at(b)));
        }
        const Places at{surface};
        sum += least - squared_to_segment(sample.position, at(edge.first), at(edge.second));
      }
    }
    return sum;
  }

  void expect_attached() const {
    const Places at{surface};
    for (const auto& [face, c] : faces)
      for (const EnergySample& sample : energy.samples().blocks.of(face)) {
        const double is = distance(sample, c, at);
        ASSERT_NEAR(sample.energy, is, 1e-3 * is + 1e-11);
      }
  }

  [[nodiscard]] std::size_t sample_count() const {
    std::size_t count = 0;
    for (const auto& [face, c] : faces) count += energy.samples().blocks.of(face).size();
    return count;
  }
};

// A change is a difference of sums of about `energy`, whose terms are floats.
void expect_near(const EnergyChange& is, const EnergyChange& expected, double energy) {
  const auto near = [&](const char* term, double a, double b) {
    ASSERT_NEAR(a, b, 2e-3 * std::max(std::abs(a), std::abs(b)) + 1e-10 + 1e-6 * energy) << term;
  };
  near("surface", is.surface, expected.surface);
  near("spring", is.spring, expected.spring);
  near("curve", is.curve, expected.curve);
}

class EnergyOracle : public testing::TestWithParam<std::tuple<const char*, float>> {};

// A walk of random legal collapses; at each point of it some changes are compared, and after each
// step every sample is where it is said to be.
TEST_P(EnergyOracle, ChangesAreDifferencesOfEnergies) {
  const auto& [shape, samples] = GetParam();
  TriangleMesh mesh =
      std::string(shape) == "grid" ? test::grid(9, 9) : *generate(shape, {.triangles = 300});
  mesh.normals.clear(), mesh.texcoords.clear(), mesh.colors.clear(), mesh.ranges.clear();
  if (std::string(shape) == "grid")
    for (Vec3& p : mesh.positions) p.z = 0.3f * p.x * (p.y - 4) / 9 + 0.05f * p.x * p.x;
  InputFaults faults;
  WorkingSurface surface = build_surface(mesh, {}, faults);
  SurfaceEnergy energy({surface, mesh, nullptr}, {.samples_per_triangle = samples, .spring = 1});
  EnergyScratch scratch;
  Random random(7);
  const std::size_t all = Oracle(surface, energy).sample_count();
  int steps = 0, border_steps = 0, moved_steps = 0;
  for (int tries = 0; tries < 1500 && surface.face_count > 12; ++tries) {
    const std::uint32_t from = random.below(surface.point_count());
    PointState& state = surface.points[from];
    if (state.flags & PointState::kDead) continue;
    const auto ring = surface.ring_span(from);
    const std::uint32_t onto = ring[random.below(static_cast<std::uint32_t>(ring.size()))].neighbor;
    if (test_collapse(surface, from, onto, {}) != Refusal::kLegal) continue;
    energy.look_at(scratch, from);
    EnergyCollapse best = energy.kept(scratch, onto, kInfinity);
    const Oracle oracle(surface, energy);
    expect_near(best.change, oracle.change(best), scratch.before);
    if (state.kind == surface.points[onto].kind) {
      const EnergyCollapse start = energy.started(scratch, onto);
      const EnergyCollapse fitted = energy.fitted(scratch, start);
      EXPECT_LE(fitted.change.total(), start.change.total());
      // What is not legal may be a needle, in which floats find no normal.
      const auto is_legal = [&](const EnergyCollapse& c) {
        return test_placed_collapse(surface, {from, onto, c.place, state.normal}, {}) ==
               Refusal::kLegal;
      };
      if (is_legal(start)) expect_near(start.change, oracle.change(start), scratch.before);
      if (is_legal(fitted)) expect_near(fitted.change, oracle.change(fitted), scratch.before);
      if (random.below(2) == 0 && is_legal(fitted)) best = fitted;
    }
    if (HasFatalFailure()) return;
    ++steps;
    border_steps += state.kind == VertexKind::kBorder;
    moved_steps += best.moves;
    (void)energy.collapse(scratch, best);
    std::vector<std::uint32_t> removed;
    RingMerger(surface, scratch.merge).merge(from, onto, removed);
    surface.face_count -= static_cast<std::uint32_t>(removed.size());
    state.flags |= PointState::kDead;
    surface.points[onto].position = best.place;
    const Oracle after(surface, energy);
    ASSERT_EQ(after.sample_count(), all);
    after.expect_attached();
  }
  EXPECT_GT(steps, 20);
  EXPECT_GT(moved_steps, 5);
  EXPECT_EQ(border_steps > 0, std::string(shape) == "grid");
}

INSTANTIATE_TEST_SUITE_P(Shapes, EnergyOracle,
                         testing::Combine(testing::Values("planet", "torus", "grid"),
                                          testing::Values(0.0f, 3.0f)));

}  // namespace
}  // namespace varifold
