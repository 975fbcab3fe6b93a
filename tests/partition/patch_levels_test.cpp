// Properties of levels of patches, over all groups of meshes.
#include <gtest/gtest.h>
#include <tests/partition/patch_checks.h>
#include <varifold/mesh/generators.h>
#include <varifold/partition/patch_levels.h>
#include <algorithm>
#include <numeric>
#include <set>

namespace varifold::test {
namespace {

struct Leveled {
  Partition partition;
  PatchLevels levels;
};

Leveled leveled(const TestSurface& surface, std::uint32_t size, int threads = 0) {
  Leveled result;
  result.partition =
      make_patches(surface.view(), {.triangles_per_patch = size, .threads = threads});
  result.levels = make_levels(surface.view(), result.partition, threads);
  return result;
}

TEST(PatchLevels, HalveDownToOne) {
  for (const TestSurface& surface : partition_surfaces())
    for (const std::uint32_t size : {1u, 16u, 100u}) {
      SCOPED_TRACE(surface.name + " " + std::to_string(size));
      const auto [partition, levels] = leveled(surface, size);
      if (surface.corners.empty()) {
        EXPECT_EQ(levels.level_count(), 0u);
        continue;
      }
      ASSERT_EQ(levels.patch_count(0), partition.patch_count);
      for (std::uint32_t l = 0; l + 1 < levels.level_count(); ++l)
        EXPECT_EQ(levels.patch_count(l + 1), (levels.patch_count(l) + 1) / 2);
      EXPECT_EQ(levels.parent.back(), std::vector<std::uint32_t>(1, kNone));
    }
}

TEST(PatchLevels, ChildrenStandTogetherInTheOrderOfTheirParents) {
  for (const TestSurface& surface : partition_surfaces()) {
    SCOPED_TRACE(surface.name);
    const PatchLevels levels = leveled(surface, 16).levels;
    for (std::uint32_t l = 0; l + 1 < levels.level_count(); ++l) {
      const std::vector<std::uint32_t>& parent = levels.parent[l];
      EXPECT_TRUE(std::is_sorted(parent.begin(), parent.end()));
      const std::set<std::uint32_t> used(parent.begin(), parent.end());
      ASSERT_EQ(used.size(), levels.patch_count(l + 1)) << "every patch has a child";
      EXPECT_EQ(*used.rbegin() + 1, levels.patch_count(l + 1));
    }
  }
}

TEST(PatchLevels, OnlyNumberThePatchesAnew) {
  for (const TestSurface& surface : partition_surfaces()) {
    SCOPED_TRACE(surface.name);
    const Partition before = make_patches(surface.view(), {.triangles_per_patch = 16});
    Partition after = before;
    (void)make_levels(surface.view(), after);
    std::vector<std::uint32_t> number(before.patch_count, kNone), seen(before.patch_count, 0);
    for (std::size_t t = 0; t < before.patch_of.size(); ++t) {
      std::uint32_t& as = number[before.patch_of[t]];
      if (as == kNone) {
        as = after.patch_of[t];
        ASSERT_EQ(seen[as]++, 0u);
      }
      ASSERT_EQ(as, after.patch_of[t]);
    }
  }
}

// Labels of the triangles at every level.
std::vector<std::vector<std::uint32_t>> labels_of_levels(const Leveled& l) {
  std::vector<std::vector<std::uint32_t>> labels{l.partition.patch_of};
  for (std::uint32_t i = 0; i + 1 < l.levels.level_count(); ++i) {
    labels.push_back(labels.back());
    for (std::uint32_t& label : labels.back()) label = l.levels.parent[i][label];
  }
  return labels;
}

TEST(PatchLevels, OfClosedSurfacesStayCompact) {
  PlanetOptions options;
  options.triangles = 20'000;
  const TestSurface surface = make_surface("planet", planet(options));
  const Leveled l = leveled(surface, 100);
  const auto labels = labels_of_levels(l);
  for (std::uint32_t i = 0; i < l.levels.level_count(); ++i) {
    SCOPED_TRACE("level " + std::to_string(i));
    const std::uint32_t count = l.levels.patch_count(i);
    const double mean = 20'000.0 / count;
    std::uint32_t non_discs = 0;
    for (const auto& triangles : triangles_by_label(labels[i], count)) {
      EXPECT_LE(static_cast<double>(triangles.size()), 2.5 * mean + 1);
      non_discs += euler_of(surface, triangles) != 1;
    }
    EXPECT_LE(non_discs, count == 1 ? 1 : count / 20) << "of " << count;
    const std::vector<std::uint32_t> part = connected_parts(surface, labels[i], false);
    EXPECT_EQ(std::set<std::uint32_t>(part.begin(), part.end()).size(), count);
  }
}

TEST(PatchLevels, JoinWhatIsNear) {
  // Two rows of separate grids, far from each other: the last merge is that of the rows.
  TriangleMesh mesh;
  for (int row = 0; row < 2; ++row)
    for (int i = 0; i < 8; ++i) {
      const Vec3 offset(static_cast<float>(i) * 5, static_cast<float>(row) * 500, 0);
      mesh = mesh.indices.empty() ? join(grid(4, 4), {}, offset) : join(mesh, grid(4, 4), offset);
    }
  const TestSurface surface = make_surface("rows", mesh);
  const Leveled l = leveled(surface, 32);
  ASSERT_EQ(l.partition.patch_count, 16u);
  const auto labels = labels_of_levels(l);
  ASSERT_EQ(l.levels.level_count(), 5u);
  std::set<std::uint32_t> of_row[2];
  for (std::uint32_t t = 0; t < surface.corners.size() / 3; ++t)
    of_row[surface.positions[surface.corners[3 * t]].y > 250].insert(labels[3][t]);
  EXPECT_EQ(of_row[0].size(), 1u);
  EXPECT_EQ(of_row[1].size(), 1u);
  EXPECT_NE(of_row[0], of_row[1]);
}

TEST(PatchLevels, DoNotDependOnThreads) {
  for (const TestSurface& surface : partition_surfaces()) {
    SCOPED_TRACE(surface.name);
    const Leveled one = leveled(surface, 16, 1);
    for (const int threads : {2, 3}) {
      const Leveled more = leveled(surface, 16, threads);
      EXPECT_EQ(one.levels.parent, more.levels.parent);
      EXPECT_EQ(one.partition.patch_of, more.partition.patch_of);
    }
  }
}

TEST(PatchNeighbors, AreThePatchesAtCommonPoints) {
  for (const TestSurface& surface : partition_surfaces()) {
    SCOPED_TRACE(surface.name);
    const Partition partition = make_patches(surface.view(), {.triangles_per_patch = 16});
    std::vector<std::vector<std::uint32_t>> rows(partition.patch_count);
    for (std::size_t h = 0; h < surface.corners.size(); ++h)
      rows[partition.patch_of[h / 3]].push_back(surface.corners[h]);
    std::vector<std::uint32_t> points, first{0};
    for (const std::vector<std::uint32_t>& row : rows) {
      points.insert(points.end(), row.begin(), row.end());
      first.push_back(static_cast<std::uint32_t>(points.size()));
    }
    const PatchNeighbors found =
        patch_neighbors(points, first, static_cast<std::uint32_t>(surface.positions.size()));
    std::vector<std::set<std::uint32_t>> at_point(surface.positions.size());
    for (std::size_t h = 0; h < surface.corners.size(); ++h)
      at_point[surface.corners[h]].insert(partition.patch_of[h / 3]);
    std::vector<std::set<std::uint32_t>> expected(partition.patch_count);
    for (const auto& here : at_point)
      for (const std::uint32_t a : here) expected[a].insert(here.begin(), here.end());
    ASSERT_EQ(found.first.size(), partition.patch_count + 1u);
    for (std::uint32_t p = 0; p < partition.patch_count; ++p) {
      expected[p].erase(p);
      const auto of_patch = found.of(p);
      EXPECT_EQ(std::vector<std::uint32_t>(of_patch.begin(), of_patch.end()),
                std::vector<std::uint32_t>(expected[p].begin(), expected[p].end()));
    }
  }
}

}  // namespace
}  // namespace varifold::test
