// varifold build: a mesh becomes a model with levels of detail.
#include <apps/cli/build_common.h>

namespace varifold::cli {

void add_build_options(CLI::App& command, BuildOptions& options) {
  CLI::Option* const mesh =
      command.add_option("mesh", options.input, "The mesh file")->type_name("MESH");
  add_pose_sources(command, *mesh, options.poses);
  command.add_option("-o,--output", options.output, "The model file, .vfm")
      ->required()
      ->type_name("MODEL");
  add_simplify_flags(command, options.flags);
  add_prepare_options(command, options.prepare);
  command.add_flag("--no-measure", options.no_measure,
                   "Estimate the errors of the levels instead of measuring them");
}

Result<BuildInput> simplify_input(const BuildOptions& command) {
  const auto path = rest_path(command.input, command.poses);
  BuildInput input;
  const Stopwatch read_watch;
  auto imported = read_posed_surface(command.input, command.poses);
  input.read_seconds = read_watch.seconds();
  if (!imported) return tl::unexpected(std::move(imported.error()));
  prepare_mesh(imported->mesh, command.prepare);
  SimplifyOptions options = simplify_options(command.flags, command.common, path);
  options.measure_error = !command.no_measure;
  options.poses = pose_use(*imported, command.poses);
  input.sampled_poses = imported->samples.size();
  auto result = simplify(imported->mesh, options);
  end_progress();
  if (!result) return fail_in(path.string(), std::move(result.error()));
  if (auto has_any = check_any_left(*result, path); !has_any)
    return tl::unexpected(std::move(has_any.error()));
  input.detailed = std::move(result->detailed);
  input.stop = result->stop;
  input.faults = result->faults;
  input.simplify_seconds = result->collapse_seconds;
  input.measure_seconds = result->measure_seconds;
  return input;
}

void report_poses(const TriangleMesh& mesh, std::size_t sampled, Report& report) {
  if (!mesh.poses.empty()) report.count("poses", "poses", mesh.poses.size());
  if (sampled > 0) report.count("sampled_poses", "sampled from animations", sampled);
}

void report_times(const BuildInput& input, const BuildTimes& times, Report& report) {
  report.seconds("read_seconds", "time to read", input.read_seconds);
  report.seconds("simplify_seconds", "to collapse", input.simplify_seconds);
  report.seconds("measure_seconds", "to measure errors", input.measure_seconds);
  report.seconds("model_seconds", "to build the model", times.model);
  report.seconds("write_seconds", "to write", times.write);
  report.seconds("seconds", "in all", times.all);
  report.bytes("peak_rss_bytes", "memory at most", peak_rss_bytes());
}

void add_build(CLI::App& app, CommandRunner& runner) {
  CLI::App* const build = app.add_subcommand("build", "Build a model with levels of detail");
  build->require_subcommand(1);
  add_build_frames(*build, runner);
  add_build_patchtree(*build, runner);
  add_build_pm(*build, runner);
  add_build_strips(*build, runner);
  add_build_vdpm(*build, runner);
}

}  // namespace varifold::cli
