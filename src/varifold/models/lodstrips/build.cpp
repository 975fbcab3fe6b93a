#include <varifold/models/lodstrips/build.h>

#include <cassert>

namespace varifold {

LodStrips build_lod_strips(const DetailedMesh& detailed, const LodStripsOptions& /*options*/) {
  assert(!detailed.sequence.moves_vertices());
  return {LevelTable(detailed.sequence), detailed.mesh, build_block_form(detailed)};
}

}  // namespace varifold
