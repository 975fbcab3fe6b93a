#include <varifold/models/pm/encoding.h>
#include <varifold/models/pm/stream_reader.h>

namespace varifold {

Result<ProgressiveMesh> decode_progressive_mesh(std::span<const std::byte> bytes) {
  ProgressiveStreamReader reader;
  if (auto pushed = reader.push(bytes); !pushed) return tl::unexpected<Error>(pushed.error());
  return std::move(reader).finish();
}

Result<std::size_t> progressive_mesh_prefix(std::span<const std::byte> bytes, std::uint32_t level) {
  ProgressiveStreamReader reader(level);
  if (auto pushed = reader.push(bytes); !pushed) return tl::unexpected<Error>(pushed.error());
  const std::size_t size = reader.bytes_used();
  return std::move(reader).finish().map([&](const ProgressiveMesh&) { return size; });
}

}  // namespace varifold
