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
  const auto make = [&command](const DetailedMesh& detailed) {
    StepBoundsOptions options;
    options.threads = command.build.common.threads;
    options.progress = show_progress(input_path(command.build.input).filename().string());
    options.vertical = command.vertical;
    auto model =
        std::make_shared<const ViewDependentMesh>(build_view_dependent_mesh(detailed, options));
    end_progress();
    return model;
  };
  return build_and_write(command.build, make, [](const auto&, Report&) {});
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
