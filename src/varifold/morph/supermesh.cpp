// Based on: [Ramos2008] section 6.3.1; [KentCarlsonParent1992] for the overlay, [PraunHoppe2003]
// for the maps. Differs: the thesis names its builder only; here maps have little stretch, signs
// are exact, and
//   the overlay is simplified.
#include <varifold/base/parallel.h>
#include <varifold/morph/correspondence.h>
#include <varifold/morph/disc_pair.h>
#include <varifold/morph/feature_warp.h>
#include <varifold/morph/overlay_mesh.h>
#include <varifold/morph/overlay_reduction.h>
#include <varifold/morph/sphere_embedding.h>
#include <varifold/morph/sphere_surface.h>
#include <varifold/morph/supermesh.h>
#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <thread>
#include <utility>

namespace varifold {
namespace {

class Stopwatch {
 public:
  double lap() {
    const auto now = std::chrono::steady_clock::now();
    return std::chrono::duration<double>(now - std::exchange(start_, now)).count();
  }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

// Nudges are this many radians at first, about 500 steps of the grid, and grow with each try.
constexpr double kFirstNudge = 0x1.0p-31;
constexpr int kNudges = 7;

tl::unexpected<Error> cancelled() {
  return fail(ErrorKind::kCancelled, "cancelled while a supermesh was built");
}

class SupermeshBuilder {
 public:
  SupermeshBuilder(const TriangleMesh& a, const TriangleMesh& b, const SupermeshOptions& options)
      : meshes_{&a, &b}, options_(options) {}

  Result<Supermesh> run() {
    using Stage = Result<void> (SupermeshBuilder::*)();
    for (const Stage stage : {&SupermeshBuilder::check, &SupermeshBuilder::embed,
                              &SupermeshBuilder::overlay, &SupermeshBuilder::reduce})
      if (auto done = (this->*stage)(); !done) return tl::unexpected(std::move(done.error()));
    if (!report(options_.progress, "supermesh", 1)) return cancelled();
    return std::move(result_);
  }

 private:
  Result<void> check() {
    for (int i = 0; i < 2; ++i) {
      auto surface =
          as_sphere_or_disc(*meshes_[i], i == 0 ? "first mesh" : "second mesh", options_.threads);
      if (!surface) return tl::unexpected(std::move(surface.error()));
      surfaces_[i] = std::move(*surface);
      result_.report.input_vertices[i] = static_cast<std::uint32_t>(surfaces_[i].positions.size());
      result_.report.input_triangles[i] = static_cast<std::uint32_t>(surfaces_[i].triangles.size());
    }
    if (surfaces_[0].is_disc() != surfaces_[1].is_disc())
      return fail(ErrorKind::kInvalidInput,
                  surfaces_[0].is_disc()
                      ? "first mesh: open, with 1 hole, but the second mesh is closed"
                      : "second mesh: open, with 1 hole, but the first mesh is closed");
    result_.report.are_discs = of_discs();
    return check_features();
  }

  Result<void> check_features() {
    for (const auto& [in_a, in_b] : options_.features) {
      FeaturePoint points{kNone, kNone};
      if (in_a < meshes_[0]->vertex_count()) points.first = surfaces_[0].point_of_vertex[in_a];
      if (in_b < meshes_[1]->vertex_count()) points.second = surfaces_[1].point_of_vertex[in_b];
      if (points.first == kNone || points.second == kNone)
        return fail(ErrorKind::kInvalidInput, "feature " + std::to_string(in_a) + " " +
                                                  std::to_string(in_b) + ": no such vertices");
      for (const auto& [other_a, other_b] : features_)
        if ((other_a == points.first) != (other_b == points.second))
          return fail(ErrorKind::kInvalidInput, "feature " + std::to_string(in_a) + " " +
                                                    std::to_string(in_b) +
                                                    ": a vertex is matched twice");
      features_.push_back(points);
    }
    return {};
  }

  [[nodiscard]] bool of_discs() const { return surfaces_[0].is_disc(); }

  Result<void> embed_discs() {
    for (std::size_t i = 0; i < 2; ++i)
      discs_.maps[i].disc = to_disc_mesh(*meshes_[i], surfaces_[i]);
    if (auto laid = lay_boundaries(discs_, features_); !laid) return laid;
    Result<std::vector<SpherePoint>> found[2];
    // The callback belongs to the caller's thread, which maps the first disc.
    std::atomic<bool> is_cancelled = false;
    SphereEmbeddingOptions quiet, loud;
    quiet.progress = [&](float) { return !is_cancelled; };
    loud.progress = [&](float done) {
      if (!report(options_.progress, "embed", 0.5f * done)) is_cancelled = true;
      return !is_cancelled;
    };
    const auto embed_one = [&](std::size_t i, const SphereEmbeddingOptions& embedding) {
      found[i] =
          embed_on_half_sphere(discs_.maps[i].disc.surface, discs_.maps[i].points, embedding);
    };
    parallel_both(
        options_.threads, [&] { embed_one(0, loud); }, [&] { embed_one(1, quiet); });
    for (std::size_t i = 0; i < 2; ++i) {
      if (!found[i])
        return fail_in(i == 0 ? "first mesh" : "second mesh", std::move(found[i].error()));
      discs_.maps[i].points = std::move(*found[i]);
    }
    return join_discs();
  }

  // Both are closed below after that.
  Result<void> join_discs() {
    const auto meeting = bring_together(discs_);
    if (!meeting) return tl::unexpected(meeting.error());
    result_.report.feature_distance = *meeting;
    shared_ = merge_boundaries(discs_.maps[0], discs_.maps[1]);
    for (std::size_t i = 0; i < 2; ++i) {
      CappedDisc disc = capped(std::move(discs_.maps[i]));
      cut_meshes_[i] = std::move(disc.mesh);
      meshes_[i] = &cut_meshes_[i];
      surfaces_[i] = std::move(disc.surface);
      points_[i] = std::move(disc.points);
      is_fixed_[i] = std::move(disc.is_fixed);
    }
    result_.report.embed_seconds = watch_.lap();
    return {};
  }

  Result<void> embed() {
    if (of_discs()) return embed_discs();
    CorrespondenceOptions correspondence;
    correspondence.features = features_;
    correspondence.threads = options_.threads;
    correspondence.progress = [&](float done) {
      return report(options_.progress, "embed", 0.6f * done);
    };
    const std::array<SurfaceView, 2> views{
        SurfaceView{surfaces_[0].indices, surfaces_[0].positions},
        SurfaceView{surfaces_[1].indices, surfaces_[1].positions}};
    auto found = find_correspondence(views, correspondence);
    if (!found) return tl::unexpected(std::move(found.error()));
    for (int i = 0; i < 2; ++i) points_[i] = std::move(found->points[i]);
    result_.report.feature_distance = found->feature_distance;
    result_.report.distortion = found->distortion;
    result_.report.embed_seconds = watch_.lap();
    return {};
  }

  Result<void> overlay() {
    if (!report(options_.progress, "overlay", 0.6f)) return cancelled();
    double nudge = kFirstNudge;
    for (int attempt = 0; attempt <= kNudges; ++attempt, nudge *= 4) {
      const SphereTriangulation a(surfaces_[0].indices, points_[0]),
          b(surfaces_[1].indices, points_[1]);
      const auto crossings = find_crossings(a, b, options_.threads, shared_);
      if (!crossings) {
        jitter(map_of(1), nudge, static_cast<std::uint64_t>(attempt) + 1);
        continue;
      }
      if (!crossings->is_complete)
        return fail(ErrorKind::kFailed,
                    "the edges of both meshes cross each other too often: triangles are too thin");
      const OverlayCells cells = trace_cells(a, b, *crossings);
      overlay_ = make_overlay_mesh({*meshes_[0], a, surfaces_[0].triangles},
                                   {*meshes_[1], b, surfaces_[1].triangles}, *crossings, cells);
      result_.report.crossings = static_cast<std::uint32_t>(crossings->crossings.size());
      result_.report.overlay_triangles = overlay_.mesh.triangle_count();
      for (int i = 0; i < 2; ++i)
        result_.report.flipped_on_sphere +=
            count_flipped_on_sphere(surfaces_[i].indices, points_[i]);
      result_.report.overlay_seconds = watch_.lap();
      return {};
    }
    return fail(ErrorKind::kFailed, "the maps of both meshes have vertices on each other's edges");
  }

  Result<void> reduce() {
    bool is_cancelled = false;
    ReductionOptions reduction;
    reduction.tolerance = options_.tolerance;
    reduction.progress = [&](float done) {
      is_cancelled = !report(options_.progress, "reduce", 0.6f + 0.4f * done);
      return !is_cancelled;
    };
    const ReductionReport reduced = reduce_overlay(overlay_, reduction);
    if (is_cancelled) return cancelled();
    result_.report.merged_points = reduced.merged_points;
    result_.report.removed_points = reduced.removed_points;
    result_.mesh = std::move(overlay_.mesh);
    if (options_.fit) fit();
    result_.report.reduce_seconds = watch_.lap();
    return {};
  }

  // The turn by right angles that brings places that meet closest; boxes give the rest.
  void fit() {
    Similarity& similarity = result_.report.moved_b;
    similarity.turn = best_axis_turn(result_.mesh.positions, result_.mesh.poses[0].positions);
    Box box_a, box_b;
    for (const Vec3& p : surfaces_[0].positions) box_a.add(p);
    for (const Vec3& p : surfaces_[1].positions) box_b.add(similarity(p));
    if (box_b.diagonal() > 0)
      similarity.scale = static_cast<double>(box_a.diagonal()) / box_b.diagonal();
    similarity.offset = DVec3(box_a.center()) - similarity.scale * DVec3(box_b.center());
    Pose& pose = result_.mesh.poses[0];
    for (Vec3& p : pose.positions) p = similarity(p);
    for (Vec3& n : pose.normals) n = Vec3(rotated(similarity.turn, DVec3(n)));
  }

  MutableSphereMap map_of(int i) {
    return {surfaces_[i].indices, surfaces_[i].positions, points_[i],
            of_discs() ? &is_fixed_[i] : nullptr};
  }

  const TriangleMesh* meshes_[2];
  const SupermeshOptions& options_;
  SphereSurface surfaces_[2];
  std::vector<FeaturePoint> features_;  // as points
  std::vector<SpherePoint> points_[2];
  DiscPair discs_;
  SharedPoints shared_;         // of discs
  TriangleMesh cut_meshes_[2];  // discs with the vertices of both boundaries
  std::vector<bool> is_fixed_[2];
  OverlayTriangles overlay_;
  Stopwatch watch_;
  Supermesh result_;
};

}  // namespace

Result<Supermesh> build_supermesh(const TriangleMesh& a, const TriangleMesh& b,
                                  const SupermeshOptions& options) {
  return SupermeshBuilder(a, b, options).run();
}

}  // namespace varifold
