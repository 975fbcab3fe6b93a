#include <varifold/mesh/vertex_arrays.h>
#include <varifold/morph/disc_cuts.h>
#include <varifold/morph/sphere_triangulation.h>
#include <algorithm>
#include <array>
#include <numeric>
#include <type_traits>
#include <utility>

namespace varifold {
namespace {

// Appends triangles of a mesh with their materials, which must come one after the other.
class TriangleWriter {
 public:
  explicit TriangleWriter(TriangleMesh& mesh)
      : mesh_(mesh), has_ranges_(!mesh.ranges.empty()), materials_(triangle_materials(mesh)) {
    mesh_.ranges.clear();
  }

  void add(std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t source) {
    const std::uint32_t triangle = static_cast<std::uint32_t>(indices_.size() / 3);
    indices_.insert(indices_.end(), {a, b, c});
    if (!has_ranges_) return;
    const std::uint32_t material = materials_[source];
    if (mesh_.ranges.empty() || mesh_.ranges.back().material != material)
      mesh_.ranges.push_back({material, triangle, 0});
    ++mesh_.ranges.back().triangle_count;
  }
  void finish() { mesh_.indices = std::move(indices_); }

 private:
  TriangleMesh& mesh_;
  bool has_ranges_;
  std::vector<std::uint32_t> materials_, indices_;
};

class EdgeCutter {
 public:
  EdgeCutter(DiscMesh& disc, std::span<const EdgeCut> cuts) : disc_(disc), cuts_(cuts) {
    SphereSurface& surface = disc.surface;
    const auto first = static_cast<std::uint32_t>(surface.positions.size());
    for (std::uint32_t i = 0; i < cuts.size(); ++i) {
      const EdgeCut& cut = cuts[i];
      const DVec3 from(surface.positions[surface.indices[cut.half_edge]]);
      const DVec3 to(surface.positions[surface.indices[next_half_edge(cut.half_edge)]]);
      surface.positions.emplace_back(from + cut.at * (to - from));
      places_.push_back({cut.half_edge, first + i, i, cut.at});
      if (cut.opposite != kNone) places_.push_back({cut.opposite, first + i, i, 1 - cut.at});
    }
    std::sort(places_.begin(), places_.end(), [](const Place& p, const Place& q) {
      if (p.half_edge != q.half_edge) return p.half_edge < q.half_edge;
      return p.at != q.at ? p.at < q.at : p.point < q.point;
    });
  }

  void run() {
    TriangleWriter writer(disc_.mesh);
    SphereSurface& surface = disc_.surface;
    std::vector<std::uint32_t> points;
    std::vector<Corner> polygon;
    made_.resize(cuts_.size(), {{kNone, kNone}, kNone});
    const auto count = static_cast<std::uint32_t>(surface.indices.size() / 3);
    std::size_t next = 0;
    for (std::uint32_t t = 0; t < count; ++t) {
      std::size_t apex = 0;
      gather(t, next, polygon, apex);
      for (std::size_t i = 1; i + 1 < polygon.size(); ++i) {
        const Corner &a = polygon[apex], &b = polygon[(apex + i) % polygon.size()],
                     &c = polygon[(apex + i + 1) % polygon.size()];
        writer.add(a.vertex, b.vertex, c.vertex, t);
        points.insert(points.end(), {a.point, b.point, c.point});
      }
    }
    writer.finish();
    surface.indices = std::move(points);
    surface.triangles.resize(surface.indices.size() / 3);
    std::iota(surface.triangles.begin(), surface.triangles.end(), 0u);
    surface.point_of_vertex.resize(disc_.mesh.vertex_count(), kNone);
    for (std::size_t corner = 0; corner < surface.indices.size(); ++corner)
      surface.point_of_vertex[disc_.mesh.indices[corner]] = surface.indices[corner];
    surface.boundary = find_boundary(surface);
  }

 private:
  struct Place {  // of a cut, on one side of its edge
    std::uint32_t half_edge, point, cut;
    double at;
  };
  struct Corner {
    std::uint32_t point, vertex;
  };

  // The corners of a triangle and what lies on its edges; and what to fan about.
  void gather(std::uint32_t triangle, std::size_t& next, std::vector<Corner>& polygon,
              std::size_t& apex) {
    polygon.clear();
    int edges = 0;
    std::size_t first_new = 0, across = 0;
    for (std::uint32_t h = 3 * triangle; h < 3 * triangle + 3; ++h) {
      polygon.push_back({disc_.surface.indices[h], disc_.mesh.indices[h]});
      if (next == places_.size() || places_[next].half_edge != h) continue;
      if (edges++ == 0) first_new = polygon.size();
      for (; next < places_.size() && places_[next].half_edge == h; ++next)
        polygon.push_back({places_[next].point, vertex_at(places_[next])});
      // The corner across comes two corners after the one that the edge begins at.
      across = h % 3 == 0 ? polygon.size() + 1 : h % 3 == 1 ? 0 : 1;
    }
    apex = edges == 1 ? across : first_new;
  }

  // The vertex of a cut on one side, that of the other one where no seam runs along the edge.
  std::uint32_t vertex_at(const Place& place) {
    TriangleMesh& mesh = disc_.mesh;
    const std::uint32_t from = mesh.indices[place.half_edge],
                        to = mesh.indices[next_half_edge(place.half_edge)];
    auto& [ends, vertex] = made_[place.cut];
    const std::array<std::uint32_t, 2> own{std::min(from, to), std::max(from, to)};
    if (vertex != kNone && ends == own) return vertex;
    for_each_vertex_array(mesh, [&]<class Value>(std::vector<Value>& values) {
      if constexpr (!std::is_same_v<Value, JointWeights>) {
        if (values.empty()) return;
        using Sum = glm::vec<Value::length(), double>;
        Sum sum = (1 - place.at) * Sum(values[from]) + place.at * Sum(values[to]);
        if constexpr (std::is_integral_v<typename Value::value_type>) sum += 0.5;
        values.push_back(Value(sum));
      }
    });
    // Both sides of a seam are at one place, bit by bit.
    mesh.positions.back() = disc_.surface.positions[place.point];
    if (mesh.has_normals()) mesh.normals.back() = normalize_or_zero(mesh.normals.back());
    ends = own;
    vertex = mesh.vertex_count() - 1;
    return vertex;
  }

  DiscMesh& disc_;
  std::span<const EdgeCut> cuts_;
  std::vector<Place> places_;  // by half-edge, along it
  std::vector<std::pair<std::array<std::uint32_t, 2>, std::uint32_t>> made_;  // per cut, the last
};

}  // namespace

DiscMesh to_disc_mesh(const TriangleMesh& mesh, SphereSurface surface) {
  DiscMesh disc;
  disc.mesh = mesh;
  disc.mesh.poses.clear(), disc.mesh.skin.clear(), disc.mesh.rig.reset();
  TriangleWriter writer(disc.mesh);
  for (const std::uint32_t t : surface.triangles) {
    const std::uint32_t* const corner = &mesh.indices[3 * std::size_t{t}];
    writer.add(corner[0], corner[1], corner[2], t);
  }
  writer.finish();
  disc.surface = std::move(surface);
  std::iota(disc.surface.triangles.begin(), disc.surface.triangles.end(), 0u);
  return disc;
}

void cut_edges(DiscMesh& disc, std::span<const EdgeCut> cuts) {
  if (!cuts.empty()) EdgeCutter(disc, cuts).run();
}

void cut_chords(DiscMesh& disc) {
  const SphereSurface& surface = disc.surface;
  std::vector<bool> is_boundary(surface.positions.size(), false);
  for (const std::uint32_t point : surface.boundary) is_boundary[point] = true;
  const SphereTriangulation triangles(surface.indices,
                                      std::vector<SpherePoint>(surface.positions.size()));
  std::vector<EdgeCut> cuts;
  for (const std::uint32_t h : triangles.edge_half)
    if (triangles.opposite[h] != kNone && is_boundary[triangles.from(h)] &&
        is_boundary[triangles.to(h)])
      cuts.push_back({h, triangles.opposite[h], 0.5});
  cut_edges(disc, cuts);
}

}  // namespace varifold
