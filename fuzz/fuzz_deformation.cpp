// Skin, poses and rig of a progressive mesh of four vertices.
#include <fuzz/fuzz_support.h>
#include <varifold/models/pm/deformation.h>

namespace {

varifold::ProgressiveMesh square() {
  varifold::ProgressiveMeshData data;
  data.mesh.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  data.mesh.indices = {0, 1, 2, 0, 2, 3};
  data.base_vertices = 4;
  data.base_triangles = 2;
  data.error = {0};
  return varifold::ProgressiveMesh(std::move(data));
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using varifold::fuzz::require;
  static const varifold::ProgressiveMesh model = square();
  const auto decoded = varifold::decode_deformation(varifold::fuzz::bytes(data, size), model);
  if (!decoded) {
    require(decoded.error().message.starts_with("byte "));
    return 0;
  }
  varifold::fuzz::check_motion(decoded->attributes());
  const auto encoded = varifold::encode_deformation(*decoded);
  if (encoded.empty()) return 0;
  const auto again = varifold::decode_deformation(encoded, model);
  require(again && varifold::encode_deformation(*again) == encoded);
  return 0;
}
