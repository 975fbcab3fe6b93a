#include <gtest/gtest.h>

#include <tests/render/pixel_counts.h>
#include <tests/render/scenes.h>
#include <varifold/mesh/generators.h>
#include <varifold/render/colors.h>
#include <varifold/render/image_difference.h>
#include <varifold/render/mesh_draw_list.h>
#include <cmath>
#include <limits>
#include <tuple>
#include <vector>

namespace varifold {
namespace {

using test::enclosed_background_pixels;
using test::is_background;
using test::magenta_pixels_inside;
using test::red_pixels;
using test::RenderTest;

class RendererTest : public RenderTest {};

TEST_F(RendererTest, ClosedMeshesShowNoBackgroundInside) {
  PictureOptions magenta;
  magenta.background_top = magenta.background_bottom = Vec3(1, 0, 1);
  PlanetOptions planet_options;
  planet_options.triangles = 50000;
  for (const TriangleMesh& mesh : {test::tetrahedron(), test::colored_cube(),
                                   test::round_sphere(20000), planet(planet_options)}) {
    const Image8 image = picture_of(mesh, {}, magenta);
    const auto depths = renderer().read_depth();
    ASSERT_TRUE(depths);
    EXPECT_EQ(enclosed_background_pixels(*depths), 0);
    EXPECT_EQ(magenta_pixels_inside(image, *depths), 0);
    EXPECT_EQ(red_pixels(image), 0) << "a back face shows";
  }
}

TEST_F(RendererTest, AMissingTriangleShows) {
  TriangleMesh mesh = test::round_sphere(400);
  const Image8 whole = picture_of(mesh);
  EXPECT_EQ(red_pixels(whole), 0);
  // The triangle that the camera looks at most directly.
  std::uint32_t front = 0;
  float most = 0;
  for (std::uint32_t t = 0; t < mesh.triangle_count(); ++t) {
    const Vec3 sum = mesh.positions[mesh.indices[3 * t]] + mesh.positions[mesh.indices[3 * t + 1]] +
                     mesh.positions[mesh.indices[3 * t + 2]];
    const float along = -glm::dot(sum, view_direction(camera));
    if (along > most) most = along, front = t;
  }
  mesh.indices.erase(mesh.indices.begin() + 3 * front, mesh.indices.begin() + 3 * front + 3);
  EXPECT_GT(red_pixels(picture_of(mesh)), 100) << "the inside of the far wall";
}

TEST_F(RendererTest, FlippedTrianglesShowAndCanBeShadedOrCulled) {
  TriangleMesh mesh = test::round_sphere(2000);
  const Image8 sound = picture_of(mesh);
  for (std::size_t i = 0; i < mesh.indices.size(); i += 3)
    std::swap(mesh.indices[i], mesh.indices[i + 1]);
  for (Vec3& normal : mesh.normals) normal = -normal;
  EXPECT_GT(red_pixels(picture_of(mesh)), 20000);

  DrawStyle style;
  style.back_faces = BackFaces::kLikeFront;
  const auto difference = image_difference(sound, picture_of(mesh, style));
  ASSERT_TRUE(difference);
  EXPECT_LT(difference->rms, 1.0) << "two-sided shading sees no difference";

  style.back_faces = BackFaces::kCulled;
  (void)picture_of(mesh, style);
  const auto depths = renderer().read_depth();
  ASSERT_TRUE(depths);
  const float center = depths->depth(128, 128);
  EXPECT_GT(center, glm::length(camera.eye)) << "only the far wall is left";
}

TEST_F(RendererTest, DepthsAreDistancesAlongTheLineOfSight) {
  camera.target = Vec3(0);
  const DepthImage depths = depths_of(test::round_sphere(20000));
  EXPECT_NEAR(depths.depth(128, 128), glm::length(camera.eye) - 1, 0.01);
  EXPECT_TRUE(is_background(depths, 0, 0));
  EXPECT_TRUE(is_background(depths, 255, 255));
}

TEST_F(RendererTest, StripsDrawTheSameTrianglesAsLists) {
  turn_camera(-45);
  const test::StripBand band = test::strip_band();
  const test::StripBand list = test::as_triangles(band);
  EXPECT_EQ(submitted_triangles(band.list()), submitted_triangles(list.list()));
  for (const bool wireframe : {false, true}) {
    DrawStyle style;
    style.wireframe = wireframe;
    const auto a = renderer().render(band.list(), camera, style);
    const auto b = renderer().render(list.list(), camera, style);
    ASSERT_TRUE(a && b);
    const auto difference = image_difference(*a, *b, 4);
    EXPECT_LE(difference->part_above, 0.001);
    EXPECT_EQ(red_pixels(*a), 0) << "the winding alternates as it should";
  }
}

TEST_F(RendererTest, ChangedRangesGiveTheSamePictureAsAFreshUpload) {
  TriangleMesh mesh = test::round_sphere(2000);
  const MeshDrawList drawn(mesh);
  DrawList list = drawn.list();
  const auto gpu_mesh = renderer().add(list);
  ASSERT_TRUE(gpu_mesh);

  for (std::uint32_t v = 100; v < 200; ++v) mesh.positions[v] *= 0.8f;
  for (std::uint32_t i = 300; i < 600; i += 3) std::swap(mesh.indices[i], mesh.indices[i + 1]);
  const ElementRange vertices[] = {{100, 60}, {160, 40}};
  const ElementRange indices[] = {{300, 300}};
  list.changed_vertices = vertices;
  list.changed_indices = indices;
  const auto uploaded = renderer().update(*gpu_mesh, list);
  ASSERT_TRUE(uploaded);
  EXPECT_EQ(*uploaded, 100 * (2 * sizeof(Vec3) + sizeof(Vec2)) + 300 * sizeof(std::uint32_t));

  ASSERT_TRUE(renderer().begin(camera, plain_background()));
  ASSERT_TRUE(renderer().draw(*gpu_mesh, list));
  const auto patched = renderer().read_image();
  ASSERT_TRUE(patched);
  EXPECT_TRUE(*patched == picture_of(mesh));
  EXPECT_FALSE(*patched == picture_of(test::round_sphere(2000)));
}

TEST_F(RendererTest, ListsMayShrinkAndGrow) {
  const TriangleMesh mesh = test::round_sphere(2000);
  const MeshDrawList drawn(mesh);
  const DrawList whole = drawn.list();
  const Image8 expected = picture_of(mesh);
  const std::size_t index_bytes = mesh.indices.size() * sizeof(std::uint32_t);

  DrawList half = whole;
  half.indices = whole.indices.first(3000);
  const DrawRange half_range{0, 3000, Primitive::kTriangles, 0, 1};
  half.ranges = {&half_range, 1};
  const auto gpu_mesh = renderer().add(half);
  ASSERT_TRUE(gpu_mesh);
  for (const std::size_t bytes : {index_bytes, std::size_t{0}}) {
    const auto uploaded = renderer().update(*gpu_mesh, whole);
    ASSERT_TRUE(uploaded);
    EXPECT_EQ(*uploaded, bytes) << "grown beyond its room: all of it; unchanged: nothing";
  }
  EXPECT_EQ(*renderer().update(*gpu_mesh, half), 0u);
  EXPECT_EQ(*renderer().update(*gpu_mesh, whole), index_bytes - 3000 * sizeof(std::uint32_t));
  ASSERT_TRUE(renderer().begin(camera, plain_background()));
  ASSERT_TRUE(renderer().draw(*gpu_mesh, whole));
  EXPECT_TRUE(*renderer().read_image() == expected);
}

TEST_F(RendererTest, ACallForEachStripDrawsTheSamePicture) {
  const test::StripBand band = test::strip_band();
  for (const ColorMode mode : {ColorMode::kPlain, ColorMode::kLevel}) {
    DrawStyle style;
    style.color_mode = mode;
    const auto together = renderer().render(band.list(), camera, style, plain_background());
    style.call_per_strip = true;
    const auto apart = renderer().render(band.list(), camera, style, plain_background());
    ASSERT_TRUE(together && apart);
    EXPECT_TRUE(*together == *apart);
  }
}

TEST_F(RendererTest, EveryStripHasItsColor) {
  const test::StripBand band = test::strip_band();
  // The same strips one by one, each drawn plain in the colour of its number.
  std::vector<DrawRange> strips;
  for (const DrawRange& range : band.ranges) {
    std::uint32_t first = range.first_index;
    for (std::uint32_t i = first; i <= range.first_index + range.index_count; ++i) {
      const bool ends = i == range.first_index + range.index_count;
      if (!ends && band.indices[i] != kStripRestart) continue;
      strips.push_back({first, i - first, Primitive::kStrips, 0, 1});
      first = i + 1;
    }
  }
  ASSERT_EQ(strips.size(), 6u);
  const auto gpu_mesh = renderer().add(band.list());
  ASSERT_TRUE(gpu_mesh && renderer().begin(camera, plain_background()));
  for (std::uint32_t s = 0; s < strips.size(); ++s) {
    DrawList one = band.list();
    one.ranges = {&strips[s], 1};
    DrawStyle style;
    style.plain_color = strip_color(s);
    ASSERT_TRUE(renderer().draw(*gpu_mesh, one, style));
  }
  const auto expected = renderer().read_image();

  DrawStyle style;
  style.color_mode = ColorMode::kStrip;
  // Ranges and restarts both divide strips; restarts in a row divide them no more than one.
  DrawList list = band.list();
  const auto by_range = renderer().render(list, camera, style, plain_background());
  ASSERT_TRUE(expected && by_range);
  EXPECT_TRUE(*by_range == *expected);
  std::vector<std::uint32_t> joined;
  for (const DrawRange& strip : strips) {
    if (!joined.empty()) joined.insert(joined.end(), 3, kStripRestart);
    joined.insert(joined.end(), band.indices.begin() + strip.first_index,
                  band.indices.begin() + strip.first_index + strip.index_count);
  }
  const DrawRange whole{0, static_cast<std::uint32_t>(joined.size()), Primitive::kStrips, 0, 1};
  list.indices = joined;
  list.ranges = {&whole, 1};
  const auto by_restart = renderer().render(list, camera, style, plain_background());
  ASSERT_TRUE(by_restart);
  EXPECT_TRUE(*by_restart == *expected);
}

TEST_F(RendererTest, SeveralMeshesWithPlacementsShareAPicture) {
  const TriangleMesh mesh = test::round_sphere(2000);
  const MeshDrawList drawn(mesh);
  const auto gpu_mesh = renderer().add(drawn.list());
  ASSERT_TRUE(gpu_mesh);
  ASSERT_TRUE(renderer().begin(camera));
  for (const float x : {-1.0f, 1.0f}) {
    DrawStyle style;
    style.placement = Mat4(0.3f);
    style.placement[3] = Vec4(x, 0, 0, 1);
    ASSERT_TRUE(renderer().draw(*gpu_mesh, drawn.list(), style));
  }
  const auto depths = renderer().read_depth();
  ASSERT_TRUE(depths);
  EXPECT_TRUE(is_background(*depths, 128, 128));
  int runs = 0;
  for (int x = 1; x < 256; ++x)
    for (int y = 100; y < 156; ++y)
      if (is_background(*depths, x - 1, y) && !is_background(*depths, x, y)) ++runs;
  EXPECT_GT(runs, 40);
}

TEST_F(RendererTest, SamplesAndSupersamplingOnlySmoothTheEdges) {
  const TriangleMesh mesh = test::round_sphere(2000);
  PictureOptions options = plain_background();
  const Image8 reference = picture_of(mesh, {}, options);
  for (const auto& [samples, factor] : {std::pair(1, 1), std::pair(1, 3), std::pair(4, 2)}) {
    options.samples = samples;
    options.supersampling = factor;
    const auto difference = image_difference(reference, picture_of(mesh, {}, options), 8);
    ASSERT_TRUE(difference);
    EXPECT_GT(difference->rms, 0);
    EXPECT_LT(difference->part_above, 0.015);
    EXPECT_EQ(renderer().read_depth()->width, 256);
  }
}

TEST_F(RendererTest, BadListsCamerasAndOrdersAreErrors) {
  const TriangleMesh mesh = test::tetrahedron();
  const MeshDrawList drawn(mesh);
  EXPECT_FALSE(renderer().read_image()) << "nothing was begun";
  EXPECT_FALSE(renderer().read_depth());
  EXPECT_FALSE(renderer().draw(GpuMesh{}, drawn.list()));

  DrawList list = drawn.list();
  const std::vector<Vec3> three(3);
  list.normals = three;
  EXPECT_EQ(renderer().add(list).error().kind, ErrorKind::kInvalidInput);
  list = drawn.list();
  const DrawRange beyond{6, 9, Primitive::kTriangles, 0, 1};
  list.ranges = {&beyond, 1};
  EXPECT_EQ(renderer().add(list).error().kind, ErrorKind::kInvalidInput);

  Camera bad = camera;
  bad.target = bad.eye;
  EXPECT_EQ(renderer().begin(bad).error().kind, ErrorKind::kInvalidInput);
  bad = camera;
  bad.width = kMaxFrameSize + 1;
  EXPECT_EQ(renderer().begin(bad).error().kind, ErrorKind::kInvalidInput);
  ASSERT_TRUE(renderer().begin(camera));
  EXPECT_FALSE(renderer().draw(GpuMesh{7}, drawn.list()));
}

TEST_F(RendererTest, AnEmptyListIsAnEmptyPicture) {
  const auto image = renderer().render(DrawList{}, camera, {}, plain_background());
  ASSERT_TRUE(image) << image.error().message;
  EXPECT_EQ(image->pixel(128, 128)[0], 230);
}

TEST_F(RendererTest, RemovedNamesAreGivenOutAgain) {
  const TriangleMesh mesh = test::tetrahedron();
  const MeshDrawList drawn(mesh);
  const auto first = renderer().add(drawn.list());
  const auto second = renderer().add(drawn.list());
  ASSERT_TRUE(first && second);
  EXPECT_NE(*first, *second);
  renderer().remove(*first);
  EXPECT_FALSE(renderer().update(*first, drawn.list()));
  EXPECT_EQ(*renderer().add(drawn.list()), *first);
}

}  // namespace
}  // namespace varifold
