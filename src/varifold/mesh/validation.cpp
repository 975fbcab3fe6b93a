#include <varifold/base/parallel.h>
#include <varifold/mesh/normals.h>
#include <varifold/mesh/topology_scan.h>
#include <varifold/mesh/validation.h>
#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

namespace varifold {

namespace {

using detail::Tally;

bool is_finite(const Vec2& v) { return std::isfinite(v.x) && std::isfinite(v.y); }
bool is_finite(const Vec3& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

/// Collects faults and writes their places out.
class FaultList {
 public:
  template <class Place>
  void add(Severity severity, const char* kind, const Tally& tally, const char* what,
           const Place& place) {
    if (tally.count == 0) return;
    std::string where = what;
    for (std::size_t i = 0; i < Tally::kPlaces && i < tally.count; ++i)
      where.append(i == 0 ? " " : ", ").append(place(tally.places[i]));
    if (tally.count > Tally::kPlaces) where += ", ...";
    faults_.push_back({kind, tally.count, std::move(where), severity});
  }
  void add(Severity severity, const char* kind, const Tally& tally, const char* what) {
    add(severity, kind, tally, what, [](std::uint64_t i) { return std::to_string(i); });
  }
  void add(Severity severity, const char* kind, std::uint64_t count, std::string where) {
    faults_.push_back({kind, count, std::move(where), severity});
  }
  [[nodiscard]] bool empty() const { return faults_.empty(); }
  [[nodiscard]] std::vector<Fault> take() { return std::move(faults_); }

 private:
  std::vector<Fault> faults_;
};

void check_array_sizes(const TriangleMesh& mesh, FaultList& faults) {
  const auto check = [&](std::size_t size, const char* name) {
    if (size == 0 || size == mesh.positions.size()) return;
    faults.add(Severity::kBroken, "wrong_array_size", 1,
               std::to_string(size) + " " + name + " for " + std::to_string(mesh.positions.size()) +
                   " positions");
  };
  check(mesh.normals.size(), "normals");
  check(mesh.texcoords.size(), "texture coordinates");
  check(mesh.colors.size(), "colours");
  check(mesh.skin.size(), "joints and weights");
  for (const Pose& pose : mesh.poses) {
    if (pose.positions.empty() && !mesh.positions.empty())
      faults.add(Severity::kBroken, "wrong_array_size", 1, "a pose without positions");
    check(pose.positions.size(), "positions of a pose");
    check(pose.normals.size(), "normals of a pose");
  }
  const std::size_t limit = std::numeric_limits<std::uint32_t>::max();
  if (mesh.positions.size() >= limit || mesh.indices.size() >= limit)
    faults.add(Severity::kBroken, "wrong_array_size", 1, "more than 2^32 - 2 vertices or indices");
}

void check_indices(const TriangleMesh& mesh, FaultList& faults) {
  if (mesh.indices.size() % 3 != 0)
    faults.add(Severity::kBroken, "incomplete_triangle", 1,
               std::to_string(mesh.indices.size()) + " indices");
  Tally out_of_range;
  for (std::size_t i = 0; i < mesh.indices.size(); ++i)
    if (mesh.indices[i] >= mesh.positions.size()) out_of_range.add(i / 3);
  faults.add(Severity::kBroken, "index_out_of_range", out_of_range, "triangle");
}

/// Ranges cover all triangles in order, without gaps, each material at most once.
void check_materials(const TriangleMesh& mesh, FaultList& faults) {
  Tally bad_ranges;
  std::uint64_t next = 0;
  std::vector<bool> seen(mesh.materials.size(), false);
  for (std::size_t i = 0; i < mesh.ranges.size(); ++i) {
    const MaterialRange& range = mesh.ranges[i];
    const bool known = range.material < mesh.materials.size();
    if (!known || seen[range.material] || range.first_triangle != next) bad_ranges.add(i);
    if (known) seen[range.material] = true;
    next = std::uint64_t{range.first_triangle} + range.triangle_count;
  }
  faults.add(Severity::kBroken, "bad_material_range", bad_ranges, "range");
  if (!mesh.ranges.empty() && next != mesh.triangle_count())
    faults.add(Severity::kBroken, "bad_material_range", 1,
               "ranges end at triangle " + std::to_string(next) + " of " +
                   std::to_string(mesh.triangle_count()));

  Tally bad_textures;
  for (std::size_t i = 0; i < mesh.materials.size(); ++i)
    for (const std::uint32_t image : mesh.materials[i].textures)
      if (image != kNone && image >= mesh.images.size()) bad_textures.add(i);
  faults.add(Severity::kBroken, "bad_texture_index", bad_textures, "material");
}

template <class Values, class IsBad>
Tally tally_vertices(const Values& values, const IsBad& is_bad) {
  Tally tally;
  for (std::size_t v = 0; v < values.size(); ++v)
    if (is_bad(values[v])) tally.add(v);
  return tally;
}

void check_attributes(const TriangleMesh& mesh, FaultList& faults) {
  faults.add(Severity::kFault, "nonfinite_normal",
             tally_vertices(mesh.normals, [](const Vec3& n) { return !is_finite(n); }), "vertex");
  faults.add(Severity::kFault, "zero_normal",
             tally_vertices(mesh.normals, [](const Vec3& n) { return n == Vec3(0); }), "vertex");
  faults.add(Severity::kFault, "nonfinite_texcoord",
             tally_vertices(mesh.texcoords, [](const Vec2& t) { return !is_finite(t); }), "vertex");
}

/// Names places on position classes by the first vertex of each class.
class PlaceNames {
 public:
  explicit PlaceNames(const WeldMap& weld) : first_(weld.class_count) {
    for (std::size_t v = weld.class_of.size(); v-- > 0;)
      first_[weld.class_of[v]] = static_cast<std::uint32_t>(v);
  }
  [[nodiscard]] std::string vertex(std::uint64_t c) const { return std::to_string(first_[c]); }
  [[nodiscard]] std::string edge(std::uint64_t place) const {
    return vertex(place >> 32) + "-" + vertex(place & 0xffffffffu);
  }

 private:
  std::vector<std::uint32_t> first_;
};

void check_surface(const detail::TopologyScan& scan, const PlaceNames& names, FaultList& faults) {
  const auto edge = [&](std::uint64_t place) { return names.edge(place); };
  const auto vertex = [&](std::uint64_t place) { return names.vertex(place); };
  faults.add(Severity::kFault, "degenerate_triangle", scan.degenerate_triangles, "triangle");
  faults.add(Severity::kFault, "duplicate_triangle", scan.duplicate_triangles, "triangle");
  faults.add(Severity::kFault, "nonmanifold_edge", scan.nonmanifold_edges, "edge", edge);
  faults.add(Severity::kFault, "misoriented_edge", scan.misoriented_edges, "edge", edge);
  faults.add(Severity::kFault, "nonmanifold_vertex", scan.nonmanifold_vertices, "vertex", vertex);
}

void check_notes(const TriangleMesh& mesh, const WeldMap& weld, FaultList& faults) {
  std::vector<bool> used(mesh.positions.size(), false);
  for (const std::uint32_t v : mesh.indices) used[v] = true;
  faults.add(Severity::kNote, "unused_vertex",
             tally_vertices(used, [](bool is_used) { return !is_used; }), "vertex");

  Tally zero_area;
  for (std::uint32_t t = 0; t < mesh.triangle_count(); ++t) {
    if (area_vector(mesh, t) != DVec3(0)) continue;
    const std::uint32_t* index = &mesh.indices[3 * std::size_t{t}];
    const std::uint32_t a = weld.class_of[index[0]], b = weld.class_of[index[1]],
                        c = weld.class_of[index[2]];
    if (a != b && b != c && a != c) zero_area.add(t);
  }
  faults.add(Severity::kNote, "zero_area_triangle", zero_area, "triangle");

  const auto unnormalized = [](const Vec3& n) {
    const double square = glm::dot(DVec3(n), DVec3(n));
    return square > 0 && std::isfinite(square) && (square < 0.99 * 0.99 || square > 1.01 * 1.01);
  };
  faults.add(Severity::kNote, "unnormalized_normal", tally_vertices(mesh.normals, unnormalized),
             "vertex");
}

}  // namespace

std::vector<Fault> validate(const TriangleMesh& mesh, int threads) {
  FaultList faults;
  check_array_sizes(mesh, faults);
  check_indices(mesh, faults);
  check_materials(mesh, faults);
  faults.add(Severity::kBroken, "nonfinite_position",
             tally_vertices(mesh.positions, [](const Vec3& p) { return !is_finite(p); }), "vertex");
  for (const Pose& pose : mesh.poses)
    faults.add(Severity::kBroken, "nonfinite_position",
               tally_vertices(pose.positions, [](const Vec3& p) { return !is_finite(p); }),
               "vertex of a pose");
  if (!faults.empty()) return faults.take();

  const WeldMap weld = weld_points(mesh);
  const detail::TopologyScan scan = detail::scan_topology(mesh, weld, threads);
  const PlaceNames names(weld);
  check_surface(scan, names, faults);
  check_attributes(mesh, faults);
  faults.add(Severity::kNote, "boundary_edge", scan.boundary_edges, "edge",
             [&](std::uint64_t place) { return names.edge(place); });
  check_notes(mesh, weld, faults);
  return faults.take();
}

bool is_sound(const std::vector<Fault>& faults) {
  return std::all_of(faults.begin(), faults.end(),
                     [](const Fault& fault) { return fault.severity == Severity::kNote; });
}

std::vector<std::uint32_t> flipped_triangles(const TriangleMesh& mesh,
                                             const TriangleMesh& reference, int threads) {
  // Weld both meshes together: the vertices of the reference come first.
  std::vector<Vec3> positions = reference.positions;
  positions.insert(positions.end(), mesh.positions.begin(), mesh.positions.end());
  const WeldMap weld = weld_exact(positions);
  const VertexFaces stars(reference.indices, weld);
  const std::vector<Vec3> reference_normals = face_normals(reference, threads);
  const std::span<const std::uint32_t> class_of =
      std::span(weld.class_of).subspan(reference.positions.size());

  const auto is_flipped = [&](std::uint32_t t) {
    const DVec3 normal = area_vector(mesh, t);
    bool judged = false;
    for (int corner = 0; corner < 3; ++corner) {
      const std::uint32_t c = class_of[mesh.indices[3 * std::size_t{t} + corner]];
      if (stars.triangles_of(c).empty()) return false;  // a vertex that the reference has not
      for (const std::uint32_t u : stars.triangles_of(c)) {
        if (reference_normals[u] == Vec3(0)) continue;
        if (!(glm::dot(normal, DVec3(reference_normals[u])) < 0)) return false;
        judged = true;
      }
    }
    return judged;
  };

  std::vector<char> flipped(mesh.triangle_count(), 0);
  parallel_for(threads, flipped.size(), 4096, [&](std::size_t begin, std::size_t end) {
    for (std::size_t t = begin; t < end; ++t)
      flipped[t] = is_flipped(static_cast<std::uint32_t>(t)) ? 1 : 0;
  });
  std::vector<std::uint32_t> result;
  for (std::uint32_t t = 0; t < flipped.size(); ++t)
    if (flipped[t] != 0) result.push_back(t);
  return result;
}

std::uint64_t count_flipped(const TriangleMesh& mesh, const TriangleMesh& reference) {
  return flipped_triangles(mesh, reference).size();
}

}  // namespace varifold
