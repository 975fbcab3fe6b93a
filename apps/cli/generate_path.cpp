#include <apps/cli/generate_path.h>
#include <apps/cli/input.h>
#include <varifold/base/bytes.h>
#include <varifold/io/camera_path_file.h>
#include <varifold/io/output_file.h>
#include <varifold/view/known_paths.h>
#include <algorithm>

namespace varifold::cli {

void add_path_options(CLI::App& command, PathOptions& options) {
  command.add_option("name", options.name, "Of a path: orbit, fly_by, dive or canyon")
      ->type_name("NAME");
  command.add_option("--frames", options.frames, "path: how many (default 360, 300, 300, 900)")
      ->check(CLI::Range(2u, kMaxPathFrames))
      ->type_name("N");
  command
      .add_option("--fovy", options.fovy_degrees,
                  "path: vertical angle of view (default 30; 50 for the canyon)")
      ->check(CLI::Range(0.01, 179.0))
      ->type_name("DEGREES");
  command
      .add_option("--distance", options.distance,
                  "orbit: diagonals of the mesh from its centre (default 2)")
      ->check(CLI::Range(0.001, 1000.0))
      ->type_name("D");
}

CommandResult generate_path(const PathOptions& options, const std::string& output,
                            const CommonOptions& common) {
  const auto names = known_path_names();
  if (std::find(names.begin(), names.end(), options.name) == names.end())
    wrong_usage("a path needs the NAME of one: orbit, fly_by, dive or canyon");
  if (options.distance && options.name != "orbit")
    wrong_usage("--distance means nothing to " + options.name);
  const auto file = output_path(output);
  if (auto writable = check_output(file, common); !writable)
    return tl::unexpected(writable.error());
  KnownPathOptions known;
  known.frames = options.frames;
  known.width = options.size.width;
  known.height = options.size.height;
  known.fovy_degrees = options.fovy_degrees;
  known.orbit_distance = options.distance.value_or(known.orbit_distance);
  const auto path = known_path(options.name, known);
  if (!path) return tl::unexpected(path.error());
  if (auto written = write_file(file, as_bytes(format_camera_path(*path))); !written)
    return tl::unexpected(written.error());
  Report report;
  report.text("path", "path", path->name);
  report.count("frames", "frames", path->frames);
  report.count("keys", "keys", path->keys.size());
  return finish(report, common, file);
}

}  // namespace varifold::cli
