// Whole streams and streams in two pieces must agree; what is accepted can be drawn at any level
// and gives itself when it is encoded and decoded again.
#include <fuzz/fuzz_support.h>
#include <varifold/models/pm/encoding.h>
#include <varifold/models/pm/instance.h>
#include <varifold/models/pm/stream_reader.h>
#include <memory>

using namespace varifold;

namespace {

void check_level(const ProgressiveMeshInstance& instance) {
  const TriangleMesh mesh = instance.extract();
  fuzz::check(Result<ImportedMesh>(ImportedMesh{mesh, {}}));
  fuzz::require(mesh.vertex_count() == instance.vertex_count());
  fuzz::require(mesh.triangle_count() == instance.triangle_count());
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto input = fuzz::bytes(data, size);
  auto whole = decode_progressive_mesh(input);
  ProgressiveStreamReader reader;
  bool is_good = true;
  for (const auto piece : {input.first(size / 2), input.subspan(size / 2)}) {
    is_good = is_good && reader.push(piece);
    for (const std::uint32_t v : reader.draw_list().indices)
      fuzz::require(v < reader.vertex_count() || reader.vertex_count() == 0);
  }
  const auto streamed = std::move(reader).finish();
  fuzz::require(whole.has_value() == streamed.has_value());
  if (!whole) return 0;
  fuzz::require(whole->finest_level() == streamed->finest_level());

  const auto encoded = encode_progressive_mesh(*whole);
  const auto again = decode_progressive_mesh(encoded);
  fuzz::require(again && encode_progressive_mesh(*again) == encoded);
  fuzz::require(again->data().slots == whole->data().slots);
  fuzz::require(again->data().mesh.indices == whole->data().mesh.indices);

  ProgressiveMeshInstance instance(std::make_shared<ProgressiveMesh>(std::move(*whole)));
  const std::uint32_t finest = instance.model().finest_level();
  for (const std::uint32_t level : {finest, finest / 2, 0u}) {
    instance.go_to_level(level);
    check_level(instance);
  }
  return 0;
}
