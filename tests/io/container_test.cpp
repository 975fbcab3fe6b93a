#include <varifold/io/container.h>

#include <tests/io/io_support.h>
#include <tests/support/test_files.h>
#include <varifold/base/checksum.h>
#include <varifold/base/random.h>
#include <varifold/io/container_stream.h>
#include <varifold/io/output_file.h>

namespace varifold {
namespace {

using test::message_of;
using Bytes = std::vector<std::byte>;

constexpr std::uint32_t kKind = fourcc("TEST");

Bytes bytes_of(std::string_view text) {
  const auto bytes = as_bytes(text);
  return {bytes.begin(), bytes.end()};
}

/// One chunk of each sort: compressed, as it is, empty.
std::vector<Chunk> small_chunks() {
  return {{fourcc("PACK"), Bytes(500, std::byte{7}), true},
          {fourcc("RAW1"), bytes_of("plain bytes"), false},
          {fourcc("NONE"), {}, true}};
}

Bytes small_file() { return *encode_container(kKind, small_chunks()); }

/// Text of a small alphabet: compresses, but not to nothing.
Bytes compressible(std::size_t size) {
  Random random(1);
  Bytes bytes(size);
  for (std::byte& byte : bytes) byte = static_cast<std::byte>('a' + random.below(8));
  return bytes;
}

TEST(Container, RoundTrips) {
  const Bytes file = small_file();
  EXPECT_EQ(file.size() % 16, 0u);
  VARIFOLD_ASSERT_VALUE(container, Container::parse(file));
  EXPECT_EQ(container.kind(), kKind);
  ASSERT_EQ(container.chunks().size(), 3u);
  EXPECT_TRUE(container.chunks()[0].compressed);
  EXPECT_FALSE(container.chunks()[1].compressed);
  EXPECT_FALSE(container.chunks()[2].compressed);
  for (const Chunk& chunk : small_chunks()) {
    VARIFOLD_ASSERT_VALUE(found, container.find(chunk.tag));
    EXPECT_EQ(Bytes(found.begin(), found.end()), chunk.bytes);
  }
  EXPECT_TRUE(container.has(fourcc("RAW1")));
  EXPECT_FALSE(container.has(fourcc("WHAT")));
  EXPECT_EQ(message_of(container.find(fourcc("WHAT"))), "no chunk 'WHAT'");
  EXPECT_EQ(small_file(), file) << "encoding is deterministic";
}

TEST(Container, HasTheLayoutThatIsDocumented) {
  const std::vector<Chunk> chunks{{fourcc("ABCD"), bytes_of("12345"), false}};
  const Bytes file = *encode_container(kKind, chunks);
  test::Binary expected("\x89VFM\r\n\x1a\n");
  expected.number(std::uint32_t{1}).text("TEST").number(std::uint32_t{1}).number(std::uint32_t{0});
  expected.number(std::uint64_t{96});
  expected.text("ABCD").number(std::uint32_t{0}).number(std::uint64_t{80});
  expected.number(std::uint64_t{5}).number(std::uint64_t{5}).number(checksum(chunks[0].bytes));
  expected.number(checksum(expected.bytes()));
  expected.text("12345").text(std::string(11, '\0'));
  EXPECT_EQ(file, expected.bytes());
  EXPECT_EQ(*encode_container(kKind, {}), Bytes(*encode_container(kKind, {})));
  EXPECT_EQ(encode_container(kKind, {})->size(), 48u);
}

TEST(Container, OpensFilesAndNamesThem) {
  const test::TemporaryFolder folder;
  const auto path = folder.file("a.vfm");
  ASSERT_TRUE(write_file(path, small_file()));
  VARIFOLD_ASSERT_VALUE(opened, Container::open(path));
  Container container = std::move(opened);
  VARIFOLD_ASSERT_VALUE(found, container.find(fourcc("RAW1")));
  EXPECT_EQ(as_text(found), "plain bytes");
  EXPECT_EQ(message_of(container.find(fourcc("WHAT"))), path.string() + ": no chunk 'WHAT'");
  ASSERT_TRUE(write_file(path, as_bytes("ply")));
  EXPECT_EQ(message_of(Container::open(path)), path.string() + ": byte 0: not a .vfm file");
}

TEST(Container, RefusesWhatItCannotWrite) {
  const std::vector<Chunk> twice{{fourcc("SAME"), {}, false}, {fourcc("SAME"), {}, false}};
  EXPECT_EQ(message_of(encode_container(kKind, twice)), "chunk 'SAME' twice");
  EXPECT_EQ(message_of(encode_container(kKind, std::vector<Chunk>(4097))),
            "4097 chunks are too many");
}

TEST(Container, KeepsWhatCompressesTooWellAsItIs) {
  // 100 MB of zeros pack into some KB: a reader would take that for a bomb.
  const std::vector<Chunk> chunks{{fourcc("ZERO"), Bytes(100'000'000), true}};
  VARIFOLD_ASSERT_VALUE(file, encode_container(kKind, chunks));
  VARIFOLD_ASSERT_VALUE(container, Container::parse(file));
  EXPECT_TRUE(container.verify().has_value());
}

bool is_readable(const Bytes& file) {
  auto container = Container::parse(file);
  return container && container->verify();
}

/// A message of the first call that finds a fault.
std::string fault_of(const Bytes& file) {
  auto container = Container::parse(file);
  if (!container) return message_of(container);
  return message_of(container->verify());
}

/// Replaces a number in the head and makes its checksum right again.
template <class T>
Bytes with_number(Bytes file, std::size_t at, T value, std::size_t chunk_count = 3) {
  store_little(file.data() + at, value);
  const std::size_t end = 32 + 40 * chunk_count;
  store_little(file.data() + end, checksum(std::span(file).first(end)));
  return file;
}

TEST(Container, NamesFaults) {
  const Bytes file = small_file();
  EXPECT_EQ(fault_of({}), "byte 0: the file ends in the header");
  EXPECT_EQ(fault_of(with_number(file, 8, 2u)), "byte 8: version 2 is not known");
  EXPECT_EQ(fault_of(with_number(file, 16, 5000u)), "byte 16: 5000 chunks are too many");
  EXPECT_EQ(fault_of(with_number(file, 20, 1u)), "byte 20: reserved bytes are not zero");
  EXPECT_EQ(fault_of(with_number(file, 24, std::uint64_t{1} << 63)),
            "byte 24: the file size is not believable");
  EXPECT_EQ(fault_of(with_number(file, 32 + 4, 2u)), "byte 36: unknown flags");
  EXPECT_EQ(fault_of(with_number(file, 32 + 8, std::uint64_t{161})),
            "byte 40: chunk 'PACK' is not where the one before ends");
  EXPECT_EQ(fault_of(with_number(file, 32 + 16, std::uint64_t{1} << 40)),
            "byte 48: chunk 'PACK' goes past the end of the file");
  EXPECT_EQ(fault_of(with_number(file, 32 + 24, std::uint64_t{1} << 40)),
            "byte 56: chunk 'PACK' cannot have 1099511627776 bytes");
  EXPECT_EQ(fault_of(with_number(file, 32 + 24, std::uint64_t{501})),
            "chunk 'PACK': cannot be decompressed");
  EXPECT_EQ(fault_of(with_number(file, 32 + 40, fourcc("PACK"))), "byte 72: chunk 'PACK' twice");
  EXPECT_TRUE(is_readable(with_number(file, 32 + 40, 1u))) << "other tags are fine";
  Bytes longer = file;
  longer.resize(file.size() + 16);
  EXPECT_EQ(fault_of(longer), "byte 224: the file should have 208 bytes, but has 224");
}

bool is_streamable(const Bytes& file) {
  ContainerStream stream;
  return stream.push(file) && stream.finish();
}

TEST(Container, FindsEveryTruncationAndEverySingleBitError) {
  const Bytes whole = small_file();
  ASSERT_TRUE(is_readable(whole));
  ASSERT_TRUE(is_streamable(whole));
  for (std::size_t size = 0; size < whole.size(); ++size) {
    const Bytes file(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size));
    EXPECT_FALSE(is_readable(file)) << size;
    EXPECT_FALSE(is_streamable(file)) << size;
  }
  for (std::size_t bit = 0; bit < 8 * whole.size(); ++bit) {
    Bytes file = whole;
    file[bit / 8] ^= static_cast<std::byte>(1 << bit % 8);
    EXPECT_FALSE(is_readable(file)) << "bit " << bit;
    EXPECT_FALSE(is_streamable(file)) << "bit " << bit;
  }
}

TEST(ContainerStream, GivesTheSameForPiecesOfAnySize) {
  std::vector<Chunk> chunks = small_chunks();
  chunks.push_back({fourcc("LONG"), compressible(300'000), true});
  chunks.push_back({fourcc("LAST"), {}, false});
  const Bytes file = *encode_container(kKind, chunks);
  for (const std::size_t piece : {std::size_t{1}, std::size_t{7}, std::size_t{4096}, file.size()}) {
    ContainerStream stream;
    std::size_t complete = 0;
    for (std::size_t at = 0; at < file.size(); at += piece) {
      VARIFOLD_ASSERT_VALUE(
          events, stream.push(std::span(file).subspan(at, std::min(piece, file.size() - at))));
      for (const StreamEvent& event : events) {
        if (event.kind != StreamEvent::Kind::kComplete) continue;
        EXPECT_EQ(event.chunk, complete++);
        EXPECT_EQ(stream.take(event.chunk), chunks[event.chunk].bytes);
      }
    }
    EXPECT_EQ(complete, chunks.size());
    EXPECT_TRUE(stream.finish().has_value());
    EXPECT_EQ(stream.table().kind, kKind);
    EXPECT_EQ(message_of(stream.push(as_bytes("x"))),
              "byte " + std::to_string(file.size()) + ": bytes after the end");
  }
}

TEST(ContainerStream, ShowsChunksWhileTheyGrow) {
  const Bytes content = compressible(1'000'000);
  for (const bool compress : {false, true}) {
    const std::vector<Chunk> chunks{{fourcc("GROW"), content, compress}};
    const Bytes file = *encode_container(kKind, chunks);
    ContainerStream stream;
    VARIFOLD_ASSERT_VALUE(first, stream.push(std::span(file).first(file.size() / 2)));
    ASSERT_EQ(first.size(), 2u);
    EXPECT_EQ(first[0].kind, StreamEvent::Kind::kTable);
    EXPECT_EQ(first[1].kind, StreamEvent::Kind::kGrown);
    const auto half = stream.bytes(0);
    EXPECT_GT(half.size(), content.size() / 4);
    EXPECT_TRUE(std::equal(half.begin(), half.end(), content.begin()));
    EXPECT_EQ(message_of(stream.finish()),
              "byte " + std::to_string(file.size() / 2) + ": the file ends too early");
    VARIFOLD_ASSERT_VALUE(rest, stream.push(std::span(file).subspan(file.size() / 2)));
    ASSERT_EQ(rest.size(), 1u);
    EXPECT_EQ(rest[0].kind, StreamEvent::Kind::kComplete);
    EXPECT_TRUE(stream.is_complete());
    EXPECT_EQ(stream.take(0), content);
  }
}

TEST(ContainerStream, StaysWithItsFirstError) {
  ContainerStream stream;
  const std::string message =
      message_of(stream.push(as_bytes("not a container, but 32 bytes at least")));
  EXPECT_EQ(message, "byte 0: not a .vfm file");
  EXPECT_EQ(message_of(stream.push(small_file())), message);
  EXPECT_EQ(message_of(stream.finish()), message);
}

}  // namespace
}  // namespace varifold
