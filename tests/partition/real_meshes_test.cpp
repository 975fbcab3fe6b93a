// Partitions of scanned meshes.
#include <gtest/gtest.h>
#include <tests/partition/patch_checks.h>
#include <tests/support/test_files.h>
#include <varifold/io/mesh_file.h>
#include <varifold/partition/patch_levels.h>
#include <set>

namespace varifold::test {
namespace {

TEST(RealMeshes, BunnyIsCutIntoDiscs) {
  VARIFOLD_REAL_MESH_OR_SKIP(path, "bunny.ply");
  const auto read = read_mesh(path);
  ASSERT_TRUE(read.has_value());
  const TestSurface surface = make_surface("bunny", read->mesh);
  for (const std::uint32_t size : {100u, 1000u}) {
    SCOPED_TRACE(size);
    Partition partition = make_patches(surface.view(), {.triangles_per_patch = size});
    const std::uint32_t wanted = (surface.view().triangle_count() + size - 1) / size;
    EXPECT_EQ(partition.patch_count, wanted);
    EXPECT_LE(100 * partition.non_discs, partition.patch_count);
    const std::vector<std::uint32_t> part = connected_parts(surface, partition.patch_of, false);
    EXPECT_EQ(std::set<std::uint32_t>(part.begin(), part.end()).size(), wanted);
    EXPECT_EQ(make_levels(surface.view(), partition).parent.back().size(), 1u);
  }
}

}  // namespace
}  // namespace varifold::test
