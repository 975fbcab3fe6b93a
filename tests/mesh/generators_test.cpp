#include <gtest/gtest.h>

#include <varifold/mesh/generators.h>
#include <varifold/mesh/normals.h>
#include <varifold/mesh/weld.h>
#include <algorithm>
#include <cmath>
#include <cstring>
#include <map>

namespace varifold {
namespace {

/// Brute force on position classes: how many edges have which number of triangles, and Euler's
/// characteristic.
struct Census {
  std::map<int, int> edges_with_faces;
  long euler = 0;
  bool oriented = true;

  explicit Census(const TriangleMesh& mesh) {
    const WeldMap weld = weld_exact(mesh.positions);
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::pair<int, int>> edges;
    for (std::size_t i = 0; i < mesh.indices.size(); i += 3)
      for (int k = 0; k < 3; ++k) {
        const std::uint32_t a = weld.class_of[mesh.indices[i + k]];
        const std::uint32_t b = weld.class_of[mesh.indices[i + (k + 1) % 3]];
        EXPECT_NE(a, b);
        auto& edge = edges[std::minmax(a, b)];
        ++(a < b ? edge.first : edge.second);
      }
    for (const auto& [key, count] : edges) {
      ++edges_with_faces[count.first + count.second];
      oriented = oriented && count.first <= 1 && count.second <= 1;
    }
    euler = static_cast<long>(weld.class_count) - static_cast<long>(edges.size()) +
            static_cast<long>(mesh.triangle_count());
  }
  [[nodiscard]] bool closed() const {
    return edges_with_faces.size() == 1 && edges_with_faces.count(2) == 1;
  }
};

void expect_normals_outside(const TriangleMesh& mesh) {
  ASSERT_EQ(mesh.normals.size(), mesh.positions.size());
  for (const Vec3& n : mesh.normals) ASSERT_NEAR(glm::length(n), 1, 1e-5);
  for (std::uint32_t t = 0; t < mesh.triangle_count(); ++t)
    for (int k = 0; k < 3; ++k)
      ASSERT_GT(glm::dot(face_normal(mesh, t), mesh.normals[mesh.indices[3 * t + k]]), 0)
          << "triangle " << t;
}

template <class T>
bool same_bytes(const std::vector<T>& a, const std::vector<T>& b) {
  return a.size() == b.size() &&
         (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0);
}

TEST(Generators, EveryShapeIsWellFormed) {
  for (const std::string_view name : generator_names())
    for (const std::uint32_t wanted : {1u, 50u, 777u, 5000u}) {
      GeneratorOptions options;
      options.triangles = wanted;
      const Result<TriangleMesh> mesh = generate(name, options);
      ASSERT_TRUE(mesh) << name;
      SCOPED_TRACE(std::string(name) + " " + std::to_string(wanted));
      EXPECT_GT(mesh->triangle_count(), 0u);
      if (wanted >= 777) {
        EXPECT_NEAR(mesh->triangle_count(), wanted, 0.15 * wanted);
        expect_normals_outside(*mesh);
      }
      std::vector<bool> used(mesh->vertex_count(), false);
      for (const std::uint32_t v : mesh->indices) used.at(v) = true;
      EXPECT_EQ(std::count(used.begin(), used.end(), false), 0);
      EXPECT_TRUE(Census(*mesh).oriented);
    }
}

TEST(Generators, TopologyOfTheClosedShapes) {
  const std::map<std::string_view, long> euler{{"planet", 2}, {"sphere", 2}, {"torus", 0},
                                               {"knot", 0},   {"box", 2},    {"seamed_sphere", 2}};
  for (const auto& [name, expected] : euler)
    for (const std::uint32_t wanted : {1u, 300u, 3000u}) {
      GeneratorOptions options;
      options.triangles = wanted;
      const TriangleMesh mesh = generate(name, options).value();
      const Census census(mesh);
      EXPECT_TRUE(census.closed()) << name << wanted;
      EXPECT_EQ(census.euler, expected) << name << wanted;
      EXPECT_GT(signed_volume(mesh), 0) << name << wanted;
    }
}

TEST(Generators, OpenShapesAreDisks) {
  for (const std::string_view name : {"plane", "terrain"}) {
    const TriangleMesh mesh = generate(name, {.triangles = 800}).value();
    const Census census(mesh);
    EXPECT_EQ(census.euler, 1);
    EXPECT_EQ(census.edges_with_faces.at(1), 80);
  }
}

TEST(Generators, UnknownNameAndBadCounts) {
  const auto unknown = generate("teapot");
  ASSERT_FALSE(unknown);
  EXPECT_EQ(unknown.error().kind, ErrorKind::kInvalidInput);
  EXPECT_NE(unknown.error().message.find("planet"), std::string::npos);
  EXPECT_FALSE(generate("planet", {.triangles = 0}));
  EXPECT_FALSE(generate("planet", {.triangles = kMaxGeneratedTriangles + 1}));
}

TEST(Generators, SameBytesForAnyNumberOfThreads) {
  for (const std::string_view name : generator_names()) {
    const TriangleMesh one = generate(name, {.triangles = 60'000, .seed = 5, .threads = 1}).value();
    for (const int threads : {2, 3, 0}) {
      const TriangleMesh many =
          generate(name, {.triangles = 60'000, .seed = 5, .threads = threads}).value();
      EXPECT_TRUE(same_bytes(one.positions, many.positions)) << name;
      EXPECT_TRUE(same_bytes(one.normals, many.normals)) << name;
      EXPECT_TRUE(same_bytes(one.texcoords, many.texcoords)) << name;
      EXPECT_TRUE(same_bytes(one.indices, many.indices)) << name;
    }
  }
}

TEST(Planet, CountsAreThoseOfTheIcosphere) {
  EXPECT_EQ(planet({{.triangles = 1}, 0.1f, false}).triangle_count(), 20u);
  EXPECT_EQ(planet({{.triangles = 49}, 0.1f, false}).triangle_count(), 20u);
  EXPECT_EQ(planet({{.triangles = 51}, 0.1f, false}).triangle_count(), 80u);
  const TriangleMesh mesh = planet({{.triangles = 20'000}, 0.1f, false});
  EXPECT_EQ(mesh.triangle_count(), 20'480u);
  EXPECT_EQ(mesh.vertex_count(), 10'242u);
  EXPECT_EQ(weld_exact(mesh.positions).class_count, mesh.vertex_count());
}

TEST(Planet, SeedsDifferAndReliefStaysInRange) {
  const TriangleMesh a = planet({{.triangles = 20'000, .seed = 1}, 0.12f, true});
  const TriangleMesh b = planet({{.triangles = 20'000, .seed = 2}, 0.12f, true});
  EXPECT_FALSE(same_bytes(a.positions, b.positions));
  EXPECT_EQ(a.colors.size(), a.positions.size());
  float lowest = 2, highest = 0;
  for (const Vec3& p : a.positions) {
    lowest = std::min(lowest, glm::length(p));
    highest = std::max(highest, glm::length(p));
  }
  EXPECT_GT(lowest, 0.8799f);
  EXPECT_LT(highest, 1.1201f);
  EXPECT_GT(highest - lowest, 0.1f);  // there are continents and basins
}

TEST(Planet, WithoutReliefASphere) {
  const TriangleMesh mesh = planet({{.triangles = 2'000}, 0.0f, false});
  for (const Vec3& p : mesh.positions) ASSERT_NEAR(glm::length(p), 1, 1e-6);
}

TEST(Terrain, OfAHeightMap) {
  // 0 1 2      z = -2
  // 3 4 5      z = 2
  HeightField field{3, 2, {0, 1, 2, 3, 4, 5}, 4, 0.5f};
  const TriangleMesh mesh = terrain(field).value();
  const std::vector<Vec3> expected{{-4, 0, -2},   {0, 0.5f, -2}, {4, 1, -2},
                                   {-4, 1.5f, 2}, {0, 2, 2},     {4, 2.5f, 2}};
  EXPECT_EQ(mesh.positions, expected);
  EXPECT_EQ(mesh.triangle_count(), 4u);
  EXPECT_EQ(mesh.texcoords[4], Vec2(0.5f, 1));
  for (std::uint32_t t = 0; t < 4; ++t) EXPECT_GT(face_normal(mesh, t).y, 0);
}

TEST(Terrain, RejectsBadHeightMaps) {
  EXPECT_FALSE(terrain(HeightField{1, 2, {0, 1}, 1, 1}));
  EXPECT_FALSE(terrain(HeightField{2, 2, {0, 1, 2}, 1, 1}));
  EXPECT_FALSE(terrain(HeightField{2, 2, {0, 1, 2, NAN}, 1, 1}));
  EXPECT_FALSE(terrain(HeightField{2, 2, {0, 1, 2, 3}, 0, 1}));
  EXPECT_FALSE(terrain(HeightField{2, 2, {0, 1, 2, 3e38f}, 1, 10}));
}

TEST(SeamedSphere, TwoMaterialsAndSeams) {
  const TriangleMesh mesh = seamed_sphere({.triangles = 1000});
  ASSERT_EQ(mesh.ranges.size(), 2u);
  EXPECT_EQ(mesh.materials.size(), 2u);
  EXPECT_EQ(mesh.ranges[0].triangle_count, mesh.ranges[1].first_triangle);
  EXPECT_LT(weld_exact(mesh.positions).class_count, mesh.vertex_count());
}

TEST(Box, IsExact) {
  const TriangleMesh mesh = box({.triangles = 12});
  EXPECT_EQ(mesh.vertex_count(), 24u);
  EXPECT_EQ(weld_exact(mesh.positions).class_count, 8u);
  EXPECT_EQ(signed_volume(mesh), 8.0);
  EXPECT_EQ(surface_area(box({.triangles = 300})), 24.0);
}

}  // namespace
}  // namespace varifold
