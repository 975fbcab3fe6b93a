// Private to this folder: what the check of fronts needs and what does not depend on the kind of
// model.
#pragma once

#include <varifold/measure/check_parts.h>
#include <varifold/measure/seeded_front.h>
#include <varifold/mesh/triangle_mesh.h>
#include <varifold/view/draw_list.h>
#include <array>
#include <cstdint>
#include <vector>

namespace varifold::check {

/// A triangle by what its corners are and not by their numbers: checksums of the attributes, turned
/// so that the triple is the least, and the material.
using PlacedTriangle = std::array<std::uint64_t, 4>;
/// Those of a mesh, in its order. O(n).
[[nodiscard]] std::vector<PlacedTriangle> placed_triangles(const TriangleMesh& mesh);
[[nodiscard]] std::vector<PlacedTriangle> sorted(std::vector<PlacedTriangle> triangles);

/// The triangles that a list draws over the vertices of the list, whose indices must exist.
[[nodiscard]] TriangleMesh drawn_mesh(const TriangleMesh& attributes, const DrawList& list);

/// Whether a list draws the vertices of the model as they are, so that numbers of the one are those
/// of the other.
[[nodiscard]] bool draws_attributes(const TriangleMesh& attributes, const DrawList& list);

/// The ancestor of each vertex in a front that draws those of the model: the nearest one that is of
/// the base or is drawn. A point that is there without being drawn has no triangle with three
/// different corners, and gets none by being passed over. O(vertices).
[[nodiscard]] std::vector<std::uint32_t> ancestors_in_front(const ModelPoints& points,
                                                            const TriangleMesh& drawn);

/// Those whose corners lie on a line, all three at different positions or not.
[[nodiscard]] std::uint32_t count_zero_area(const TriangleMesh& mesh);

/// Whether there is everything of the full mesh that a front asks for by places. `placed` are the
/// triangles of the full mesh in its order, `found` those of the front, sorted. O(n log n).
[[nodiscard]] bool has_all_asked_for(const SeededFront& front, const TriangleMesh& full,
                                     const std::vector<PlacedTriangle>& placed,
                                     const std::vector<PlacedTriangle>& found);

}  // namespace varifold::check
