// The half of the sphere that discs are laid onto, in arithmetic of its own.
#include <gtest/gtest.h>
#include <tests/morph/disc_shapes.h>
#include <varifold/morph/disc_pair.h>
#include <varifold/morph/sphere_embedding.h>
#include <cmath>
#include <numbers>
#include <set>

namespace varifold {
namespace {

__extension__ using Int128 = __int128;

int sign_of(const SpherePoint& a, const SpherePoint& b, const SpherePoint& c) {
  const Int128 sum = a.x * (Int128{b.y} * c.z - Int128{b.z} * c.y) +
                     a.y * (Int128{b.z} * c.x - Int128{b.x} * c.z) +
                     a.z * (Int128{b.x} * c.y - Int128{b.y} * c.x);
  return (sum > 0) - (sum < 0);
}

long double solid_angle(const SpherePoint& a, const SpherePoint& b, const SpherePoint& c) {
  using V = glm::vec<3, long double>;
  const V p = glm::normalize(V(a.x, a.y, a.z)), q = glm::normalize(V(b.x, b.y, b.z)),
          r = glm::normalize(V(c.x, c.y, c.z));
  const long double volume = glm::dot(p, glm::cross(q - p, r - p));
  return 2 * std::atan2(volume, 1 + glm::dot(p, q) + glm::dot(q, r) + glm::dot(r, p));
}

void expect_half_sphere(const DiscMap& map) {
  const auto& indices = map.disc.surface.indices;
  const std::set<std::uint32_t> boundary(map.disc.surface.boundary.begin(),
                                         map.disc.surface.boundary.end());
  long double area = 0;
  for (std::size_t t = 0; t < indices.size(); t += 3) {
    const SpherePoint &a = map.points[indices[t]], &b = map.points[indices[t + 1]],
                      &c = map.points[indices[t + 2]];
    EXPECT_EQ(sign_of(a, b, c), 1) << "triangle " << t / 3;
    area += solid_angle(a, b, c);
  }
  EXPECT_NEAR(static_cast<double>(area), 2 * std::numbers::pi, 1e-9);
  for (std::uint32_t v = 0; v < map.points.size(); ++v) {
    if (boundary.contains(v))
      EXPECT_EQ(map.points[v].z, 0);
    else
      EXPECT_GT(map.points[v].z, 0);
  }
}

DiscMap map_of(const TriangleMesh& mesh) {
  auto surface = as_sphere_or_disc(mesh, "mesh");
  EXPECT_TRUE(surface && surface->is_disc());
  return {to_disc_mesh(mesh, std::move(*surface)), {}};
}

TEST(DiscEmbedding, CoversHalfTheSphereWithoutFolds) {
  for (const test::NamedMesh& named : test::small_discs()) {
    SCOPED_TRACE(named.name);
    DiscMap map = map_of(named.mesh);
    ASSERT_TRUE(lay_boundary(map, {}));
    auto points = embed_on_half_sphere(map.disc.surface, map.points);
    ASSERT_TRUE(points) << points.error().message;
    map.points = std::move(*points);
    expect_half_sphere(map);
  }
}

TEST(DiscEmbedding, LongCoilsFindPlaces) {
  // Coarse levels of a coil have no shape to go by, and their vertices pile up.
  for (const std::uint32_t length : {100u, 145u, 200u})
    for (float turns = 1; turns < 6; turns += 0.5f) {
      SCOPED_TRACE(std::to_string(length) + " " + std::to_string(turns));
      DiscMap map = map_of(test::spiral(length, turns));
      ASSERT_TRUE(lay_boundary(map, {}));
      auto points = embed_on_half_sphere(map.disc.surface, map.points);
      ASSERT_TRUE(points) << points.error().message;
      map.points = std::move(*points);
      expect_half_sphere(map);
    }
}

TEST(DiscEmbedding, MergedBoundariesAreOne) {
  const std::vector<test::NamedMesh> discs = test::small_discs();
  for (std::size_t i = 0; i < discs.size(); ++i) {
    SCOPED_TRACE(discs[i].name);
    DiscPair pair;
    pair.maps = {map_of(discs[i].mesh), map_of(discs[(i + 5) % discs.size()].mesh)};
    ASSERT_TRUE(lay_boundaries(pair, {}));
    for (DiscMap& map : pair.maps) {
      auto points = embed_on_half_sphere(map.disc.surface, map.points);
      ASSERT_TRUE(points);
      map.points = std::move(*points);
    }
    ASSERT_TRUE(bring_together(pair));
    const std::size_t before =
        pair.maps[0].disc.surface.boundary.size() + pair.maps[1].disc.surface.boundary.size();
    const SharedPoints shared = merge_boundaries(pair.maps[0], pair.maps[1]);
    for (const DiscMap& map : pair.maps) {
      expect_half_sphere(map);
      EXPECT_LE(map.disc.surface.boundary.size(), before);
      ASSERT_EQ(map.disc.surface.boundary.size(), pair.maps[0].disc.surface.boundary.size());
      EXPECT_EQ(map.disc.mesh.triangle_count(), map.disc.surface.indices.size() / 3);
    }
    for (const std::uint32_t point : pair.maps[0].disc.surface.boundary) {
      const std::uint32_t other = shared.in_b[point];
      ASSERT_NE(other, kNone);
      EXPECT_EQ(shared.in_a[other], point);
      EXPECT_EQ(pair.maps[0].points[point], pair.maps[1].points[other]);
    }
  }
}

TEST(DiscEmbedding, CutsLeaveTheShapeAndNoChords) {
  for (const test::NamedMesh& named : test::small_discs()) {
    SCOPED_TRACE(named.name);
    DiscMap map = map_of(named.mesh);
    ASSERT_TRUE(lay_boundary(map, {}));
    const SphereSurface& surface = map.disc.surface;
    const std::set<std::uint32_t> boundary(surface.boundary.begin(), surface.boundary.end());
    std::size_t chords = 0;
    for (std::size_t h = 0; h < surface.indices.size(); ++h)
      chords += boundary.contains(surface.indices[h]) &&
                boundary.contains(surface.indices[h % 3 == 2 ? h - 2 : h + 1]);
    EXPECT_EQ(chords, boundary.size());  // the edges of the boundary, once each
    const auto area_of = [](const std::vector<Vec3>& positions,
                            const std::vector<std::uint32_t>& indices) {
      double area = 0;
      for (std::size_t t = 0; t < indices.size(); t += 3) {
        const DVec3 a(positions[indices[t]]);
        area += 0.5 * glm::length(glm::cross(DVec3(positions[indices[t + 1]]) - a,
                                             DVec3(positions[indices[t + 2]]) - a));
      }
      return area;
    };
    const double area = area_of(named.mesh.positions, named.mesh.indices);
    EXPECT_NEAR(area_of(surface.positions, surface.indices), area, 1e-6 * area);
    EXPECT_NEAR(area_of(map.disc.mesh.positions, map.disc.mesh.indices), area, 1e-6 * area);
  }
}

}  // namespace
}  // namespace varifold
