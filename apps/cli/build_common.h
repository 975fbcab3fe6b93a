// What all `varifold build KIND` share: options, the way from a file to a sequence, the report.
#pragma once

#include <apps/cli/commands.h>
#include <apps/cli/input.h>
#include <apps/cli/pose_options.h>
#include <apps/cli/simplify_options.h>
#include <varifold/io/model_file.h>
#include <varifold/models/common/uniform_model.h>
#include <algorithm>
#include <filesystem>
#include <string>

namespace varifold::cli {

struct BuildOptions {
  CommonOptions common;
  PrepareOptions prepare;
  SimplifyFlags flags;
  PoseSources poses;
  std::string input, output;
  bool no_measure = false;
};
/// The files, what happens to the mesh before, and how the sequence is made.
void add_build_options(CLI::App& command, BuildOptions& options);

/// What became of the input, and how long it took; `detailed` may be let go of.
struct BuildInput {
  DetailedMesh detailed;
  StopReport stop;
  InputFaults faults;
  std::size_t sampled_poses = 0;  ///< shapes of animations that were heeded
  double read_seconds = 0, simplify_seconds = 0, measure_seconds = 0;
};
/// Reads, prepares and simplifies to the base. Errors begin with the path.
[[nodiscard]] Result<BuildInput> simplify_input(const BuildOptions& options);

/// The keys that every build has but for times: of the model and of its file.
template <class Model>
void report_model(const Model& model, const ModelFileReport& file, const InputFaults& faults,
                  Report& report) {
  const std::uint32_t finest = model.finest_level();
  const std::uint32_t vertices = model.vertex_count(finest);
  report.text("kind", "kind", ModelKind<Model>::kName);
  report.count("vertices", "vertices", vertices);
  report.count("triangles", "triangles", model.triangle_count(finest));
  report.count("base_vertices", "base vertices", model.vertex_count(0));
  report.count("base_triangles", "base triangles", model.triangle_count(0));
  report.count("levels", "levels", std::uint64_t{finest} + 1);
  report.length("base_error", "error of the base", model.error(0));
  report.set("error_is_measured", error_is_measured(model));
  report.length("position_error", "rounding of positions", file.position_error);
  report.bytes("model_bytes", "in memory", model.bytes());
  report.bytes("file_bytes", "file", file.file_bytes);
  report.length("bytes_per_vertex", "bytes a vertex, memory",
                static_cast<double>(model.bytes()) / std::max(1u, vertices));
  report.length("file_bytes_per_vertex", "bytes a vertex, file",
                static_cast<double>(file.file_bytes) / std::max(1u, vertices));
  report.set("dropped_degenerate_triangles", faults.degenerate_triangles);
  report.set("dropped_duplicate_triangles", faults.duplicate_triangles);
}

/// Poses of the model and shapes of animations that were heeded; nothing where there are none.
void report_poses(const TriangleMesh& mesh, std::size_t sampled, Report& report);

/// The times, beginning with those of the input.
struct BuildTimes {
  double model = 0, write = 0, all = 0;
};
void report_times(const BuildInput& input, const BuildTimes& times, Report& report);

/// From the input to the model's file and the report. make(detailed) makes the model, and
/// tell(model, report) adds what is special about its kind.
template <class Make, class Tell, class... FileOptions>
CommandResult build_and_write(const BuildOptions& build, const Make& make, const Tell& tell,
                              const FileOptions&... file_options) {
  const auto input = rest_path(build.input, build.poses), output = output_path(build.output);
  if (auto writable = check_output(output, build.common, ".vfm"); !writable)
    return tl::unexpected(writable.error());
  const Stopwatch watch;
  auto simplified = simplify_input(build);
  if (!simplified) return tl::unexpected(simplified.error());
  BuildTimes times;
  const Stopwatch model_watch;
  const auto model = make(simplified->detailed);
  times.model = model_watch.seconds();
  simplified->detailed = {};
  if (auto done = check_interrupted(input); !done) return tl::unexpected(done.error());
  const Stopwatch write_watch;
  const auto file = write_model(*model, output, file_options...);
  if (!file) return tl::unexpected(file.error());
  times.write = write_watch.seconds();
  times.all = watch.seconds();

  Report report;
  report_model(*model, *file, simplified->faults, report);
  report_poses(model->attributes(), simplified->sampled_poses, report);
  tell(model, report);
  report_stop(simplified->stop, input, report);
  report_times(*simplified, times, report);
  return finish(report, build.common, output);
}

/// The kinds, as subcommands of `build`.
void add_build_frames(CLI::App& build, CommandRunner& runner);
void add_build_patchtree(CLI::App& build, CommandRunner& runner);
void add_build_pm(CLI::App& build, CommandRunner& runner);
void add_build_strips(CLI::App& build, CommandRunner& runner);
void add_build_vdpm(CLI::App& build, CommandRunner& runner);

}  // namespace varifold::cli
