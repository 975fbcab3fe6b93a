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
  const auto make = [](const DetailedMesh& detailed) {
    return std::make_shared<const ProgressiveMesh>(build_progressive_mesh(detailed));
  };
  return build_and_write(
      command.build, make, [](const auto&, Report&) {}, command.file);
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
