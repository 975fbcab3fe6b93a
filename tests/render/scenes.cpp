#include <tests/render/scenes.h>
#include <varifold/mesh/generators.h>
#include <varifold/render/mesh_draw_list.h>
#include <cmath>
#include <utility>

namespace varifold::test {

void RenderTest::SetUp() {
  auto context = HeadlessContext::create();
  if (!context) GTEST_SKIP() << context.error().message;
  context_.emplace(std::move(*context));
  auto made = Renderer::create();
  ASSERT_TRUE(made) << made.error().message;
  renderer_.emplace(std::move(*made));
  turn_camera(30);
}

void RenderTest::turn_camera(float azimuth_degrees) {
  FrameOptions options;
  options.width = options.height = 256;
  options.azimuth_degrees = azimuth_degrees;
  camera = frame(Box{Vec3(-1), Vec3(1)}, options);
}

PictureOptions RenderTest::plain_background() {
  PictureOptions options;
  options.background_top = options.background_bottom = Vec3(0.9f);
  return options;
}

Image8 RenderTest::picture_of(const TriangleMesh& mesh, const DrawStyle& style,
                              const PictureOptions& options) {
  const MeshDrawList drawn(mesh);
  DrawStyle full_style = style;
  full_style.material_colors = drawn.material_colors();
  auto image = renderer().render(drawn.list(), camera, full_style, options);
  EXPECT_TRUE(image) << image.error().message;
  return image ? std::move(*image) : Image8{};
}

DepthImage RenderTest::depths_of(const TriangleMesh& mesh) {
  (void)picture_of(mesh);
  auto depths = renderer().read_depth();
  EXPECT_TRUE(depths) << depths.error().message;
  return depths ? std::move(*depths) : DepthImage{};
}

TriangleMesh tetrahedron() {
  TriangleMesh mesh;
  mesh.positions = {{1, 1, 1}, {-1, -1, 1}, {-1, 1, -1}, {1, -1, -1}};
  mesh.indices = {0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3};
  return mesh;
}

TriangleMesh colored_cube() {
  GeneratorOptions options;
  options.triangles = 12;
  TriangleMesh mesh = box(options);
  const Vec4 colors[] = {{0.6f, 0.1f, 0.1f, 1}, {0.1f, 0.5f, 0.1f, 1}, {0.1f, 0.2f, 0.7f, 1},
                         {0.7f, 0.6f, 0.1f, 1}, {0.1f, 0.6f, 0.6f, 1}, {0.5f, 0.1f, 0.6f, 1}};
  for (const Vec4& color : colors) {
    Material material;
    material.base_color = color;
    mesh.materials.push_back(material);
  }
  std::vector<std::uint32_t> materials;
  for (std::uint32_t t = 0; t < mesh.triangle_count(); ++t) materials.push_back(t / 2);
  set_triangle_materials(mesh, materials);
  return mesh;
}

TriangleMesh round_sphere(std::uint32_t triangles) {
  GeneratorOptions options;
  options.triangles = triangles;
  return sphere(options);
}

DrawList StripBand::list() const {
  DrawList list;
  list.positions = positions;
  list.indices = indices;
  list.ranges = ranges;
  return list;
}

StripBand strip_band() {
  constexpr std::uint32_t kColumns = 12, kRows = 3;
  StripBand band;
  for (std::uint32_t row = 0; row <= kRows; ++row)
    for (std::uint32_t column = 0; column <= kColumns; ++column) {
      const float angle = 1.5707963f * static_cast<float>(column) / kColumns;
      band.positions.push_back({2 * std::sin(angle) - 1,
                                -1 + 2.0f * static_cast<float>(row) / kRows,
                                1 - 2 * std::cos(angle)});
    }
  // 3--4--5   strip of a row: 3 0 4 1 5 2, counter-clockwise seen from the axis of the pipe
  // | /| /|
  // 0--1--2
  for (std::uint32_t row = 0; row < kRows; ++row) {
    DrawRange range;
    range.first_index = static_cast<std::uint32_t>(band.indices.size());
    range.primitive = Primitive::kStrips;
    range.level = static_cast<float>(row) / (kRows - 1);
    for (std::uint32_t column = 0; column <= kColumns; ++column) {
      if (column == kColumns / 2) {  // a strip may end anywhere
        band.indices.insert(band.indices.end(), {(row + 1) * (kColumns + 1) + column,
                                                 row * (kColumns + 1) + column, kStripRestart});
      }
      band.indices.push_back((row + 1) * (kColumns + 1) + column);
      band.indices.push_back(row * (kColumns + 1) + column);
    }
    range.index_count = static_cast<std::uint32_t>(band.indices.size()) - range.first_index;
    band.ranges.push_back(range);
  }
  return band;
}

StripBand as_triangles(const StripBand& band) {
  StripBand result;
  result.positions = band.positions;
  for (const DrawRange& range : band.ranges) {
    std::vector<std::uint32_t> run;
    for (std::uint32_t i = 0; i < range.index_count; ++i) {
      const std::uint32_t index = band.indices[range.first_index + i];
      if (index == kStripRestart) {
        run.clear();
        continue;
      }
      run.push_back(index);
      const std::size_t n = run.size();
      if (n < 3) continue;
      std::uint32_t a = run[n - 3], b = run[n - 2];
      if (n % 2 == 0) std::swap(a, b);
      result.indices.insert(result.indices.end(), {a, b, index});
    }
  }
  DrawRange whole;
  whole.index_count = static_cast<std::uint32_t>(result.indices.size());
  result.ranges = {whole};
  return result;
}

}  // namespace varifold::test
