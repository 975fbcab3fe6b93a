#include <varifold/io/container.h>
#include <varifold/io/model_file.h>
#include <varifold/io/output_file.h>
#include <varifold/models/pm/deformation.h>
#include <span>
#include <type_traits>
#include <utility>

namespace varifold {

namespace {

Result<ModelFileReport> write_chunks(std::uint32_t kind, std::span<const Chunk> chunks,
                                     const std::filesystem::path& path) {
  ModelFileReport report;
  for (const Chunk& chunk : chunks) report.stream_bytes += chunk.bytes.size();
  const auto file = encode_container(kind, chunks);
  if (!file) return fail_in(path.string(), file.error());
  report.file_bytes = file->size();
  if (auto written = write_file(path, *file); !written) return tl::unexpected(written.error());
  return report;
}

}  // namespace

Result<ModelFileReport> write_model_chunk(std::uint32_t kind, std::uint32_t tag,
                                          std::vector<std::byte> bytes, bool compress,
                                          const std::filesystem::path& path) {
  const Chunk chunk{tag, std::move(bytes), compress};
  return write_chunks(kind, std::span(&chunk, 1), path);
}

Result<ModelFileReport> write_model(const ProgressiveMesh& model, const std::filesystem::path& path,
                                    const ModelFileOptions& options) {
  EncodeReport encoded;
  std::vector<Chunk> chunks;
  // Floats of skins and poses are not dense.
  if (std::vector<std::byte> moving = encode_deformation(model); !moving.empty())
    chunks.push_back({kDeformationChunk, std::move(moving), true});
  chunks.push_back({kProgressiveMeshStream,
                    encode_progressive_mesh(model, options.encoding, &encoded), options.compress});
  auto report = write_chunks(kProgressiveMeshKind, chunks, path);
  if (!report) return report;
  report->base_bytes = encoded.base_bytes;
  report->position_error = encoded.max_position_error;
  return report;
}

namespace {

Result<Container> open_verified(const std::filesystem::path& path) {
  auto container = Container::open(path);
  if (!container) return container;
  // Damage in chunks that are not looked at here is damage all the same.
  if (auto verified = container->verify(); !verified)
    return tl::unexpected(std::move(verified.error()));
  return container;
}

template <class Model>
Result<Model> decode_chunk(Container& container, const std::filesystem::path& path) {
  constexpr std::uint32_t kTag = ModelKind<Model>::kChunk;
  const auto chunk = container.find(kTag);
  if (!chunk) return tl::unexpected(chunk.error());
  auto model = ModelKind<Model>::decode(*chunk);
  if (!model)
    return fail_in(path.string() + ": chunk " + fourcc_name(kTag), std::move(model.error()));
  return model;
}

Result<ProgressiveMesh> decode_progressive(Container& container,
                                           const std::filesystem::path& path) {
  auto model = decode_chunk<ProgressiveMesh>(container, path);
  if (!model || !container.has(kDeformationChunk)) return model;
  const auto chunk = container.find(kDeformationChunk);
  if (!chunk) return tl::unexpected(chunk.error());
  auto moving = decode_deformation(*chunk, std::move(*model));
  if (!moving)
    return fail_in(path.string() + ": chunk " + fourcc_name(kDeformationChunk),
                   std::move(moving.error()));
  return moving;
}

}  // namespace

Result<AnyModel> read_any_model(const std::filesystem::path& path) {
  auto container = open_verified(path);
  if (!container) return tl::unexpected(std::move(container.error()));
  Result<AnyModel> read = fail(ErrorKind::kUnsupported, path.string() + ": a model of kind " +
                                                            fourcc_name(container->kind()) +
                                                            "; known are " + known_kinds());
  AllModels::for_each([&]<class Model>() {
    if (container->kind() != ModelKind<Model>::kFourcc) return;
    auto model = [&] {
      if constexpr (std::is_same_v<Model, ProgressiveMesh>)
        return decode_progressive(*container, path);
      else
        return decode_chunk<Model>(*container, path);
    }();
    if (model)
      read = AnyModel(std::make_shared<const Model>(std::move(*model)));
    else
      read = tl::unexpected(std::move(model.error()));
  });
  return read;
}

Result<ProgressiveMesh> read_progressive_mesh(const std::filesystem::path& path) {
  auto container = open_verified(path);
  if (!container) return tl::unexpected(std::move(container.error()));
  if (container->kind() != kProgressiveMeshKind)
    return fail(ErrorKind::kUnsupported, path.string() + ": a model of kind " +
                                             fourcc_name(container->kind()) +
                                             ", not a progressive mesh");
  return decode_progressive(*container, path);
}

}  // namespace varifold
