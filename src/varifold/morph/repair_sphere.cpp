#include <varifold/base/disjoint_sets.h>
#include <varifold/mesh/normals.h>
#include <varifold/mesh/topology.h>
#include <varifold/mesh/validation.h>
#include <varifold/mesh/vertex_arrays.h>
#include <varifold/mesh/weld.h>
#include <varifold/morph/double_edges.h>
#include <varifold/morph/half_edge_matching.h>
#include <varifold/morph/handle_loop.h>
#include <varifold/morph/repair_sphere.h>
#include <varifold/morph/sphere_triangulation.h>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <utility>

namespace varifold {
namespace {

constexpr int kMostHandles = 64;

class SphereRepair {
 public:
  SphereRepair(const TriangleMesh& mesh, const RepairOptions& options)
      : mesh_(mesh), options_(options), materials_(triangle_materials(mesh)) {}

  // With `of_handles` the mesh is closed, and one handle of it is cut.
  Result<RepairedSphere> run(bool of_handles = false) {
    collect_triangles();
    match_edges();
    keep_largest_component();
    if (corners_.empty()) return fail(ErrorKind::kInvalidInput, "no triangle is left to repair");
    match_edges();
    find_points();
    if (of_handles) cut_handle();
    make_vertices();
    close_holes();
    DoubleEdges doubled{result_.mesh, opposite_, point_of_, material_of_};
    result_.report.split_points += doubled.split(options_.keep_longest_hole);
    set_result();
    return std::move(result_);
  }

 private:
  void collect_triangles() {
    const std::vector<std::uint32_t> kept = distinct_triangles(mesh_.indices, weld_);
    for (const std::uint32_t t : kept) add_triangle(t);
    result_.report.dropped_triangles =
        mesh_.triangle_count() - static_cast<std::uint32_t>(kept.size());
  }

  void add_triangle(std::uint32_t triangle) {
    for (std::size_t k = 0; k < 3; ++k)
      corners_.push_back(mesh_.indices[3 * std::size_t{triangle} + k]);
    material_of_.push_back(materials_[triangle]);
    source_.push_back(triangle);
  }

  void match_edges() {
    std::vector<std::uint32_t> classes;
    classes.reserve(corners_.size());
    for (const std::uint32_t vertex : corners_) classes.push_back(weld_.class_of[vertex]);
    opposite_ = match_half_edges(
        classes, [&](std::uint32_t t) { return face_normal(mesh_, source_[t]); },
        result_.report.cut_edges);
  }

  void keep_largest_component() {
    const auto count = static_cast<std::uint32_t>(corners_.size() / 3);
    DisjointSets sets(count);
    for (std::uint32_t h = 0; h < corners_.size(); ++h)
      if (opposite_[h] != kNone) sets.unite(h / 3, opposite_[h] / 3);
    std::vector<std::uint32_t> size(count, 0);
    for (std::uint32_t t = 0; t < count; ++t) ++size[sets.find(t)];
    const auto largest =
        static_cast<std::uint32_t>(std::max_element(size.begin(), size.end()) - size.begin());
    RepairReport& report = result_.report;
    for (std::uint32_t t = 0; t < count; ++t)
      if (t != largest && size[t] > 0) {
        ++report.dropped_components;
        report.component_triangles += size[t];
      }
    if (report.dropped_components == 0) return;
    const std::vector<std::uint32_t> triangles = std::move(source_);
    corners_.clear(), material_of_.clear(), source_.clear();
    for (std::uint32_t t = 0; t < count; ++t)
      if (sets.find(t) == largest) add_triangle(triangles[t]);
  }

  // Opens the surface along a short way around a handle; it is closed on both sides as a hole is.
  void cut_handle() {
    const SphereTriangulation surface(point_of_, std::vector<SpherePoint>(corners_.size()));
    const std::vector<std::uint32_t> loop = find_handle_loop(surface);
    Box box;
    for (const std::uint32_t vertex : corners_) box.add(mesh_.positions[vertex]);
    float length = 0;
    for (const std::uint32_t h : loop)
      length +=
          glm::distance(mesh_.positions[corners_[h]], mesh_.positions[corners_[next_half_edge(h)]]);
    if (loop.empty() || length > options_.max_handle * box.diagonal()) return;
    for (const std::uint32_t h : loop) {
      opposite_[surface.opposite[h]] = kNone;
      opposite_[h] = kNone;
    }
    result_.report.cut_handles = 1;
    find_points();
  }

  // The corners around a fan are one point.
  void find_points() {
    DisjointSets sets(static_cast<std::uint32_t>(corners_.size()));
    for (std::uint32_t h = 0; h < corners_.size(); ++h) {
      if (opposite_[h] == kNone) continue;
      sets.unite(h, next_half_edge(opposite_[h]));
      sets.unite(next_half_edge(h), opposite_[h]);
    }
    point_of_.resize(corners_.size());
    for (std::uint32_t h = 0; h < corners_.size(); ++h) point_of_[h] = sets.find(h);
  }

  // A vertex for each vertex of the mesh and point; copies of a place apart.
  void make_vertices() {
    std::vector<std::pair<std::uint32_t, std::uint32_t>> keys;
    for (std::uint32_t h = 0; h < corners_.size(); ++h)
      keys.emplace_back(corners_[h], point_of_[h]);
    std::sort(keys.begin(), keys.end());
    keys.erase(std::unique(keys.begin(), keys.end()), keys.end());
    std::vector<std::uint32_t> kept, owner(weld_.class_count, kNone);
    for (const auto& key : keys) kept.push_back(key.first);
    TriangleMesh& mesh = result_.mesh;
    mesh = gather_vertices(mesh_, kept);
    for (std::uint32_t h = 0; h < corners_.size(); ++h)
      mesh.indices.push_back(static_cast<std::uint32_t>(
          std::lower_bound(keys.begin(), keys.end(), std::pair(corners_[h], point_of_[h])) -
          keys.begin()));
    // The first fan of a place stays there.
    std::vector<DVec3> middle(corners_.size(), DVec3(0));
    std::vector<std::uint32_t> neighbours(corners_.size(), 0);
    for (std::uint32_t h = 0; h < corners_.size(); ++h) {
      middle[point_of_[h]] += DVec3(mesh_.positions[corners_[next_half_edge(h)]]);
      ++neighbours[point_of_[h]];
    }
    std::vector<bool> is_counted(corners_.size(), false);
    for (std::size_t v = 0; v < keys.size(); ++v) {
      const std::uint32_t point = keys[v].second;
      std::uint32_t& first = owner[weld_.class_of[keys[v].first]];
      if (first == kNone) first = point;
      if (first == point) continue;
      result_.report.split_points += is_counted[point] ? 0 : 1;
      is_counted[point] = true;
      const Vec3 goal(middle[point] / static_cast<double>(neighbours[point]));
      mesh.positions[v] += kRepairNudge * (goal - mesh.positions[v]);
    }
  }

  void close_holes() {
    std::vector<bool> is_closed(corners_.size(), false);
    std::vector<std::vector<std::uint32_t>> loops;
    const auto count = static_cast<std::uint32_t>(corners_.size());
    for (std::uint32_t first = 0; first < count; ++first) {
      if (opposite_[first] != kNone || is_closed[first]) continue;
      loops.emplace_back();
      for (std::uint32_t h = first; !is_closed[h]; h = next_open(h)) {
        is_closed[h] = true;
        loops.back().push_back(h);
      }
    }
    const std::size_t kept = options_.keep_longest_hole ? longest_of(loops) : loops.size();
    for (std::size_t i = 0; i < loops.size(); ++i)
      if (i != kept && loops[i].size() >= 3 && loops[i].size() <= options_.max_hole_edges)
        close_hole(loops[i]);
  }

  std::size_t longest_of(const std::vector<std::vector<std::uint32_t>>& loops) {
    std::size_t longest = loops.size();
    double most = 0;
    for (std::size_t i = 0; i < loops.size(); ++i) {
      double length = 0;
      for (const std::uint32_t h : loops[i])
        length += glm::distance(mesh_.positions[corners_[h]],
                                mesh_.positions[corners_[next_half_edge(h)]]);
      if (length > most) most = length, longest = i;
    }
    if (longest == loops.size()) return longest;
    result_.report.open_edges = static_cast<std::uint32_t>(loops[longest].size());
    const double area = surface_area(result_.mesh);
    if (area > 0) result_.report.openness = most / std::sqrt(4 * std::numbers::pi * area);
    return longest;
  }

  // The open half-edge that begins where `open` ends, around the fan there.
  [[nodiscard]] std::uint32_t next_open(std::uint32_t open) const {
    std::uint32_t h = next_half_edge(open);
    while (opposite_[h] != kNone) h = next_half_edge(opposite_[h]);
    return h;
  }

  void close_hole(const std::vector<std::uint32_t>& loop) {
    TriangleMesh& mesh = result_.mesh;
    const auto vertex = [&](std::uint32_t h) { return mesh.indices[h]; };
    const std::uint32_t apex = mesh.vertex_count();
    const auto add_mean = [&]<class Value>(std::vector<Value>& values) {
      if (values.empty()) return;
      glm::vec<Value::length(), double> sum(0);
      for (const std::uint32_t h : loop)
        sum += glm::vec<Value::length(), double>(values[vertex(h)]);
      values.push_back(Value(sum / static_cast<double>(loop.size())));
    };
    add_mean(mesh.positions), add_mean(mesh.normals), add_mean(mesh.texcoords);
    add_mean(mesh.colors);
    if (mesh.has_normals()) mesh.normals.back() = normalize_or_zero(mesh.normals.back());
    for (const std::uint32_t h : loop) {
      const std::uint32_t from = vertex(h), to = vertex(next_half_edge(h));
      opposite_[h] = static_cast<std::uint32_t>(mesh.indices.size());
      opposite_.insert(opposite_.end(), {h, kNone, kNone});
      point_of_.insert(point_of_.end(), {point_of_[next_half_edge(h)], point_of_[h], kNone});
      mesh.indices.insert(mesh.indices.end(), {to, from, apex});
      material_of_.push_back(material_of_[h / 3]);
    }
    ++result_.report.closed_holes;
    result_.report.new_triangles += static_cast<std::uint32_t>(loop.size());
  }

  void set_result() {
    TriangleMesh& mesh = result_.mesh;
    mesh.materials = mesh_.materials;
    mesh.images = mesh_.images;
    if (!mesh_.ranges.empty()) set_triangle_materials(mesh, material_of_);
  }

  const TriangleMesh& mesh_;
  const RepairOptions& options_;
  std::vector<std::uint32_t> materials_;
  WeldMap weld_ = weld_exact(mesh_.positions);
  std::vector<std::uint32_t> corners_;  // three vertices of the mesh a triangle that is kept
  std::vector<std::uint32_t> material_of_, source_;
  std::vector<std::uint32_t> opposite_;  // per corner, as of half-edges; kNone at holes
  std::vector<std::uint32_t> point_of_;  // per corner
  RepairedSphere result_;
};

}  // namespace

namespace {

void turn_inside_out(TriangleMesh& mesh) {
  for (std::size_t t = 0; t + 2 < mesh.indices.size(); t += 3)
    std::swap(mesh.indices[t + 1], mesh.indices[t + 2]);
  for (Vec3& normal : mesh.normals) normal = -normal;
}

// Handles one by one, as long as they are small.
Result<RepairedSphere> cut_handles(RepairedSphere repaired, const RepairOptions& options) {
  for (int handle = 0; handle < kMostHandles; ++handle) {
    const TopologyReport topology =
        analyze_topology(repaired.mesh, weld_exact(repaired.mesh.positions));
    if (topology.genus().value_or(0) <= 0) break;
    auto cut = SphereRepair(repaired.mesh, options).run(true);
    if (!cut || cut->report.cut_handles == 0) break;
    ++repaired.report.cut_handles;
    repaired.report.new_triangles += cut->report.new_triangles;
    repaired.mesh = std::move(cut->mesh);
  }
  return repaired;
}

}  // namespace

Result<RepairedSphere> repair_to_sphere(const TriangleMesh& mesh, const RepairOptions& options) {
  for (const Fault& fault : validate(mesh))
    if (fault.severity == Severity::kBroken)
      return fail(ErrorKind::kInvalidInput, fault.kind + " " + fault.where);
  TriangleMesh at_rest = mesh;
  at_rest.poses.clear(), at_rest.skin.clear(), at_rest.rig.reset();
  auto repaired = SphereRepair(at_rest, options).run();
  if (!repaired) return repaired;
  repaired = cut_handles(std::move(*repaired), options);
  if (repaired->report.open_edges == 0 && signed_volume(repaired->mesh) < 0) {
    turn_inside_out(repaired->mesh);
    repaired->report.turned = true;
  }
  return repaired;
}

}  // namespace varifold
