#include <gtest/gtest.h>
#include <tests/models/pm/pm_support.h>

#include <varifold/base/random.h>
#include <varifold/mesh/generators.h>
#include <varifold/mesh/validation.h>
#include <varifold/models/pm/encoding.h>
#include <varifold/models/pm/stream_reader.h>
#include <cmath>

namespace varifold::test {
namespace {

using Bytes = std::vector<std::byte>;

std::span<const std::byte> prefix(const Bytes& bytes, std::size_t size) {
  return std::span(bytes).first(size);
}

TEST(PmEncoding, LosslessIsTheIdentity) {
  for (const NamedModel& named : all_models()) {
    const Bytes bytes = encode_progressive_mesh(*named.model);
    const auto decoded = decode_progressive_mesh(bytes);
    ASSERT_TRUE(decoded) << named.name << ": " << decoded.error().message;
    EXPECT_EQ(difference(named.model->data(), decoded->data()), "") << named.name;
    EXPECT_EQ(encode_progressive_mesh(*decoded), bytes) << named.name;
  }
}

TEST(PmEncoding, KeepsMaterialsAndImages) {
  NamedMesh named{"patchwork", {}};
  for (NamedMesh& candidate : group_seams())
    if (candidate.name == "patchwork") named = std::move(candidate);
  Material& material = named.mesh.materials.at(0);
  material.base_color = {0.5f, 0.25f, 1, 0.75f};
  material.emissive = {1, 2, 3};
  material.alpha_mode = "MASK";
  material.double_sided = true;
  material.textures[1] = 1;
  named.mesh.images = {{"a", "image/png", "a.png", {}}, {"", "", "", {1, 2, 3, 0, 255}}};
  const NamedModel model = make_model(named, Placement::kKept);
  const auto decoded = decode_progressive_mesh(encode_progressive_mesh(*model.model));
  ASSERT_TRUE(decoded);
  EXPECT_EQ(difference(model.model->data(), decoded->data()), "");
  EXPECT_EQ(decoded->data().mesh.images.size(), 2u);
  EXPECT_EQ(decoded->data().mesh.ranges.size(), 2u);
}

// As the poles of a sphere do that have a wedge in each sector.
TEST(PmEncoding, ASplitMovesManyVerticesBack) {
  NamedModel named = make_model({"icosphere", icosphere(2000)}, Placement::kOptimal);
  CollapseSequence& sequence = named.detailed.sequence;
  const std::uint32_t level = sequence.step_count() / 2;
  const TriangleMesh finer = mesh_at_level(named.detailed, level + 1);
  const auto at = sequence.placed_vertex.begin() + sequence.first_placed[level + 1];
  const auto first = sequence.placed_vertex.begin() + sequence.first_placed[level];
  std::vector<std::uint32_t> more;
  for (std::uint32_t v = 0; v < sequence.vertices[level]; ++v)
    if (std::find(first, at, v) == at) more.push_back(v);
  ASSERT_GT(more.size(), 255u);
  const auto place = at - sequence.placed_vertex.begin();
  sequence.placed_vertex.insert(at, more.begin(), more.end());
  TriangleMesh& placed = sequence.placed;
  const auto insert = [&](const std::vector<Vec3>& from, std::vector<Vec3>& to) {
    std::vector<Vec3> values;
    for (const std::uint32_t v : more) values.push_back(from[v]);
    to.insert(to.begin() + place, values.begin(), values.end());
  };
  insert(finer.positions, placed.positions);
  insert(finer.normals, placed.normals);
  for (std::size_t k = level + 1; k < sequence.first_placed.size(); ++k)
    sequence.first_placed[k] += static_cast<std::uint32_t>(more.size());

  const ProgressiveMesh model = build_progressive_mesh(named.detailed);
  const auto decoded = decode_progressive_mesh(encode_progressive_mesh(model));
  ASSERT_TRUE(decoded) << decoded.error().message;
  EXPECT_EQ(difference(model.data(), decoded->data()), "");
}

TEST(PmEncoding, EmptyModels) {
  const auto decoded = decode_progressive_mesh(encode_progressive_mesh(ProgressiveMesh{}));
  ASSERT_TRUE(decoded);
  EXPECT_EQ(decoded->finest_level(), 0u);
  EXPECT_EQ(decoded->triangle_count(), 0u);
  EXPECT_FALSE(decode_progressive_mesh({}));
}

TEST(PmEncoding, RoundsToTheStatedError) {
  for (const NamedModel& named : all_models()) {
    const ProgressiveMeshData& data = named.model->data();
    for (const int bits : {1, 8, 16, 24}) {
      EncodeReport report;
      const Bytes bytes = encode_progressive_mesh(*named.model, {bits, 8, 12}, &report);
      EXPECT_LE(report.base_bytes, bytes.size());
      const auto decoded = decode_progressive_mesh(bytes);
      ASSERT_TRUE(decoded) << named.name << ": " << decoded.error().message;
      const ProgressiveMeshData& rounded = decoded->data();
      EXPECT_EQ(rounded.mesh.indices, data.mesh.indices);
      EXPECT_EQ(rounded.slots, data.slots);
      EXPECT_EQ(rounded.finer, data.finer);
      double farthest = 0;
      for (std::size_t v = 0; v < data.mesh.positions.size(); ++v)
        farthest = std::max(farthest, glm::distance(DVec3(rounded.mesh.positions[v]),
                                                    DVec3(data.mesh.positions[v])));
      for (std::size_t j = 0; j < data.placed.positions.size(); ++j)
        farthest = std::max(farthest, glm::distance(DVec3(rounded.placed.positions[j]),
                                                    DVec3(data.placed.positions[j])));
      EXPECT_LE(farthest, static_cast<double>(report.max_position_error)) << named.name;
      for (std::uint32_t k = 0; k <= decoded->finest_level() && data.error_is_measured; ++k)
        EXPECT_GE(decoded->error(k), named.model->error(k) + 0.999f * report.max_position_error);
      for (std::size_t v = 0; v < data.mesh.normals.size(); ++v)
        ASSERT_GT(glm::dot(rounded.mesh.normals[v], data.mesh.normals[v]), 0.999f) << named.name;
    }
  }
}

// What a stream that ends anywhere gives is the model at the last level that it holds.
void expect_level(const NamedModel& named, const ProgressiveMesh& part) {
  const std::uint32_t level = part.finest_level();
  const ProgressiveMesh& whole = *named.model;
  ASSERT_LE(level, whole.finest_level());
  EXPECT_EQ(part.vertex_count(level), whole.vertex_count(level));
  EXPECT_EQ(part.error(level), whole.error(level));
  const auto shared = std::make_shared<ProgressiveMesh>(part);
  ProgressiveMeshInstance instance(shared);
  ProgressiveMeshInstance reference(named.model);
  for (const std::uint32_t k : {level, level / 2, 0u, level}) {
    instance.go_to_level(k);
    reference.go_to_level(k);
    EXPECT_EQ(mesh_difference(instance.extract(), reference.extract()), "")
        << named.name << " level " << k << " of " << level;
  }
}

TEST(PmEncoding, EveryPrefixIsAMesh) {
  for (const NamedModel* named : small_models(120)) {
    EncodeReport report;
    const Bytes bytes = encode_progressive_mesh(*named->model, {}, &report);
    std::uint32_t last_level = 0;
    for (std::size_t size = 0; size <= bytes.size(); ++size) {
      const auto part = decode_progressive_mesh(prefix(bytes, size));
      ASSERT_EQ(part.has_value(), size >= report.base_bytes) << named->name << " " << size;
      if (!part) continue;
      ASSERT_GE(part->finest_level(), last_level);
      const bool is_new = part->finest_level() > last_level || size == report.base_bytes;
      last_level = part->finest_level();
      if (is_new) expect_level(*named, *part);
    }
    EXPECT_EQ(last_level, named->model->finest_level());
  }
}

TEST(PmEncoding, PrefixesOfLargeMeshes) {
  for (const NamedModel& named : all_models()) {
    const Bytes bytes =
        encode_progressive_mesh(named.model->finest_level() > 0 ? *named.model : ProgressiveMesh{});
    for (const std::uint32_t level : spread_levels(named.model->finest_level())) {
      const auto size = progressive_mesh_prefix(bytes, level);
      ASSERT_TRUE(size) << named.name;
      ASSERT_LE(*size, bytes.size());
      const auto part = decode_progressive_mesh(prefix(bytes, *size));
      ASSERT_TRUE(part) << named.name;
      EXPECT_EQ(part->finest_level(), level);
      if (level % 7 == 0 && level > 0) expect_level(named, *part);
    }
  }
}

TEST(PmEncoding, BytesOneByOne) {
  for (const NamedModel* named : small_models(700)) {
    const Bytes bytes = encode_progressive_mesh(*named->model);
    ProgressiveStreamReader reader;
    EXPECT_EQ(reader.draw_list().indices.size(), 0u);
    std::uint32_t shown = 0;
    for (const std::byte& byte : bytes) {
      ASSERT_TRUE(reader.push({&byte, 1})) << named->name;
      if (!reader.has_base() || reader.level() < shown) continue;
      EXPECT_EQ(mesh_difference(reader.extract(), level_mesh(*named, reader.level())), "");
      EXPECT_EQ(submitted_triangles(reader.draw_list()), reader.triangle_count());
      shown = reader.level() + 1 + reader.finest_level() / 20;
    }
    EXPECT_EQ(reader.bytes_used(), bytes.size());
    EXPECT_EQ(reader.level(), reader.finest_level());
    const auto decoded = std::move(reader).finish();
    ASSERT_TRUE(decoded);
    EXPECT_EQ(difference(named->model->data(), decoded->data()), "") << named->name;
  }
}

TEST(PmEncoding, PiecesOfRandomSizes) {
  Random random(1);
  for (const NamedModel& named : all_models()) {
    const Bytes bytes = encode_progressive_mesh(*named.model);
    ProgressiveStreamReader reader;
    for (std::size_t at = 0; at < bytes.size();) {
      const std::size_t size = std::min<std::size_t>(random.below(300), bytes.size() - at);
      ASSERT_TRUE(reader.push(std::span(bytes).subspan(at, size)));
      at += size;
    }
    const auto decoded = std::move(reader).finish();
    ASSERT_TRUE(decoded);
    EXPECT_EQ(difference(named.model->data(), decoded->data()), "") << named.name;
  }
}

// An error of one line with an offset, or a model of which every level can be drawn.
void expect_fault_or_model(const std::string& name, std::span<const std::byte> bytes) {
  const auto decoded = decode_progressive_mesh(bytes);
  if (!decoded) {
    EXPECT_EQ(decoded.error().kind, ErrorKind::kInvalidInput);
    EXPECT_EQ(decoded.error().message.rfind("byte ", 0), 0u) << decoded.error().message;
    EXPECT_EQ(decoded.error().message.find('\n'), std::string::npos);
    return;
  }
  ProgressiveMeshInstance instance(std::make_shared<ProgressiveMesh>(*decoded));
  const std::uint32_t finest = decoded->finest_level();
  for (const std::uint32_t level : {0u, finest, finest / 2}) {
    instance.go_to_level(level);
    for (const Fault& fault : validate(instance.extract(), 1))
      ASSERT_NE(fault.severity, Severity::kBroken) << name << ": " << fault.kind;
  }
}

TEST(PmEncoding, DamagedBits) {
  for (const NamedModel* named : small_models(90)) {
    for (const int bits : {0, 12}) {
      Bytes bytes = encode_progressive_mesh(*named->model, {bits, bits, bits});
      const std::size_t step = 1 + bytes.size() / 100;
      for (std::size_t bit = 0; bit < 8 * bytes.size(); bit += bit < 480 ? 1 : step) {
        const std::byte mask{static_cast<unsigned char>(1u << (bit % 8))};
        bytes[bit / 8] ^= mask;
        expect_fault_or_model(named->name, bytes);
        bytes[bit / 8] ^= mask;
      }
    }
  }
}

TEST(PmEncoding, RandomBytesBehindAGoodBase) {
  Random random(7);
  for (const NamedModel* named : small_models(400)) {
    EncodeReport report;
    const Bytes good = encode_progressive_mesh(*named->model, {10, 0, 0}, &report);
    for (int i = 0; i < 30; ++i) {
      Bytes bytes = good;
      for (std::size_t at = report.base_bytes + random.below(40); at < bytes.size(); ++at)
        bytes[at] = std::byte(static_cast<unsigned char>(random.next()));
      expect_fault_or_model(named->name, bytes);
    }
  }
}

TEST(PmEncoding, RefusesWhatFollowsTheEnd) {
  const NamedModel named = make_model({"icosphere", icosphere(80)}, Placement::kKept);
  Bytes bytes = encode_progressive_mesh(*named.model);
  bytes.push_back(std::byte{0});
  const auto decoded = decode_progressive_mesh(bytes);
  ASSERT_FALSE(decoded);
  EXPECT_EQ(decoded.error().message,
            "byte " + std::to_string(bytes.size() - 1) + ": there are bytes behind the last split");

  ProgressiveStreamReader reader;
  EXPECT_FALSE(reader.push(bytes));
  EXPECT_FALSE(reader.push({}));  // a fault stays
}

TEST(PmEncoding, CountsThatTheBytesDoNotBear) {
  const NamedModel named = make_model({"icosphere", icosphere(80)}, Placement::kKept);
  const Bytes good = encode_progressive_mesh(*named.model);
  for (std::size_t field = 24 + 4; field < 24 + 28; field += 4) {
    Bytes bytes = good;
    for (std::size_t i = 0; i < 4; ++i) bytes[field + i] = std::byte{0x0f};
    expect_fault_or_model("count at byte " + std::to_string(field), bytes);
  }
}

TEST(PmEncoding, IsSmall) {
  TriangleMesh bare = planet({{.triangles = 20000}, 0.12f, false});
  bare.normals.clear();
  const NamedModel model = make_model({"planet", bare}, Placement::kKept);
  const double vertices = bare.vertex_count();
  const auto size = [&](const EncodeOptions& options) {
    return static_cast<double>(encode_progressive_mesh(*model.model, options).size());
  };
  EXPECT_LT(size({16, 0, 0}), 9 * vertices);
  EXPECT_LT(size({12, 0, 0}), 7 * vertices);
  EXPECT_LT(size({}), 14 * vertices);
}

}  // namespace
}  // namespace varifold::test
