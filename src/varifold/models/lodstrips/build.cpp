#include <varifold/models/lodstrips/build.h>

#include <cassert>

namespace varifold {

LodStrips build_lod_strips(const DetailedMesh& detailed, const LodStripsOptions& options) {
  const bool needs_strips = options.form != LodStripsForm::kBlocks;
  return build_lod_strips(
      detailed, options.form,
      needs_strips ? stripify(detailed.mesh, options.stripify) : TriangleStrips{});
}

LodStrips build_lod_strips(const DetailedMesh& detailed, LodStripsForm form,
                           const TriangleStrips& full_strips) {
  assert(!detailed.sequence.moves_vertices());
  const auto make = [&]() -> LodStrips::Form {
    switch (form) {
      case LodStripsForm::kGrouped:
        return build_grouped_form(detailed, full_strips);
      case LodStripsForm::kThesis:
        return build_thesis_form(detailed, full_strips);
      default:
        return build_block_form(detailed);
    }
  };
  return {LevelTable(detailed.sequence), detailed.mesh, make()};
}

}  // namespace varifold
