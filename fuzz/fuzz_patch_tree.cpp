// What is accepted gives itself when it is encoded and decoded again, can be drawn at every level
// and at fronts of all sorts, and keeps to budgets. Checksums are not looked at, or else nothing
// else would be.
#include <fuzz/fuzz_support.h>
#include <varifold/base/random.h>
#include <varifold/models/patch_tree/encoding.h>
#include <varifold/models/patch_tree/extract.h>
#include <varifold/models/patch_tree/instance.h>
#include <memory>
#include <utility>

using namespace varifold;

namespace {

void look_at(PatchTreeInstance& instance) {
  const DrawList list = instance.draw_list();
  for (const DrawRange& range : list.ranges) {
    const std::size_t end = std::size_t{range.first_index} + range.index_count;
    fuzz::require(end <= list.indices.size());
    for (std::size_t i = range.first_index; i < end; ++i)
      fuzz::require(list.indices[i] < list.positions.size());
  }
  fuzz::require(is_legal(instance.model().topology(), instance.split_flags()));
  fuzz::check(Result<ImportedMesh>(ImportedMesh{instance.extract(), {}}));
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  auto tree = decode_patch_tree(fuzz::bytes(data, size), Checksums::kTrust);
  if (!tree) {
    fuzz::check(Result<ImportedMesh>(tl::unexpected<Error>(tree.error())));
    return 0;
  }
  const auto encoded = encode_patch_tree(*tree);
  const auto again = decode_patch_tree(encoded);
  fuzz::require(again && encode_patch_tree(*again) == encoded);

  const auto model = std::make_shared<const PatchTree>(std::move(*tree));
  PatchTreeInstance instance(model);
  const std::uint32_t finest = model->finest_level();
  for (const std::uint32_t level : {finest, finest / 2, 0u}) {
    instance.go_to_level(level);
    fuzz::require(instance.triangle_count() == model->triangle_count(level));
    look_at(instance);
  }
  Random random(size);
  for (int i = 0; i < 4; ++i) {
    RefineCriteria criteria;
    const auto coordinate = [&] { return static_cast<float>(2 * random.uniform() - 1); };
    criteria.sphere = Sphere{Vec3(coordinate(), coordinate(), coordinate()), 0.4f};
    AdaptOptions options;
    if (i % 2 == 1) options.max_triangles = random.below(300);
    const FrontStatistics front = instance.adapt(criteria, options);
    fuzz::require(front.triangles <= options.max_triangles ||
                  front.triangles == model->triangle_count(0));
    look_at(instance);
  }
  return 0;
}
