// varifold build vdpm: a mesh becomes a view-dependent mesh.
#include <apps/cli/build_common.h>
#include <varifold/models/vdpm/build.h>
#include <memory>

namespace varifold::cli {
namespace {

struct BuildCommand {
  BuildOptions build;
  bool vertical = false;
};

CommandResult run_build(const BuildCommand& command) {
  const auto input = input_path(command.build.input), output = output_path(command.build.output);
  if (auto writable = check_output(output, command.build.common); !writable)
    return tl::unexpected(writable.error());
  const Stopwatch watch;
  auto simplified = simplify_input(command.build);
  if (!simplified) return tl::unexpected(simplified.error());
  BuildTimes times;
  const Stopwatch model_watch;
  StepBoundsOptions options;
  options.threads = command.build.common.threads;
  options.progress = show_progress(input.filename().string());
  options.vertical = command.vertical;
  const ViewDependentMesh model = build_view_dependent_mesh(simplified->detailed, options);
  end_progress();
  times.model = model_watch.seconds();
  simplified->detailed = {};
  if (auto done = check_interrupted(input); !done) return tl::unexpected(done.error());
  const Stopwatch write_watch;
  const auto file = write_model(model, output);
  if (!file) return tl::unexpected(file.error());
  times.write = write_watch.seconds();

  Report report;
  report_model(model, *file, simplified->faults, report);
  report_stop(simplified->stop, input, report);
  times.all = watch.seconds();
  report_times(*simplified, times, report);
  return finish(report, command.build.common, output);
}

}  // namespace

void add_build_vdpm(CLI::App& build, CommandRunner& runner) {
  CLI::App* const command = build.add_subcommand(
      ModelKind<ViewDependentMesh>::kName, "View-dependent mesh: detail where a view needs it");
  const auto options = std::make_shared<BuildCommand>();
  add_build_options(*command, options->build);
  command->add_flag("--vertical", options->vertical,
                    "Height field: errors are measured along y, which is up, alone");
  runner.add_common(*command, options->build.common, true);
  runner.attach(*command, options->build.common, [options] { return run_build(*options); });
}

}  // namespace varifold::cli
