// Based on: [ThuermerWuethrich1998], weights by angle.
#include <varifold/base/angle.h>
#include <varifold/base/disjoint_sets.h>
#include <varifold/base/parallel.h>
#include <varifold/mesh/normals.h>
#include <algorithm>
#include <cmath>
#include <numeric>

namespace varifold {

namespace {

constexpr std::size_t kGrain = 4096;

DVec3 normalize_double(const DVec3& v) {
  const double length = std::sqrt(glm::dot(v, v));
  return length > 0 ? v / length : DVec3(0);
}

DVec3 corner_position(const TriangleMesh& mesh, std::uint32_t triangle, int corner) {
  return DVec3(mesh.positions[mesh.indices[3 * std::size_t{triangle} + corner]]);
}

/// Normal of a triangle, weighted as it counts at the class `c`.
DVec3 weighted_normal(const TriangleMesh& mesh, const WeldMap& weld, std::uint32_t triangle,
                      std::uint32_t c, NormalWeight weight) {
  const DVec3 area = area_vector(mesh, triangle);
  if (weight == NormalWeight::kArea) return area;
  int corner = 0;
  while (corner < 2 && weld.class_of[mesh.indices[3 * std::size_t{triangle} + corner]] != c)
    ++corner;
  const DVec3 p = corner_position(mesh, triangle, corner);
  const DVec3 a = normalize_double(corner_position(mesh, triangle, (corner + 1) % 3) - p);
  const DVec3 b = normalize_double(corner_position(mesh, triangle, (corner + 2) % 3) - p);
  return arc_cosine(glm::dot(a, b)) * normalize_double(area);
}

/// The unit normal of a group of triangles around a class.
template <class Triangles>
Vec3 group_normal(const TriangleMesh& mesh, const WeldMap& weld, const Triangles& triangles,
                  std::uint32_t c, NormalWeight weight) {
  DVec3 sum(0);
  for (const std::uint32_t t : triangles) sum += weighted_normal(mesh, weld, t, c, weight);
  if (sum == DVec3(0)) {
    for (const std::uint32_t t : triangles)
      if (sum == DVec3(0)) sum = area_vector(mesh, t);
  }
  return sum == DVec3(0) ? Vec3(0, 0, 1) : Vec3(normalize_double(sum));
}

/// The groups of triangles around one class that smooth edges join.
class SmoothGroups {
 public:
  SmoothGroups(const TriangleMesh& mesh, const WeldMap& weld, double least_cosine)
      : mesh_(mesh), weld_(weld), least_cosine_(least_cosine) {}

  /// Returns, for each of the triangles, the position in the list of the first of its group.
  const std::vector<std::uint32_t>& find(std::span<const std::uint32_t> triangles,
                                         std::uint32_t c) {
    sets_.reset(triangles.size());

    // Sort the spokes by the class at their far end: the two sides of an edge become neighbours.
    spokes_.clear();
    for (std::uint32_t i = 0; i < triangles.size(); ++i)
      for (int corner = 0; corner < 3; ++corner) {
        const std::uint32_t far =
            weld_.class_of[mesh_.indices[3 * std::size_t{triangles[i]} + corner]];
        if (far != c) spokes_.emplace_back(far, i);
      }
    std::sort(spokes_.begin(), spokes_.end());

    for (std::size_t begin = 0, end = 0; begin < spokes_.size(); begin = end) {
      while (end < spokes_.size() && spokes_[end].first == spokes_[begin].first) ++end;
      if (end - begin != 2) continue;
      const std::uint32_t a = spokes_[begin].second;
      const std::uint32_t b = spokes_[begin + 1].second;
      if (is_smooth(triangles[a], triangles[b])) sets_.unite(a, b);
    }
    group_.resize(triangles.size());
    for (std::uint32_t i = 0; i < group_.size(); ++i) group_[i] = sets_.find(i);
    return group_;
  }

 private:
  [[nodiscard]] bool is_smooth(std::uint32_t t, std::uint32_t u) const {
    const DVec3 a = normalize_double(area_vector(mesh_, t));
    const DVec3 b = normalize_double(area_vector(mesh_, u));
    return glm::dot(a, b) >= least_cosine_;
  }
  const TriangleMesh& mesh_;
  const WeldMap& weld_;
  double least_cosine_;
  DisjointSets sets_;
  std::vector<std::uint32_t> group_;
  std::vector<std::pair<std::uint32_t, std::uint32_t>> spokes_;
};

/// Splits the vertices that several smooth groups use and sets their normals.
class CreaseSplitter {
 public:
  CreaseSplitter(TriangleMesh& mesh, const WeldMap& weld, const NormalOptions& options)
      : mesh_(mesh),
        weld_(weld),
        weight_(options.weight),
        groups_(mesh, weld_, least_cosine(options.crease_degrees)),
        taken_(mesh.vertex_count(), false) {}

  void split(std::uint32_t c, std::span<const std::uint32_t> triangles) {
    const std::vector<std::uint32_t>& group = groups_.find(triangles, c);
    order_.resize(triangles.size());
    std::iota(order_.begin(), order_.end(), 0u);
    std::stable_sort(order_.begin(), order_.end(),
                     [&](std::uint32_t a, std::uint32_t b) { return group[a] < group[b]; });
    for (std::size_t begin = 0, end = 0; begin < order_.size(); begin = end) {
      members_.clear();
      for (; end < order_.size() && group[order_[end]] == group[order_[begin]]; ++end)
        members_.push_back(triangles[order_[end]]);
      assign_group(c, group_normal(mesh_, weld_, members_, c, weight_));
    }
  }

 private:
  static double least_cosine(float degrees) {
    return std::cos(std::max(degrees, 0.0f) * (3.14159265358979323846 / 180));
  }

  /// Gives the members their normal; vertices that another group owns are copied.
  void assign_group(std::uint32_t c, const Vec3& normal) {
    owned_.clear();
    for (const std::uint32_t t : members_)
      for (int corner = 0; corner < 3; ++corner) {
        std::uint32_t& index = mesh_.indices[3 * std::size_t{t} + corner];
        if (weld_.class_of[index] == c) index = owned_vertex(index, normal);
      }
  }

  /// The vertex that stands for v in the present group.
  std::uint32_t owned_vertex(std::uint32_t v, const Vec3& normal) {
    for (const auto& [before, now] : owned_)
      if (before == v) return now;
    const std::uint32_t own = taken_[v] ? copy_vertex(v) : v;
    taken_[own] = true;
    mesh_.normals[own] = normal;
    owned_.emplace_back(v, own);
    return own;
  }

  std::uint32_t copy_vertex(std::uint32_t v) {
    mesh_.positions.push_back(Vec3(mesh_.positions[v]));
    mesh_.normals.push_back(Vec3(mesh_.normals[v]));
    if (mesh_.has_texcoords()) mesh_.texcoords.push_back(Vec2(mesh_.texcoords[v]));
    if (mesh_.has_colors()) mesh_.colors.push_back(Color(mesh_.colors[v]));
    weld_.class_of.push_back(std::uint32_t{weld_.class_of[v]});
    taken_.push_back(true);
    return mesh_.vertex_count() - 1;
  }

  TriangleMesh& mesh_;
  WeldMap weld_;  // grows with the copies
  NormalWeight weight_;
  SmoothGroups groups_;
  std::vector<bool> taken_;
  std::vector<std::pair<std::uint32_t, std::uint32_t>> owned_;  // vertex before, vertex now
  std::vector<std::uint32_t> order_, members_;
};

}  // namespace

DVec3 area_vector(const TriangleMesh& mesh, std::uint32_t triangle) {
  const DVec3 a = corner_position(mesh, triangle, 0);
  return 0.5 *
         glm::cross(corner_position(mesh, triangle, 1) - a, corner_position(mesh, triangle, 2) - a);
}

Vec3 face_normal(const TriangleMesh& mesh, std::uint32_t triangle) {
  return Vec3(normalize_double(area_vector(mesh, triangle)));
}

std::vector<Vec3> face_normals(const TriangleMesh& mesh, int threads) {
  std::vector<Vec3> normals(mesh.triangle_count());
  parallel_for(threads, normals.size(), kGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t t = begin; t < end; ++t)
      normals[t] = face_normal(mesh, static_cast<std::uint32_t>(t));
  });
  return normals;
}

double triangle_area(const TriangleMesh& mesh, std::uint32_t triangle) {
  const DVec3 area = area_vector(mesh, triangle);
  return std::sqrt(glm::dot(area, area));
}

double surface_area(const TriangleMesh& mesh) {
  double sum = 0;
  for (std::uint32_t t = 0; t < mesh.triangle_count(); ++t) sum += triangle_area(mesh, t);
  return sum;
}

double signed_volume(const TriangleMesh& mesh) {
  if (mesh.indices.empty()) return 0;
  // About a vertex of the mesh, so that a surface far from the origin loses no digits.
  const DVec3 origin = corner_position(mesh, 0, 0);
  double sum = 0;
  for (std::uint32_t t = 0; t < mesh.triangle_count(); ++t)
    sum += glm::dot(area_vector(mesh, t), corner_position(mesh, t, 0) - origin);
  return sum / 3;
}

void compute_normals(TriangleMesh& mesh, const NormalOptions& options) {
  compute_normals(mesh, weld_exact(mesh.positions), options);
}

void compute_normals(TriangleMesh& mesh, const WeldMap& weld, const NormalOptions& options) {
  const VertexFaces faces(mesh.indices, weld);
  mesh.normals.assign(mesh.positions.size(), Vec3(0, 0, 1));
  if (options.crease_degrees < 180) {
    CreaseSplitter splitter(mesh, weld, options);
    for (std::uint32_t c = 0; c < weld.class_count; ++c) splitter.split(c, faces.triangles_of(c));
    return;
  }

  std::vector<Vec3> of_class(weld.class_count);
  parallel_for(options.threads, of_class.size(), kGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const auto c = static_cast<std::uint32_t>(i);
      of_class[c] = group_normal(mesh, weld, faces.triangles_of(c), c, options.weight);
    }
  });
  for (std::size_t v = 0; v < mesh.positions.size(); ++v)
    mesh.normals[v] = of_class[weld.class_of[v]];
}

}  // namespace varifold
