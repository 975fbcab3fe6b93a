// The stations of the demo, and what each of them showed.
#pragma once

#include <apps/cli/context.h>
#include <apps/cli/demo_strips.h>
#include <apps/cli/input.h>
#include <apps/cli/picture.h>
#include <varifold/base/result.h>
#include <varifold/mesh/triangle_mesh.h>
#include <varifold/mesh/validation.h>
#include <varifold/models/pm/progressive_mesh.h>
#include <varifold/view/camera.h>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace varifold::cli {

/// A shape of the demo, and how it is shown.
struct DemoShape {
  std::string name;   ///< of its files
  std::string title;  ///< for people
  std::string text;
  std::string command;         ///< that makes the same mesh
  std::vector<double> shares;  ///< of the triangles, one level each
  float elevation_degrees = 20;
  bool color_by_material = false;
  int picture_width = 600;  ///< and four fifths of it high
};

/// One level, extracted and drawn. Pictures are file names; empty where nothing is drawn.
struct DemoLevel {
  std::uint32_t level = 0, vertices = 0, triangles = 0;
  double error = 0;                ///< measured, of the vertices of the full mesh
  double rms = 0, maximum = 0;     ///< sampled in both directions
  std::uint64_t stream_bytes = 0;  ///< of the file, until this level is there
  double extract_seconds = 0;
  std::string mesh_file, shaded, wired;
};

/// A shape and its model.
struct DemoModel {
  DemoShape shape;
  std::uint32_t vertices = 0, triangles = 0, base_triangles = 0;
  double diagonal = 0;
  double build_seconds = 0, simplify_seconds = 0, check_seconds = 0;
  std::uint64_t model_bytes = 0, file_bytes = 0, mesh_bytes = 0;
  std::uint32_t levels = 0, levels_checked = 0;
  std::vector<Fault> faults;
  std::vector<DemoLevel> shown;
};

/// What a reader has after the first so many bytes of a file.
struct DemoPrefix {
  double part = 0;
  std::uint64_t bytes = 0;
  std::uint32_t vertices = 0, triangles = 0;
  double error = 0;
  std::string picture;
};

/// Instances of one model in a row, each as fine as a pixel asks for.
struct DemoCrowd {
  std::uint32_t instances = 0;
  std::uint64_t triangles = 0, full_triangles = 0;
  std::string picture, wired_picture;
};

struct DemoResult {
  std::vector<DemoModel> models;
  DemoStrips strips;
  std::vector<DemoPrefix> prefixes;
  std::optional<DemoCrowd> crowd;
  std::string device;  ///< what drew; empty where nothing could
};

/// Where the demo works, with what.
struct DemoPlace {
  std::filesystem::path folder;
  CommonOptions common;
  Painter* painter = nullptr;  ///< none without OpenGL
};

/// A line about what happens now, where people look.
void tell(const DemoPlace& place, const std::string& line);

/// Builds, checks, extracts and draws one shape; its files go to the folder.
[[nodiscard]] Result<DemoModel> show_shape(const DemoPlace& place, const DemoShape& shape,
                                           const TriangleMesh& mesh);

/// Reads the beginnings of a shape's model file.
[[nodiscard]] Result<std::vector<DemoPrefix>> show_stream(const DemoPlace& place,
                                                          const DemoShape& shape);

/// Draws a row of a shape's model that goes off into the distance. Needs a painter.
[[nodiscard]] Result<DemoCrowd> show_crowd(const DemoPlace& place, const DemoShape& shape);

}  // namespace varifold::cli
