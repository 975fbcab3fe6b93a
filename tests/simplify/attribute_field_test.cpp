#include <varifold/simplify/attribute_field.h>

#include <gtest/gtest.h>
#include <tests/support/meshes.h>
#include <varifold/mesh/generators.h>
#include <varifold/simplify/simplify.h>

namespace varifold {
namespace {

// Two triangles of a square whose texture coordinate u is linear: moving along it costs nothing,
// taking another value costs the squared difference times the area that sees it.
TEST(AttributeField, IsZeroForLinearAttributes) {
  TriangleMesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  for (const Vec3& p : mesh.positions) mesh.texcoords.emplace_back(2 * p.x + p.y, 0);
  mesh.indices = {0, 1, 2, 0, 2, 3};
  const std::uint32_t wedges[] = {0, 1, 2, 3};
  AttributeField field(mesh, wedges, {.normal = 0, .texcoord = 1, .color = 0});
  field.add_face({0, 1, 2}, Vec3(1, 0, 0), Vec3(1, 1, 0));
  field.add_face({0, 2, 3}, Vec3(1, 1, 0), Vec3(0, 1, 0));
  EXPECT_NEAR(field.cost(0, 1, Vec3(1, 0, 0)), 0, 1e-6);
  EXPECT_NEAR(field.cost(0, 2, Vec3(1, 1, 0)), 0, 1e-6);
  // At the place of vertex 1 the surface says 2; vertex 3 has 1. A third of the area is 1/3.
  EXPECT_NEAR(field.cost(0, 3, Vec3(1, 0, 0)), 1.0 / 3, 1e-6);
  EXPECT_NEAR(field.distance_squared(1, 3), 1, 1e-6);
}

TEST(AttributeField, GathersWhatItMerges) {
  TriangleMesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  for (const Vec3& p : mesh.positions) mesh.texcoords.emplace_back(p.x * p.y, 0);  // not linear
  mesh.indices = {0, 1, 2, 0, 2, 3};
  const std::uint32_t wedges[] = {0, 1, 2, 3};
  AttributeField field(mesh, wedges, {.normal = 0, .texcoord = 1, .color = 0});
  field.add_face({0, 1, 2}, Vec3(1, 0, 0), Vec3(1, 1, 0));
  field.add_face({1, 2, 0}, Vec3(0, 1, 0), Vec3(-1, 0, 0));
  const float before = field.cost(1, 0, Vec3(-1, 0, 0));
  const float step = field.cost(0, 1, Vec3(1, 0, 0));
  field.merge(0, 1, Vec3(1, 0, 0));
  // Back at the place and value of 0, the merged quadric of 1 sees only its own part.
  EXPECT_NEAR(field.cost(1, 0, Vec3(-1, 0, 0)), before, 1e-6);
  EXPECT_NEAR(field.cost(1, 1, Vec3(0)), step, 1e-6);
}

// A flat square with a sharp line of colour: with colours in the cost the line survives.
TEST(AttributeField, KeepsColorEdges) {
  TriangleMesh mesh = test::grid(32, 32);
  const Box box = bounds(mesh);
  mesh.colors.resize(mesh.positions.size());
  for (std::uint32_t v = 0; v < mesh.vertex_count(); ++v)
    mesh.colors[v] =
        mesh.positions[v].x < box.center().x ? Color(255, 0, 0, 255) : Color(0, 0, 255, 255);
  const auto colored_area = [&](float weight) {
    SimplifyOptions options;
    options.attributes.color = weight;
    options.target_triangles = 60;
    const auto result = simplify(mesh, options);
    const TriangleMesh level = mesh_at_level(result->detailed, 0);
    double mixed = 0;
    for (std::uint32_t t = 0; t < level.triangle_count(); ++t) {
      const std::uint32_t* v = &level.indices[3 * t];
      if (level.colors[v[0]] == level.colors[v[1]] && level.colors[v[1]] == level.colors[v[2]])
        continue;
      mixed += 0.5 * glm::length(glm::cross(level.positions[v[1]] - level.positions[v[0]],
                                            level.positions[v[2]] - level.positions[v[0]]));
    }
    return mixed;
  };
  EXPECT_LT(colored_area(0.05f), 0.5 * colored_area(0));
}

}  // namespace
}  // namespace varifold
