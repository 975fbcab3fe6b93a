#include <benchmarks/peers.h>

#include <meshoptimizer.h>
#include <varifold/view/draw_list.h>
#include <cstddef>

namespace varifold::bench {

TriangleMesh meshoptimizer_simplify(const TriangleMesh& mesh, std::uint32_t triangles) {
  constexpr float kNoLimit = 1e10f;
  TriangleMesh simplified;
  simplified.positions = mesh.positions;
  simplified.indices.resize(mesh.indices.size());
  const std::size_t count = meshopt_simplify(
      simplified.indices.data(), mesh.indices.data(), mesh.indices.size(), &mesh.positions[0].x,
      mesh.positions.size(), sizeof(Vec3), 3 * std::size_t{triangles}, kNoLimit, 0, nullptr);
  simplified.indices.resize(count);
  return simplified;
}

std::vector<std::uint32_t> meshoptimizer_cache_order(const TriangleMesh& mesh) {
  std::vector<std::uint32_t> indices(mesh.indices.size());
  meshopt_optimizeVertexCache(indices.data(), mesh.indices.data(), mesh.indices.size(),
                              mesh.positions.size());
  return indices;
}

std::vector<std::uint32_t> meshoptimizer_strips(const TriangleMesh& mesh) {
  std::vector<std::uint32_t> list(mesh.indices.size());
  meshopt_optimizeVertexCacheStrip(list.data(), mesh.indices.data(), mesh.indices.size(),
                                   mesh.positions.size());
  std::vector<std::uint32_t> strips(meshopt_stripifyBound(list.size()));
  strips.resize(meshopt_stripify(strips.data(), list.data(), list.size(), mesh.positions.size(),
                                 kStripRestart));
  return strips;
}

}  // namespace varifold::bench
