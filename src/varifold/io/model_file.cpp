#include <varifold/io/container.h>
#include <varifold/io/model_file.h>
#include <varifold/io/output_file.h>

#include <span>
#include <utility>

namespace varifold {

Result<ModelFileReport> write_model_chunk(std::uint32_t kind, std::uint32_t tag,
                                          std::vector<std::byte> bytes, bool compress,
                                          const std::filesystem::path& path) {
  ModelFileReport report;
  report.stream_bytes = bytes.size();
  Chunk chunk;
  chunk.tag = tag;
  chunk.bytes = std::move(bytes);
  chunk.compress = compress;
  const auto file = encode_container(kind, std::span(&chunk, 1));
  if (!file) return fail_in(path.string(), file.error());
  report.file_bytes = file->size();
  if (auto written = write_file(path, *file); !written) return tl::unexpected(written.error());
  return report;
}

Result<ModelFileReport> write_model(const ProgressiveMesh& model, const std::filesystem::path& path,
                                    const ModelFileOptions& options) {
  EncodeReport encoded;
  std::vector<std::byte> bytes = encode_progressive_mesh(model, options.encoding, &encoded);
  auto report = write_model_chunk(kProgressiveMeshKind, kProgressiveMeshStream, std::move(bytes),
                                  options.compress, path);
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

}  // namespace

Result<AnyModel> read_any_model(const std::filesystem::path& path) {
  auto container = open_verified(path);
  if (!container) return tl::unexpected(std::move(container.error()));
  Result<AnyModel> read = fail(ErrorKind::kUnsupported, path.string() + ": a model of kind " +
                                                            fourcc_name(container->kind()) +
                                                            "; known are " + known_kinds());
  AllModels::for_each([&]<class Model>() {
    if (container->kind() != ModelKind<Model>::kFourcc) return;
    auto model = decode_chunk<Model>(*container, path);
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
  return decode_chunk<ProgressiveMesh>(*container, path);
}

}  // namespace varifold
