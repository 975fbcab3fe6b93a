// varifold build patchtree: a mesh becomes a tree of patches.
#include <apps/cli/build_common.h>
#include <fmt/format.h>
#include <varifold/models/patch_tree/build.h>
#include <algorithm>
#include <memory>
#include <string>
#include <utility>

namespace varifold::cli {
namespace {

struct BuildCommand {
  CommonOptions common;
  PrepareOptions prepare;
  PoseSources poses;
  AttributeWeights weights;
  std::string input, output;
  std::uint32_t patch_triangles = PatchTreeOptions{}.triangles_per_patch;
  bool no_smoothing = false;
  std::string priority = "closest";
};

struct Times {
  double read = 0, build = 0, write = 0, all = 0;
};

void report_tree(const PatchTree& tree, const PatchTreeReport& built, Report& report) {
  const PatchTopology& topology = tree.topology();
  const std::uint32_t roots = topology.level_count() == 0 ? 0 : topology.first_of_level[1];
  const std::uint32_t stored = tree.data().offsets.back().triangle;
  const double input = std::max(1u, tree.triangle_count(tree.finest_level()));
  report.count("nodes", "nodes", topology.node_count());
  report.count("roots", "roots", roots);
  report.text("stop_reason", "stopped because",
              built.stop == TreeStop::kOneRoot ? "one_root" : "poor_ratio");
  report.count("stored_triangles", "triangles stored", stored);
  report.length("stored_ratio", "of those of the input", stored / input);
  report.set("non_disc_leaves", built.non_disc_leaves);
  report.set("reruns", built.reruns);
  report.set("locked_points", built.locked_points);
  report.set("vanished_points", built.vanished_points);
}

void report_times(const PatchTree& tree, const PatchTreeReport& built, const Times& times,
                  Report& report) {
  report.seconds("read_seconds", "time to read", times.read);
  report.seconds("partition_seconds", "to cut into patches", built.partition_seconds);
  report.seconds("simplify_seconds", "to halve", built.halving_seconds);
  report.seconds("measure_seconds", "to measure errors", built.error_seconds);
  report.seconds("layout_seconds", "to lay out", built.layout_seconds);
  report.seconds("model_seconds", "to build in all", times.build);
  report.seconds("write_seconds", "to write", times.write);
  report.seconds("seconds", "in all", times.all);
  report.length("triangles_per_second", "triangles a second, without files",
                tree.triangle_count(tree.finest_level()) / std::max(times.build, 1e-9));
  report.bytes("peak_rss_bytes", "memory at most", peak_rss_bytes());
}

// Roots that are many say that the surface resisted.
void warn_of_stop(const PatchTreeReport& built, const std::string& input) {
  if (built.stop == TreeStop::kOneRoot || built.level_triangles.empty()) return;
  print_message(fmt::format(
      "{}: stopped at {} triangles in {} patches: another level would have kept more than three "
      "quarters",
      input, format_count(built.level_triangles.back()), format_count(built.level_patches.back())));
}

Result<void> check_any_left(const PatchTree& tree, const PatchTreeReport& built,
                            const std::filesystem::path& input) {
  if (tree.node_count() > 0) return {};
  return fail(ErrorKind::kInvalidInput,
              fmt::format("{}: all {} triangles are degenerate: two corners at one position",
                          input.string(), format_count(built.faults.degenerate_triangles)));
}

CommandResult run_build(const BuildCommand& command) {
  const auto input = rest_path(command.input, command.poses), output = output_path(command.output);
  if (auto writable = check_output(output, command.common, ".vfm"); !writable)
    return tl::unexpected(writable.error());
  Times times;
  const Stopwatch watch;
  auto imported = read_posed_surface(command.input, command.poses);
  if (!imported) return tl::unexpected(std::move(imported.error()));
  times.read = watch.seconds();
  prepare_mesh(imported->mesh, command.prepare);

  const Stopwatch build_watch;
  PatchTreeOptions options;
  options.triangles_per_patch = command.patch_triangles;
  options.smooth_borders = !command.no_smoothing;
  options.priority =
      command.priority == "mean-value" ? PatchPriority::kMeanValue : PatchPriority::kClosestPoint;
  options.attributes = command.weights;
  options.threads = command.common.threads;
  options.progress = show_progress(input.filename().string());
  const auto built = build_patch_tree(imported->mesh, options);
  end_progress();
  if (!built) return fail_in(input.string(), built.error());
  times.build = build_watch.seconds();
  if (auto has_any = check_any_left(built->tree, built->report, input); !has_any)
    return tl::unexpected(std::move(has_any.error()));
  if (auto done = check_interrupted(input); !done) return tl::unexpected(done.error());

  const Stopwatch write_watch;
  const auto file = write_model(built->tree, output);
  if (!file) return tl::unexpected(file.error());
  times.write = write_watch.seconds();
  times.all = watch.seconds();
  Report report;
  report_model(built->tree, *file, built->report.faults, report);
  report_poses(built->tree.attributes(), imported->samples.size(), report);
  report_tree(built->tree, built->report, report);
  report.length("file_bytes_per_triangle", "bytes a triangle, file",
                static_cast<double>(file->file_bytes) /
                    std::max(1u, built->tree.triangle_count(built->tree.finest_level())));
  report.length("bytes_per_triangle", "bytes a triangle, memory",
                static_cast<double>(built->tree.bytes()) /
                    std::max(1u, built->tree.triangle_count(built->tree.finest_level())));
  warn_of_stop(built->report, command.input);
  report_times(built->tree, built->report, times, report);
  return finish(report, command.common, output);
}

}  // namespace

void add_build_patchtree(CLI::App& build, CommandRunner& runner) {
  CLI::App* const command = build.add_subcommand(
      ModelKind<PatchTree>::kName, "Patch tree: patches of triangles, few decisions for a view");
  const auto options = std::make_shared<BuildCommand>();
  CLI::Option* const mesh =
      command->add_option("mesh", options->input, "The mesh file")->type_name("MESH");
  add_pose_sources(*command, *mesh, options->poses);
  command->add_option("-o,--output", options->output, "The model file, .vfm")
      ->required()
      ->type_name("MODEL");
  command
      ->add_option("--patch-triangles", options->patch_triangles,
                   "Triangles of a patch in the mean, at every level")
      ->check(CLI::Range(1u, 4000u))
      ->capture_default_str()
      ->type_name("N");
  command->add_flag("--no-smoothing", options->no_smoothing,
                    "Leave the borders of patches as merging made them");
  command
      ->add_option("--priority", options->priority,
                   "How far vertices move, for the paper's priority: closest, to the nearest place "
                   "of the coarse surface; mean-value, by mean value coordinates as in the paper")
      ->check(CLI::IsMember({"closest", "mean-value"}))
      ->capture_default_str()
      ->type_name("KIND");
  add_weight_options(*command, options->weights);
  add_prepare_options(*command, options->prepare);
  runner.add_common(*command, options->common, true);
  runner.attach(*command, options->common, [options] { return run_build(*options); });
}

}  // namespace varifold::cli
