// Properties of partitions, over all groups of meshes.
#include <gtest/gtest.h>
#include <tests/partition/patch_checks.h>
#include <varifold/mesh/generators.h>
#include <varifold/partition/patches.h>
#include <algorithm>
#include <cstdlib>
#include <numeric>
#include <set>
#include <string_view>

namespace varifold::test {
namespace {

constexpr std::uint32_t kSizes[] = {1, 16, 100, 1000};

struct Regions {
  std::vector<std::uint32_t> of;     // per triangle: the lowest triangle of its region
  std::vector<std::uint32_t> sizes;  // at that triangle
};

// Triangles of one material joined by edges, or also by chains of non-manifold edges.
Regions regions_of(const TestSurface& surface, bool through_nonmanifold) {
  std::vector<std::uint32_t> label(surface.corners.size() / 3, 0);
  if (!surface.materials.empty()) label = surface.materials;
  Regions regions{connected_parts(surface, label, through_nonmanifold), {}};
  regions.sizes.assign(label.size(), 0);
  for (const std::uint32_t region : regions.of) ++regions.sizes[region];
  return regions;
}

TEST(Patches, EveryTriangleIsInOnePatchOfOneMaterial) {
  for (const TestSurface& surface : partition_surfaces())
    for (const std::uint32_t size : kSizes) {
      SCOPED_TRACE(surface.name + " " + std::to_string(size));
      const Partition partition = make_patches(surface.view(), {.triangles_per_patch = size});
      ASSERT_EQ(partition.patch_of.size(), surface.corners.size() / 3);
      std::vector<std::set<std::uint32_t>> materials(partition.patch_count);
      for (std::uint32_t t = 0; t < partition.patch_of.size(); ++t) {
        ASSERT_LT(partition.patch_of[t], partition.patch_count);
        materials[partition.patch_of[t]].insert(surface.view().material_of(t));
      }
      for (const auto& of_patch : materials) EXPECT_EQ(of_patch.size(), 1u);
    }
}

TEST(Patches, AreConnectedOrOfWholeSmallRegions) {
  for (const TestSurface& surface : partition_surfaces())
    for (const std::uint32_t size : kSizes) {
      SCOPED_TRACE(surface.name + " " + std::to_string(size));
      const Partition partition = make_patches(surface.view(), {.triangles_per_patch = size});
      const std::vector<std::uint32_t> part = connected_parts(surface, partition.patch_of, true);
      const Regions by_edges = regions_of(surface, false);
      for (const auto& triangles : triangles_by_label(partition.patch_of, partition.patch_count)) {
        const auto is_small = [&](std::uint32_t t) {
          return 2 * by_edges.sizes[by_edges.of[t]] < size;
        };
        const auto is_joined = [&](std::uint32_t t) { return part[t] == part[triangles.front()]; };
        if (std::all_of(triangles.begin(), triangles.end(), is_joined)) continue;
        EXPECT_TRUE(std::all_of(triangles.begin(), triangles.end(), is_small));
        EXPECT_LE(triangles.size(), size);
      }
      // What is small even with all that chains of non-manifold edges join to it is never cut.
      const Regions by_all = regions_of(surface, true);
      for (std::uint32_t t = 0; t < by_all.of.size(); ++t)
        if (2 * by_all.sizes[by_all.of[t]] < size) {
          ASSERT_EQ(partition.patch_of[t], partition.patch_of[by_all.of[t]]);
        }
    }
}

TEST(Patches, StayBelowTheCap) {
  for (const TestSurface& surface : partition_surfaces())
    for (const std::uint32_t size : kSizes) {
      SCOPED_TRACE(surface.name + " " + std::to_string(size));
      const Partition partition = make_patches(surface.view(), {.triangles_per_patch = size});
      for (const auto& triangles : triangles_by_label(partition.patch_of, partition.patch_count))
        EXPECT_LE(static_cast<float>(triangles.size()), kMaxPatchExcess * static_cast<float>(size));
    }
}

std::vector<TestSurface> manifold_surfaces() {
  std::vector<TestSurface> surfaces;
  for (const NamedMesh& named : group_closed())
    surfaces.push_back(make_surface(named.name, named.mesh));
  for (const NamedMesh& named : group_open())
    surfaces.push_back(make_surface(named.name, named.mesh));
  return surfaces;
}

TEST(Patches, AreAsManyAsAsked) {
  for (const TestSurface& surface : manifold_surfaces())
    for (const std::uint32_t size : {1u, 2u, 16u, 100u, 1000u}) {
      SCOPED_TRACE(surface.name + " " + std::to_string(size));
      const Partition partition = make_patches(surface.view(), {.triangles_per_patch = size});
      const std::uint32_t wanted = (surface.view().triangle_count() + size - 1) / size;
      EXPECT_GE(partition.patch_count, wanted);
      EXPECT_LE(partition.patch_count, wanted + wanted / 8) << "the cap stops few merges";
      if (size < 3) {
        EXPECT_EQ(partition.patch_count, wanted);
      }
    }
}

TEST(Patches, OfManifoldsAreDiscs) {
  for (const TestSurface& surface : manifold_surfaces())
    for (const std::uint32_t size : {2u, 16u, 100u}) {
      SCOPED_TRACE(surface.name + " " + std::to_string(size));
      const Partition partition = make_patches(surface.view(), {.triangles_per_patch = size});
      // Every handle may cost a disc.
      std::vector<std::uint32_t> all(partition.patch_of.size());
      std::iota(all.begin(), all.end(), 0u);
      const std::int64_t handles = std::abs(2 - euler_of(surface, all)) / 2;
      if (partition.patch_count >= 12) {
        EXPECT_LE(20 * partition.non_discs, partition.patch_count + 5 * handles);
      }
    }
}

TEST(Patches, CountThePatchesThatAreNoDiscs) {
  for (const TestSurface& surface : partition_surfaces())
    for (const std::uint32_t size : kSizes) {
      SCOPED_TRACE(surface.name + " " + std::to_string(size));
      const Partition partition = make_patches(surface.view(), {.triangles_per_patch = size});
      std::uint32_t non_discs = 0;
      for (const auto& triangles : triangles_by_label(partition.patch_of, partition.patch_count))
        non_discs += euler_of(surface, triangles) != 1;
      EXPECT_EQ(partition.non_discs, non_discs);
    }
}

TEST(Patches, DoNotCrossNonmanifoldEdges) {
  for (const NamedMesh& named : group_nonmanifold()) {
    const TestSurface surface = make_surface(named.name, named.mesh);
    SCOPED_TRACE(surface.name);
    const Partition partition = make_patches(surface.view(), {.triangles_per_patch = 200});
    if (surface.view().triangle_count() > 500) continue;  // a chain may be beyond the cap
    for (const auto& [edge, triangles] : triangles_of_edges(surface))
      for (const std::uint32_t t : triangles)
        if (triangles.size() > 2) {
          EXPECT_EQ(partition.patch_of[t], partition.patch_of[triangles[0]]);
        }
  }
}

TEST(Patches, DoNotDependOnThreads) {
  PlanetOptions options;
  options.triangles = 60'000;
  std::vector<TestSurface> surfaces = partition_surfaces();
  surfaces.push_back(make_surface("larger planet", planet(options)));
  for (const TestSurface& surface : surfaces)
    for (const std::uint32_t size : {16u, 128u}) {
      SCOPED_TRACE(surface.name + " " + std::to_string(size));
      const Partition one =
          make_patches(surface.view(), {.triangles_per_patch = size, .threads = 1});
      for (const int threads : {2, 3}) {
        const Partition more =
            make_patches(surface.view(), {.triangles_per_patch = size, .threads = threads});
        EXPECT_EQ(one.patch_of, more.patch_of);
        EXPECT_EQ(one.border_length, more.border_length);
      }
    }
}

TEST(Patches, CanBeCancelledAtEveryReport) {
  const TestSurface surface = make_surface("planet", planet({}));
  int reports = 0;
  float last = -1;
  const auto count = [&](std::string_view stage, float done) {
    EXPECT_EQ(stage, "patches");
    EXPECT_GT(done, last);
    last = done;
    ++reports;
    return true;
  };
  EXPECT_FALSE(make_patches(surface.view(), {.progress = count}).cancelled);
  ASSERT_GE(reports, 2);
  for (int stop = 1; stop <= reports; ++stop) {
    int left = stop;
    const auto cancel = [&](std::string_view, float) { return --left > 0; };
    const Partition partition = make_patches(surface.view(), {.progress = cancel});
    EXPECT_TRUE(partition.cancelled);
    EXPECT_TRUE(partition.patch_of.empty());
  }
}

TEST(Patches, OfScaledSurfacesAreTheSame) {
  PlanetOptions options;
  options.triangles = 5'000;
  const TestSurface surface = make_surface("planet", planet(options));
  const auto patches = [](const TestSurface& of, bool smooth) {
    return make_patches(of.view(), {.triangles_per_patch = 64, .smooth = smooth}).patch_of;
  };
  for (const float scale : {0x1p-120f, 0x1p-60f, 0x1p60f, 0x1p120f}) {
    TestSurface scaled = surface;
    for (Vec3& p : scaled.positions) p *= scale;
    EXPECT_EQ(patches(scaled, false), patches(surface, false));
    // Smoothing does without where squares of lengths run over.
    if (scale > 0x1p-100f && scale < 0x1p100f) {
      EXPECT_EQ(patches(scaled, true), patches(surface, true));
    }
  }
}

}  // namespace
}  // namespace varifold::test
