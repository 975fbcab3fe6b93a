// varifold build pm: a mesh becomes a progressive mesh.
#include <apps/cli/commands.h>
#include <apps/cli/input.h>
#include <apps/cli/simplify_options.h>
#include <varifold/io/model_file.h>
#include <varifold/models/pm/build.h>
#include <memory>

namespace varifold::cli {
namespace {

struct BuildCommand {
  CommonOptions common;
  PrepareOptions prepare;
  SimplifyFlags flags;
  ModelFileOptions file;
  std::string input, output;
  bool no_measure = false;
};

struct BuiltModel {
  ProgressiveMesh model;
  StopReport stop;
  InputFaults faults;
  double read_seconds = 0, simplify_seconds = 0, measure_seconds = 0, model_seconds = 0;
};

// Lets go of everything but the model on its way.
Result<BuiltModel> build_model(const BuildCommand& command, const std::filesystem::path& input) {
  BuiltModel built;
  const Stopwatch read_watch;
  auto imported = read_surface(input);
  built.read_seconds = read_watch.seconds();
  if (!imported) return tl::unexpected(std::move(imported.error()));
  prepare_mesh(imported->mesh, command.prepare);
  SimplifyOptions options = simplify_options(command.flags, command.common, input);
  options.measure_error = !command.no_measure;
  auto result = simplify(imported->mesh, options);
  end_progress();
  if (!result) return fail_in(input.string(), std::move(result.error()));
  imported->mesh = {};
  built.stop = result->stop;
  built.faults = result->faults;
  built.simplify_seconds = result->collapse_seconds;
  built.measure_seconds = result->measure_seconds;
  const Stopwatch model_watch;
  built.model = build_progressive_mesh(result->detailed);
  built.model_seconds = model_watch.seconds();
  return built;
}

void report_model(const BuiltModel& built, const ModelFileReport& file, Report& report) {
  const ProgressiveMesh& model = built.model;
  const std::uint32_t vertices = model.data().mesh.vertex_count();
  report.text("kind", "kind", "pm");
  report.count("vertices", "vertices", vertices);
  report.count("triangles", "triangles", model.triangle_count());
  report.count("base_vertices", "base vertices", model.vertex_count(0));
  report.count("base_triangles", "base triangles", model.triangle_count(0));
  report.count("levels", "levels", std::uint64_t{model.finest_level()} + 1);
  report.length("base_error", "error of the base", model.error(0));
  report.set("error_is_measured", model.data().error_is_measured);
  report.length("position_error", "rounding of positions", file.position_error);
  report.bytes("model_bytes", "in memory", model.bytes());
  report.bytes("file_bytes", "file", file.file_bytes);
  report.length("bytes_per_vertex", "bytes a vertex, memory",
                static_cast<double>(model.bytes()) / std::max(1u, vertices));
  report.length("file_bytes_per_vertex", "bytes a vertex, file",
                static_cast<double>(file.file_bytes) / std::max(1u, vertices));
  report.set("dropped_degenerate_triangles", built.faults.degenerate_triangles);
  report.set("dropped_duplicate_triangles", built.faults.duplicate_triangles);
}

CommandResult run_build(const BuildCommand& command) {
  const auto input = input_path(command.input), output = output_path(command.output);
  if (auto writable = check_output(output, command.common); !writable)
    return tl::unexpected(writable.error());
  const Stopwatch watch;
  const auto built = build_model(command, input);
  if (!built) return tl::unexpected(built.error());
  if (auto done = check_interrupted(input); !done) return tl::unexpected(done.error());
  const Stopwatch write_watch;
  const auto file = write_model(built->model, output, command.file);
  if (!file) return tl::unexpected(file.error());

  const double write_seconds = write_watch.seconds();
  Report report;
  report_model(*built, *file, report);
  report_stop(built->stop, input, report);
  report.seconds("read_seconds", "time to read", built->read_seconds);
  report.seconds("simplify_seconds", "to collapse", built->simplify_seconds);
  report.seconds("measure_seconds", "to measure errors", built->measure_seconds);
  report.seconds("model_seconds", "to build the model", built->model_seconds);
  report.seconds("write_seconds", "to write", write_seconds);
  report.seconds("seconds", "in all", watch.seconds());
  report.bytes("peak_rss_bytes", "memory at most", peak_rss_bytes());
  return finish(report, command.common, output);
}

void add_bits(CLI::App& command, const char* name, int& bits, const char* help) {
  command.add_option(name, bits, help)->check(CLI::Range(1, 24))->type_name("B");
}

}  // namespace

void add_build(CLI::App& app, CommandRunner& runner) {
  CLI::App* const build = app.add_subcommand("build", "Build a model with levels of detail");
  build->require_subcommand(1);
  CLI::App* const command = build->add_subcommand("pm", "Progressive mesh");
  const auto options = std::make_shared<BuildCommand>();
  command->add_option("mesh", options->input, "The mesh file")->required()->type_name("MESH");
  command->add_option("-o,--output", options->output, "The model file, .vfm")
      ->required()
      ->type_name("MODEL");
  add_simplify_flags(*command, options->flags);
  add_prepare_options(*command, options->prepare);
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
  command->add_flag("--no-measure", options->no_measure,
                    "Estimate the errors of the levels instead of measuring them");
  runner.add_common(*command, options->common, true);
  runner.attach(*command, options->common, [options] { return run_build(*options); });
}

}  // namespace varifold::cli
