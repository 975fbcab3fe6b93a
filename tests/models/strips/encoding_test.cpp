#include <gtest/gtest.h>
#include <tests/models/strips/strips_support.h>

#include <varifold/base/bytes.h>
#include <varifold/base/random.h>
#include <varifold/mesh/validation.h>
#include <varifold/models/strips/encoding.h>
#include <varifold/models/strips/strip_levels.h>
#include <cstring>

namespace varifold::test {
namespace {

using Bytes = std::vector<std::byte>;

TEST(StripsEncoding, IsTheIdentity) {
  for (const NamedFramework& named : all_frameworks()) {
    const Bytes bytes = encode_strip_framework(*named.model);
    const auto decoded = decode_strip_framework(bytes);
    ASSERT_TRUE(decoded) << named.name << ": " << decoded.error().message;
    EXPECT_EQ(encode_strip_framework(*decoded), bytes) << named.name;
    EXPECT_EQ(decoded->bytes(), named.model->bytes()) << named.name;
    // The same at levels and fronts.
    StripFrameworkInstance a(named.model), b(std::make_shared<StripFramework>(*decoded));
    for (const std::uint32_t level : {named.model->finest_level() / 2, 0u, 0xffffffffu}) {
      a.go_to_level(level);
      b.go_to_level(level);
      EXPECT_EQ(difference(a, b), "") << named.name;
    }
    RefineCriteria criteria;
    criteria.sphere = Sphere{{0.5f, 0.5f, 0.5f}, 0.4f};
    criteria.view.emplace(Camera{});
    a.adapt(criteria);
    b.adapt(criteria);
    EXPECT_EQ(difference(a, b), "") << named.name;
    EXPECT_EQ(decoded->attributes().materials.size(), named.detailed.mesh.materials.size());
    EXPECT_EQ(decoded->attributes().ranges, named.detailed.mesh.ranges);
  }
}

TEST(StripsEncoding, TrianglesAddedAreThoseOfTheSequence) {
  for (const NamedFramework& named : all_frameworks()) {
    const auto added =
        strip_levels(named.detailed.mesh, named.model->levels(), named.model->full_strips()).added;
    const std::vector<std::uint32_t>& triangles = named.detailed.sequence.triangles;
    if (triangles.empty()) continue;
    EXPECT_EQ(added[0], triangles[0]) << named.name;
    for (std::size_t k = 1; k < triangles.size(); ++k)
      ASSERT_EQ(added[k], triangles[k] - triangles[k - 1]) << named.name;
  }
}

// An error of one line with an offset, or a model of which every level and front can be drawn.
// Returns whether it was a model.
bool expect_fault_or_model(const std::string& name, std::span<const std::byte> bytes) {
  const auto decoded = decode_strip_framework(bytes);
  if (!decoded) {
    EXPECT_EQ(decoded.error().kind, ErrorKind::kInvalidInput);
    EXPECT_EQ(decoded.error().message.rfind("byte ", 0), 0u) << decoded.error().message;
    EXPECT_EQ(decoded.error().message.find('\n'), std::string::npos);
    return false;
  }
  const auto model = std::make_shared<StripFramework>(*decoded);
  StripFrameworkInstance instance(model);
  const std::uint32_t finest = decoded->finest_level();
  for (const std::uint32_t level : {0u, finest, finest / 2}) {
    instance.go_to_level(level);
    const TriangleMesh mesh = instance.extract();
    EXPECT_EQ(mesh.triangle_count(), decoded->triangle_count(level)) << name;
    // Whatever the front before was.
    StripFrameworkInstance fresh(model);
    fresh.go_to_level(level);
    EXPECT_TRUE(fresh.slots() == instance.slots()) << name;
    for (const Fault& fault : validate(mesh, 1))
      EXPECT_NE(fault.severity, Severity::kBroken) << name << ": " << fault.kind;
    RefineCriteria criteria;
    criteria.view.emplace(Camera{});
    criteria.sphere = Sphere{{0, 0, 0}, 0.3f};
    instance.adapt(criteria, {.tolerance = 1, .max_triangles = 100 + level});
    const DrawList list = instance.draw_list();
    for (const DrawRange& range : list.ranges)
      for (std::uint32_t i = 0; i < range.index_count; ++i) {
        const std::uint32_t index = list.indices[range.first_index + i];
        EXPECT_TRUE(index == kStripRestart || index < list.positions.size()) << name;
      }
  }
  return true;
}

TEST(StripsEncoding, EveryTruncationIsRefused) {
  for (const NamedFramework* named : small_frameworks(60)) {
    const Bytes bytes = encode_strip_framework(*named->model);
    for (std::size_t size = 0; size < bytes.size(); ++size)
      ASSERT_FALSE(decode_strip_framework(std::span(bytes).first(size))) << named->name;
    Bytes longer = bytes;
    longer.push_back(std::byte{0});
    EXPECT_FALSE(decode_strip_framework(longer)) << named->name;
  }
}

TEST(StripsEncoding, DamagedBytesAreRefusedOrHarmless) {
  Random random(9);
  std::uint32_t refused = 0, accepted = 0;
  for (const NamedFramework* named : small_frameworks(400)) {
    const Bytes bytes = encode_strip_framework(*named->model);
    for (int i = 0; i < 150; ++i) {
      Bytes damaged = bytes;
      const std::uint32_t faults = 1 + random.below(3);
      for (std::uint32_t j = 0; j < faults; ++j) {
        const std::uint32_t at = random.below(static_cast<std::uint32_t>(bytes.size()));
        damaged[at] = static_cast<std::byte>(random.next());
        // Whole words near what they were are the ones that get furthest.
        if (random.below(2) == 0 && at + 4 <= bytes.size())
          store_little(damaged.data() + at,
                       load<std::uint32_t>(bytes.data() + at) + 1 - 2 * random.below(2));
      }
      ++(expect_fault_or_model(named->name, damaged) ? accepted : refused);
    }
  }
  EXPECT_GT(refused, 500u);
  EXPECT_GT(accepted, 500u);  // damaged attributes are still attributes
}

TEST(StripsEncoding, CountsBeyondTheBytesAllocateNothing) {
  const Bytes bytes = encode_strip_framework(*small_frameworks(400).back()->model);
  for (std::size_t at = 4; at + 4 <= bytes.size(); at += 4)
    for (const std::uint32_t value : {0xffffffffu, 0x7fffffffu, 0x10000000u}) {
      Bytes damaged = bytes;
      store_little(damaged.data() + at, value);
      expect_fault_or_model("count", damaged);
    }
}

}  // namespace
}  // namespace varifold::test
