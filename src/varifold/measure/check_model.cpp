#include <varifold/base/checksum.h>
#include <varifold/base/parallel.h>
#include <varifold/measure/check_model.h>
#include <varifold/measure/surface_distance.h>
#include <varifold/mesh/normals.h>
#include <varifold/mesh/topology.h>
#include <varifold/mesh/weld.h>
#include <varifold/models/pm/instance.h>
#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <iterator>
#include <map>
#include <span>
#include <string>
#include <utility>

namespace varifold {

namespace {

/// How many levels have a fault, and the first of them.
class LevelFaults {
 public:
  void add(const char* kind, std::uint32_t level, const std::string& detail = {}) {
    Entry& entry = entries_[kind];
    if (++entry.count > kPlaces) return;
    entry.where += (entry.where.empty() ? "level " : ", ") + std::to_string(level);
    if (!detail.empty()) entry.where += " (" + detail + ")";
  }
  [[nodiscard]] std::vector<Fault> list() const {
    std::vector<Fault> faults;
    for (const auto& [kind, entry] : entries_)
      faults.push_back({kind, entry.count, entry.where + (entry.count > kPlaces ? ", ..." : ""),
                        Severity::kFault});
    return faults;
  }

 private:
  static constexpr std::uint64_t kPlaces = 4;
  struct Entry {
    std::uint64_t count = 0;
    std::string where;
  };
  std::map<std::string, Entry> entries_;
};

/// The points of the model; those of a level are the first so many.
struct ModelPoints {
  std::vector<std::uint32_t> point_of;  ///< per vertex
  std::uint32_t base_points = 0;

  [[nodiscard]] WeldMap at_level(std::uint32_t level, std::uint32_t vertices) const {
    WeldMap weld;
    weld.class_of.assign(point_of.begin(), point_of.begin() + vertices);
    weld.class_count = base_points + level;
    return weld;
  }
};

ModelPoints points_of(const ProgressiveMesh& model) {
  const ProgressiveMeshData& data = model.data();
  const WeldMap base = weld_exact(std::span(data.mesh.positions).first(data.base_vertices));
  ModelPoints points{base.class_of, base.class_count};
  points.point_of.reserve(data.mesh.positions.size());
  for (std::uint32_t k = 0; k < model.finest_level(); ++k)
    points.point_of.insert(points.point_of.end(), data.splits[k].vertices, points.base_points + k);
  return points;
}

/// All levels of a small model; of a large one, half of the spread even, half dense at the base.
std::vector<std::uint32_t> levels_to_visit(std::uint32_t finest, const ModelCheckOptions& options) {
  std::vector<std::uint32_t> levels;
  const bool all = finest <= options.all_levels_up_to;
  const std::uint32_t half = std::max(1u, options.spread_levels / 2);
  for (std::uint32_t k = 0; all && k <= finest; ++k) levels.push_back(k);
  for (std::uint32_t i = 0; !all && i <= half; ++i) {
    const double part = static_cast<double>(i) / half;
    levels.push_back(static_cast<std::uint32_t>(part * finest));
    levels.push_back(static_cast<std::uint32_t>(std::pow(static_cast<double>(finest), part)));
  }
  levels.push_back(0);
  levels.push_back(finest);
  std::sort(levels.begin(), levels.end());
  levels.erase(std::unique(levels.begin(), levels.end()), levels.end());
  return levels;
}

/// A checksum of all that an instance shows.
std::uint64_t fingerprint(const ProgressiveMeshInstance& instance) {
  const TriangleMesh& vertices = instance.vertices();
  const bool moves = instance.model().moves_vertices();
  ChecksumStream sum;
  sum.add(std::as_bytes(std::span(instance.indices())));
  if (moves) {  // else they are the model's own
    sum.add(std::as_bytes(std::span(vertices.positions)));
    sum.add(std::as_bytes(std::span(vertices.normals)));
    sum.add(std::as_bytes(std::span(vertices.texcoords)));
    sum.add(std::as_bytes(std::span(vertices.colors)));
  }
  const std::array<std::uint32_t, 3> counts{instance.level(), instance.vertex_count(),
                                            instance.triangle_count()};
  sum.add(std::as_bytes(std::span(counts)));
  return sum.value();
}

class ModelChecker {
 public:
  ModelChecker(std::shared_ptr<const ProgressiveMesh> model, const ModelCheckOptions& options)
      : model_(std::move(model)),
        options_(options),
        points_(points_of(*model_)),
        levels_(levels_to_visit(model_->finest_level(), options)),
        full_(model_) {
    full_.go_to_level(model_->finest_level());
    full_mesh_ = full_.extract();
    full_topology_ = topology_at(full_mesh_, model_->finest_level());
  }

  Result<ModelCheck> run() {
    check_errors();
    if (!walk_up() || !walk_down() || !check_distances())
      return fail(ErrorKind::kCancelled, "cancelled while checking");
    ModelCheck result;
    result.faults = faults_.list();
    result.levels_checked = static_cast<std::uint32_t>(levels_.size());
    result.distances_checked = distances_checked_;
    note_coincident_points(result.faults);
    return result;
  }

 private:
  [[nodiscard]] TopologyReport topology_at(const TriangleMesh& mesh, std::uint32_t level) const {
    return analyze_topology(mesh, points_.at_level(level, mesh.vertex_count()), options_.threads);
  }

  void check_errors() {
    for (std::uint32_t k = 0; k <= model_->finest_level(); ++k) {
      const float error = model_->error(k);
      const bool is_distance = std::isfinite(error) && error >= 0;
      if (!is_distance || (k > 0 && error > model_->error(k - 1)))
        faults_.add("error_not_monotone", k);
    }
  }

  // Up by one instance, each level also by a fresh one; all looks at levels happen here.
  bool walk_up() {
    ProgressiveMeshInstance walker(model_);
    for (const std::uint32_t level : levels_) {
      if (!report_progress("walking up", level, 0)) return false;
      walker.go_to_level(level);
      ProgressiveMeshInstance fresh(model_);
      fresh.go_to_level(level);
      fingerprints_.push_back(fingerprint(fresh));
      if (fingerprint(walker) != fingerprints_.back()) faults_.add("not_identical", level);
      const TriangleMesh mesh = fresh.extract();
      check_counts(fresh, mesh);
      if (check_corners(fresh)) check_surface(mesh, level);
    }
    return true;
  }

  // Down again, with a leap to one of the ends before each other level.
  bool walk_down() {
    ProgressiveMeshInstance walker(model_);
    ProgressiveMeshInstance leaper(model_);
    for (std::size_t i = levels_.size(); i-- > 0;) {
      const std::uint32_t level = levels_[i];
      if (!report_progress("walking down", model_->finest_level() - level, 1)) return false;
      walker.go_to_level(level);
      if (i % 8 == 0) leaper.go_to_level(i % 16 == 0 ? 0 : model_->finest_level());
      leaper.go_to_level(level);
      if (fingerprint(walker) != fingerprints_[i] || fingerprint(leaper) != fingerprints_[i])
        faults_.add("not_identical", level);
    }
    return true;
  }

  void check_counts(const ProgressiveMeshInstance& instance, const TriangleMesh& extracted) {
    const std::uint32_t level = instance.level();
    if (instance.vertex_count() != model_->vertex_count(level) ||
        instance.triangle_count() != model_->triangle_count(level) ||
        extracted.triangle_count() != model_->triangle_count(level))
      faults_.add("wrong_count", level);
  }

  // Every corner must be what the history says. Returns whether all of them exist.
  bool check_corners(const ProgressiveMeshInstance& instance) {
    const std::uint32_t level = instance.level();
    const std::vector<std::uint32_t> ancestor = ancestors_at(instance.vertex_count());
    const std::vector<bool> is_there = triangles_there(level);
    bool corners_right = true, corners_exist = true, all_there = true;
    for (std::uint32_t t = 0; t < full_.indices().size() / 3; ++t) {
      std::array<std::uint32_t, 3> point{};
      for (int c = 0; c < 3; ++c) {
        const std::size_t slot = 3 * std::size_t{t} + c;
        const std::uint32_t expected = ancestor[full_.indices()[slot]];
        point[c] = points_.point_of[expected];
        if (!is_there[t]) continue;
        corners_right = corners_right && instance.indices()[slot] == expected;
        corners_exist = corners_exist && instance.indices()[slot] < instance.vertex_count();
      }
      const bool has_area = point[0] != point[1] && point[1] != point[2] && point[0] != point[2];
      all_there = all_there && (is_there[t] || !has_area);
    }
    if (!corners_right) faults_.add("wrong_corner", level);
    if (!all_there) faults_.add("lost_triangle", level);
    return corners_exist;
  }

  [[nodiscard]] std::vector<std::uint32_t> ancestors_at(std::uint32_t vertices) const {
    std::vector<std::uint32_t> ancestor(model_->data().mesh.positions.size());
    for (std::uint32_t v = 0; v < ancestor.size(); ++v)
      ancestor[v] = v < vertices ? v : ancestor[model_->data().target[v]];
    return ancestor;
  }

  // The triangles of a level are the first of every range.
  [[nodiscard]] std::vector<bool> triangles_there(std::uint32_t level) const {
    const ProgressiveMeshData& data = model_->data();
    std::vector<bool> is_there(data.mesh.triangle_count(), false);
    if (data.triangle_level.empty())
      std::fill_n(is_there.begin(), model_->triangle_count(level), true);
    for (std::size_t t = 0; t < data.triangle_level.size(); ++t)
      is_there[t] = data.triangle_level[t] <= level;
    return is_there;
  }

  void check_surface(const TriangleMesh& mesh, std::uint32_t level) {
    const TopologyReport topology = topology_at(mesh, level);
    const auto expect = [&](bool holds, const char* kind) {
      if (!holds) faults_.add(kind, level);
    };
    expect(topology.closed || !full_topology_.closed, "not_closed");
    expect(topology.euler_characteristic == full_topology_.euler_characteristic, "euler_changed");
    expect(topology.components == full_topology_.components, "components_changed");
    expect(topology.degenerate_triangles == 0, "degenerate_triangle");
    expect(topology.duplicate_triangles <= full_topology_.duplicate_triangles,
           "new_duplicate_triangle");
    expect(topology.nonmanifold_edges <= full_topology_.nonmanifold_edges, "new_nonmanifold_edge");
    expect(topology.misoriented_edges <= full_topology_.misoriented_edges, "new_misoriented_edge");
    if (const std::size_t flipped = flipped_beyond_rounding(mesh); flipped > 0)
      faults_.add("flipped_triangle", level, std::to_string(flipped) + " triangles");
  }

  // A triangle thinner than positions were rounded may be turned by that alone.
  [[nodiscard]] std::size_t flipped_beyond_rounding(const TriangleMesh& mesh) const {
    const double thin = 4.0 * model_->error(model_->finest_level());
    const auto flipped = flipped_triangles(mesh, full_mesh_, options_.threads);
    return static_cast<std::size_t>(
        std::count_if(flipped.begin(), flipped.end(), [&](std::uint32_t t) {
          double longest = 0;
          for (int c = 0; c < 3; ++c)
            longest = std::max<double>(
                longest,
                glm::length(mesh.positions[mesh.indices[3 * std::size_t{t} + c]] -
                            mesh.positions[mesh.indices[3 * std::size_t{t} + (c + 1) % 3]]));
          return 2 * triangle_area(mesh, t) > thin * longest;
        }));
  }

  // A spread of levels by the logarithm of their number: the coarse ones have the large errors.
  bool check_distances() {
    if (!model_->data().error_is_measured || full_mesh_.indices.empty()) return true;
    const std::uint32_t finest = model_->finest_level();
    std::vector<std::uint32_t> chosen{0};
    for (std::uint32_t i = 0; i < options_.distance_levels; ++i)
      chosen.push_back(static_cast<std::uint32_t>(
          std::pow(finest + 1.0, (i + 0.5) / options_.distance_levels) - 1));
    chosen.erase(std::unique(chosen.begin(), chosen.end()), chosen.end());
    for (const std::uint32_t level : chosen) {
      if (!report_progress("measuring", level, 2)) return false;
      check_distance(level);
    }
    distances_checked_ = static_cast<std::uint32_t>(chosen.size());
    return true;
  }

  void check_distance(std::uint32_t level) {
    ProgressiveMeshInstance instance(model_);
    instance.go_to_level(level);
    const SurfaceDistance surface(instance.extract());
    // Even a point on a triangle is a few bits of a double away from it.
    double reach = 0;
    for (const Vec3& p : full_mesh_.positions) reach = std::max<double>(reach, glm::length(p));
    const double bound =
        model_->error(level) * (1 + 1e-5) + model_->error(model_->finest_level()) + 1e-12 * reach;
    std::atomic<bool> is_exceeded{false};
    parallel_for(options_.threads, full_mesh_.positions.size(), 4096,
                 [&](std::size_t begin, std::size_t end) {
                   for (std::size_t v = begin; v < end && !is_exceeded; ++v)
                     if (surface.distance(DVec3(full_mesh_.positions[v])) > bound)
                       is_exceeded = true;
                 });
    if (is_exceeded) faults_.add("error_exceeded", level);
  }

  void note_coincident_points(std::vector<Fault>& faults) const {
    const std::uint32_t points = points_.base_points + model_->finest_level();
    const std::uint32_t positions = weld_exact(full_mesh_.positions).class_count;
    if (positions < points)
      faults.push_back({"coincident_point", points - positions, "the full level", Severity::kNote});
  }

  [[nodiscard]] bool report_progress(const char* stage, std::uint32_t done, int part) const {
    const float finest = static_cast<float>(std::max(1u, model_->finest_level()));
    return report(options_.progress, stage,
                  (static_cast<float>(part) + static_cast<float>(done) / finest) / 3);
  }

  std::shared_ptr<const ProgressiveMesh> model_;
  const ModelCheckOptions& options_;
  ModelPoints points_;
  std::vector<std::uint32_t> levels_;
  ProgressiveMeshInstance full_;
  TriangleMesh full_mesh_;
  TopologyReport full_topology_;
  std::vector<std::uint64_t> fingerprints_;  ///< per visited level, by a fresh instance
  LevelFaults faults_;
  std::uint32_t distances_checked_ = 0;
};

}  // namespace

Result<ModelCheck> check_progressive_mesh(const std::shared_ptr<const ProgressiveMesh>& model,
                                          const ModelCheckOptions& options) {
  if (model->data().splits.empty() && model->data().mesh.positions.empty()) return ModelCheck{};
  return ModelChecker(model, options).run();
}

}  // namespace varifold
