// varifold render: a picture of a mesh, or of a level of a model.
#include <apps/cli/commands.h>
#include <apps/cli/contact_sheet.h>
#include <apps/cli/frame_lists.h>
#include <apps/cli/input.h>
#include <apps/cli/level_options.h>
#include <apps/cli/picture.h>
#include <apps/cli/pose_options.h>
#include <varifold/measure/patch_motion.h>
#include <varifold/render/colors.h>
#include <varifold/render/mesh_draw_list.h>
#include <algorithm>
#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace varifold::cli {
namespace {

struct RenderCommand {
  CommonOptions common;
  LevelOptions level;
  ViewOptions view;
  PlaceOptions places;
  PoseChoice pose;
  ContactSheet sheet;
  std::string input, output, color = "auto";
  bool flat = false, wireframe = false, cull = false, no_occlusion = false;
  bool no_border_switch = false, arrays = false, morph = false;
  float morph_band = PatchMorphRange().band;
  float wire_width = 1;
  int supersampling = 2;
};

// What shows most of what the mesh has. White materials, as those with textures are, show nothing.
ColorMode automatic_color(const TriangleMesh& mesh) {
  if (mesh.has_colors()) return ColorMode::kVertexColor;
  const bool is_colored =
      std::any_of(mesh.materials.begin(), mesh.materials.end(),
                  [](const Material& material) { return Vec3(material.base_color) != Vec3(1); });
  return is_colored ? ColorMode::kMaterial : ColorMode::kPlain;
}

ColorMode color_mode(const std::string& name, const TriangleMesh& mesh) {
  if (name == "plain") return ColorMode::kPlain;
  if (name == "material") return ColorMode::kMaterial;
  if (name == "vertex") return ColorMode::kVertexColor;
  if (name == "level") return ColorMode::kLevel;
  if (name == "strip") return ColorMode::kStrip;
  if (name == "patch") return ColorMode::kPatch;
  return automatic_color(mesh);
}

// What is drawn: a list, and the mesh whose materials and bounds it has.
struct Scene {
  FrameList drawn;
  const TriangleMesh* mesh = nullptr;
  std::uint64_t triangles = 0;
  std::span<const std::uint32_t> patches;  // per range, where a model has patches
  const ShownPose* pose = nullptr;         // where the vertices go, if anywhere
};

// The ranges with a material for each patch, and the colours of those.
struct PatchColors {
  std::vector<DrawRange> ranges;
  std::vector<Vec4> colors;

  explicit PatchColors(const Scene& scene)
      : ranges(scene.drawn.list.ranges.begin(), scene.drawn.list.ranges.end()) {
    for (std::size_t r = 0; r < ranges.size(); ++r) {
      if (r == 0 || scene.patches[r] != scene.patches[r - 1])
        colors.emplace_back(linear_from_srgb(strip_color(scene.patches[r])), 1);
      ranges[r].material = static_cast<std::uint32_t>(colors.size() - 1);
    }
  }
};

CommandResult render_scene(const RenderCommand& command, const Scene& scene, Report& report) {
  const auto output = output_path(command.output);
  const auto camera =
      make_camera(command.view, scene.pose ? scene.pose->positions : scene.mesh->positions);
  if (!camera) return tl::unexpected(camera.error());
  DrawStyle style;
  if (scene.pose) style.pose = {scene.pose->weights, scene.pose->joints};
  style.shading = command.flat ? Shading::kFlat : Shading::kSmooth;
  style.color_mode = color_mode(command.color, *scene.mesh);
  const bool has_patches = scene.drawn.patches || !scene.patches.empty();
  if (style.color_mode == ColorMode::kStrip && has_patches) style.color_mode = ColorMode::kPatch;
  style.back_faces = command.cull ? BackFaces::kCulled : BackFaces::kTinted;
  style.wireframe = command.wireframe;
  style.wire_width = command.wire_width;
  if (command.no_border_switch) {
    style.back_faces = BackFaces::kSignal;
    style.back_tint = Vec3(1, 0, 0);
  }
  const MeshDrawList materials(*scene.mesh);
  style.material_colors = materials.material_colors();
  DrawList list = scene.drawn.list;
  std::optional<PatchColors> patch_colors;
  if (style.color_mode == ColorMode::kPatch && !scene.drawn.patches) {
    patch_colors.emplace(scene);
    list.ranges = patch_colors->ranges;
    style.color_mode = ColorMode::kMaterial;
    style.material_colors = patch_colors->colors;
  }

  auto painter = Painter::create();
  if (!painter) return tl::unexpected(painter.error());
  painter->options().supersampling = command.supersampling;
  painter->options().ambient_occlusion = !command.no_occlusion;
  const Stopwatch watch;
  auto painted =
      scene.drawn.patches
          ? painter->paint({*scene.drawn.patches, style, scene.drawn.patch_style}, *camera, output)
          : painter->paint(list, *camera, style, output);
  if (!painted) return tl::unexpected(painted.error());
  report.count("triangles", "triangles", scene.triangles);
  report.set("width", camera->width);
  report.set("height", camera->height);
  report.row("size", std::to_string(camera->width) + " x " + std::to_string(camera->height));
  report.text("device", "drawn by", painter->device());
  report.seconds("draw_seconds", "time of the drawing", watch.seconds());
  return kDone;
}

CommandResult render_mesh(const RenderCommand& command, const std::filesystem::path& input,
                          Report& report) {
  if (!command.level.empty()) wrong_usage(command.input + ": a LEVEL needs a model");
  if (command.color == "level" || command.color == "strip" || command.color == "patch")
    wrong_usage(command.input + ": --color " + command.color + " needs a model");
  if (command.no_border_switch) wrong_usage(command.input + ": --no-border-switch needs a model");
  if (command.arrays) wrong_usage(command.input + ": --arrays needs a model");
  if (command.morph) wrong_usage(command.input + ": --morph needs a model");
  if (!command.sheet.empty()) wrong_usage(command.input + ": --sheet needs a model");
  auto imported = read_surface(input);
  if (!imported) return tl::unexpected(imported.error());
  const TriangleMesh mesh = without_unused_vertices(imported->mesh);
  const ShownPose pose = shown_pose(mesh, choose_pose(command.input, mesh, command.pose));
  const MeshDrawList drawn(mesh);
  return render_scene(command, {{drawn.list(), {}, {}}, &mesh, mesh.triangle_count(), {}, &pose},
                      report);
}

// Wrong usage of what is for patch trees alone.
template <class Model>
void check_patch_options(const RenderCommand& command) {
  if constexpr (DrawsPatches<Model>) return;
  for (const auto& [is_used, option] :
       {std::pair{command.color == "patch", "--color patch"},
        std::pair{command.no_border_switch, "--no-border-switch"},
        std::pair{command.arrays, "--arrays"}, std::pair{command.morph, "--morph"}})
    if (is_used)
      wrong_usage(command.input + ": " + option + " is for patch trees, not for kind " +
                  ModelKind<Model>::kName);
}

// Vertices of the front of a view go towards those of the next coarser level.
void blend(const RenderCommand& command, const Camera& camera, const ChosenLevel& chosen,
           const PatchTree& tree, Scene& scene, Report& report) {
  const auto range =
      morph_range(camera, PatchMeasure::kPixels, chosen.pixel_error, command.morph_band);
  scene.drawn.patch_style.morph = range;
  PatchMotion motion(std::shared_ptr<const PatchTree>(std::shared_ptr<void>(), &tree));
  PatchDrawList posed = *scene.drawn.patches;
  posed.positions = scene.pose->positions;
  const PatchMotion::Frame told = motion.next(posed, range, camera);
  report.count("moving_vertices", "vertices on their way", told.moving);
  report.count("turned_triangles", "triangles turned over", told.turned);
}

// Levels by rows, shapes by columns.
template <class Model>
CommandResult render_sheet(const RenderCommand& command, const std::shared_ptr<const Model>& model,
                           Report& report) {
  const TriangleMesh& full = model->attributes();
  if (full.poses.empty()) wrong_usage(command.input + ": --sheet needs a model with poses");
  std::vector<Vec3> places = full.positions;
  for (const Pose& pose : full.poses)
    places.insert(places.end(), pose.positions.begin(), pose.positions.end());
  ViewOptions view = command.view;
  if (!view.has_size) view.width = view.height = 320;
  const auto camera = make_camera(view, places);
  if (!camera) return tl::unexpected(camera.error());
  DrawStyle style;
  style.shading = command.flat ? Shading::kFlat : Shading::kSmooth;
  style.color_mode = color_mode(command.color, full);
  style.wireframe = command.wireframe;
  style.wire_width = command.wire_width;
  const MeshDrawList materials(full);
  style.material_colors = materials.material_colors();
  auto painter = Painter::create();
  if (!painter) return tl::unexpected(painter.error());
  painter->options().supersampling = command.supersampling;
  painter->options().ambient_occlusion = !command.no_occlusion;
  std::vector<std::uint32_t> triangles;
  const auto image = draw_sheet(model, command.sheet, *camera, style, *painter, triangles);
  if (auto written = Painter::write(image, output_path(command.output)); !written)
    return tl::unexpected(written.error());
  report.text("kind", "kind", ModelKind<Model>::kName);
  report.set("row_triangles", triangles);
  report.set("width", image->width);
  report.set("height", image->height);
  report.row("size", std::to_string(image->width) + " x " + std::to_string(image->height));
  return kDone;
}

template <class Model>
CommandResult render_level(const RenderCommand& command, const std::shared_ptr<const Model>& model,
                           Report& report) {
  check_patch_options<Model>(command);
  const TriangleMesh& full = model->attributes();
  const ChosenPose chosen_pose = choose_pose(command.input, full, command.pose);
  const ShownPose pose = shown_pose(full, chosen_pose);
  const auto camera = make_camera(command.view, pose.positions);
  if (!camera) return tl::unexpected(camera.error());
  InstanceOf<Model> instance(model);
  go_to_pose(instance, chosen_pose);
  const ChosenLevel chosen = go_to_choice<Model>(instance, command.level, command.places, &*camera,
                                                 asks_for_view(command.view, command.level));
  warn_of_base(command.input, command.level, model->vertex_count(0), model->triangle_count(0));
  report.text("kind", "kind", ModelKind<Model>::kName);
  if (!chosen.is_front) report.count("level", "level", chosen.level);
  if (chosen.error) report.length("error", "error", *chosen.error);
  report_budget(command.level, chosen, report);
  report.length("pixel_error", "error in pixels", chosen.pixel_error);
  ListOptions how{.arrays = command.arrays};
  if (command.morph) how.morphs = PatchMeasure::kPixels;
  FrameLists<Model> lists(model, how);
  if constexpr (DrawsPatches<Model>) instance.set_switches(!command.no_border_switch);
  Scene scene{lists.of(instance), &full, chosen.triangles, {}, &pose};
  if constexpr (DrawsPatches<Model>) {
    scene.drawn.patch_style.switch_borders = !command.no_border_switch;
    scene.patches = instance.nodes_of_ranges();
    if (command.morph) blend(command, *camera, chosen, *model, scene, report);
    report.count("patches", "patches", instance.front().draws().draws().size());
    report.count("collapsed_triangles", "collapsed at borders", instance.collapsed_triangles());
  }
  return render_scene(command, scene, report);
}

CommandResult render_model(const RenderCommand& command, const std::filesystem::path& input,
                           Report& report) {
  const auto any = read_any_model(input);
  if (!any) return tl::unexpected(any.error());
  return std::visit(
      [&](const auto& model) {
        return command.sheet.empty() ? render_level(command, model, report)
                                     : render_sheet(command, model, report);
      },
      *any);
}

void check_morph(const RenderCommand& command) {
  if (!command.morph) return;
  if (command.arrays) wrong_usage("--morph: index arrays do not blend; leave out --arrays");
  if (!command.places.empty())
    wrong_usage("--morph blends by what the view needs, not by --sphere, --plane or --light");
  if (!asks_for_view(command.view, command.level))
    wrong_usage("--morph needs a view: --pixels, or --triangles with --eye or --path");
}

CommandResult run_render(const RenderCommand& command) {
  const auto input = input_path(command.input), output = output_path(command.output);
  if (auto writable = check_output(output, command.common, ".png"); !writable)
    return tl::unexpected(writable.error());
  const Stopwatch watch;
  Report report;
  CommandResult drawn = is_model_file(input) ? render_model(command, input, report)
                                             : render_mesh(command, input, report);
  if (!drawn) return drawn;
  report.seconds("seconds", "time", watch.seconds());
  return finish(report, command.common, output);
}

}  // namespace

void add_render(CLI::App& app, CommandRunner& runner) {
  CLI::App* const command = app.add_subcommand("render", "Draw a picture of a mesh or a model");
  const auto options = std::make_shared<RenderCommand>();
  command->add_option("file", options->input, "A mesh or model file")
      ->required()
      ->type_name("FILE");
  command->add_option("-o,--output", options->output, "The picture, .png")
      ->required()
      ->type_name("IMAGE");
  add_level_options(*command, options->level);
  add_view_options(*command, options->view);
  add_place_options(*command, options->places);
  add_pose_choice(*command, options->pose);
  command->add_flag("--flat", options->flat, "Shade every triangle by its own normal");
  command->add_flag("--wireframe", options->wireframe, "Draw the edges over the shading");
  command->add_option("--wire-width", options->wire_width, "In pixels")
      ->check(CLI::Range(0.1, 100.0))
      ->check(finite_number())
      ->capture_default_str()
      ->type_name("W");
  command
      ->add_option("--color", options->color,
                   "auto, plain, material, vertex, level, strip or patch (of a patch tree)")
      ->check(CLI::IsMember({"auto", "plain", "material", "vertex", "level", "strip", "patch"}))
      ->capture_default_str()
      ->type_name("KIND");
  command->add_flag("--cull", options->cull, "Leave out what is seen from behind (else red)");
  command->add_flag("--no-border-switch", options->no_border_switch,
                    "Patch trees: leave the cracks where levels meet; back faces are bright red");
  command->add_flag("--morph", options->morph,
                    "Patch trees: blend vertices between levels, for the view of --pixels or "
                    "--triangles");
  command
      ->add_option("--morph-band", options->morph_band,
                   "With --morph: from this many times the tolerance down to it")
      ->check(CLI::Range(1.01f, 16.0f))
      ->check(finite_number())
      ->needs("--morph")
      ->capture_default_str()
      ->type_name("B");
  command->add_flag("--arrays", options->arrays,
                    "Patch trees: draw index arrays, not commands over constant indices");
  CLI::Option* const sheet =
      command
          ->add_option(
              "--sheet", options->sheet.fractions,
              "Models with poses: one picture of many, a row for each of these parts of the "
              "vertices, a column for each shape from that at rest through all poses; "
              "--size is that of a cell")
          ->delimiter(',')
          ->check(CLI::Range(0.0f, 1.0f))
          ->check(finite_number())
          ->type_name("F,...");
  command->add_option("--columns", options->sheet.columns, "With --sheet: how many shapes")
      ->check(CLI::Range(1u, 64u))
      ->needs(sheet)
      ->capture_default_str()
      ->type_name("N");
  command->add_flag("--no-occlusion", options->no_occlusion, "Without darkened creases");
  command->add_option("--supersampling", options->supersampling, "Shaded samples per axis")
      ->check(CLI::Range(1, 8))
      ->capture_default_str()
      ->type_name("N");
  runner.add_common(*command, options->common, false);
  runner.attach(*command, options->common, [options] {
    check_level_options(options->level);
    check_morph(*options);
    if (!options->sheet.empty() && (!options->level.empty() || !options->pose.empty()))
      wrong_usage("--sheet shows levels and poses of its own: leave out LEVEL, --pose and --blend");
    return run_render(*options);
  });
}

}  // namespace varifold::cli
