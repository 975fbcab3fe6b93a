// What is accepted gives itself when it is encoded and decoded again, has the triangles that it
// says at every level, and its steps may come in any order that their requirements allow.
#include <fuzz/fuzz_support.h>
#include <varifold/base/random.h>
#include <varifold/models/vdpm/encoding.h>
#include <varifold/models/vdpm/instance.h>
#include <algorithm>
#include <memory>
#include <vector>

using namespace varifold;

namespace {

void check_list(const DrawList& list) {
  for (const DrawRange& range : list.ranges)
    fuzz::require(std::uint64_t{range.first_index} + range.index_count <= list.indices.size());
  for (const std::uint32_t v : list.indices) fuzz::require(v < list.positions.size());
}

// Splits and collapses at random.
void walk(const ViewDependentMesh& model) {
  const std::uint32_t steps = model.step_count();
  std::vector<std::uint32_t> missing(steps, 0), dependents(steps, 0);
  std::vector<std::vector<std::uint32_t>> required_by(steps);
  for (std::uint32_t k = 0; k < steps; ++k)
    model.for_each_required(k, [&](std::uint32_t coarser) {
      fuzz::require(coarser < k);
      ++missing[k];
      required_by[coarser].push_back(k);
    });
  ActiveSurface surface(model);
  Random random(steps);
  for (std::uint32_t i = 0; i < 4 * steps; ++i) {
    const std::uint32_t k = random.below(steps);
    const bool is_split = surface.is_split(k);
    if (is_split ? dependents[k] > 0 : missing[k] > 0) continue;
    if (is_split)
      surface.collapse(k);
    else
      surface.split(k);
    for (const std::uint32_t finer : required_by[k]) missing[finer] += is_split ? 1 : -1;
    model.for_each_required(k, [&](std::uint32_t r) { dependents[r] += is_split ? -1 : 1; });
  }
  check_list(surface.draw_list());
  fuzz::check(Result<ImportedMesh>(ImportedMesh{surface.extract(), {}}));
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  auto model = decode_view_dependent_mesh(fuzz::bytes(data, size));
  if (!model) {
    fuzz::check(Result<ImportedMesh>(tl::unexpected<Error>(model.error())));
    return 0;
  }
  const auto encoded = encode_view_dependent_mesh(*model);
  const auto again = decode_view_dependent_mesh(encoded);
  fuzz::require(again && encode_view_dependent_mesh(*again) == encoded);

  ViewDependentInstance instance(std::make_shared<ViewDependentMesh>(std::move(*model)));
  const std::uint32_t finest = instance.model().finest_level();
  for (const std::uint32_t level : {finest, finest / 2, 0u}) {
    instance.go_to_level(level);
    check_list(instance.draw_list());
    fuzz::require(instance.extract().triangle_count() == instance.model().triangle_count(level));
  }
  walk(instance.model());
  return 0;
}
