// Which level of a model, seen from where: the LEVEL of the command line.
#pragma once

#include <apps/cli/context.h>
#include <apps/cli/report.h>
#include <varifold/base/result.h>
#include <varifold/io/any_model.h>
#include <varifold/models/common/uniform_model.h>
#include <varifold/view/camera.h>
#include <varifold/view/camera_path.h>
#include <varifold/view/criteria.h>
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace varifold::cli {

/// Adds --size WxH; sides from 1 to 16384.
struct PictureSize {
  int width = 0, height = 0;
};
CLI::Option* add_size_option(CLI::App& command, const std::string& help,
                             const std::function<void(PictureSize)>& set);

/// A camera path: the name of one that comes with the project, or else a file. Errors begin with
/// the argument.
[[nodiscard]] Result<CameraPath> find_camera_path(const std::string& argument);

/// Where the camera stands; framed automatically where there is no eye.
struct ViewOptions {
  std::optional<Vec3> eye, target;
  Vec3 up{0, 1, 0};
  float fovy_degrees = 30;
  int width = 1280;
  int height = 960;
  float azimuth_degrees = 30;
  float elevation_degrees = 20;
  std::string path;  ///< a camera path, instead of all others
  std::uint32_t frame = 0;
  bool has_size = false;
};
void add_view_options(CLI::App& command, ViewOptions& options);

/// The camera; frames `points` where no eye is given. Wrong usage where it cannot see; an error
/// where a path cannot be read or its frame cannot see.
[[nodiscard]] Result<Camera> make_camera(const ViewOptions& options, std::span<const Vec3> points);

/// Where the user wants detail, beside the view.
struct PlaceOptions {
  std::optional<Vec4> sphere;  ///< center and radius
  std::optional<Vec4> plane;   ///< a x + b y + c z + d >= 0
  std::optional<Vec3> light;   ///< direction; with a view
  DeviationMeasure deviation = DeviationMeasure::kSeen;

  [[nodiscard]] bool empty() const { return !sphere && !plane && !light; }
};
void add_place_options(CLI::App& command, PlaceOptions& options);
/// The camera, where there is one, and the places. Wrong usage where a place is none.
[[nodiscard]] RefineCriteria make_criteria(const PlaceOptions& places, const Camera* camera);

struct LevelOptions {
  std::optional<double> lod, error, pixels;
  std::optional<std::uint32_t> triangles, vertices, level;

  [[nodiscard]] bool empty() const {
    return !lod && !error && !pixels && !triangles && !vertices && !level;
  }
};
void add_level_options(CLI::App& command, LevelOptions& options);
/// Wrong usage where several levels are asked for that do not go together.
void check_level_options(const LevelOptions& options);

/// Tells where less was asked for than the base has, so that it is the base that comes.
void warn_of_base(const std::string& input, const LevelOptions& options,
                  std::uint32_t base_vertices, std::uint32_t base_triangles);

/// The point of the bounds of `points` that is nearest to the eye.
[[nodiscard]] Vec3 nearest_point(std::span<const Vec3> points, const Vec3& eye);

struct ChosenLevel {
  std::uint32_t level = 0;
  float pixel_error = 0;       ///< of the level, where there is a camera
  std::optional<float> error;  ///< in model units, where it does not depend on a view
  bool is_front = false;       ///< levels differ from place to place; `level` says nothing
  std::uint32_t forced_splits = 0, triangles = 0;
};

/// The level that is asked for: the finest where none is.
///
/// --pixels: the coarsest whose error covers at most so many pixels at the point of the bounds that
/// is nearest to the eye; with --triangles the coarser of the two.
template <LeveledModel Model>
[[nodiscard]] ChosenLevel choose_level(const Model& model, const LevelOptions& options,
                                       const Camera* camera) {
  ChosenLevel chosen{model.finest_level()};
  if (options.level) {
    if (*options.level > model.finest_level())
      wrong_usage("--level: the levels of this model are 0 to " +
                  std::to_string(model.finest_level()));
    chosen.level = *options.level;
  }
  if (options.lod) chosen.level = model.level_for_fraction(static_cast<float>(*options.lod));
  if (options.vertices) chosen.level = model.level_for_vertices(*options.vertices);
  if (options.error) chosen.level = model.level_for_error(static_cast<float>(*options.error));
  if (options.triangles) chosen.level = model.level_for_triangles(*options.triangles);
  chosen.error = model.error(chosen.level);
  if (!camera || model.attributes().positions.empty()) return chosen;

  const PixelScale scale(*camera);
  const Vec3 nearest = nearest_point(model.attributes().positions, camera->eye);
  if (options.pixels) {
    const float error = scale.error_of(static_cast<float>(*options.pixels), nearest);
    chosen.level = std::min(chosen.level, model.level_for_error(error));
  }
  chosen.error = model.error(chosen.level);
  chosen.pixel_error = scale.pixels_of(*chosen.error, nearest);
  return chosen;
}

/// Whether a budget of triangles was not met: even the base has more.
inline void report_budget(const LevelOptions& options, const ChosenLevel& chosen, Report& report) {
  if (options.triangles) report.set("over_budget", chosen.triangles > *options.triangles);
}

/// Whether levels may follow the view: a camera was placed, or pixels were asked for.
[[nodiscard]] inline bool asks_for_view(const ViewOptions& view, const LevelOptions& level) {
  return level.pixels || ((view.eye || !view.path.empty()) && level.triangles);
}

/// Of a front that was found for a budget: a model may meet it by trials, the splits of which all
/// count, so that the front is made once more, without.
template <HasFronts Model>
[[nodiscard]] std::uint32_t forced_splits(const Model& model, const RefineCriteria& criteria,
                                          const FrontStatistics& found) {
  InstanceOf<Model> instance(std::shared_ptr<const Model>(std::shared_ptr<void>(), &model));
  const FrontStatistics front = instance.adapt(criteria, {found.tolerance});
  return front.triangles == found.triangles ? front.forced_splits : found.forced_splits;
}

/// Models that have a front of least error for a number of triangles, beside whole levels.
template <class Model>
concept FindsLeastError = requires(InstanceOf<Model>& instance, std::uint32_t number) {
  instance.go_to_triangles(number);
};

template <FindsLeastError Model>
[[nodiscard]] ChosenLevel go_to_least_error(InstanceOf<Model>& instance, std::uint32_t triangles,
                                            const Camera* camera) {
  const FrontStatistics front = instance.go_to_triangles(triangles).statistics;
  ChosenLevel chosen{0, 0, front.tolerance, true, front.forced_splits, front.triangles};
  const std::vector<Vec3>& points = instance.model().attributes().positions;
  if (camera && !points.empty())
    chosen.pixel_error =
        PixelScale(*camera).pixels_of(front.tolerance, nearest_point(points, camera->eye));
  return chosen;
}

/// Takes an instance to what is asked for: a level, or, for models whose levels may differ from
/// place to place, the front that the places and, if `by_view`, the camera ask for, or else the
/// one of least error where the model finds that.
template <class Model>
[[nodiscard]] ChosenLevel go_to_choice(InstanceOf<Model>& instance, const LevelOptions& options,
                                       const PlaceOptions& places, const Camera* camera,
                                       bool by_view) {
  const Model& model = instance.model();
  by_view = by_view && camera;
  if constexpr (HasFronts<Model>) {
    if (by_view || !places.empty()) {
      const RefineCriteria criteria = make_criteria(places, by_view ? camera : nullptr);
      FrontStatistics front = instance.adapt(
          criteria,
          {static_cast<float>(options.pixels.value_or(0)), options.triangles.value_or(kNone)});
      if (options.triangles) front.forced_splits = forced_splits(model, criteria, front);
      // From there on places of full detail gave way: nothing bounds the error.
      const float error = front.tolerance < RefineCriteria::kFullDetail
                              ? front.tolerance
                              : std::numeric_limits<float>::infinity();
      return {0, error, {}, true, front.forced_splits, front.triangles};
    }
  } else if (!places.empty()) {
    wrong_usage(std::string("--sphere, --plane and --light are for models with fronts (strips, "
                            "vdpm, patchtree), not ") +
                ModelKind<Model>::kName);
  }
  if constexpr (FindsLeastError<Model>)
    if (options.triangles && *options.triangles < model.triangle_count(model.finest_level()))
      return go_to_least_error<Model>(instance, *options.triangles, camera);
  ChosenLevel chosen = choose_level(model, options, camera);
  instance.go_to_level(chosen.level);
  chosen.triangles = model.triangle_count(chosen.level);
  return chosen;
}

}  // namespace varifold::cli
