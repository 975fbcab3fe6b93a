// Discs that tests of supermeshes run over.
#pragma once

#include <tests/support/meshes.h>
#include <varifold/mesh/triangle_mesh.h>
#include <cstdint>
#include <functional>
#include <vector>

namespace varifold::test {

/// The largest component of the triangles that are kept, judged by their middles, with all holes
/// but the longest one closed.
[[nodiscard]] TriangleMesh cut_disc(const TriangleMesh& mesh,
                                    const std::function<bool(const Vec3& middle)>& is_kept);

/// columns x rows squares over [0, 1]^2 with random diagonals, heights and small moves.
[[nodiscard]] TriangleMesh rough_grid(std::uint32_t columns, std::uint32_t rows,
                                      std::uint64_t seed);

/// A vertex in the middle of a polygon.
[[nodiscard]] TriangleMesh fan(std::uint32_t corners);

/// A band of `length` squares that turns inwards, `turns` times around; all vertices are on its
/// boundary.
[[nodiscard]] TriangleMesh spiral(std::uint32_t length, float turns);

/// A triangle on each outer edge of another disc, one of whose corners touches nothing else.
[[nodiscard]] TriangleMesh with_ears(const TriangleMesh& disc);

/// A triangulation of a polygon with random chords alone.
[[nodiscard]] TriangleMesh random_chords(std::uint32_t corners, std::uint64_t seed);

/// All kinds, small.
[[nodiscard]] std::vector<NamedMesh> small_discs();

}  // namespace varifold::test
