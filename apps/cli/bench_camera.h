// varifold bench --test camera: what a model costs along a camera path.
#pragma once

#include <apps/cli/context.h>
#include <apps/cli/frame_lists.h>
#include <apps/cli/level_options.h>
#include <apps/cli/report.h>
#include <varifold/base/result.h>
#include <varifold/io/any_model.h>
#include <varifold/measure/frame_jumps.h>
#include <varifold/measure/patch_motion.h>
#include <varifold/strip/strip_measures.h>
#include <varifold/view/camera_path.h>
#include <algorithm>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace varifold::cli {

struct CameraTest {
  std::string path;
  std::optional<double> pixels;
  std::optional<std::uint32_t> triangles;
  std::optional<PictureSize> size;
  std::uint32_t morph_frames = 0;
  bool per_frame = false;
  ListOptions lists;
  bool no_frustum = false, no_orientation = false;
  bool paper_priority = false;      ///< of patch trees
  std::optional<float> morph_band;  ///< of patch trees

  /// 1 where nothing is asked for; 0, as fine as the triangles allow, with --triangles alone.
  [[nodiscard]] float tolerance() const {
    return static_cast<float>(pixels.value_or(triangles ? 0.0 : 1.0));
  }
};
void add_camera_test_options(CLI::App& command, CameraTest& test);

/// The path with the size of the command line.
[[nodiscard]] Result<CameraPath> camera_test_path(const CameraTest& test);

/// What happened at one frame.
struct CameraFrame {
  double adapt_seconds = 0, list_seconds = 0, draw_seconds = 0;
  double upload_seconds = 0;
  std::uint64_t uploaded_bytes = 0;
  double from_roots_seconds = 0;  // of choosing the same front without the one before
  std::uint32_t patches = 0;
  std::uint32_t splits = 0, collapses = 0, forced_splits = 0, vertices = 0, triangles = 0;
  std::uint32_t moving = 0;  // vertices that morphs move
  float tolerance = 0;
  std::uint64_t indices = 0;
  IndexMeasures measures;           // of the list
  double acmr_16 = 0, acmr_24 = 0;  // first-in first-out caches of so many vertices
  std::uint64_t changed_bytes = 0;  // what a device has to be sent
  FrameJumps::Jumps jumps;
  std::uint64_t drawn_vertices = 0;           // different ones, of patches
  std::uint64_t turned = 0, turned_seen = 0;  // triangles that blending turns over
};

/// The results of a walk, as the format of the JSON has them.
[[nodiscard]] Json camera_result(const CameraTest& test, const CameraPath& path,
                                 std::span<const CameraFrame> frames, bool is_drawn);
/// The line for people.
[[nodiscard]] std::string camera_row(const Json& result);

/// Models whose vertex buffers are not numbered as the collapse sequence say which vertex stands
/// where in them.
template <class Model>
concept NumbersVertices = requires(const InstanceOf<Model>& instance) {
  { instance.vertices_of_slots() } -> std::same_as<std::vector<std::uint32_t>>;
};

/// Where each vertex goes when it collapses; kNone for those of the base. O(vertices).
template <UniformModel Model>
[[nodiscard]] std::vector<std::uint32_t> collapse_targets(const Model& model) {
  std::vector<std::uint32_t> targets(model.vertex_count(model.finest_level()), kNone);
  for (std::uint32_t level = 0; level < model.finest_level(); ++level)
    for (std::uint32_t v = model.vertex_count(level); v < model.vertex_count(level + 1); ++v)
      targets[v] = model.ancestor(v, level);
  return targets;
}

/// Counts what a list draws and, after the lists of the frames before, what of it is new.
class ListMeasures {
 public:
  void next(const DrawList& list, CameraFrame& frame);

 private:
  std::uint64_t vertices_ = 0, indices_ = 0;
};

/// What bringing the buffers of the device up to date took.
struct Upload {
  std::size_t bytes = 0;
  double seconds = 0;
};

/// Draws a list as a camera sees it; empty where nothing is drawn.
using DrawFrame = std::function<Result<Upload>(const FrameList&, const Camera&)>;

/// What part of a budget may stay unused in a frame.
inline constexpr float kUnusedBudget = 0.004f;

template <class Model>
class CameraWalk {
 public:
  CameraWalk(const CameraTest& test, const std::shared_ptr<const Model>& model)
      : test_(test), model_(model) {
    for (const Vec3& p : model_->attributes().positions) box_.add(p);
  }

  /// Walks twice: once against the clock, and once, with an instance of its own, for the jumps and
  /// what the lists are like.
  Result<Json> run(const CameraPath& path, const DrawFrame& draw) {
    const auto cameras = cameras_of(path, box_);
    if (!cameras) return fail_in(test_.path, cameras.error());
    std::vector<CameraFrame> frames(cameras->size());
    std::size_t instance_bytes = 0;
    if (auto timed = time(*cameras, draw, frames, instance_bytes); !timed)
      return tl::unexpected(timed.error());
    if constexpr (DrawsPatches<Model>) time_from_roots(*cameras, frames);
    measure(*cameras, frames);
    Json result{{"kind", ModelKind<Model>::kName}};
    result.update(camera_result(test_, path, frames, static_cast<bool>(draw)));
    const double vertices = std::max(1u, model_->vertex_count(model_->finest_level()));
    result["model_bytes"] = model_->bytes();
    result["instance_bytes"] = instance_bytes;
    result["bytes_per_vertex"] = static_cast<double>(model_->bytes()) / vertices;
    return result;
  }

 private:
  Result<void> time(std::span<const Camera> cameras, const DrawFrame& draw,
                    std::vector<CameraFrame>& frames, std::size_t& instance_bytes) {
    InstanceOf<Model> instance(model_);
    FrameLists<Model> lists(model_, test_.lists);
    for (std::size_t i = 0; i < cameras.size(); ++i) {
      CameraFrame& frame = frames[i];
      const Stopwatch adapting;
      frame = adapt(instance, cameras[i]);
      frame.adapt_seconds = adapting.seconds();
      const Stopwatch listing;
      FrameList list = lists.of(instance);
      list.patch_style.morph = morph_of(cameras[i], frame.tolerance);
      frame.list_seconds = listing.seconds();
      frame.indices = submitted_indices(list).indices;
      if (!draw) continue;
      const Stopwatch drawing;
      const auto drawn = draw(list, cameras[i]);
      if (!drawn) return tl::unexpected(drawn.error());
      frame.draw_seconds = drawing.seconds();
      frame.upload_seconds = drawn->seconds;
      frame.uploaded_bytes = drawn->bytes;
    }
    instance_bytes = instance.bytes();
    return {};
  }

  // The paper's way, after one frame for the memory.
  void time_from_roots(std::span<const Camera> cameras, std::vector<CameraFrame>& frames) {
    InstanceOf<Model> instance(model_);
    const PatchFrontOptions options = patch_options();
    (void)instance.adapt(criteria_of(cameras[0]), options, true);
    for (std::size_t i = 0; i < cameras.size(); ++i) {
      const RefineCriteria criteria = criteria_of(cameras[i]);
      const Stopwatch adapting;
      (void)instance.adapt(criteria, options, true);
      frames[i].from_roots_seconds = adapting.seconds();
      frames[i].patches = static_cast<std::uint32_t>(instance.front().draws().draws().size());
    }
  }

  [[nodiscard]] PatchMeasure patch_measure() const {
    return test_.paper_priority ? PatchMeasure::kMeanSquared : PatchMeasure::kPixels;
  }

  [[nodiscard]] PatchFrontOptions patch_options() const {
    PatchFrontOptions options;
    options.limits = {test_.tolerance(), test_.triangles.value_or(kNone)};
    options.measure = patch_measure();
    return options;
  }

  [[nodiscard]] std::optional<PatchMorphRange> morph_of(const Camera& camera,
                                                        float tolerance) const {
    if (!test_.morph_band) return std::nullopt;
    return morph_range(camera, patch_measure(), tolerance, *test_.morph_band);
  }

  [[nodiscard]] RefineCriteria criteria_of(const Camera& camera) const {
    RefineCriteria criteria;
    criteria.view.emplace(camera);
    if (test_.no_frustum) criteria.view->outside_weight = 1;
    if (test_.no_orientation) criteria.view->back_weight = 1;
    return criteria;
  }

  void measure(std::span<const Camera> cameras, std::vector<CameraFrame>& frames) {
    InstanceOf<Model> instance(model_);
    std::optional<FrameJumps> jumps;
    if constexpr (UniformModel<Model>) jumps.emplace(collapse_targets(*model_));
    ListMeasures measures;
    // Caches are those of the triangles, however they are drawn.
    ListOptions options = test_.lists;
    options.arrays = true;
    FrameLists<Model> lists(model_, options);
    for (std::size_t i = 0; i < cameras.size(); ++i) {
      (void)adapt(instance, cameras[i]);
      const DrawList list = lists.of(instance).list;
      measures.next(list, frames[i]);
      std::vector<std::uint32_t> vertices;
      if constexpr (NumbersVertices<Model>) vertices = instance.vertices_of_slots();
      if (jumps) frames[i].jumps = jumps->next(list, vertices, cameras[i]);
    }
    if constexpr (DrawsPatches<Model>) measure_patches(cameras, frames);
  }

  void measure_patches(std::span<const Camera> cameras, std::vector<CameraFrame>& frames) {
    InstanceOf<Model> instance(model_);
    ListOptions options = test_.lists;
    options.arrays = false;
    FrameLists<Model> lists(model_, options);
    PatchMotion motion(model_);
    for (std::size_t i = 0; i < cameras.size(); ++i) {
      CameraFrame& frame = frames[i];
      const float tolerance = adapt(instance, cameras[i]).tolerance;
      const PatchDrawList list = *lists.of(instance).patches;
      const auto told = motion.next(list, morph_of(cameras[i], tolerance), cameras[i]);
      frame.jumps = told.jumps;
      frame.moving = static_cast<std::uint32_t>(told.moving);
      frame.drawn_vertices = told.vertices;
      frame.turned = told.turned;
      frame.turned_seen = told.turned_seen;
      if (!test_.lists.arrays)
        frame.changed_bytes = list.changed_draws.size() * sizeof(PatchDrawCommand);
    }
  }

  // A budget need not be used to the last triangle where a model can save the search for that.
  FrontStatistics adapt_in_frame(InstanceOf<Model>& instance, const RefineCriteria& criteria,
                                 const AdaptOptions& options) const {
    if constexpr (requires { instance.adapt(criteria, options, FrontLimits{}); }) {
      FrontLimits limits;
      limits.unused_budget = kUnusedBudget;
      limits.morph_frames = test_.morph_frames;
      return instance.adapt(criteria, options, limits);
    } else if constexpr (DrawsPatches<Model>) {
      return instance.adapt(criteria, patch_options(), false).statistics;
    } else {
      return instance.adapt(criteria, options);
    }
  }

  CameraFrame adapt(InstanceOf<Model>& instance, const Camera& camera) {
    CameraFrame frame;
    if constexpr (HasFronts<Model>) {
      const FrontStatistics front = adapt_in_frame(
          instance, criteria_of(camera), {test_.tolerance(), test_.triangles.value_or(kNone)});
      frame.splits = front.splits;
      frame.collapses = front.collapses;
      frame.forced_splits = front.forced_splits;
      frame.vertices = front.vertices;
      frame.triangles = front.triangles;
      frame.tolerance = front.tolerance;
      if constexpr (requires { instance.moving_vertices(); })
        frame.moving = instance.moving_vertices();
    } else {
      // One level for all: what the nearest point of the bounds needs.
      const PixelScale scale(camera);
      const Vec3 nearest = glm::clamp(camera.eye, box_.lower, box_.upper);
      const std::uint32_t before = instance.level();
      std::uint32_t level = model_->level_for_error(scale.error_of(test_.tolerance(), nearest));
      if (test_.triangles) level = std::min(level, model_->level_for_triangles(*test_.triangles));
      instance.go_to_level(level);
      frame.splits = level > before ? level - before : 0;
      frame.collapses = level < before ? before - level : 0;
      frame.vertices = model_->vertex_count(level);
      frame.triangles = model_->triangle_count(level);
      frame.tolerance = scale.pixels_of(model_->error(level), nearest);
    }
    return frame;
  }

  const CameraTest& test_;
  std::shared_ptr<const Model> model_;
  Box box_;
};

}  // namespace varifold::cli
