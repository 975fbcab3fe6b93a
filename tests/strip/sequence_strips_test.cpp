#include <tests/models/level_checks.h>
#include <tests/support/meshes.h>
#include <tests/support/test_files.h>

#include <gtest/gtest.h>

#include <varifold/io/mesh_file.h>
#include <varifold/mesh/generators.h>
#include <varifold/simplify/simplify.h>
#include <varifold/strip/sequence_strips.h>
#include <algorithm>
#include <string>
#include <vector>

namespace varifold {
namespace {

DetailedMesh simplified(const TriangleMesh& mesh) {
  SimplifyOptions options;
  options.threads = 1;
  options.measure_error = false;
  return std::move(simplify(mesh, options)->detailed);
}

// What strips hold as a mesh: one material range after the other.
TriangleMesh mesh_of(const TriangleStrips& strips, const TriangleMesh& full) {
  TriangleMesh mesh;
  mesh.positions = full.positions;
  for (std::uint32_t r = 0; r < std::max<std::size_t>(1, full.ranges.size()); ++r) {
    const std::uint32_t first = mesh.triangle_count();
    for (std::uint32_t s = 0; s < strips.count(); ++s) {
      if (strips.range[s] != r) continue;
      const auto strip = strips.strip(s);
      for (std::size_t i = 0; i + 2 < strip.size(); ++i) {
        const auto corners = strip_triangle(strip, i);
        if (!is_degenerate(corners))
          mesh.indices.insert(mesh.indices.end(), corners.begin(), corners.end());
      }
    }
    if (!full.ranges.empty() && mesh.triangle_count() > first)
      mesh.ranges.push_back({full.ranges[r].material, first, mesh.triangle_count() - first});
  }
  return mesh;
}

std::size_t slots_with_restarts(const SequenceStrips& strips) {
  std::size_t slots = 0;
  for (std::uint32_t b = 0; b < strips.block_count(); ++b)
    slots += strips.block(b).empty() ? 0 : strips.block(b).size() + 1;
  return slots;
}

TEST(SequenceStrips, HaveTheTrianglesOfEveryLevel) {
  for (const test::NamedMesh& named : test::all_groups()) {
    const DetailedMesh detailed = simplified(named.mesh);
    const SequenceHistory history(detailed);
    SequenceStrips strips(detailed, history);
    const std::uint32_t finest = detailed.sequence.step_count();
    const std::uint32_t stride = finest <= 300 ? 1 : finest / 50;
    for (;;) {
      if (strips.level() % stride == 0 || strips.level() == finest) {
        ASSERT_EQ(test::triangle_set(mesh_of(strips.strips(), detailed.mesh)),
                  test::triangle_set(mesh_at_level(detailed, strips.level())))
            << named.name << " level " << strips.level();
      }
      if (strips.level() == finest) break;
      strips.split();
    }
  }
}

TEST(SequenceStrips, StayShortAtEveryLevel) {
  PlanetOptions globe;
  TerrainOptions ground;
  globe.triangles = ground.triangles = 20000;
  for (const TriangleMesh& mesh : {planet(globe), terrain(ground)}) {
    const DetailedMesh detailed = simplified(mesh);
    const SequenceHistory history(detailed);
    SequenceStrips strips(detailed, history);
    while (strips.level() < detailed.sequence.step_count()) {
      strips.split();
      const std::uint32_t triangles = detailed.sequence.triangles[strips.level()];
      if (triangles <= 500) continue;
      ASSERT_LE(static_cast<double>(slots_with_restarts(strips)) / triangles, 1.85)
          << "level " << strips.level();
    }
  }
}

// What one walk learns must change nothing but the order within strips of one triangle.
TEST(SequenceStrips, WhatWasLearnedSavesTurns) {
  for (const test::NamedMesh& named : test::all_groups()) {
    const DetailedMesh detailed = simplified(named.mesh);
    const SequenceHistory history(detailed);
    SequenceStrips first(detailed, history);
    std::size_t turns = 0, fewer_turns = 0;
    const auto count_turns = [](const SequenceStrips& strips) {
      return static_cast<std::size_t>(
          std::count_if(strips.changes().begin(), strips.changes().end(),
                        [](const BlockChange& c) { return c.kind == BlockChange::kRotate; }));
    };
    while (first.level() < detailed.sequence.step_count()) {
      first.split();
      turns += count_turns(first);
    }
    SequenceStrips second(detailed, history, first.first_corners());
    while (second.level() < detailed.sequence.step_count()) {
      second.split();
      fewer_turns += count_turns(second);
    }
    EXPECT_EQ(slots_with_restarts(first), slots_with_restarts(second)) << named.name;
    EXPECT_EQ(first.block_count(), second.block_count()) << named.name;
    EXPECT_LE(fewer_turns, turns) << named.name;
    if (turns > 100) {
      EXPECT_LT(4 * fewer_turns, turns) << named.name;
    }
  }
}

// A table of who uses which slot at which level, filled without looking at how the layout is made.
TEST(SequenceStrips, LayoutKeepsBlocksApart) {
  for (const test::NamedMesh& named : test::all_groups()) {
    const DetailedMesh detailed = simplified(named.mesh);
    const SequenceHistory history(detailed);
    SequenceStrips strips(detailed, history);
    while (strips.level() < detailed.sequence.step_count()) strips.split();
    const SequenceStrips::Layout layout = strips.layout();
    SequenceStrips again(detailed, history);
    std::vector<std::uint32_t> owner(layout.size);
    for (std::uint32_t level = 0;; ++level) {
      std::fill(owner.begin(), owner.end(), kNone);
      for (std::uint32_t b = 0; b < again.block_count(); ++b) {
        for (std::uint32_t i = 0; i < again.block(b).size(); ++i) {
          ASSERT_LT(layout.first[b] + i, layout.size) << named.name;
          ASSERT_EQ(owner[layout.first[b] + i], kNone) << named.name << " level " << level;
          owner[layout.first[b] + i] = b;
        }
      }
      if (level == detailed.sequence.step_count() || level > 400) break;
      again.split();
    }
  }
}

TEST(SequenceStrips, RealMeshesStayShort) {
  for (const char* const name : {"bunny.ply", "fandisk.obj", "spot.obj", "beetle.obj"}) {
    VARIFOLD_REAL_MESH_OR_SKIP(path, name);
    const auto mesh = read_mesh(path);
    ASSERT_TRUE(mesh);
    const DetailedMesh detailed = simplified(mesh->mesh);
    const SequenceHistory history(detailed);
    SequenceStrips strips(detailed, history);
    while (strips.level() < detailed.sequence.step_count()) {
      strips.split();
      const std::uint32_t triangles = detailed.sequence.triangles[strips.level()];
      if (triangles <= 500 || strips.level() % 16 != 0) continue;
      ASSERT_LE(static_cast<double>(slots_with_restarts(strips)) / triangles, 1.85)
          << name << " level " << strips.level();
    }
  }
}

}  // namespace
}  // namespace varifold
