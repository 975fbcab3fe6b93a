#include <apps/cli/build_frames.h>
#include <apps/cli/index_report.h>
#include <fmt/format.h>
#include <varifold/models/lodstrips/frame_build.h>
#include <charconv>
#include <memory>

namespace varifold::cli {

namespace {

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

}  // namespace

void add_frame_options(CLI::App& command, FrameOptions& options) {
  CLI::Option* const sequences =
      command
          .add_option("--sequences", options.sequences,
                      "frames: an order of collapses for each shape, as in the thesis; N: for N "
                      "groups of shapes (default: one for all, changed in place)")
          ->type_name("N");
  command
      .add_option("--frames", options.frames,
                  "With --sequences: so many shapes from the one at rest to pose 1 (default: the "
                  "shape at rest and each pose)")
      ->check(CLI::Range(1u, 10000u))
      ->needs(sequences)
      ->type_name("N");
}

CommandResult run_build_frames(const BuildOptions& build, const FrameOptions& frames) {
  const auto input = rest_path(build.input, build.poses), output = output_path(build.output);
  FrameStripsOptions options;
  options.sequences = sequence_count(frames.sequences);
  if (auto writable = check_output(output, build.common, ".vfm"); !writable)
    return tl::unexpected(writable.error());
  const Stopwatch watch;
  auto imported = read_posed_surface(build.input, build.poses);
  if (!imported) return tl::unexpected(std::move(imported.error()));
  const double read_seconds = watch.seconds();
  prepare_mesh(imported->mesh, build.prepare);
  if (frames.frames && imported->mesh.poses.empty())
    wrong_usage(input.string() + ": --frames needs a pose");
  if (frames.frames) options.frames = morph_frames(*frames.frames);
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

}  // namespace varifold::cli
