#include <gtest/gtest.h>
#include <tests/models/mts/mts_support.h>

#include <varifold/base/random.h>
#include <varifold/mesh/validation.h>
#include <varifold/models/mts/encoding.h>
#include <limits>

namespace varifold::test {
namespace {

using Bytes = std::vector<std::byte>;

TEST(MtsEncoding, IsTheIdentity) {
  for (const NamedMts& named : all_mts()) {
    const Bytes bytes = encode_mts(*named.model);
    const auto decoded = decode_mts(bytes);
    ASSERT_TRUE(decoded) << named.name << ": " << decoded.error().message;
    EXPECT_EQ(encode_mts(*decoded), bytes) << named.name;
    EXPECT_EQ(decoded->bytes(), named.model->bytes()) << named.name;
    const MultiresolutionStripsData& data = decoded->data();
    EXPECT_TRUE(same_attributes(data.mesh, named.model->attributes()));
    EXPECT_TRUE(same_materials(data.mesh, named.model->attributes()));
    EXPECT_EQ(data.mesh.ranges, named.model->attributes().ranges);
    EXPECT_EQ(data.node_vertex, named.model->data().node_vertex);

    const auto shared = std::make_shared<MultiresolutionStrips>(*decoded);
    MultiresolutionStripsInstance a(shared), b(named.model);
    for (const std::uint32_t level : spread_levels(shared->finest_level())) {
      a.go_to_level(level);
      b.go_to_level(level);
      ASSERT_TRUE(a.indices() == b.indices()) << named.name << ", level " << level;
    }
  }
}

TEST(MtsEncoding, EmptyModel) {
  const auto decoded = decode_mts(encode_mts(MultiresolutionStrips{}));
  ASSERT_TRUE(decoded);
  EXPECT_EQ(decoded->strip_count(), 0u);
}

// An error of one line with an offset, or a model of which every level can be drawn.
bool expect_fault_or_model(const std::string& name, std::span<const std::byte> bytes) {
  const auto decoded = decode_mts(bytes);
  if (!decoded) {
    EXPECT_EQ(decoded.error().kind, ErrorKind::kInvalidInput);
    EXPECT_EQ(decoded.error().message.rfind("byte ", 0), 0u) << decoded.error().message;
    EXPECT_EQ(decoded.error().message.find('\n'), std::string::npos);
    return false;
  }
  MultiresolutionStripsInstance instance(std::make_shared<MultiresolutionStrips>(*decoded));
  const std::uint32_t finest = decoded->finest_level();
  for (const std::uint32_t level : {0u, finest, finest / 2, finest / 3}) {
    instance.go_to_level(level);
    for (const Fault& fault : validate(instance.extract(), 1))
      EXPECT_NE(fault.severity, Severity::kBroken) << name << ": " << fault.kind;
  }
  return true;
}

std::vector<const NamedMts*> small_mts(std::uint32_t levels) {
  std::vector<const NamedMts*> small;
  for (const NamedMts& named : all_mts())
    if (named.model->finest_level() <= levels) small.push_back(&named);
  return small;
}

TEST(MtsEncoding, EveryPrefixIsAFault) {
  for (const NamedMts* named : small_mts(60)) {
    const Bytes bytes = encode_mts(*named->model);
    for (std::size_t size = 0; size < bytes.size(); ++size)
      ASSERT_FALSE(expect_fault_or_model(named->name, std::span(bytes).first(size)))
          << named->name << " " << size;
    Bytes longer = bytes;
    longer.push_back(std::byte{0});
    EXPECT_FALSE(expect_fault_or_model(named->name, longer));
  }
}

TEST(MtsEncoding, DamagedBits) {
  std::size_t refused = 0, accepted = 0;
  for (const NamedMts* named : small_mts(90)) {
    Bytes bytes = encode_mts(*named->model);
    const std::size_t step = 1 + bytes.size() / 400;
    for (std::size_t bit = 0; bit < 8 * bytes.size(); bit += step) {
      const std::byte mask{static_cast<unsigned char>(1u << (bit % 8))};
      bytes[bit / 8] ^= mask;
      ++(expect_fault_or_model(named->name, bytes) ? accepted : refused);
      bytes[bit / 8] ^= mask;
    }
  }
  EXPECT_GT(refused, accepted / 4);
}

// Many faults at once, beyond the counts, where single bits are mostly found at once.
TEST(MtsEncoding, RandomNumbersInTheStrips) {
  Random random(9);
  for (const NamedMts* named : small_mts(400)) {
    const Bytes good = encode_mts(*named->model);
    for (int i = 0; i < 60; ++i) {
      Bytes bytes = good;
      for (int j = 0; j < 3; ++j) {
        const std::size_t tail = bytes.size() / 2;
        const std::size_t at = tail + random.below(static_cast<std::uint32_t>(bytes.size() - tail));
        bytes[at] = std::byte(static_cast<unsigned char>(random.below(4)));
      }
      expect_fault_or_model(named->name, bytes);
    }
  }
}

TEST(MtsEncoding, PositionsThatAreNoNumbers) {
  MultiresolutionStripsData data = make_mts({"icosphere", icosphere(80)}, false).model->data();
  data.mesh.positions[7].y = std::numeric_limits<float>::quiet_NaN();
  EXPECT_FALSE(expect_fault_or_model("nan", encode_mts(MultiresolutionStrips(std::move(data)))));
}

TEST(MtsEncoding, CountsThatTheBytesDoNotBear) {
  const NamedMts named = make_mts({"icosphere", icosphere(80)}, false);
  const Bytes good = encode_mts(*named.model);
  for (std::size_t at = 4; at + 4 <= good.size(); at += 2) {
    Bytes bytes = good;
    for (std::size_t i = 0; i < 4; ++i) bytes[at + i] = std::byte{0x0f};
    expect_fault_or_model("count at byte " + std::to_string(at), bytes);
  }
}

}  // namespace
}  // namespace varifold::test
