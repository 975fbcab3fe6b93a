#include <gtest/gtest.h>
#include <zlib.h>

#include <tests/support/test_files.h>
#include <varifold/base/random.h>
#include <varifold/render/png.h>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

namespace varifold {
namespace {

using Bytes = std::vector<std::byte>;

Image8 noise(int width, int height) {
  Random random(1);
  Image8 image{width, height, {}};
  for (int i = 0; i < 3 * width * height; ++i)
    image.rgb.push_back(static_cast<std::uint8_t>(random.below(256)));
  return image;
}

void append_number(Bytes& bytes, std::uint32_t value) {
  for (int shift = 24; shift >= 0; shift -= 8)
    bytes.push_back(static_cast<std::byte>(value >> shift & 255));
}

void append_chunk(Bytes& bytes, const std::string& type, const Bytes& data) {
  append_number(bytes, static_cast<std::uint32_t>(data.size()));
  const std::size_t start = bytes.size();
  for (const char c : type) bytes.push_back(static_cast<std::byte>(c));
  bytes.insert(bytes.end(), data.begin(), data.end());
  const auto* summed = reinterpret_cast<const Bytef*>(bytes.data() + start);
  append_number(
      bytes, static_cast<std::uint32_t>(crc32(0, summed, static_cast<uInt>(bytes.size() - start))));
}

/// A grey PNG: `rows` holds the bytes of each row after its filter byte.
Bytes grey_png(std::uint32_t width, std::uint32_t height, int bits, const Bytes& rows) {
  Bytes bytes;
  for (const int c : {0x89, 'P' + 0, 'N' + 0, 'G' + 0, 13, 10, 26, 10})
    bytes.push_back(static_cast<std::byte>(c));
  Bytes header;
  append_number(header, width);
  append_number(header, height);
  for (const int c : {bits, 0, 0, 0, 0}) header.push_back(static_cast<std::byte>(c));
  append_chunk(bytes, "IHDR", header);
  uLongf size = compressBound(static_cast<uLong>(rows.size()));
  Bytes packed(size);
  compress(reinterpret_cast<Bytef*>(packed.data()), &size,
           reinterpret_cast<const Bytef*>(rows.data()), static_cast<uLong>(rows.size()));
  packed.resize(size);
  append_chunk(bytes, "IDAT", packed);
  append_chunk(bytes, "IEND", {});
  return bytes;
}

Bytes bytes_of(std::initializer_list<int> values) {
  Bytes bytes;
  for (const int value : values) bytes.push_back(static_cast<std::byte>(value));
  return bytes;
}

TEST(Png, WritesWhatItReads) {
  for (const auto& [width, height] : {std::pair(1, 1), std::pair(7, 3), std::pair(64, 50)}) {
    const Image8 image = noise(width, height);
    const auto bytes = write_png(image);
    ASSERT_TRUE(bytes);
    const auto again = read_png(*bytes);
    ASSERT_TRUE(again) << again.error().message;
    EXPECT_TRUE(*again == image);
  }
}

TEST(Png, RefusesToWriteWhatIsNoPicture) {
  EXPECT_FALSE(write_png(Image8{}));
  EXPECT_FALSE(write_png(Image8{2, 2, {1, 2, 3}}));
}

TEST(Png, GreyBecomesThreeEqualChannels) {
  const auto image = read_png(grey_png(2, 1, 8, bytes_of({0, 5, 200})));
  ASSERT_TRUE(image) << image.error().message;
  EXPECT_EQ(image->rgb, (std::vector<std::uint8_t>{5, 5, 5, 200, 200, 200}));
}

TEST(HeightMap, KeepsAll16Bits) {
  const auto map =
      read_height_map(grey_png(2, 2, 16, bytes_of({0, 0, 0, 0, 1, 0, 0x12, 0x34, 255, 255})));
  ASSERT_TRUE(map) << map.error().message;
  EXPECT_EQ(map->width, 2);
  EXPECT_EQ(map->height, 2);
  const std::vector<float> expected = {0, 1 / 65535.0f, 0x1234 / 65535.0f, 1};
  EXPECT_EQ(map->heights, expected);
}

TEST(HeightMap, TakesEightBitsAndColors) {
  const auto map = read_height_map(grey_png(3, 1, 8, bytes_of({0, 0, 51, 255})));
  ASSERT_TRUE(map) << map.error().message;
  EXPECT_EQ(map->heights, (std::vector<float>{0, 0.2f, 1}));
  const auto colored = read_height_map(*write_png(Image8{2, 1, {255, 255, 255, 0, 255, 0}}));
  ASSERT_TRUE(colored);
  EXPECT_NEAR(colored->heights[0], 1, 1e-6);
  EXPECT_NEAR(colored->heights[1], 0.7152f, 1e-6);
}

TEST(HeightMap, ReadsARealTerrain) {
  VARIFOLD_REAL_MESH_OR_SKIP(path, "gcanyon_elevation.png");
  std::ifstream file(path, std::ios::binary);
  const std::vector<char> bytes{std::istreambuf_iterator<char>(file), {}};
  const auto map = read_height_map(std::as_bytes(std::span(bytes)));
  ASSERT_TRUE(map) << map.error().message;
  EXPECT_EQ(map->heights.size(), static_cast<std::size_t>(map->width) * map->height);
}

TEST(Png, ErrorsAreClear) {
  EXPECT_EQ(read_png({}).error().message, "not a PNG file");
  EXPECT_EQ(read_height_map(bytes_of({'P', '6', ' ', '1'})).error().message, "not a PNG file");
  const auto huge = read_png(grey_png(100000, 2, 8, bytes_of({0})));
  EXPECT_EQ(huge.error().kind, ErrorKind::kUnsupported);
  EXPECT_EQ(huge.error().message, "PNG: 100000 x 2 pixels, at most 16384 a side");
  EXPECT_EQ(read_png(grey_png(0, 2, 8, bytes_of({0}))).error().message, "PNG: no pixels");
  EXPECT_EQ(read_png(grey_png(64, 64, 8, bytes_of({0}))).error().kind, ErrorKind::kInvalidInput);
}

TEST(Png, SmallFilesGetLittleMemory) {
  // 16384 x 16384 with 16 bits would take half a GiB before the first fault is found.
  const auto bomb = read_height_map(grey_png(16384, 16384, 16, bytes_of({0})));
  EXPECT_EQ(bomb.error().kind, ErrorKind::kInvalidInput);
  EXPECT_EQ(bomb.error().message, "PNG: the file is too short for 16384 x 16384 pixels");
  // Pictures of one colour shrink the most, and are read.
  const auto plain = write_png(Image8{4096, 4096, std::vector<std::uint8_t>(3 * 4096 * 4096, 7)});
  ASSERT_TRUE(plain);
  EXPECT_TRUE(read_height_map(*plain));
}

TEST(Png, EveryTruncationIsAnError) {
  const auto whole = write_png(noise(9, 9));
  ASSERT_TRUE(whole);
  constexpr std::size_t kEndChunk = 12;  // its last bytes carry nothing
  for (std::size_t size = 0; size + kEndChunk <= whole->size(); ++size) {
    // A copy of exactly that size, so that sanitizers see a read beyond it.
    const Bytes cut(whole->begin(), whole->begin() + static_cast<std::ptrdiff_t>(size));
    EXPECT_FALSE(read_png(cut)) << size;
    EXPECT_FALSE(read_height_map(cut)) << size;
  }
}

TEST(Png, DamageNeverCrashes) {
  const auto whole = write_png(noise(9, 9));
  ASSERT_TRUE(whole);
  Random random(2);
  for (int i = 0; i < 5000; ++i) {
    Bytes damaged = *whole;
    // The size may become large but valid, which costs time and proves nothing.
    const auto place = 24 + random.below(static_cast<std::uint32_t>(damaged.size()) - 24);
    damaged[place] = static_cast<std::byte>(random.below(256));
    (void)read_png(damaged);
    (void)read_height_map(damaged);
  }
}

}  // namespace
}  // namespace varifold
