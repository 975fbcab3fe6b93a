// Private to this folder: how a uniform model of any kind is checked.
#pragma once

#include <varifold/base/checksum.h>
#include <varifold/base/parallel.h>
#include <varifold/measure/check_model.h>
#include <varifold/measure/check_parts.h>
#include <varifold/measure/front_checker.h>
#include <varifold/measure/full_level.h>
#include <varifold/measure/shape_checker.h>
#include <varifold/measure/surface_distance.h>
#include <varifold/mesh/weld.h>
#include <varifold/models/common/uniform_model.h>
#include <varifold/models/pm/instance.h>
#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <span>
#include <string>
#include <utility>

namespace varifold {

/// The mesh that all levels come from. A progressive mesh holds triangles that it may forget to
/// show; strips have what they draw.
template <class Instance>
TriangleMesh whole_mesh(const Instance& full) {
  return full.extract();
}
inline TriangleMesh whole_mesh(const ProgressiveMeshInstance& full) {
  TriangleMesh mesh = full.extract();
  mesh.indices = full.indices();
  mesh.ranges = full.model().attributes().ranges;
  return mesh;
}

template <class Instance>
class ModelChecker {
 public:
  using Model = CheckedModel<Instance>;

  ModelChecker(std::shared_ptr<const Model> model, const ModelCheckOptions& options)
      : model_(std::move(model)),
        options_(options),
        points_(check::points_of(*model_)),
        levels_(check::levels_to_visit(model_->finest_level(), options)) {}

  Result<ModelCheck> run() {
    check_errors();
    ModelCheck result;
    result.levels_checked = 1;
    if (look_at_full_level()) {
      if (!walk_up() || !walk_down() || !check_distances() || !check_fronts(result))
        return fail(ErrorKind::kCancelled, "cancelled while checking");
      result.levels_checked = static_cast<std::uint32_t>(levels_.size());
      result.distances_checked = distances_checked_;
      note_coincident_points(result.faults);
    }
    std::vector<Fault> faults;
    faults_.append_to(faults);
    pose_faults_.append_to(faults);
    result.faults.insert(result.faults.begin(), faults.begin(), faults.end());
    return result;
  }

 private:
  // Nothing can be said of a model whose full level does not exist.
  bool look_at_full_level() {
    const std::uint32_t finest = model_->finest_level();
    Instance full(model_);
    full.go_to_level(finest);
    if (!corners_exist(full)) return false;
    full_ = {full.extract(), check::canonical_triangles(whole_mesh(full)), points_,
             model_->error(finest), options_.threads};
    shapes_ = {full_.mesh(), points_, options_.threads};
    return true;
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
    Instance walker(model_);
    for (const std::uint32_t level : levels_) {
      if (!report_progress("walking up", level, 0)) return false;
      walker.go_to_level(level);
      Instance fresh(model_);
      fresh.go_to_level(level);
      fingerprints_.push_back(check::fingerprint(fresh));
      if (check::fingerprint(walker) != fingerprints_.back()) faults_.add("not_identical", level);
      if (!corners_exist(fresh)) continue;
      const TriangleMesh mesh = fresh.extract();
      check_counts(fresh, mesh);
      if (FrontInstance<Instance>) full_.note_level(mesh);
      check_corners(mesh, level);
      const WeldMap points = points_.at_level(level, mesh.vertex_count());
      full_.check_surface(mesh, points, faults_, level);
      shapes_.check_surface(mesh, points, pose_faults_, level);
    }
    return true;
  }

  // Down again, with a leap to one of the ends before each other level.
  bool walk_down() {
    Instance walker(model_);
    Instance leaper(model_);
    for (std::size_t i = levels_.size(); i-- > 0;) {
      const std::uint32_t level = levels_[i];
      if (!report_progress("walking down", model_->finest_level() - level, 1)) return false;
      walker.go_to_level(level);
      if (i % 8 == 0) leaper.go_to_level(i % 16 == 0 ? 0 : model_->finest_level());
      leaper.go_to_level(level);
      if (check::fingerprint(walker) != fingerprints_[i] ||
          check::fingerprint(leaper) != fingerprints_[i])
        faults_.add("not_identical", level);
    }
    return true;
  }

  void check_counts(const Instance& instance, const TriangleMesh& extracted) {
    const std::uint32_t level = instance.level();
    if (extracted.vertex_count() != model_->vertex_count(level) ||
        extracted.triangle_count() != model_->triangle_count(level))
      faults_.add("wrong_count", level);
  }

  // Whatever is drawn must be a vertex of the level.
  bool corners_exist(Instance& instance) {
    const DrawList list = instance.draw_list();
    const bool exist = check::indices_exist(
        list, order_depends_on_way<Instance>() ? static_cast<std::uint32_t>(list.positions.size())
                                               : model_->vertex_count(instance.level()));
    if (!exist) faults_.add("wrong_corner", instance.level(), "no vertex of the level");
    return exist;
  }

  // The triangles must be what the history makes of those of the full mesh, each as often.
  void check_corners(const TriangleMesh& mesh, std::uint32_t level) {
    const auto vertices = static_cast<std::uint32_t>(points_.point_of.size());
    std::vector<std::uint32_t> ancestor(vertices);
    const std::uint32_t live = model_->vertex_count(level);
    for (std::uint32_t v = 0; v < vertices; ++v)
      ancestor[v] = v < live ? v : ancestor[points_.target[v]];
    full_.check_corners(mesh, ancestor, points_.point_of, faults_, level);
  }

  // A spread of levels by the logarithm of their number: the coarse ones have the large errors.
  bool check_distances() {
    if (!error_is_measured(*model_) || full_.mesh().indices.empty()) return true;
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
    Instance instance(model_);
    instance.go_to_level(level);
    const SurfaceDistance surface(instance.extract());
    // Errors are measured with floats, in flat parts off by what these round away.
    double reach = 0;
    for (const Vec3& p : full_.mesh().positions) reach = std::max<double>(reach, glm::length(p));
    const double rounding = 2e-7 * bounds(full_.mesh()).diagonal() + 1e-12 * reach;
    const double bound =
        model_->error(level) * (1 + 1e-5) + model_->error(model_->finest_level()) + rounding;
    std::atomic<bool> is_exceeded{false};
    parallel_for(options_.threads, full_.mesh().positions.size(), 4096,
                 [&](std::size_t begin, std::size_t end) {
                   for (std::size_t v = begin; v < end && !is_exceeded; ++v)
                     if (surface.distance(DVec3(full_.mesh().positions[v])) > bound)
                       is_exceeded = true;
                 });
    if (is_exceeded) faults_.add("error_exceeded", level);
    shapes_.check_distance(instance.extract(), model_->error(level), pose_faults_, level);
  }

  bool check_fronts([[maybe_unused]] ModelCheck& result) {
    if constexpr (FrontInstance<Instance>) {
      FrontChecker<Instance> checker(model_, options_, points_, full_, shapes_);
      const auto report_front = [&](std::uint32_t done) {
        return ::varifold::report(
            options_.progress, "fronts",
            (3 + static_cast<float>(done) / static_cast<float>(std::max(1u, options_.fronts))) /
                kStages);
      };
      if (!checker.run(report_front)) return false;
      checker.append_faults(result.faults);
      result.fronts_checked = checker.fronts_checked();
    }
    return true;
  }

  void note_coincident_points(std::vector<Fault>& faults) const {
    const std::uint32_t points = points_.base_points + model_->finest_level();
    const std::uint32_t positions = weld_points(full_.mesh()).class_count;
    if (positions < points)
      faults.push_back({"coincident_point", points - positions, "the full level", Severity::kNote});
  }

  [[nodiscard]] bool report_progress(const char* stage, std::uint32_t done, int part) const {
    const float finest = static_cast<float>(std::max(1u, model_->finest_level()));
    return report(options_.progress, stage,
                  (static_cast<float>(part) + static_cast<float>(done) / finest) / kStages);
  }

  static constexpr float kStages = FrontInstance<Instance> ? 4 : 3;

  std::shared_ptr<const Model> model_;
  const ModelCheckOptions& options_;
  check::ModelPoints points_;
  std::vector<std::uint32_t> levels_;
  check::FullLevel full_;
  std::vector<std::uint64_t> fingerprints_;  ///< per visited level, by a fresh instance
  check::ShapeChecker shapes_;
  check::PlaceFaults faults_{"level"};
  check::PlaceFaults pose_faults_{"level", "pose_"};
  std::uint32_t distances_checked_ = 0;
};

}  // namespace varifold
