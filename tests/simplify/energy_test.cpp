#include <varifold/simplify/energy_collapser.h>

#include <gtest/gtest.h>
#include <tests/simplify/sequence_checks.h>
#include <tests/support/meshes.h>
#include <varifold/measure/surface_distance.h>
#include <varifold/mesh/generators.h>
#include <varifold/simplify/simplify.h>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>

namespace varifold {
namespace {

Simplification by_energy(const TriangleMesh& mesh, Placement placement,
                         const SimplifyOptions& base = {}) {
  SimplifyOptions options = base;
  options.metric = Metric::kEnergy;
  options.placement = placement;
  auto result = simplify(mesh, options);
  EXPECT_TRUE(result);
  return std::move(*result);
}

class Energy : public testing::TestWithParam<Placement> {};
INSTANTIATE_TEST_SUITE_P(Placements, Energy,
                         testing::Values(Placement::kKept, Placement::kOptimal));

TEST_P(Energy, OfSomeCollapsesFalls) {
  const TriangleMesh mesh = planet({{.triangles = 2000}});
  InputFaults faults;
  WorkingSurface surface = build_surface(mesh, {}, faults);
  PlacementLog placement;
  const EnergyLog log = collapse_by_energy(
      {surface, mesh, nullptr}, {}, GetParam() == Placement::kOptimal ? &placement : nullptr);
  ASSERT_EQ(log.costs.size(), log.log.entries.size());
  const auto negative =
      std::count_if(log.costs.begin(), log.costs.end(), [](float cost) { return cost < 0; });
  EXPECT_GT(negative, 0);
  EXPECT_LT(negative, static_cast<std::ptrdiff_t>(log.costs.size()));
}

TEST_P(Energy, KeepsFlatFacesOfABox) {
  const TriangleMesh box = *generate("box", {.triangles = 1200});
  const Simplification result = by_energy(box, GetParam());
  const CollapseSequence& sequence = result.detailed.sequence;
  const TriangleMesh small = mesh_at_level(result.detailed, sequence.level_for_triangles(24));
  const auto distance = surface_distance(small, box);
  EXPECT_LT(distance.rms, 1e-3 * distance.diagonal);
}

double area(const TriangleMesh& mesh, std::uint32_t t) {
  const auto at = [&](std::size_t k) {
    return DVec3(mesh.positions[mesh.indices[3 * std::size_t{t} + k]]);
  };
  return 0.5 * glm::length(glm::cross(at(1) - at(0), at(2) - at(0)));
}

// A cube whose sides are halved between two materials along a zigzag of gentle steps: the border
// lies in flat sides, so nothing but E_disc holds it.
TEST_P(Energy, KeepsMaterialBordersOfACube) {
  TriangleMesh cube = *generate("box", {.triangles = 4800});
  const auto wave = [](const Vec3& p) { return 0.1f * std::sin(4 * p.x + 4 * p.y) - p.z; };
  Box box = bounds(cube);
  for (Vec3& p : cube.positions) p = 2.0f * (p - box.center()) / (box.upper - box.lower);
  cube.normals.clear(), cube.texcoords.clear();
  std::vector<std::uint32_t> material(cube.triangle_count());
  for (std::uint32_t t = 0; t < cube.triangle_count(); ++t) {
    Vec3 center(0);
    for (std::size_t k = 0; k < 3; ++k) center += cube.positions[cube.indices[3 * t + k]] / 3.0f;
    material[t] = wave(center) > 0;
  }
  set_triangle_materials(cube, material);
  cube.materials.resize(2);
  const Simplification result = by_energy(cube, GetParam());
  const auto areas = [](const TriangleMesh& mesh) {
    std::map<std::uint32_t, double> sum;
    const auto materials = triangle_materials(mesh);
    for (std::uint32_t t = 0; t < mesh.triangle_count(); ++t) sum[materials[t]] += area(mesh, t);
    return sum;
  };
  const CollapseSequence& sequence = result.detailed.sequence;
  const std::uint32_t count = cube.triangle_count() / 10;
  const TriangleMesh small = mesh_at_level(result.detailed, sequence.level_for_triangles(count));
  EXPECT_LE(small.triangle_count(), count);
  auto before = areas(cube), after = areas(small);
  ASSERT_EQ(after.size(), 2u);
  for (const auto& [name, size] : before) EXPECT_NEAR(after[name], size, 0.01 * size);
  // Each material by itself is where it was.
  for (const std::uint32_t m : {0u, 1u}) {
    const auto part = [&](TriangleMesh mesh) {
      const auto materials = triangle_materials(mesh);
      std::vector<std::uint32_t> indices;
      for (std::uint32_t t = 0; t < mesh.triangle_count(); ++t)
        if (materials[t] == m)
          for (std::size_t k = 0; k < 3; ++k) indices.push_back(mesh.indices[3 * t + k]);
      mesh.indices = indices;
      mesh.ranges.clear();
      return mesh;
    };
    EXPECT_LT(surface_distance(part(small), part(cube)).rms, 0.02);
  }
}

// The colour of a flat mesh above (x, y), found by trying all triangles.
float red_at(const TriangleMesh& mesh, double x, double y) {
  for (std::uint32_t t = 0; t < mesh.triangle_count(); ++t) {
    std::array<DVec3, 3> p;
    std::array<double, 3> red{};
    for (std::size_t k = 0; k < 3; ++k) {
      p[k] = mesh.positions[mesh.indices[3 * std::size_t{t} + k]];
      red[k] = mesh.colors[mesh.indices[3 * std::size_t{t} + k]].r;
    }
    const auto cross = [&](const DVec3& a, const DVec3& b) {
      return (a.x - x) * (b.y - y) - (a.y - y) * (b.x - x);
    };
    const double u = cross(p[1], p[2]), v = cross(p[2], p[0]), w = cross(p[0], p[1]);
    if (u < -1e-9 || v < -1e-9 || w < -1e-9 || !(u + v + w > 0)) continue;
    return static_cast<float>((u * red[0] + v * red[1] + w * red[2]) / (u + v + w));
  }
  ADD_FAILURE() << "nothing above " << x << ", " << y;
  return 0;
}

TEST_P(Energy, ColoursOfAPlaneStayWhereTheyChange) {
  TriangleMesh plane = test::grid(24, 24);
  for (const Vec3& p : plane.positions) {
    const float from_middle = std::hypot(p.x - 12, p.y - 12);
    plane.colors.emplace_back(from_middle < 6 ? 255 : 0, 0, 0, 255);
  }
  const auto error = [&](float weight) {
    SimplifyOptions options;
    options.attributes.color = weight;
    const Simplification result = by_energy(plane, GetParam(), options);
    const CollapseSequence& sequence = result.detailed.sequence;
    const TriangleMesh small = mesh_at_level(result.detailed, sequence.level_for_triangles(150));
    double sum = 0;
    for (double y = 0.3; y < 24; y += 0.7)
      for (double x = 0.3; x < 24; x += 0.7)
        sum += std::abs(red_at(small, x, y) - red_at(plane, x, y));
    return sum;
  };
  EXPECT_LT(error(0.05f), 0.35 * error(0));
}

TEST_P(Energy, HoldsOpenBorders) {
  // A disc with a scalloped border.
  TriangleMesh disc = test::grid(30, 30);
  for (Vec3& p : disc.positions) {
    const Vec3 q = (p - Vec3(15, 15, 0)) / 15.0f;
    const float square = std::max(std::abs(q.x), std::abs(q.y));
    const float round = glm::length(q);
    const float angle = std::atan2(q.y, q.x);
    const float radius = square * (1 + 0.1f * std::sin(8 * angle));
    p = round > 0 ? q / round * radius : Vec3(0);
  }
  const Simplification result = by_energy(disc, GetParam());
  const CollapseSequence& sequence = result.detailed.sequence;
  const TriangleMesh small = mesh_at_level(result.detailed, sequence.level_for_triangles(90));
  double before = 0, after = 0;
  for (std::uint32_t t = 0; t < disc.triangle_count(); ++t) before += area(disc, t);
  for (std::uint32_t t = 0; t < small.triangle_count(); ++t) after += area(small, t);
  EXPECT_NEAR(after, before, 0.02 * before);
}

TEST(EnergyMetric, SamplesAreAsManyAsAsked) {
  const TriangleMesh mesh = planet({{.triangles = 1000}});
  InputFaults faults;
  WorkingSurface surface = build_surface(mesh, {}, faults);
  const SurfaceSamples samples = make_samples(surface, mesh, {}, {.samples_per_triangle = 2.5f});
  std::size_t count = 0;
  for (std::uint32_t t = 0; t < mesh.triangle_count(); ++t) {
    const auto at = [&](std::size_t k) {
      return surface.points[surface.point_of_vertex[mesh.indices[3 * t + k]]].position;
    };
    const Vec3 normal = glm::normalize(glm::cross(at(1) - at(0), at(2) - at(0)));
    count += samples.blocks.of(t).size();
    for (const EnergySample& sample : samples.blocks.of(t))
      EXPECT_NEAR(glm::dot(normal, sample.position - at(0)), 0, 1e-6);
  }
  EXPECT_EQ(count, surface.point_count() + std::size_t(2.5 * surface.face_count));
}

// At a tenth of the triangles and fewer the energy is the better measure of the two.
TEST(EnergyMetric, IsNoLessAccurateThanQuadrics) {
  const TriangleMesh mesh = planet({{.triangles = 6000}});
  const Simplification energy = by_energy(mesh, Placement::kKept);
  const auto quadric = simplify(mesh);
  for (const std::uint32_t count : {600u, 120u}) {
    const auto rms = [&](const DetailedMesh& detailed) {
      const std::uint32_t level = detailed.sequence.level_for_triangles(count);
      return surface_distance(mesh_at_level(detailed, level), mesh).rms;
    };
    EXPECT_LT(rms(energy.detailed), 1.05 * rms(quadric->detailed)) << count;
  }
}

}  // namespace
}  // namespace varifold
