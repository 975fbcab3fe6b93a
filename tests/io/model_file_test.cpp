#include <gtest/gtest.h>

#include <tests/support/greedy_strips.h>
#include <tests/support/meshes.h>
#include <tests/support/test_files.h>
#include <varifold/base/bytes.h>
#include <varifold/io/container.h>
#include <varifold/io/container_stream.h>
#include <varifold/io/mapped_file.h>
#include <varifold/io/model_file.h>
#include <varifold/io/output_file.h>
#include <varifold/models/lodstrips/build.h>
#include <varifold/models/lodstrips/frame_build.h>
#include <varifold/models/mts/build.h>
#include <varifold/models/patch_tree/build.h>
#include <varifold/models/pm/build.h>
#include <varifold/models/pm/instance.h>
#include <varifold/models/pm/stream_reader.h>
#include <varifold/models/strips/build.h>
#include <varifold/models/vdpm/build.h>
#include <varifold/simplify/simplify.h>
#include <algorithm>

namespace varifold {
namespace {

using test::TemporaryFolder;

ProgressiveMesh model_of(const TriangleMesh& mesh) {
  const auto simplified = simplify(mesh);
  EXPECT_TRUE(simplified);
  return build_progressive_mesh(simplified->detailed);
}

/// The mesh at the finest level.
TriangleMesh full_level(ProgressiveMesh model) {
  ProgressiveMeshInstance instance(std::make_shared<const ProgressiveMesh>(std::move(model)));
  instance.go_to_level(instance.model().finest_level());
  return instance.extract();
}

std::vector<std::byte> file_bytes(const std::filesystem::path& path) {
  const auto file = MappedFile::open(path);
  return file ? std::vector<std::byte>(file->bytes().begin(), file->bytes().end())
              : std::vector<std::byte>();
}

TEST(ModelFile, ReadsWhatWasWritten) {
  const TemporaryFolder folder;
  for (const auto& [name, mesh] : test::all_groups()) {
    const ProgressiveMesh model = model_of(mesh);
    for (const bool compress : {false, true}) {
      ModelFileOptions options;
      options.compress = compress;
      const auto written = write_model(model, folder.file("m.vfm"), options);
      ASSERT_TRUE(written) << written.error().message;
      EXPECT_EQ(written->file_bytes, std::filesystem::file_size(folder.file("m.vfm")));
      EXPECT_EQ(written->position_error, 0);
      const auto read = read_progressive_mesh(folder.file("m.vfm"));
      ASSERT_TRUE(read) << name << ": " << read.error().message;
      EXPECT_EQ(read->data().slots, model.data().slots) << name;
      EXPECT_EQ(read->data().error, model.data().error) << name;
      EXPECT_EQ(full_level(*read).positions, full_level(model).positions) << name;
      EXPECT_EQ(full_level(*read).indices, full_level(model).indices) << name;
    }
  }
}

TEST(ModelFile, RoundingIsReported) {
  const TemporaryFolder folder;
  const ProgressiveMesh model = model_of(test::icosphere(500));
  ModelFileOptions options;
  options.encoding.position_bits = 10;
  const auto written = write_model(model, folder.file("m.vfm"), options);
  ASSERT_TRUE(written);
  EXPECT_GT(written->position_error, 0);
  const auto read = read_progressive_mesh(folder.file("m.vfm"));
  ASSERT_TRUE(read);
  for (std::size_t v = 0; v < model.data().mesh.positions.size(); ++v)
    EXPECT_LE(glm::length(read->data().mesh.positions[v] - model.data().mesh.positions[v]),
              written->position_error * 1.0001f);
}

TEST(ModelFile, AnotherKindIsRefusedByName) {
  const TemporaryFolder folder;
  Chunk chunk;
  chunk.tag = kProgressiveMeshStream;
  const auto file = encode_container(fourcc("vdpm"), std::span(&chunk, 1));
  ASSERT_TRUE(write_file(folder.file("other.vfm"), *file));
  const auto read = read_progressive_mesh(folder.file("other.vfm"));
  ASSERT_FALSE(read);
  EXPECT_EQ(read.error().kind, ErrorKind::kUnsupported);
  EXPECT_NE(read.error().message.find("other.vfm"), std::string::npos);
  EXPECT_NE(read.error().message.find("vdpm"), std::string::npos);
}

TEST(ModelFile, AMissingStreamAndDamageInAnUnknownChunk) {
  const TemporaryFolder folder;
  std::vector<Chunk> chunks(1);
  chunks[0].tag = fourcc("NOTE");
  chunks[0].bytes.resize(100, std::byte{7});
  auto file = encode_container(kProgressiveMeshKind, chunks);
  ASSERT_TRUE(write_file(folder.file("m.vfm"), *file));
  auto read = read_progressive_mesh(folder.file("m.vfm"));
  ASSERT_FALSE(read);
  EXPECT_NE(read.error().message.find("STRM"), std::string::npos);

  (*file)[file->size() - 20] ^= std::byte{1};
  ASSERT_TRUE(write_file(folder.file("m.vfm"), *file));
  read = read_progressive_mesh(folder.file("m.vfm"));
  ASSERT_FALSE(read);
  EXPECT_NE(read.error().message.find("NOTE"), std::string::npos) << read.error().message;
}

TEST(ModelFile, EveryTruncationAndEveryBitIsFound) {
  const TemporaryFolder folder;
  ASSERT_TRUE(write_model(model_of(test::octahedron()), folder.file("m.vfm")));
  const std::vector<std::byte> whole = file_bytes(folder.file("m.vfm"));
  const auto read = [&](std::span<const std::byte> bytes) {
    EXPECT_TRUE(write_file(folder.file("bad.vfm"), bytes));
    const auto model = read_progressive_mesh(folder.file("bad.vfm"));
    return model ? std::string() : model.error().message;
  };
  for (std::size_t size = 0; size < whole.size(); ++size)
    EXPECT_NE(read(std::span(whole).first(size)).find("bad.vfm: "), std::string::npos) << size;
  for (std::size_t bit = 0; bit < 8 * whole.size(); bit += 7) {
    std::vector<std::byte> damaged = whole;
    damaged[bit / 8] ^= std::byte{1} << static_cast<int>(bit % 8);
    EXPECT_NE(read(damaged).find("bad.vfm: "), std::string::npos) << bit;
  }
}

TEST(ModelFile, RefinesWhileItComesThroughAPipe) {
  const TemporaryFolder folder;
  const ProgressiveMesh model = model_of(test::icosphere(2000));
  // Uncompressed: zstd hands out blocks of 128 kB at the finest.
  ASSERT_TRUE(write_model(model, folder.file("m.vfm")));
  const std::vector<std::byte> file = file_bytes(folder.file("m.vfm"));

  ContainerStream container;
  ProgressiveStreamReader reader;
  std::size_t taken = 0;
  std::uint32_t last_level = 0, steps = 0;
  for (std::size_t place = 0; place < file.size(); place += 257) {
    const auto piece =
        std::span(file).subspan(place, std::min<std::size_t>(257, file.size() - place));
    ASSERT_TRUE(container.push(piece));
    if (!container.has_table()) continue;
    const auto stream = container.bytes(container.table().chunks.size() - 1);
    ASSERT_TRUE(reader.push(stream.subspan(taken)));
    taken = stream.size();
    if (reader.has_base() && reader.level() > last_level) ++steps;
    last_level = reader.has_base() ? reader.level() : 0;
  }
  ASSERT_TRUE(container.finish());
  EXPECT_EQ(last_level, model.finest_level());
  EXPECT_GT(steps, 5u);
}

template <class Model>
Model built(const DetailedMesh& detailed);
template <>
ProgressiveMesh built(const DetailedMesh& detailed) {
  return build_progressive_mesh(detailed);
}
template <>
MultiresolutionStrips built(const DetailedMesh& detailed) {
  return build_mts(detailed, test::greedy_strips(detailed.mesh));
}
template <>
StripFramework built(const DetailedMesh& detailed) {
  return build_strip_framework(detailed, test::greedy_strips(detailed.mesh));
}
template <>
LodStrips built(const DetailedMesh& detailed) {
  return build_lod_strips(detailed);
}

template <>
FrameStrips built(const DetailedMesh& detailed) {
  auto built = build_frame_strips(detailed.mesh);
  EXPECT_TRUE(built);
  return built ? std::move(built->model) : FrameStrips();
}

template <>
ViewDependentMesh built(const DetailedMesh& detailed) {
  return build_view_dependent_mesh(detailed);
}

template <>
PatchTree built(const DetailedMesh& detailed) {
  PatchTreeOptions options;
  options.triangles_per_patch = 12;
  auto tree = build_patch_tree(detailed.mesh, options);
  EXPECT_TRUE(tree);
  return tree ? std::move(tree->tree) : PatchTree();
}

TEST(AnyModelFile, EveryKindComesBackAsItself) {
  const TemporaryFolder folder;
  for (const auto& [name, mesh] : test::all_groups()) {
    const DetailedMesh detailed = simplify(mesh)->detailed;
    AllModels::for_each([&]<class Model>() {
      const Model model = built<Model>(detailed);
      const auto written = write_model(model, folder.file("m.vfm"));
      ASSERT_TRUE(written) << written.error().message;
      EXPECT_EQ(written->file_bytes, std::filesystem::file_size(folder.file("m.vfm")));
      const auto read = read_any_model(folder.file("m.vfm"));
      ASSERT_TRUE(read) << name << ": " << read.error().message;
      EXPECT_EQ(kind_name(*read), ModelKind<Model>::kName);
      const auto* same = std::get_if<std::shared_ptr<const Model>>(&*read);
      ASSERT_TRUE(same) << name;
      EXPECT_EQ(ModelKind<Model>::encode(**same), ModelKind<Model>::encode(model)) << name;
    });
  }
}

TEST(AnyModelFile, ZstdOnlyWhereItPays) {
  const TemporaryFolder folder;
  const DetailedMesh detailed = simplify(test::icosphere(2000))->detailed;
  const MultiresolutionStrips model = built<MultiresolutionStrips>(detailed);
  const auto packed = write_model(model, folder.file("a.vfm"));
  const auto plain = write_model(model, folder.file("b.vfm"), false);
  ASSERT_TRUE(packed && plain);
  EXPECT_EQ(packed->stream_bytes, plain->stream_bytes);
  EXPECT_LT(packed->file_bytes, plain->file_bytes * 3 / 5);
  EXPECT_TRUE(read_any_model(folder.file("b.vfm")));
}

TEST(AnyModelFile, UnknownKindsNameTheKnownOnes) {
  const TemporaryFolder folder;
  const auto file = encode_container(fourcc("nope"), {});
  ASSERT_TRUE(write_file(folder.file("other.vfm"), *file));
  const auto read = read_any_model(folder.file("other.vfm"));
  ASSERT_FALSE(read);
  EXPECT_EQ(read.error().kind, ErrorKind::kUnsupported);
  EXPECT_EQ(read.error().message.find('\n'), std::string::npos);
  for (const char* part : {"other.vfm", "nope", "pm", "mts"})
    EXPECT_NE(read.error().message.find(part), std::string::npos) << read.error().message;
}

TEST(AnyModelFile, EveryTruncationAndBitOfEveryKindIsFound) {
  const TemporaryFolder folder;
  const DetailedMesh detailed = simplify(test::octahedron())->detailed;
  AllModels::for_each([&]<class Model>() {
    ASSERT_TRUE(write_model(built<Model>(detailed), folder.file("m.vfm")));
    const std::vector<std::byte> whole = file_bytes(folder.file("m.vfm"));
    const auto is_refused = [&](std::span<const std::byte> bytes) {
      EXPECT_TRUE(write_file(folder.file("bad.vfm"), bytes));
      const auto model = read_any_model(folder.file("bad.vfm"));
      return !model && model.error().message.find("bad.vfm: ") != std::string::npos;
    };
    for (std::size_t size = 0; size < whole.size(); size += 3)
      EXPECT_TRUE(is_refused(std::span(whole).first(size))) << ModelKind<Model>::kName << size;
    for (std::size_t bit = 0; bit < 8 * whole.size(); bit += 13) {
      std::vector<std::byte> damaged = whole;
      damaged[bit / 8] ^= std::byte{1} << static_cast<int>(bit % 8);
      EXPECT_TRUE(is_refused(damaged)) << ModelKind<Model>::kName << bit;
    }
  });
}

}  // namespace
}  // namespace varifold
