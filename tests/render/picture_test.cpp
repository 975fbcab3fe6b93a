// Pictures of tiny meshes against goldens.
#include <gtest/gtest.h>

#include <tests/render/golden.h>
#include <tests/render/scenes.h>
#include <varifold/mesh/generators.h>
#include <varifold/mesh/normals.h>
#include <varifold/render/mesh_draw_list.h>
#include <cmath>

namespace varifold {
namespace {

using test::expect_golden;
using test::RenderTest;

class Picture : public RenderTest {
 protected:
  void halve_size() { camera.width = camera.height = 128; }
};

TEST_F(Picture, FacetsOfATetrahedronWithoutNormals) {
  expect_golden(picture_of(test::tetrahedron()), "tetrahedron");
}

TEST_F(Picture, CubeInSixMaterials) {
  DrawStyle style;
  style.color_mode = ColorMode::kMaterial;
  expect_golden(picture_of(test::colored_cube(), style), "cube_materials");
}

TEST_F(Picture, SmoothSphere) {
  halve_size();
  expect_golden(picture_of(test::round_sphere(2000)), "sphere_smooth");
}

TEST_F(Picture, FlatSphereWithWires) {
  DrawStyle style;
  style.shading = Shading::kFlat;
  style.wireframe = true;
  expect_golden(picture_of(test::round_sphere(400), style), "sphere_wires");
}

TEST_F(Picture, StripsInTheColorsOfTheirLevels) {
  DrawStyle style;
  style.color_mode = ColorMode::kLevel;
  turn_camera(-45);
  style.wireframe = true;
  const auto image =
      renderer().render(test::strip_band().list(), camera, style, plain_background());
  ASSERT_TRUE(image);
  expect_golden(*image, "strips_levels");
}

TEST_F(Picture, BumpsInVertexColorsSupersampledWithOcclusion) {
  halve_size();
  TriangleMesh mesh = test::round_sphere(5000);
  for (Vec3& p : mesh.positions) {
    const float height = std::sin(6 * p.x) * std::sin(6 * p.y) * std::sin(6 * p.z);
    mesh.colors.push_back(height > 0 ? Color(90, 150, 70, 255) : Color(50, 110, 190, 255));
    p *= 1 + 0.15f * height;
  }
  compute_normals(mesh);
  DrawStyle style;
  style.color_mode = ColorMode::kVertexColor;
  PictureOptions options = plain_background();
  options.supersampling = 2;
  options.ambient_occlusion = true;
  expect_golden(picture_of(mesh, style, options), "bumps_colors");
}

TEST_F(Picture, GradientBehindAKnot) {
  KnotOptions knot_options;
  knot_options.triangles = 4000;
  const TriangleMesh mesh = knot(knot_options);
  FrameOptions frame_options;
  frame_options.width = frame_options.height = 192;
  camera = frame(mesh.positions, frame_options);
  PictureOptions options;
  options.ambient_occlusion = true;
  expect_golden(picture_of(mesh, {}, options), "knot_gradient");
}

TEST_F(Picture, FlippedTrianglesInTheTint) {
  halve_size();
  TriangleMesh mesh = test::round_sphere(400);
  for (std::uint32_t t = 0; t < mesh.triangle_count(); t += 5)
    std::swap(mesh.indices[3 * t], mesh.indices[3 * t + 1]);
  expect_golden(picture_of(mesh), "sphere_flipped");
}

}  // namespace
}  // namespace varifold
