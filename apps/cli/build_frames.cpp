// varifold build framestrips: an order of collapses for each shape of a mesh, or for groups of
// them.
#include <apps/cli/build_common.h>
#include <apps/cli/index_report.h>
#include <fmt/format.h>
#include <varifold/models/lodstrips/frame_build.h>
#include <charconv>
#include <memory>
#include <optional>

namespace varifold::cli {

namespace {

struct BuildCommand {
  BuildOptions build;
  std::string sequences = "frames";     ///< or how many
  std::optional<std::uint32_t> frames;  ///< from the shape at rest to pose 1
};

// 0: one for each frame.
std::uint32_t sequence_count(const std::string& text) {
  if (text == "frames") return 0;
  std::uint32_t count = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), count);
  if (error != std::errc() || end != text.data() + text.size() || count == 0)
    wrong_usage("--sequences: 'frames', or a number from 1 on, not '" + text + "'");
  return count;
}

void report_frames(const FrameStrips& model, Report& report) {
  const double vertices = std::max(1u, model.attributes().vertex_count());
  const double frames = model.frame_count();
  report.count("frames", "frames", model.frame_count());
  report.count("sequences", "sequences", model.data().sequences.size());
  report.bytes("sequence_bytes", "sequences, memory",
               static_cast<std::uint64_t>(model.sequence_bytes()));
  report.length("sequence_bytes_per_vertex_and_frame", "bytes a vertex and frame",
                static_cast<double>(model.sequence_bytes()) / vertices / frames);
  report.length("shared_bytes_per_frame", "vertices and strips, bytes a frame",
                static_cast<double>(model.bytes() - model.sequence_bytes()) / frames);
  auto instance = FrameStripsInstance(std::make_shared<const FrameStrips>(model));
  instance.go_to_level(model.finest_level());
  report_indices(index_measures(instance.draw_list()), report);
}

CommandResult run_build(const BuildCommand& command) {
  const BuildOptions& build = command.build;
  const auto input = rest_path(build.input, build.poses), output = output_path(build.output);
  FrameStripsOptions options;
  options.sequences = sequence_count(command.sequences);
  if (build.flags.placement == "optimal")
    wrong_usage("--placement optimal: strips name vertices, they do not move them; use kept");
  if (auto writable = check_output(output, build.common, ".vfm"); !writable)
    return tl::unexpected(writable.error());
  const Stopwatch watch;
  auto imported = read_posed_surface(build.input, build.poses);
  if (!imported) return tl::unexpected(std::move(imported.error()));
  const double read_seconds = watch.seconds();
  prepare_mesh(imported->mesh, build.prepare);
  if (command.frames && imported->mesh.poses.empty())
    wrong_usage(input.string() + ": --frames needs a pose");
  if (command.frames) options.frames = morph_frames(*command.frames);
  options.simplify = simplify_options(build.flags, build.common, input);
  options.simplify.measure_error = !build.no_measure;
  auto built = build_frame_strips(imported->mesh, options);
  end_progress();
  if (!built) return fail_in(input.string(), std::move(built.error()));
  if (auto done = check_interrupted(input); !done) return tl::unexpected(done.error());
  const Stopwatch write_watch;
  const auto file = write_model(built->model, output);
  if (!file) return tl::unexpected(file.error());
  const double write_seconds = write_watch.seconds();

  Report report;
  report_model(built->model, *file, built->faults, report);
  report_poses(built->model.attributes(), 0, report);
  report_frames(built->model, report);
  report_stop(built->stop, input, report);
  report.seconds("read_seconds", "time to read", read_seconds);
  report.seconds("cluster_seconds", "to group frames", built->cluster_seconds);
  report.seconds("simplify_seconds", "to collapse", built->simplify_seconds);
  report.seconds("measure_seconds", "to measure errors", built->measure_seconds);
  report.seconds("write_seconds", "to write", write_seconds);
  report.seconds("seconds", "in all", watch.seconds());
  report.bytes("peak_rss_bytes", "memory at most", peak_rss_bytes());
  return finish(report, build.common, output);
}

}  // namespace

void add_build_frames(CLI::App& build, CommandRunner& runner) {
  CLI::App* const command = build.add_subcommand(
      ModelKind<FrameStrips>::kName,
      "LodStrips of a mesh that moves, with a sequence for each of its shapes");
  const auto options = std::make_shared<BuildCommand>();
  add_build_options(*command, options->build);
  command
      ->add_option(
          "--sequences", options->sequences,
          "frames: an order of collapses for each shape; N: for each of N groups of shapes")
      ->capture_default_str()
      ->type_name("N");
  command
      ->add_option("--frames", options->frames,
                   "So many shapes from the one at rest to pose 1 (default: the shape at rest and "
                   "each pose)")
      ->check(CLI::Range(1u, 10000u))
      ->type_name("N");
  runner.add_common(*command, options->build.common, true);
  runner.attach(*command, options->build.common, [options] { return run_build(*options); });
}

}  // namespace varifold::cli
