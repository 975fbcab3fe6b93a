// varifold extract: the mesh at a level of a model.
#include <apps/cli/commands.h>
#include <apps/cli/index_report.h>
#include <apps/cli/input.h>
#include <apps/cli/level_options.h>
#include <apps/cli/pose_options.h>
#include <apps/cli/strip_mesh.h>
#include <varifold/strip/strip_measures.h>
#include <memory>
#include <optional>
#include <type_traits>
#include <utility>

namespace varifold::cli {
namespace {

struct ExtractCommand {
  CommonOptions common;
  LevelOptions level;
  ViewOptions view;
  PlaceOptions places;
  PoseChoice pose;
  bool has_view = false;
  std::string input, output;
  std::string strips;  ///< how they are divided; empty: triangles
};

// The level, with strips where they are asked for.
template <class Instance>
StripMesh level_mesh(Instance& instance, std::optional<StripJoin> join) {
  using Model = std::remove_cvref_t<decltype(instance.model())>;
  if constexpr (kDrawsStrips<Model>)
    if (join) return drawn_strips(instance.draw_list(), instance.model().attributes(), *join);
  TriangleMesh mesh = without_unused_vertices(instance.extract());
  return join ? new_strips(std::move(mesh), *join) : StripMesh{std::move(mesh), {}};
}

void report_strips(const JoinedStrips& strips, Report& report) {
  const IndexMeasures measures = measure_indices(strips.indices, strips.ranges);
  report.count("strips", "strips", measures.strips);
  report.count("indices", "indices", measures.indices);
  report.length("indices_per_triangle", "indices a triangle", measures.indices_per_triangle());
}

template <class Model>
CommandResult extract_from(const ExtractCommand& command, const std::shared_ptr<const Model>& model,
                           const Stopwatch& watch) {
  const auto output = output_path(command.output);
  std::optional<Camera> camera;
  if (command.has_view) {
    const auto made = make_camera(command.view, model->attributes().positions);
    if (!made) return tl::unexpected(made.error());
    camera = *made;
  }
  InstanceOf<Model> instance(model);
  const ChosenPose pose = choose_pose(command.input, model->attributes(), command.pose);
  go_to_pose(instance, pose);
  const ChosenLevel chosen =
      go_to_choice<Model>(instance, command.level, command.places, camera ? &*camera : nullptr,
                          asks_for_view(command.view, command.level));
  warn_of_base(command.input, command.level, model->vertex_count(0), model->triangle_count(0));
  const std::optional<StripJoin> join = strip_join(command.strips, output);
  StripMesh level = level_mesh(instance, join);
  if (!command.pose.empty()) level.mesh = frozen(level.mesh, pose);
  const TriangleMesh& mesh = level.mesh;
  if (auto written = write_mesh_loudly(mesh, output, join ? &level.strips : nullptr); !written)
    return tl::unexpected(written.error());

  Report report;
  report.text("kind", "kind", ModelKind<Model>::kName);
  if (!chosen.is_front) {
    report.count("level", "level", chosen.level);
    report.count("finest_level", "of", model->finest_level());
  }
  report.count("vertices", "vertices", mesh.vertex_count());
  report.count("triangles", "triangles", mesh.triangle_count());
  if constexpr (requires { instance.collapsed_triangles(); })
    report.count("collapsed_triangles", "collapsed at borders", instance.collapsed_triangles());
  if (join) report_strips(level.strips, report);
  if (chosen.error) report.length("error", "error", *chosen.error);
  report_budget(command.level, chosen, report);
  if (camera) {
    report.length("pixel_error", "error in pixels", chosen.pixel_error);
    report.count("forced_splits", "forced splits", chosen.forced_splits);
  }
  report.seconds("seconds", "time", watch.seconds());
  return finish(report, command.common, output);
}

CommandResult run_extract(const ExtractCommand& command) {
  const auto input = input_path(command.input), output = output_path(command.output);
  if (auto writable = check_mesh_output(output, command.common); !writable)
    return tl::unexpected(writable.error());
  const Stopwatch watch;
  const auto any = read_any_model(input);
  if (!any) return tl::unexpected(any.error());
  return std::visit([&](const auto& model) { return extract_from(command, model, watch); }, *any);
}

}  // namespace

void add_extract(CLI::App& app, CommandRunner& runner) {
  CLI::App* const command = app.add_subcommand("extract", "Write the mesh at a level of a model");
  const auto options = std::make_shared<ExtractCommand>();
  command->add_option("model", options->input, "The model file; - for standard input")
      ->required()
      ->type_name("MODEL");
  add_level_options(*command, options->level);
  add_view_options(*command, options->view);
  add_place_options(*command, options->places);
  add_pose_choice(*command, options->pose);
  command->add_option("-o,--output", options->output, "The mesh file: .ply, .obj or .glb")
      ->required()
      ->type_name("MESH");
  add_strips_option(*command, options->strips);
  runner.add_common(*command, options->common, false);
  runner.attach(*command, options->common, [options] {
    if (options->level.empty() && options->places.empty())
      wrong_usage(
          "a LEVEL is needed: --lod, --level, --triangles, --vertices, --error or --pixels");
    check_level_options(options->level);
    static_cast<void>(strip_join(options->strips, options->output));
    options->has_view = options->view.eye || !options->view.path.empty() || options->level.pixels;
    return run_extract(*options);
  });
}

}  // namespace varifold::cli
