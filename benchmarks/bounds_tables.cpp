// Prints the tables of docs/algorithms/deviation_space.md.
#include <benchmarks/bench_meshes.h>
#include <varifold/base/random.h>
#include <varifold/models/common/step_graph.h>
#include <varifold/models/vdpm/deviation_space.h>
#include <varifold/models/vdpm/step_bounds.h>
#include <varifold/models/vdpm/watch_bounds.h>
#include <varifold/simplify/sample_carrier.h>
#include <varifold/simplify/simplify.h>
#include <array>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <string>
#include <vector>

namespace varifold::bench {
namespace {

double cpu_seconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

struct Case {
  std::string name;
  DetailedMesh detailed;
  std::vector<std::uint32_t> parent;
  std::vector<StepBounds> bounds;
};

Case measure(const std::string& name) {
  Case c{.name = name};
  const TriangleMesh mesh = without_attributes(bench::mesh(name));
  const double start = cpu_seconds();
  c.detailed = simplify(mesh, {.measure_error = false, .threads = 1})->detailed;
  const double simplified = cpu_seconds();
  const StepGraph graph(c.detailed);
  c.parent.assign(c.detailed.sequence.step_count(), kNone);
  for (std::uint32_t k = 0; k < c.parent.size(); ++k)
    for (const std::uint32_t finer : graph.of(k)) c.parent[finer] = k;
  const double began = cpu_seconds();
  double stars = 0;
  const auto note = [&](std::string_view stage, float) {
    if (stage == "stars") stars = cpu_seconds() - began;
    return true;
  };
  measure_step_bounds(c.detailed, c.parent, {.threads = 1, .progress = note}, c.bounds);
  const double bounds = cpu_seconds() - began;
  const double triangles = mesh.triangle_count();
  std::printf("%s: bounds %.2f us a triangle (stars %.2f); with simplify %.0fk triangles/s\n",
              name.c_str(), bounds / triangles * 1e6, stars / triangles * 1e6,
              triangles / (bounds + simplified - start) / 1e3);
  return c;
}

void print_nesting(const Case& c) {
  std::vector<Vec3> centers;
  for (const StepBounds& b : c.bounds) centers.push_back(c.detailed.mesh.positions[b.vertex]);
  std::vector<StepBounds> exact = c.bounds, loose = c.bounds;
  nest_bounds(c.parent, centers, exact, 100000);
  const auto angle = [](const StepBounds& b) { return std::acos(b.nested_cone().cosine); };
  for (const std::uint32_t depth : {1u, 2u, 4u, 8u, 16u, 100000u}) {
    nest_bounds(c.parent, centers, loose, depth);
    double radius = 0, turn = 0, narrow = 0, wide = 0;
    for (std::size_t k = 0; k < exact.size(); ++k) {
      radius += loose[k].nested_radius_length() / exact[k].nested_radius_length();
      if (loose[k].nested_angle == StepBounds::kWide) {
        ++wide;
      } else {
        turn += angle(loose[k]) / angle(exact[k]);
        ++narrow;
      }
    }
    const auto steps = static_cast<double>(exact.size());
    std::printf("  %6u ancestors: radius x %.4f, angle x %.4f, wide %.1f %%\n", depth,
                radius / steps, turn / narrow, 100 * wide / steps);
  }
}

// One length, the paper's ratio, and what is stored.
constexpr std::size_t kKinds = 3;
using Spaces = std::vector<std::array<DeviationSpace, kKinds>>;

Spaces spaces_of(const Case& c) {
  Spaces spaces(c.bounds.size());
  const VerticesByPlace places(c.detailed.mesh);
  SampleCarrier carrier(c.detailed, places, {.on_edges = 3});
  NearestTriangle nearest;
  std::vector<Vec2> residuals;  // along the axis and across it
  while (carrier.level() > 0) {
    const StepBounds& own = c.bounds[carrier.level() - 1];
    const Vec3 axis = own.own_cone().axis;
    residuals.clear();
    carrier.collapse(nearest, [&](const SampleCarrier::Sample&, const Vec3& e) {
      const float along = glm::dot(e, axis);
      residuals.emplace_back(std::abs(along), glm::length(e - along * axis));
    });
    Vec2 greatest(0);
    float length = 0, mu = 0;
    for (const Vec2& r : residuals) {
      greatest = glm::max(greatest, r);
      length = std::max(length, glm::length(r));
    }
    const float ratio = greatest.y > 0 ? std::clamp(greatest.x / greatest.y, 1.001f, 1e4f) : 1e4f;
    const float slope = std::sqrt(ratio * ratio - 1);
    for (const Vec2& r : residuals)
      mu = std::max(mu, r.x * slope > r.y ? (r.x + r.y * slope) / ratio : glm::length(r));
    spaces[carrier.level()] = {
        {{length, length}, {mu, mu * ratio}, {own.mu_length(), own.delta_length()}}};
  }
  return spaces;
}

void print_views(const Case& c) {
  constexpr int kEyes = 100;
  const float pixels = 540 / std::tan(35 * 3.14159265f / 360);  // of one unit at distance one
  const Spaces spaces = spaces_of(c);
  const Box box = bounds(c.detailed.mesh);
  for (const float distance : {2.0f, 0.6f}) {
    std::array<double, kKinds> asked{}, facing{};
    Random random(7);
    for (int i = 0; i < kEyes; ++i) {
      const auto z = static_cast<float>(2 * random.uniform() - 1);
      const auto turn = static_cast<float>(6.2831853 * random.uniform());
      const float side = std::sqrt(1 - z * z);
      const Vec3 eye = box.center() + distance * box.diagonal() *
                                          Vec3(side * std::cos(turn), side * std::sin(turn), z);
      for (std::size_t k = 0; k < spaces.size(); ++k) {
        const StepBounds& own = c.bounds[k];
        const Sphere ball{c.detailed.mesh.positions[own.vertex], own.radius_length()};
        const NormalCone cone = own.own_cone();
        const bool is_back = is_back_facing(cone, ball, eye);
        const Vec3 p = eye - ball.center;
        const float along = glm::dot(p, cone.axis);
        const float aside = std::sqrt(std::max(0.0f, glm::dot(p, p) - along * along));
        for (std::size_t kind = 0; kind < kKinds; ++kind) {
          const DeviationSpace& space = spaces[k][kind];
          // From within a torus around the axis delta looks too large.
          const float half = 0.5f * space.delta * pixels;
          const float torus = std::hypot(aside - half, along) - half;
          const bool is_asked = space.mu * pixels > glm::length(p) - ball.radius ||
                                (space.delta > space.mu && torus < ball.radius);
          asked[kind] += is_asked;
          facing[kind] += is_asked && !is_back;
        }
      }
    }
    std::printf("  %.1f diagonals: one length %.0f, paper x %.3f, stored x %.3f;", distance,
                asked[0] / kEyes, asked[1] / asked[0], asked[2] / asked[0]);
    std::printf(" facing: %.0f, x %.3f, x %.3f\n", facing[0] / kEyes, facing[1] / facing[0],
                facing[2] / facing[0]);
  }
}

}  // namespace
}  // namespace varifold::bench

int main() {
  using namespace varifold::bench;
  for (const std::string& name : present({"bunny.ply", "igea.ply", "armadillo.ply", "planet"})) {
    const Case c = measure(name);
    print_nesting(c);
    if (name != "planet") print_views(c);
  }
}
