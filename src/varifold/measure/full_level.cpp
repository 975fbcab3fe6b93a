#include <varifold/measure/full_level.h>

#include <varifold/measure/front_parts.h>
#include <varifold/mesh/normals.h>
#include <varifold/mesh/validation.h>
#include <algorithm>
#include <array>
#include <string>
#include <utility>

namespace varifold::check {

FullLevel::FullLevel(TriangleMesh mesh, std::vector<CanonicalTriangle> triangles,
                     const ModelPoints& points, double rounding, int threads)
    : mesh_(std::move(mesh)),
      triangles_(std::move(triangles)),
      topology_(analyze_topology(mesh_, points.all(), threads)),
      thin_(4 * rounding),
      threads_(threads) {
  note_level(mesh_);
}

void FullLevel::note_level(const TriangleMesh& mesh) {
  has_zero_area_ = has_zero_area_ || count_zero_area(mesh) > 0;
}

void FullLevel::check_corners(const TriangleMesh& mesh, std::span<const std::uint32_t> ancestor,
                              std::span<const std::uint32_t> point_of, PlaceFaults& faults,
                              std::uint32_t place) const {
  std::vector<CanonicalTriangle> expected;
  expected.reserve(triangles_.size());
  for (CanonicalTriangle t : triangles_) {
    std::array<std::uint32_t, 3> point{};
    for (std::size_t c = 0; c < 3; ++c) {
      if (t[c] >= ancestor.size()) return faults.add("wrong_corner", place);
      t[c] = ancestor[t[c]];
      point[c] = point_of[t[c]];
    }
    if (point[0] != point[1] && point[1] != point[2] && point[0] != point[2])
      expected.push_back(canonical(t));
  }
  std::sort(expected.begin(), expected.end());
  const TriangleDifferences differences = compare_triangles(expected, canonical_triangles(mesh));
  if (differences.wrong) faults.add("wrong_corner", place);
  if (differences.lost) faults.add("lost_triangle", place);
  if (differences.doubled) faults.add("doubled_triangle", place);
}

void FullLevel::check_surface(const TriangleMesh& mesh, const WeldMap& weld, PlaceFaults& faults,
                              std::uint32_t place) const {
  const TopologyReport topology = analyze_topology(mesh, weld, threads_);
  const auto expect = [&](bool holds, const char* kind) {
    if (!holds) faults.add(kind, place);
  };
  expect(topology.closed || !topology_.closed, "not_closed");
  expect(topology.euler_characteristic == topology_.euler_characteristic, "euler_changed");
  expect(topology.components == topology_.components, "components_changed");
  expect(topology.degenerate_triangles == 0, "degenerate_triangle");
  expect(topology.duplicate_triangles <= topology_.duplicate_triangles, "new_duplicate_triangle");
  expect(topology.nonmanifold_edges <= topology_.nonmanifold_edges, "new_nonmanifold_edge");
  expect(topology.misoriented_edges <= topology_.misoriented_edges, "new_misoriented_edge");
  if (const std::size_t flipped = flipped_beyond_rounding(mesh); flipped > 0)
    faults.add("flipped_triangle", place, std::to_string(flipped) + " triangles");
}

// A triangle thinner than positions were rounded may be turned by that alone.
std::size_t FullLevel::flipped_beyond_rounding(const TriangleMesh& mesh) const {
  const auto flipped = flipped_triangles(mesh, mesh_, threads_);
  const auto is_thick = [&](std::uint32_t t) {
    const std::uint32_t* const corners = &mesh.indices[3 * std::size_t{t}];
    double longest = 0;
    for (std::size_t c = 0; c < 3; ++c)
      longest = std::max<double>(
          longest, glm::length(mesh.positions[corners[c]] - mesh.positions[corners[(c + 1) % 3]]));
    return 2 * triangle_area(mesh, t) > thin_ * longest;
  };
  return static_cast<std::size_t>(std::count_if(flipped.begin(), flipped.end(), is_thick));
}

}  // namespace varifold::check
