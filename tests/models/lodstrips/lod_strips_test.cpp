#include <tests/models/level_checks.h>
#include <tests/support/count_allocations.h>
#include <tests/support/meshes.h>
#include <tests/support/test_files.h>

#include <gtest/gtest.h>

#include <varifold/base/random.h>
#include <varifold/io/mesh_file.h>
#include <varifold/mesh/generators.h>
#include <varifold/models/lodstrips/build.h>
#include <varifold/simplify/simplify.h>
#include <algorithm>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace varifold {
namespace {

using SharedStrips = std::shared_ptr<const LodStrips>;

DetailedMesh simplified(const TriangleMesh& mesh) {
  SimplifyOptions options;
  options.threads = 1;
  return std::move(simplify(mesh, options)->detailed);
}

struct NamedStrips {
  std::string name;
  DetailedMesh detailed;
  SharedStrips model;
};

// Every test mesh in every form, that of blocks with short and with long words; made once.
const std::vector<NamedStrips>& all_models() {
  static const std::vector<NamedStrips> models = [] {
    std::vector<NamedStrips> made;
    for (const test::NamedMesh& named : test::all_groups()) {
      const DetailedMesh detailed = simplified(named.mesh);
      const auto add = [&](const std::string& form, LodStrips model) {
        made.push_back({named.name + "/" + form, detailed,
                        std::make_shared<const LodStrips>(std::move(model))});
      };
      for (const LodStripsForm form : kLodStripsForms)
        add(std::string(form_name(form)), build_lod_strips(detailed, {.form = form}));
      add("blocks, long words",
          {LevelTable(detailed.sequence), detailed.mesh, build_block_form(detailed, 4)});
    }
    return made;
  }();
  return models;
}

std::vector<std::uint32_t> drawn_bytes(LodStripsInstance& instance) {
  const DrawList list = instance.draw_list();
  std::vector<std::uint32_t> bytes(list.indices.begin(), list.indices.end());
  for (const DrawRange& range : list.ranges)
    bytes.insert(bytes.end(), {range.first_index, range.index_count, range.material});
  return bytes;
}

TEST(LodStripsModel, HasTheTrianglesOfEveryLevel) {
  for (const NamedStrips& strips : all_models()) {
    for (const StripBuffer buffer : {StripBuffer::kInPlace, StripBuffer::kCompact}) {
      LodStripsInstance instance(strips.model, buffer);
      const std::uint32_t finest = strips.model->finest_level();
      const std::uint32_t stride = finest <= 300 ? 1 : finest / 40;
      for (std::uint32_t level = 0; level <= finest; level += stride) {
        instance.go_to_level(level);
        const TriangleMesh mesh = instance.extract();
        ASSERT_EQ(test::triangle_set(mesh),
                  test::triangle_set(mesh_at_level(strips.detailed, level)))
            << strips.name << " level " << level;
        ASSERT_EQ(mesh.vertex_count(), strips.detailed.sequence.vertices[level]);
        ASSERT_EQ(mesh.triangle_count(), strips.model->triangle_count(level));
      }
    }
  }
}

// Down and up again one by one: the bytes of each level are those of the way up.
TEST(LodStripsModel, EveryCollapseUndoesItsSplit) {
  for (const NamedStrips& strips : all_models()) {
    if (strips.model->finest_level() > 400) continue;
    LodStripsInstance instance(strips.model);
    std::vector<std::vector<std::uint32_t>> bytes;
    for (std::uint32_t level = 0; level <= strips.model->finest_level(); ++level) {
      instance.go_to_level(level);
      bytes.push_back(drawn_bytes(instance));
    }
    for (std::uint32_t level = strips.model->finest_level() + 1; level-- > 0;) {
      instance.go_to_level(level);
      ASSERT_EQ(drawn_bytes(instance), bytes[level]) << strips.name << " level " << level;
    }
  }
}

TEST(LodStripsModel, BytesDependOnTheLevelAlone) {
  Random random(7);
  for (const NamedStrips& strips : all_models()) {
    for (const StripBuffer buffer : {StripBuffer::kInPlace, StripBuffer::kCompact}) {
      LodStripsInstance wanderer(strips.model, buffer);
      for (int i = 0; i < 8; ++i) {
        const std::uint32_t level = random.below(strips.model->finest_level() + 1);
        wanderer.go_to_level(random.below(strips.model->finest_level() + 1));
        wanderer.go_to_level(level);
        LodStripsInstance fresh(strips.model, buffer);
        fresh.go_to_level(level);
        ASSERT_EQ(drawn_bytes(wanderer), drawn_bytes(fresh)) << strips.name << " level " << level;
      }
    }
  }
}

TEST(LodStripsModel, ChangedRangesAreEnoughForADevice) {
  Random random(11);
  for (const NamedStrips& strips : all_models()) {
    if (strips.detailed.mesh.positions.empty()) continue;
    for (const StripBuffer buffer : {StripBuffer::kInPlace, StripBuffer::kCompact}) {
      LodStripsInstance instance(strips.model, buffer);
      test::DeviceCopy device;
      device.take(instance.draw_list());
      for (int i = 0; i < 6; ++i) {
        instance.go_to_level(random.below(strips.model->finest_level() + 1));
        const DrawList list = instance.draw_list();
        device.take(list);
        device.expect_same(list, strips.name);
      }
    }
  }
}

TEST(LodStripsModel, ChangingLevelsAllocatesNothing) {
  Random random(13);
  for (const NamedStrips& strips : all_models()) {
    for (const StripBuffer buffer : {StripBuffer::kInPlace, StripBuffer::kCompact}) {
      LodStripsInstance instance(strips.model, buffer);
      const std::size_t before = allocations;
      std::size_t drawn = 0;
      for (int i = 0; i < 6; ++i) {
        instance.go_to_level(random.below(strips.model->finest_level() + 1));
        drawn += instance.draw_list().ranges.size();
      }
      EXPECT_EQ(allocations, before) << strips.name << ", " << drawn << " ranges";
    }
  }
}

TEST(LodStripsModel, ComesBackFromItsBytes) {
  for (const NamedStrips& strips : all_models()) {
    const std::vector<std::byte> bytes = encode_lod_strips(*strips.model);
    const auto model = decode_lod_strips(bytes);
    ASSERT_TRUE(model) << strips.name << ": " << model.error().message;
    EXPECT_EQ(encode_lod_strips(*model), bytes) << strips.name;
    LodStripsInstance instance(std::make_shared<const LodStrips>(*model));
    const std::uint32_t level = model->finest_level() / 2;
    instance.go_to_level(level);
    EXPECT_EQ(test::mesh_difference(instance.extract(),
                                    [&] {
                                      LodStripsInstance original(strips.model);
                                      original.go_to_level(level);
                                      return original.extract();
                                    }()),
              "")
        << strips.name;
  }
}

// Each of these has a change that one mesh of ten has.
TEST(LodStripsModel, SeedsWithRareChangesComeBackFromTheirBytes) {
  for (const std::uint64_t seed : {21u, 31u, 32u, 40u}) {
    PlanetOptions globe;
    TerrainOptions ground;
    globe.triangles = ground.triangles = 30000;
    globe.seed = ground.seed = seed;
    for (const TriangleMesh& mesh : {planet(globe), terrain(ground)}) {
      const auto decoded = decode_lod_strips(encode_lod_strips(build_lod_strips(simplified(mesh))));
      EXPECT_TRUE(decoded) << "seed " << seed;
    }
  }
}

TEST(LodStripsModel, LargeMeshesComeBackFromTheirBytes) {
  PlanetOptions options;
  options.triangles = 150000;
  const DetailedMesh detailed = simplified(planet(options));
  const LodStrips model = build_lod_strips(detailed);
  const auto decoded = decode_lod_strips(encode_lod_strips(model));
  ASSERT_TRUE(decoded) << decoded.error().message;
  LodStripsInstance instance(std::make_shared<const LodStrips>(*decoded));
  for (const std::uint32_t level : test::spread_levels(model.finest_level())) {
    if (level % 5 != 0) continue;
    instance.go_to_level(level);
    ASSERT_EQ(test::triangle_set(instance.extract()),
              test::triangle_set(mesh_at_level(detailed, level)))
        << "level " << level;
  }
}

// Any damage is either refused or leaves a model that can be played; the sanitizers watch.
void play(const LodStrips& damaged) {
  const auto model = std::make_shared<const LodStrips>(damaged);
  LodStripsInstance instance(model);
  for (const std::uint32_t level : {model->finest_level(), 0u, model->finest_level() / 2}) {
    instance.go_to_level(level);
    const DrawList list = instance.draw_list();
    for (const DrawRange& range : list.ranges)
      for (const std::uint32_t index : list.indices.subspan(range.first_index, range.index_count))
        ASSERT_TRUE(index == kStripRestart || index < model->vertex_count(level));
  }
}

TEST(LodStripsModel, DamagedBytesAreHarmless) {
  Random random(5);
  std::uint32_t refused = 0, all = 0;
  for (const NamedStrips& strips : all_models()) {
    const std::vector<std::byte> bytes = encode_lod_strips(*strips.model);
    if (bytes.size() > 20000) continue;
    for (int i = 0; i < 40; ++i) {
      std::vector<std::byte> damaged = bytes;
      const std::uint32_t hits = 1 + random.below(3);
      for (std::uint32_t hit = 0; hit < hits; ++hit)
        damaged[random.below(static_cast<std::uint32_t>(damaged.size()))] =
            static_cast<std::byte>(random.below(256));
      const auto model = decode_lod_strips(damaged);
      ++all;
      if (!model) {
        ++refused;
        EXPECT_EQ(model.error().kind, ErrorKind::kInvalidInput);
        EXPECT_NE(model.error().message.find("byte "), std::string::npos);
      } else {
        play(*model);
      }
    }
    for (std::size_t size = 0; size < bytes.size(); size += 1 + bytes.size() / 40)
      EXPECT_FALSE(decode_lod_strips(std::span(bytes).first(size))) << strips.name;
  }
  EXPECT_GT(refused, all / 10);
}

TEST(LodStripsModel, TakesLittleMemory) {
  for (const char* const name : {"bunny.ply", "armadillo.ply"}) {
    VARIFOLD_REAL_MESH_OR_SKIP(path, name);
    const auto mesh = read_mesh(path);
    ASSERT_TRUE(mesh);
    SimplifyOptions options;
    options.measure_error = false;
    const DetailedMesh detailed = std::move(simplify(mesh->mesh, options)->detailed);
    const auto model = std::make_shared<const LodStrips>(build_lod_strips(detailed));
    const LodStripsInstance in_place(model);
    const double vertices = detailed.mesh.vertex_count();
    EXPECT_LE(static_cast<double>(model->bytes() + in_place.bytes()) / vertices, 45) << name;
    const LodStripsInstance compact(model, StripBuffer::kCompact);
    EXPECT_LE(static_cast<double>(model->bytes() + compact.bytes()) / vertices, 58) << name;
  }
}

}  // namespace
}  // namespace varifold
