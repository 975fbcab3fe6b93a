// Groups of small meshes that tests run over: every invariant is checked on every group.
#pragma once

#include <varifold/mesh/triangle_mesh.h>
#include <cstdint>
#include <string>
#include <vector>

namespace varifold::test {

struct NamedMesh {
  std::string name;
  TriangleMesh mesh;
};

/// Closed oriented manifolds of one component without seams: genus 0, 5 and 81 (Menger sponges).
[[nodiscard]] std::vector<NamedMesh> group_closed();

/// Oriented manifolds with one or more boundary loops, of one component.
[[nodiscard]] std::vector<NamedMesh> group_open();

/// With non-manifold edges or vertices: fins, a book, tetrahedra that share a vertex or an edge,
/// cubes that share edges (and are otherwise closed).
[[nodiscard]] std::vector<NamedMesh> group_nonmanifold();

/// Vertices that share positions but not attributes: sharp boxes, spheres and a torus with texture
/// seams, two materials, a grid of colour patches.
[[nodiscard]] std::vector<NamedMesh> group_seams();

/// Several components: tetrahedra, nested spheres, a zoo of closed and open parts, loose triangles.
[[nodiscard]] std::vector<NamedMesh> group_components();

/// Nothing, one triangle, two triangles (with a common edge, with a common vertex, back to back).
[[nodiscard]] std::vector<NamedMesh> group_tiny();

/// Valid to index but unsound: unused vertices, duplicate and degenerate triangles, opposing
/// orientations, a Moebius strip, random triangle soups.
[[nodiscard]] std::vector<NamedMesh> group_defects();

/// The meshes of all groups, one after the other. Names are unique.
[[nodiscard]] std::vector<NamedMesh> all_groups();

// The pieces, for tests that want one by itself.

[[nodiscard]] TriangleMesh make_mesh(std::vector<Vec3> positions,
                                     std::vector<std::uint32_t> indices);
[[nodiscard]] TriangleMesh tetrahedron();
[[nodiscard]] TriangleMesh octahedron();
/// The cube [-1, 1]^3 with 8 vertices and 12 triangles, no attributes.
[[nodiscard]] TriangleMesh cube();
/// 20 f^2 triangles on the unit sphere, nearest to `triangles`; with normals.
[[nodiscard]] TriangleMesh icosphere(std::uint32_t triangles);
/// columns x rows squares of side 1 in the plane z = 0, seen from +z; no attributes.
[[nodiscard]] TriangleMesh grid(std::uint32_t columns, std::uint32_t rows);
/// The surface of the union of unit cubes of an n^3 lattice, one vertex per lattice point used.
[[nodiscard]] TriangleMesh voxels(std::uint32_t n, bool (*is_full)(std::uint32_t x, std::uint32_t y,
                                                                   std::uint32_t z));
/// `triangles` random triangles over `vertices` random points; corners of a triangle differ.
[[nodiscard]] TriangleMesh soup(std::uint32_t vertices, std::uint32_t triangles,
                                std::uint64_t seed);
/// Both meshes in one, the second moved by `offset`; attributes only where both have them.
[[nodiscard]] TriangleMesh join(const TriangleMesh& a, const TriangleMesh& b, const Vec3& offset);

}  // namespace varifold::test
