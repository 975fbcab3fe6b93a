// What is accepted gives itself when it is encoded and decoded again, has the triangles that it
// says at every level, and can be drawn at any front, with any dependencies.
#include <fuzz/fuzz_support.h>
#include <varifold/models/strips/encoding.h>
#include <varifold/models/strips/instance.h>
#include <memory>

using namespace varifold;

namespace {

void check_list(StripFrameworkInstance& instance) {
  const DrawList list = instance.draw_list();
  for (const DrawRange& range : list.ranges)
    for (const std::uint32_t v : list.indices.subspan(range.first_index, range.index_count))
      fuzz::require(v < list.positions.size() || v == kStripRestart);
  fuzz::check(Result<ImportedMesh>(ImportedMesh{instance.extract(), {}}));
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  auto model = decode_strip_framework(fuzz::bytes(data, size));
  if (!model) {
    fuzz::check(Result<ImportedMesh>(tl::unexpected<Error>(model.error())));
    return 0;
  }
  const auto encoded = encode_strip_framework(*model);
  const auto again = decode_strip_framework(encoded);
  fuzz::require(again && encode_strip_framework(*again) == encoded);

  StripFrameworkInstance instance(std::make_shared<StripFramework>(std::move(*model)));
  const std::uint32_t finest = instance.model().finest_level();
  RefineCriteria criteria;
  criteria.view.emplace(Camera{});
  criteria.view->light = LightCriterion{};
  for (const std::uint32_t level : {finest, finest / 2, 0u}) {
    instance.go_to_level(level);
    check_list(instance);
    fuzz::require(instance.extract().triangle_count() == instance.model().triangle_count(level));
    criteria.sphere = Sphere{{0.5f, 0.5f, 0}, 0.1f};
    instance.adapt(criteria, {.tolerance = 1, .max_triangles = level});
    check_list(instance);
  }
  return 0;
}
