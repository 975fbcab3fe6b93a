// Patches drawn by one call against their triangles drawn as a mesh.
#include <gtest/gtest.h>
#include <tests/models/patch_tree/tree_fronts.h>
#include <tests/models/patch_tree/tree_of.h>
#include <tests/render/mirrored_patches.h>
#include <tests/render/pixel_counts.h>
#include <tests/render/scenes.h>
#include <varifold/mesh/generators.h>
#include <varifold/models/patch_tree/front.h>
#include <varifold/models/patch_tree/patch_draws.h>
#include <varifold/render/colors.h>
#include <varifold/render/image_difference.h>
#include <varifold/render/mesh_draw_list.h>
#include <cmath>

namespace varifold {
namespace {

using test::tree_of;
using TreePointer = std::shared_ptr<const PatchTree>;

TreePointer planet_tree(std::uint32_t per_patch) {
  PlanetOptions options;
  options.triangles = 30000;
  return tree_of(planet(options), per_patch);
}

std::shared_ptr<const PatchDrawTables> tables_of(const TreePointer& tree) {
  return std::make_shared<const PatchDrawTables>(tree, PatchMeasure::kPixels);
}

// Fine on one side, coarse on the other.
test::SplitNodes one_sided_front(const PatchTree& tree, const Vec3& side) {
  PatchFront front(std::make_shared<const PatchTree>(tree));
  RefineCriteria criteria;
  criteria.plane = Plane{side, -0.6f};
  front.adapt(criteria, {});
  test::SplitNodes is_split(tree.node_count(), 0);
  for (std::uint32_t node = 0; node < front.tables().inner_count(); ++node)
    is_split[node] = front.nodes().is_split(node) ? 1 : 0;
  return is_split;
}

class PatchesTest : public test::RenderTest {
 protected:
  [[nodiscard]] Image8 picture(const PatchDrawList& list, const DrawStyle& style = {},
                               const PatchStyle& patch_style = {}) {
    auto image = renderer().render({list, style, patch_style}, camera, plain_background());
    EXPECT_TRUE(image) << image.error().message;
    return image ? std::move(*image) : Image8{};
  }
  // The part of the pixels that differ clearly.
  static double difference(const Image8& a, const Image8& b) {
    const auto found = image_difference(a, b, 6);
    return found ? found->part_above : 1;
  }
};

TEST_F(PatchesTest, LookAsTheirTrianglesDo) {
  Random random(17);
  for (const std::uint32_t per_patch : {40u, 500u}) {
    const TreePointer tree = planet_tree(per_patch);
    PatchDraws draws(tables_of(tree));
    for (int i = 0; i < 6; ++i) {
      turn_camera(static_cast<float>(60 * i));
      const test::SplitNodes front = test::random_front(tree->topology(), random);
      draws.show(front);
      DrawStyle style;
      style.wireframe = i % 3 == 0;
      style.shading = i % 2 == 0 ? Shading::kSmooth : Shading::kFlat;
      const Image8 expected = picture_of(extract_front(*tree, front), style);
      EXPECT_LE(difference(picture(draws.list(), style), expected), 2e-4) << i;
    }
  }
}

TEST_F(PatchesTest, ShowMaterialsAndVertexColors) {
  TriangleMesh mesh = test::colored_cube();
  GeneratorOptions fine;
  fine.triangles = 5000;
  TriangleMesh cube = box(fine);
  std::vector<std::uint32_t> materials;
  for (std::uint32_t t = 0; t < cube.triangle_count(); ++t)
    materials.push_back(t * 6 / cube.triangle_count());
  cube.materials = mesh.materials;
  set_triangle_materials(cube, materials);
  for (const Vec3& p : cube.positions)
    cube.colors.emplace_back(p.x > 0 ? 250 : 90, 120, p.y > 0.3f ? 200 : 40, 255);
  const TreePointer tree = tree_of(cube, 400);
  const MeshDrawList colors(tree->data().vertices);
  PatchDraws draws(tables_of(tree));
  EXPECT_GT(draws.tables().draws_per_patch(), 1u);
  const test::SplitNodes front = one_sided_front(*tree, Vec3(0, 0, 1));
  draws.show(front);
  for (const ColorMode mode : {ColorMode::kMaterial, ColorMode::kVertexColor}) {
    DrawStyle style;
    style.color_mode = mode;
    const Image8 expected = picture_of(extract_front(*tree, front), style);
    style.material_colors = colors.material_colors();
    EXPECT_LE(difference(picture(draws.list(), style), expected), 2e-4);
    EXPECT_GT(difference(expected, picture(draws.list())), 0.1) << "not plain";
  }
}

TEST_F(PatchesTest, HaveAColorEach) {
  const TreePointer tree = planet_tree(1000);
  PatchDraws draws(tables_of(tree));
  draws.show(one_sided_front(*tree, Vec3(1, 0, 0)));
  const PatchDrawList list = draws.list();
  const TriangleMesh mesh = test::mirrored_patches(list, std::nullopt);
  const MeshDrawList drawn(mesh);
  const auto name = renderer().add(drawn.list());
  ASSERT_TRUE(name);
  for (const ColorMode mode : {ColorMode::kPatch, ColorMode::kLevel}) {
    ASSERT_TRUE(renderer().begin(camera, plain_background()));
    std::uint32_t first = 0;
    for (const PatchDrawCommand& draw : list.draws) {
      const DrawRange range{first, draw.index_count, Primitive::kTriangles, 0, draw.level};
      first += draw.index_count;
      DrawList one = drawn.list();
      one.ranges = {&range, 1};
      DrawStyle style;
      style.color_mode = mode;
      style.plain_color = strip_color(draw.patch);
      ASSERT_TRUE(renderer().draw(*name, one, style));
    }
    const auto expected = renderer().read_image();
    ASSERT_TRUE(expected);
    DrawStyle style;
    style.color_mode = mode;
    EXPECT_LE(difference(picture(list, style), *expected), 5e-4);
  }
}

TEST_F(PatchesTest, CracksAreRedUntilBordersAreSwitched) {
  DrawStyle style;
  style.back_faces = BackFaces::kSignal;
  style.back_tint = Vec3(1, 0, 0);
  for (const std::uint32_t per_patch : {40u, 200u}) {
    const TreePointer tree = planet_tree(per_patch);
    PatchDraws draws(tables_of(tree));
    for (const Vec3 side : {Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1)}) {
      const test::SplitNodes front = one_sided_front(*tree, side);
      draws.show(front);
      const int cracks = test::red_pixels(picture(draws.list(), style, {.switch_borders = false}));
      // What is turned away shows in a pixel or two of the outline of any coarse surface.
      const int unavoidable = test::red_pixels(picture_of(extract_front(*tree, front), style));
      EXPECT_GE(cracks, 20);
      EXPECT_LE(unavoidable, 3);
      EXPECT_LE(test::red_pixels(picture(draws.list(), style)), unavoidable + 2);
    }
  }
}

// Along a path: only what changes is uploaded, and the picture is that of a fresh upload.
TEST_F(PatchesTest, ChangesGiveTheSamePictureAsAFreshUpload) {
  const TreePointer tree = planet_tree(60);
  PatchFront front(tree);
  PatchDraws draws(tables_of(tree));
  draws.follow(front.draws());
  const auto patches = renderer().add(draws.list());
  ASSERT_TRUE(patches);
  std::size_t uploaded = 0, whole = 0, changed = 0;
  for (int frame = 0; frame < 60; ++frame) {
    turn_camera(static_cast<float>(frame));
    RefineCriteria criteria;
    criteria.view.emplace(camera);
    PatchFrontOptions options;
    options.limits.tolerance = 0.3f;
    front.adapt(criteria, options);
    draws.follow(front.draws());
    const auto bytes = renderer().update(*patches, draws.list());
    ASSERT_TRUE(bytes);
    const std::size_t all = draws.list().draws.size_bytes();
    if (frame > 0) {
      EXPECT_LE(*bytes, std::max(all, 200 * draws.list().changed_draws.size()));
      uploaded += *bytes;
      whole += all;
      changed += draws.list().changed_draws.size();
    }
    if (frame % 10 != 9) continue;
    ASSERT_TRUE(renderer().begin(camera, plain_background()));
    ASSERT_TRUE(renderer().draw(*patches));
    const auto image = renderer().read_image();
    ASSERT_TRUE(image);
    EXPECT_TRUE(*image == picture(draws.list()));
    draws.follow(front.draws(), true);
    EXPECT_TRUE(*image == picture(draws.list()));
    ASSERT_TRUE(renderer().update(*patches, draws.list()));
    // Nothing changed: nothing is uploaded.
    front.adapt(criteria, options);
    draws.follow(front.draws());
    EXPECT_EQ(*renderer().update(*patches, draws.list()), 0u);
  }
  EXPECT_GT(changed, 100u);
  EXPECT_LT(uploaded, whole / 2);
}

TEST_F(PatchesTest, BlendedLookAsOnTheProcessorAndHaveNoHoles) {
  Random random(23);
  const TreePointer tree = planet_tree(60);
  PatchFront front(tree);
  PatchDraws draws(tables_of(tree));
  DrawStyle style;
  style.shading = Shading::kFlat;
  style.back_tint = Vec3(1, 0, 0);
  double moved = 0;
  int turned = 0;
  for (int i = 0; i < 12; ++i) {
    turn_camera(static_cast<float>(30 * i));
    RefineCriteria criteria;
    criteria.view.emplace(camera);
    PatchFrontOptions options;
    options.limits.tolerance = static_cast<float>(std::pow(8, random.uniform()));
    if (i % 3 == 2) {
      draws.show(test::random_front(tree->topology(), random));
    } else {
      front.adapt(criteria, options);
      draws.follow(front.draws(), true);
    }
    PatchStyle morphing;
    morphing.morph = pixel_morph_range(criteria.view->scale, options.limits.tolerance);
    const Image8 image = picture(draws.list(), style, morphing);
    EXPECT_EQ(test::enclosed_background_pixels(*renderer().read_depth()), 0);
    const Image8 expected = picture_of(test::mirrored_patches(draws.list(), morphing.morph), style);
    EXPECT_LE(difference(image, expected), 2e-4);
    // A triangle may be turned over on its way; a crack would show here alone.
    EXPECT_LE(test::red_pixels(image), test::red_pixels(expected) + 1);
    turned += test::red_pixels(image);
    moved += difference(image, picture(draws.list(), style));
  }
  EXPECT_GT(moved, 0.1) << "blending shows";
  EXPECT_LE(turned, 40) << "of twelve pictures";
}

TEST_F(PatchesTest, BlendedDoNotJumpWhereANodeIsSplit) {
  const TreePointer tree = planet_tree(60);
  PatchFront front(tree);
  PatchDraws draws(tables_of(tree));
  int jumps = 0;
  for (int i = 0; i < 8; ++i) {
    turn_camera(static_cast<float>(45 * i));
    RefineCriteria criteria;
    criteria.view.emplace(camera);
    PatchFrontOptions options;
    options.limits.tolerance = 2 + 0.7f * static_cast<float>(i);
    front.adapt(criteria, options);
    float greatest = 0;
    for (const PatchDraw& draw : front.draws().draws())
      if (!tree->topology().is_leaf(draw.node))
        greatest = std::max(greatest, front.nodes().priority(draw.node));
    const auto picture_at = [&](float tolerance, bool blends) {
      options.limits.tolerance = tolerance;
      front.adapt(criteria, options);
      draws.follow(front.draws(), true);
      PatchStyle style;
      if (blends) style.morph = pixel_morph_range(criteria.view->scale, greatest);
      DrawStyle flat;
      flat.shading = Shading::kFlat;
      return picture(draws.list(), flat, style);
    };
    const float less = std::nextafter(greatest, 0.0f);
    EXPECT_LE(difference(picture_at(greatest, true), picture_at(less, true)), 1e-4);
    jumps += difference(picture_at(greatest, false), picture_at(less, false)) > 2e-4 ? 1 : 0;
  }
  EXPECT_GE(jumps, 6) << "without blending";
}

// 65535 is an index like any other.
TEST_F(PatchesTest, MayHaveAsManyVerticesAsIndicesCount) {
  std::vector<Vec3> positions(65536, Vec3(0));
  positions[65535] = {1, -1, 0};
  positions[65534] = {0, 1, 0};
  positions[0] = {-1, -1, 0};
  std::vector<PatchRemap> remap;
  for (std::uint32_t v = 0; v < 65536; ++v) remap.push_back(patch_remap(v, kPatchNeverMoves));
  const std::uint16_t indices[] = {0, 65535, 65534};
  const PatchDrawCommand draw{.index_count = 3, .mask = ~0u};
  PatchDrawList list;
  list.positions = positions;
  list.remap = remap;
  list.indices = indices;
  list.draws = {&draw, 1};
  TriangleMesh mesh;
  mesh.positions = {positions[0], positions[65535], positions[65534]};
  mesh.indices = {0, 1, 2};
  EXPECT_EQ(difference(picture(list), picture_of(mesh)), 0);
  EXPECT_GT(difference(picture(list), picture_of({})), 0.1);
}

TEST_F(PatchesTest, BadListsAndOrdersAreErrors) {
  const TreePointer tree = planet_tree(1000);
  PatchDraws draws(tables_of(tree));
  draws.show(test::uniform_front(tree->topology(), 2));
  const PatchDrawList sound = draws.list();
  EXPECT_EQ(renderer().update(GpuPatches{3}, sound).error().kind, ErrorKind::kInvalidInput);
  EXPECT_FALSE(renderer().draw(GpuPatches{})) << "nothing was begun";
  const auto expect_refused = [&](const PatchDrawList& list) {
    const auto added = renderer().add(list);
    ASSERT_FALSE(added);
    EXPECT_EQ(added.error().kind, ErrorKind::kInvalidInput);
    EXPECT_EQ(added.error().message.find('\n'), std::string::npos);
  };
  PatchDrawList bad = sound;
  bad.remap = sound.remap.first(7);
  expect_refused(bad);
  bad = sound;
  bad.indices = sound.indices.first(30);
  expect_refused(bad);
  bad = sound;
  const std::uint32_t beyond[] = {static_cast<std::uint32_t>(sound.draws.size())};
  bad.changed_draws = beyond;
  expect_refused(bad);
  bad = sound;
  bad.draws = sound.draws.subspan(1);
  bad.changed_draws = {};
  expect_refused(bad);

  const auto first = renderer().add(sound), second = renderer().add(sound);
  ASSERT_TRUE(first && second);
  EXPECT_NE(*first, *second);
  EXPECT_EQ(*renderer().update(*first, sound), sound.changed_draws.size() * 40);
  bad = sound;
  bad.indices = sound.indices.first(sound.indices.size() - 3);
  EXPECT_EQ(renderer().update(*first, bad).error().kind, ErrorKind::kInvalidInput);
  renderer().remove(*first);
  EXPECT_FALSE(renderer().update(*first, sound));
  EXPECT_EQ(*renderer().add(sound), *first);
  ASSERT_TRUE(renderer().begin(camera));
  EXPECT_FALSE(renderer().draw(GpuPatches{9}));
  EXPECT_EQ(difference(picture(PatchDrawList{}), picture_of({})), 0) << "nothing to draw";
}

}  // namespace
}  // namespace varifold
