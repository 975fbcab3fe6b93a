#include <benchmarks/cut_pieces.h>

#include <varifold/base/parallel.h>
#include <varifold/measure/surface_distance.h>
#include <varifold/mesh/normals.h>
#include <varifold/view/cone.h>
#include <algorithm>
#include <array>
#include <cstddef>
#include <utility>

namespace varifold::bench {
namespace {

bool is_culled(const Cut& cut, const CutPiece& piece, const ViewCriterion& view, Culling culling) {
  Box box;
  std::vector<Vec3> corners, normals;
  for (std::uint32_t t = piece.first_triangle; t < piece.first_triangle + piece.triangle_count;
       ++t) {
    for (std::size_t c = 0; c < 3; ++c)
      corners.push_back(cut.mesh.positions[cut.mesh.indices[3 * std::size_t{t} + c]]);
    normals.push_back(face_normal(cut.mesh, t));
  }
  for (const Vec3& corner : corners) box.add(corner);
  if (corners.empty()) return true;
  Sphere ball{box.center(), 0};
  for (const Vec3& corner : corners)
    ball.radius = std::max(ball.radius, glm::length(corner - ball.center));
  if (classify(view.frustum, ball) == Containment::kOutside) return true;
  return culling == Culling::kFrustumAndTurned &&
         is_back_facing(cone_around(normals), ball, view.eye);
}

// A position in an order of all of them; both zeros are one.
using Place = std::array<float, 3>;
Place place_of(const Vec3& p) { return {p.x + 0.0f, p.y + 0.0f, p.z + 0.0f}; }

// Edges with the number of triangles that run along them one way less that of the other.
using Border = std::vector<std::pair<std::pair<Place, Place>, int>>;

Border border_of(const TriangleMesh& mesh) {
  Border edges;
  for (std::size_t t = 0; t < mesh.indices.size(); t += 3)
    for (std::size_t c = 0; c < 3; ++c) {
      const Place a = place_of(mesh.positions[mesh.indices[t + c]]);
      const Place b = place_of(mesh.positions[mesh.indices[t + (c + 1) % 3]]);
      if (a < b) edges.push_back({{a, b}, 1});
      if (b < a) edges.push_back({{b, a}, -1});
    }
  std::sort(edges.begin(), edges.end());
  Border border;
  for (const auto& [edge, way] : edges) {
    if (border.empty() || border.back().first != edge) {
      if (!border.empty() && border.back().second == 0) border.pop_back();
      border.emplace_back(edge, 0);
    }
    border.back().second += way;
  }
  if (!border.empty() && border.back().second == 0) border.pop_back();
  return border;
}

}  // namespace

std::uint64_t drawn_triangles(const Cut& cut, const ViewCriterion& view, Culling culling) {
  std::uint64_t sum = 0;
  for (const CutPiece& piece : cut.pieces)
    if (!is_culled(cut, piece, view, culling)) sum += piece.submitted;
  return sum;
}

std::uint64_t triangles_inside(const Cut& cut, const ViewCriterion& view) {
  std::uint64_t sum = 0;
  for (std::size_t t = 0; t < cut.mesh.indices.size(); t += 3) {
    Box box;
    for (std::size_t c = 0; c < 3; ++c) box.add(cut.mesh.positions[cut.mesh.indices[t + c]]);
    sum += classify(view.frustum, box) == Containment::kOutside ? 0 : 1;
  }
  return sum;
}

std::uint64_t submitted_triangles(const Cut& cut) {
  std::uint64_t sum = 0;
  for (const CutPiece& piece : cut.pieces) sum += piece.submitted;
  return sum;
}

std::vector<double> pixels_off(std::span<const DVec3> points, const Cut& cut,
                               const PixelScale& scale) {
  const SurfaceDistance surface(cut.mesh);
  std::vector<double> pixels(points.size());
  parallel_for(0, points.size(), 1024, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      pixels[i] = surface.distance(points[i]) * double{scale.pixels_of(1, Vec3(points[i]))};
  });
  return pixels;
}

bool has_same_border(const TriangleMesh& cut, const TriangleMesh& original) {
  return border_of(cut) == border_of(original);
}

}  // namespace varifold::bench
