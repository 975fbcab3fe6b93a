// varifold simplify: one mesh, fewer triangles.
#include <apps/cli/commands.h>
#include <apps/cli/input.h>
#include <apps/cli/pose_options.h>
#include <apps/cli/simplify_options.h>
#include <varifold/measure/surface_distance.h>
#include <cmath>
#include <memory>
#include <optional>

namespace varifold::cli {
namespace {

struct SimplifyCommand {
  CommonOptions common;
  PrepareOptions prepare;
  SimplifyFlags flags;
  PoseSources poses;
  std::string input, output;
  std::optional<std::uint32_t> triangles;
  std::optional<double> ratio, error;
  std::uint32_t samples = 200'000;
  bool strict = false;
};

// Without a number of triangles nor an error the simplifier goes on as long as it can, so 0 is
// what --triangles 0 means.
std::uint32_t target_of(const SimplifyCommand& command, const TriangleMesh& mesh) {
  if (command.triangles) return *command.triangles;
  if (!command.ratio) return 0;
  return static_cast<std::uint32_t>(std::lround(*command.ratio * mesh.triangle_count()));
}

void report_distance(const TriangleMesh& simplified, const TriangleMesh& original,
                     const SimplifyCommand& command, Report& report) {
  DistanceOptions options;
  options.samples = command.samples;
  options.vertices = true;
  options.threads = command.common.threads;
  const SurfaceDistanceReport distance = surface_distance(simplified, original, options);
  report.length("rms_error", "error, root mean square", distance.rms);
  report.length("max_error", "error, maximum", distance.hausdorff);
  report.set("diagonal", distance.diagonal);
  report.row("diagonal of the box", format_number(distance.diagonal));
}

// The mesh at level 0.
Result<Simplification> run_simplifier(const PosedInput& posed, const SimplifyCommand& command,
                                      const std::filesystem::path& input) {
  TriangleMesh mesh = posed.mesh;
  prepare_mesh(mesh, command.prepare);
  SimplifyOptions options = simplify_options(command.flags, command.common, input);
  options.target_triangles = target_of(command, mesh);
  options.poses = pose_use(posed, command.poses);
  if (command.error) options.max_error = static_cast<float>(*command.error);
  auto result = simplify(mesh, options);
  end_progress();
  if (!result) return fail_in(input.string(), std::move(result.error()));
  if (auto has_any = check_any_left(*result, input); !has_any)
    return tl::unexpected(std::move(has_any.error()));
  return result;
}

CommandResult run_simplify(const SimplifyCommand& command) {
  const auto input = rest_path(command.input, command.poses), output = output_path(command.output);
  if (auto writable = check_mesh_output(output, command.common); !writable)
    return tl::unexpected(writable.error());
  const Stopwatch watch;
  const auto original = read_posed_surface(command.input, command.poses);
  if (!original) return tl::unexpected(original.error());
  const auto result = run_simplifier(*original, command, input);
  if (!result) return tl::unexpected(result.error());
  const CollapseSequence& sequence = result->detailed.sequence;
  const TriangleMesh simplified = without_unused_vertices(mesh_at_level(result->detailed, 0));
  if (auto written = write_mesh_loudly(simplified, output); !written)
    return tl::unexpected(written.error());

  Report report;
  report.count("vertices", "vertices", simplified.vertex_count());
  report.count("triangles", "triangles", simplified.triangle_count());
  report.count("input_triangles", "of", original->mesh.triangle_count());
  report_distance(simplified, original->mesh, command, report);
  report.length("bound_error", "bound for the input's vertices",
                sequence.error.empty() ? 0.0 : sequence.error.front());
  report_stop(result->stop, input, report);
  report.set("simplify_seconds", result->collapse_seconds);
  report.seconds("seconds", "time", watch.seconds());
  const CommandResult done = finish(report, command.common, output);
  const bool is_stuck = result->stop.reason == StopReason::kStuck;
  return done && command.strict && is_stuck ? CommandResult(kFailure) : done;
}

}  // namespace

void add_simplify(CLI::App& app, CommandRunner& runner) {
  CLI::App* const command = app.add_subcommand("simplify", "Reduce a mesh to fewer triangles");
  const auto options = std::make_shared<SimplifyCommand>();
  CLI::Option* const mesh =
      command->add_option("mesh", options->input, "The mesh file")->type_name("MESH");
  add_pose_sources(*command, *mesh, options->poses);
  CLI::Option_group* const target = command->add_option_group("Target", "When to stop");
  target->require_option(1);
  target->add_option("--triangles", options->triangles, "At most so many triangles")
      ->type_name("N");
  target->add_option("--ratio", options->ratio, "This part of the triangles")
      ->check(CLI::Range(0.0, 1.0))
      ->check(finite_number())
      ->type_name("R");
  target
      ->add_option("--error", options->error,
                   "As few as possible with no vertex of the input farther away than this")
      ->check(CLI::NonNegativeNumber)
      ->check(finite_number())
      ->type_name("E");
  add_simplify_flags(*command, options->flags);
  add_prepare_options(*command, options->prepare);
  command->add_option("--samples", options->samples, "Points per direction to measure the error at")
      ->check(CLI::Range(1u, 100'000'000u))
      ->capture_default_str()
      ->type_name("N");
  command->add_flag("--strict", options->strict, "Exit code 1 where the target is not reached");
  command->add_option("-o,--output", options->output, "The mesh file: .ply, .obj or .glb")
      ->required()
      ->type_name("MESH");
  runner.add_common(*command, options->common, true);
  runner.attach(*command, options->common, [options] { return run_simplify(*options); });
}

}  // namespace varifold::cli
