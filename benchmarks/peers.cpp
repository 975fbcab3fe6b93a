#include <benchmarks/peers.h>

#include <meshoptimizer.h>
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

}  // namespace varifold::bench
