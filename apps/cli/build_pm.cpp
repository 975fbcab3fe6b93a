// varifold build pm: a mesh becomes a progressive mesh.
#include <apps/cli/build_common.h>
#include <varifold/models/pm/build.h>
#include <memory>

namespace varifold::cli {
namespace {

struct BuildCommand {
  BuildOptions build;
  ModelFileOptions file;
};

CommandResult run_build(const BuildCommand& command) {
  const auto input = input_path(command.build.input), output = output_path(command.build.output);
  if (auto writable = check_output(output, command.build.common, ".vfm"); !writable)
    return tl::unexpected(writable.error());
  const Stopwatch watch;
  auto simplified = simplify_input(command.build);
  if (!simplified) return tl::unexpected(simplified.error());
  BuildTimes times;
  const Stopwatch model_watch;
  const ProgressiveMesh model = build_progressive_mesh(simplified->detailed);
  times.model = model_watch.seconds();
  simplified->detailed = {};
  if (auto done = check_interrupted(input); !done) return tl::unexpected(done.error());
  const Stopwatch write_watch;
  const auto file = write_model(model, output, command.file);
  if (!file) return tl::unexpected(file.error());
  times.write = write_watch.seconds();

  Report report;
  report_model(model, *file, simplified->faults, report);
  report_stop(simplified->stop, input, report);
  times.all = watch.seconds();
  report_times(*simplified, times, report);
  return finish(report, command.build.common, output);
}

void add_bits(CLI::App& command, const char* name, int& bits, const char* help) {
  command.add_option(name, bits, help)->check(CLI::Range(1, 24))->type_name("B");
}

}  // namespace

void add_build_pm(CLI::App& build, CommandRunner& runner) {
  CLI::App* const command = build.add_subcommand("pm", "Progressive mesh");
  const auto options = std::make_shared<BuildCommand>();
  add_build_options(*command, options->build);
  add_bits(*command, "--position-bits", options->file.encoding.position_bits,
           "Round positions to a grid of 2^B steps along the longest side (default: exact)");
  command
      ->add_option("--normal-bits", options->file.encoding.normal_bits,
                   "Round normals to 2^B steps per coordinate (default: exact)")
      ->check(CLI::Range(2, 16))
      ->type_name("B");
  add_bits(*command, "--texcoord-bits", options->file.encoding.texcoord_bits,
           "The same for texture coordinates (default: exact)");
  command->add_flag("--compress", options->file.compress, "Compress the file with zstd as well");
  runner.add_common(*command, options->build.common, true);
  runner.attach(*command, options->build.common, [options] { return run_build(*options); });
}

}  // namespace varifold::cli
