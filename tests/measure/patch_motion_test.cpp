// Jumps and turned triangles of fronts, against what stands in the tree.
#include <gtest/gtest.h>
#include <tests/models/patch_tree/built_trees.h>
#include <varifold/measure/patch_motion.h>
#include <varifold/measure/picture_projection.h>
#include <varifold/models/patch_tree/front.h>
#include <varifold/models/patch_tree/patch_draws.h>
#include <algorithm>
#include <cmath>
#include <set>

namespace varifold {
namespace {

using TreePointer = std::shared_ptr<const PatchTree>;

class Motion {
 public:
  explicit Motion(const TreePointer& tree)
      : front(tree),
        draws(std::make_shared<const PatchDrawTables>(tree, PatchMeasure::kPixels)),
        motion(tree) {}

  PatchMotion::Frame at_level(std::uint32_t level, const Camera& camera) {
    front.go_to_level(level);
    draws.follow(front.draws());
    return motion.next(draws.list(), std::nullopt, camera);
  }
  PatchMotion::Frame at(float tolerance, const Camera& camera,
                        const std::optional<PatchMorphRange>& morph) {
    RefineCriteria criteria;
    criteria.view.emplace(camera);
    PatchFrontOptions options;
    options.limits.tolerance = tolerance;
    front.adapt(criteria, options);
    draws.follow(front.draws());
    return motion.next(draws.list(), morph, camera);
  }

  PatchFront front;
  PatchDraws draws;
  PatchMotion motion;
};

Camera camera_at(const TriangleMesh& mesh, const Vec3& direction, float distance) {
  Box box;
  for (const Vec3& p : mesh.positions) box.add(p);
  Camera camera;
  camera.target = box.center();
  camera.eye = box.center() + distance * box.diagonal() * direction;
  camera.up = std::abs(direction.y) > 0.9f ? Vec3(1, 0, 0) : Vec3(0, 1, 0);
  camera.width = camera.height = 800;
  camera.near_distance = 0.01f * box.diagonal();
  camera.far_distance = 10 * box.diagonal();
  return camera;
}

// From above all of a plane faces the eye and is in the picture, so that every vertex counts.
TEST(PatchMotion, JumpsOfLevelsAreTheWaysToTheSurvivors) {
  const test::BuiltTree& built = test::built_tree("plane of patches of 25");
  const PatchTreeData& data = built.tree->data();
  const Camera camera = camera_at(built.mesh, normalize_or_zero(Vec3(0, 1, 0)), 3);
  const PictureProjection picture(camera);
  Motion motion(built.tree);
  EXPECT_EQ(motion.at_level(0, camera).jumps.vertex_pixels, 0) << "the first frame";
  const std::uint32_t finest = built.tree->finest_level();
  const auto expected = [&](std::uint32_t level) {
    float most = 0;
    for (std::uint32_t node = data.topology.first_of_level[level];
         node < data.topology.first_of_level[level + 1]; ++node)
      for (std::size_t i = 3 * std::size_t{data.offsets[node].triangle};
           i < 3 * std::size_t{data.offsets[node + 1].triangle}; ++i) {
        const std::uint32_t v = data.offsets[node].vertex + data.corners[i];
        const std::uint32_t survivor =
            data.offsets[data.topology.parent[node]].vertex + data.survivors[v];
        most = std::max(most, picture.pixels(DVec3(data.vertices.positions[v]),
                                             DVec3(data.vertices.positions[survivor])));
      }
    return most;
  };
  for (std::uint32_t level = 1; level <= finest; ++level) {
    EXPECT_EQ(motion.at_level(level, camera).jumps.vertex_pixels, expected(level)) << level;
    const auto still = motion.at_level(level, camera);
    EXPECT_EQ(still.jumps.vertex_pixels, 0);
    EXPECT_EQ(still.triangles, built.tree->triangle_count(level));
    EXPECT_EQ(still.turned, 0u);
    EXPECT_EQ(still.moving, 0u);
  }
  // And back; a plane stays where it is.
  for (std::uint32_t level = finest; level > 0; --level) {
    const auto jumps = motion.at_level(level - 1, camera).jumps;
    EXPECT_EQ(jumps.vertex_pixels, expected(level)) << level;
    EXPECT_LT(jumps.surface_pixels, 1e-3);
  }
}

// Split a hair later: without blending vertices jump, with it they are where they were.
TEST(PatchMotion, BlendingLeavesNoJumpAtASplit) {
  const test::BuiltTree& built = test::built_tree("blob of patches of 40");
  Motion plain(built.tree), blended(built.tree);
  int jumps = 0;
  for (int i = 0; i < 12; ++i) {
    const float angle = 0.5f * static_cast<float>(i);
    const Camera camera = camera_at(built.mesh, Vec3(std::cos(angle), 0.2f, std::sin(angle)), 1.5f);
    const float tolerance = 1.5f + 0.4f * static_cast<float>(i);
    (void)plain.at(tolerance, camera, std::nullopt);
    float greatest = 0;
    for (const PatchDraw& draw : plain.front.draws().draws())
      if (!built.tree->topology().is_leaf(draw.node))
        greatest = std::max(greatest, plain.front.nodes().priority(draw.node));
    const PatchMorphRange range = pixel_morph_range(PixelScale(camera), greatest);
    for (Motion* motion : {&plain, &blended}) {
      const auto morph = motion == &blended ? std::optional(range) : std::nullopt;
      (void)motion->at(greatest, camera, morph);
      const std::uint32_t before = motion->front.nodes().split_count();
      const auto after = motion->at(std::nextafter(greatest, 0.0f), camera, morph);
      EXPECT_GT(motion->front.nodes().split_count(), before);
      if (motion == &blended) {
        EXPECT_LT(after.jumps.vertex_pixels, 2e-3f);
        EXPECT_LT(after.jumps.surface_pixels, 2e-3f);
      } else {
        jumps += after.jumps.vertex_pixels > 1 ? 1 : 0;
      }
    }
  }
  EXPECT_GE(jumps, 8) << "without blending";
}

TEST(PatchMotion, CountsWhatBlendingTurnsOver) {
  const test::BuiltTree& built = test::built_tree("blob of patches of 40");
  Motion motion(built.tree);
  std::uint64_t turned = 0, seen = 0, moving = 0;
  for (int i = 0; i < 40; ++i) {
    const float angle = 0.5f * static_cast<float>(i);
    const Camera camera = camera_at(built.mesh, Vec3(std::cos(angle), 0.3f, std::sin(angle)), 1.2f);
    const float tolerance = 0.5f + 0.1f * static_cast<float>(i);
    PatchMorphRange range = pixel_morph_range(PixelScale(camera), tolerance);
    range.band = 3;
    const auto told = motion.at(tolerance, camera, range);
    const PatchDrawList list = motion.draws.list();
    std::uint64_t expected = 0, triangles = 0;
    std::set<std::uint32_t> vertices, on_their_way;
    for (const PatchDrawCommand& draw : list.draws)
      for (std::size_t t = draw.first_index; t < draw.first_index + draw.index_count; t += 3) {
        Vec3 own[3], blended[3];
        for (std::size_t k = 0; k < 3; ++k) {
          const std::uint32_t stored = draw.first_vertex + list.indices[t + k];
          const std::uint32_t v =
              switched_vertex(stored, list.remap[stored], draw.parent_vertex, draw.mask);
          own[k] = list.positions[v];
          blended[k] = morphed_position(list, v, range);
          vertices.insert(v);
          const std::uint32_t target = list.morphs[v].target;
          const Vec3 end = morphed_position(list, target, range);
          if (glm::distance(blended[k], own[k]) > 1e-5f && glm::distance(blended[k], end) > 1e-5f)
            on_their_way.insert(v);
        }
        const auto normal = [](const Vec3(&p)[3]) {
          return glm::cross(DVec3(p[1]) - DVec3(p[0]), DVec3(p[2]) - DVec3(p[0]));
        };
        triangles += normal(own) != DVec3(0) ? 1 : 0;
        expected += glm::dot(normal(own), normal(blended)) < 0 ? 1 : 0;
      }
    EXPECT_EQ(told.turned, expected);
    EXPECT_EQ(told.triangles, triangles);
    EXPECT_EQ(told.vertices, vertices.size());
    // But for rounding at the ends of the ways.
    EXPECT_NEAR(static_cast<double>(told.moving), static_cast<double>(on_their_way.size()),
                0.005 * static_cast<double>(vertices.size()) + 1);
    EXPECT_LE(told.turned_seen, told.turned);
    turned += told.turned;
    seen += told.turned_seen;
    moving += told.moving;
  }
  EXPECT_GT(moving, 1000u);
  EXPECT_GT(turned, 10u);
  EXPECT_GT(seen, 0u);
  EXPECT_LT(seen, turned);
}

TEST(PatchMotion, OfAnEmptyTree) {
  Motion motion(std::make_shared<const PatchTree>());
  EXPECT_EQ(motion.motion.next({}, std::nullopt, Camera()).triangles, 0u);
}

}  // namespace
}  // namespace varifold
