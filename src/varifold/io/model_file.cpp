#include <varifold/io/container.h>
#include <varifold/io/model_file.h>
#include <varifold/io/output_file.h>

#include <span>
#include <utility>

namespace varifold {

Result<ModelFileReport> write_model(const ProgressiveMesh& model, const std::filesystem::path& path,
                                    const ModelFileOptions& options) {
  ModelFileReport report;
  EncodeReport encoded;
  Chunk stream;
  stream.tag = kProgressiveMeshStream;
  stream.bytes = encode_progressive_mesh(model, options.encoding, &encoded);
  stream.compress = options.compress;
  report.stream_bytes = stream.bytes.size();
  report.base_bytes = encoded.base_bytes;
  report.position_error = encoded.max_position_error;
  const auto file = encode_container(kProgressiveMeshKind, std::span(&stream, 1));
  if (!file) return fail_in(path.string(), file.error());
  report.file_bytes = file->size();
  if (auto written = write_file(path, *file); !written) return tl::unexpected(written.error());
  return report;
}

Result<ProgressiveMesh> read_progressive_mesh(const std::filesystem::path& path) {
  auto container = Container::open(path);
  if (!container) return tl::unexpected(std::move(container.error()));
  if (container->kind() != kProgressiveMeshKind)
    return fail(ErrorKind::kUnsupported, path.string() + ": a model of kind " +
                                             fourcc_name(container->kind()) +
                                             ", not a progressive mesh");
  // Damage in chunks that are not looked at here is damage all the same.
  if (auto verified = container->verify(); !verified)
    return tl::unexpected(std::move(verified.error()));
  const auto stream = container->find(kProgressiveMeshStream);
  if (!stream) return tl::unexpected(stream.error());
  auto model = decode_progressive_mesh(*stream);
  if (!model)
    return fail_in(path.string() + ": chunk " + fourcc_name(kProgressiveMeshStream),
                   std::move(model.error()));
  return model;
}

}  // namespace varifold
