#include <gtest/gtest.h>
#include <tests/support/meshes.h>
#include <tests/support/test_files.h>
#include <varifold/io/mesh_file.h>
#include <varifold/mesh/generators.h>
#include <varifold/mesh/topology.h>
#include <varifold/morph/sphere_embedding.h>
#include <cmath>
#include <numbers>

namespace varifold {
namespace {

// The triangles of the position classes.
struct Surface {
  std::vector<std::uint32_t> indices;
  std::vector<Vec3> positions;
};

Surface welded(const TriangleMesh& mesh) {
  const WeldMap weld = weld_exact(mesh.positions);
  Surface surface;
  surface.positions.resize(weld.class_count);
  for (std::uint32_t v = 0; v < mesh.vertex_count(); ++v)
    surface.positions[weld.class_of[v]] = mesh.positions[v];
  for (std::size_t t = 0; t < mesh.indices.size(); t += 3) {
    const std::uint32_t a = weld.class_of[mesh.indices[t]], b = weld.class_of[mesh.indices[t + 1]],
                        c = weld.class_of[mesh.indices[t + 2]];
    if (a != b && b != c && c != a) surface.indices.insert(surface.indices.end(), {a, b, c});
  }
  return surface;
}

// By the tangent of half the angle, in other arithmetic than that of the predicate.
long double solid_angle(const SpherePoint& a, const SpherePoint& b, const SpherePoint& c) {
  using V = glm::vec<3, long double>;
  const V p = glm::normalize(V(a.x, a.y, a.z)), q = glm::normalize(V(b.x, b.y, b.z)),
          r = glm::normalize(V(c.x, c.y, c.z));
  const long double volume = glm::dot(p, glm::cross(q - p, r - p));
  return 2 * std::atan2(volume, 1 + glm::dot(p, q) + glm::dot(q, r) + glm::dot(r, p));
}

void expect_embedded(const Surface& surface, const std::vector<SpherePoint>& points) {
  ASSERT_EQ(points.size(), surface.positions.size());
  EXPECT_EQ(count_flipped_on_sphere(surface.indices, points), 0u);
  long double area = 0;
  for (std::size_t t = 0; t < surface.indices.size(); t += 3) {
    const long double angle = solid_angle(
        points[surface.indices[t]], points[surface.indices[t + 1]], points[surface.indices[t + 2]]);
    EXPECT_GT(angle, 0) << "triangle " << t / 3;
    area += angle;
  }
  EXPECT_NEAR(static_cast<double>(area), 4 * std::numbers::pi, 1e-9);
}

TEST(SphereEmbedding, LaysClosedSurfacesWithoutFolds) {
  for (const test::NamedMesh& named : test::group_closed()) {
    const TopologyReport topology = analyze_topology(named.mesh, weld_exact(named.mesh.positions));
    if (topology.genus() != 0) continue;
    SCOPED_TRACE(named.name);
    const Surface surface = welded(named.mesh);
    const auto points = embed_on_sphere(surface.indices, surface.positions);
    ASSERT_TRUE(points) << points.error().message;
    expect_embedded(surface, *points);
  }
}

TEST(SphereEmbedding, RealMeshes) {
  for (const char* name : {"horse.ply", "spot.obj", "fandisk.obj", "armadillo.ply"}) {
    VARIFOLD_REAL_MESH_OR_SKIP(path, name);
    SCOPED_TRACE(name);
    const Surface surface = welded(read_mesh(path)->mesh);
    const auto points = embed_on_sphere(surface.indices, surface.positions);
    ASSERT_TRUE(points) << points.error().message;
    expect_embedded(surface, *points);
  }
}

}  // namespace
}  // namespace varifold
