// Which level of a model, seen from where: the LEVEL of the command line.
#pragma once

#include <varifold/models/pm/progressive_mesh.h>
#include <varifold/view/camera.h>
#include <CLI/CLI.hpp>
#include <cstdint>
#include <optional>
#include <span>

namespace varifold::cli {

/// Where the camera stands; framed automatically where there is no eye.
struct ViewOptions {
  std::optional<Vec3> eye, target;
  Vec3 up{0, 1, 0};
  float fovy_degrees = 30;
  int width = 1280;
  int height = 960;
  float azimuth_degrees = 30;
  float elevation_degrees = 20;
};
void add_view_options(CLI::App& command, ViewOptions& options);

/// The camera; frames `points` where no eye is given. Wrong usage where it cannot see.
[[nodiscard]] Camera make_camera(const ViewOptions& options, std::span<const Vec3> points);

struct LevelOptions {
  std::optional<double> lod, error, pixels;
  std::optional<std::uint32_t> triangles, vertices;

  [[nodiscard]] bool empty() const { return !lod && !error && !pixels && !triangles && !vertices; }
};
void add_level_options(CLI::App& command, LevelOptions& options);
/// Wrong usage where several levels are asked for that do not go together.
void check_level_options(const LevelOptions& options);

struct ChosenLevel {
  std::uint32_t level = 0;
  float pixel_error = 0;  ///< of the level, where there is a camera
};

/// The level that is asked for: the finest where none is.
///
/// --pixels: the coarsest whose error covers at most so many pixels at the point of the bounds that
/// is nearest to the eye; with --triangles the coarser of the two.
[[nodiscard]] ChosenLevel choose_level(const ProgressiveMesh& model, const LevelOptions& options,
                                       const Camera* camera);

}  // namespace varifold::cli
