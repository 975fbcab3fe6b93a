// varifold check: proves a mesh or a model sound, or lists what is not.
#include <apps/cli/commands.h>
#include <apps/cli/input.h>
#include <fmt/format.h>
#include <varifold/measure/check_frame_strips.h>
#include <varifold/measure/check_model.h>
#include <varifold/measure/check_patch_tree.h>
#include <varifold/measure/surface_distance.h>
#include <varifold/mesh/validation.h>
#include <varifold/models/common/uniform_model.h>
#include <memory>
#include <string>
#include <type_traits>

namespace varifold::cli {
namespace {

struct CheckCommand {
  CommonOptions common;
  std::string input, against;
  bool closed = false;
  std::uint32_t samples = 200'000;
  std::uint32_t fronts = ModelCheckOptions{}.fronts;
  bool asks_for_fronts = false;
};

Json json_of(const std::vector<Fault>& faults, bool notes) {
  Json list = Json::array();
  for (const Fault& fault : faults)
    if ((fault.severity == Severity::kNote) == notes)
      list.push_back({{"kind", fault.kind}, {"count", fault.count}, {"where", fault.where}});
  return list;
}

CommandResult tell(const CheckCommand& command, const std::vector<Fault>& faults, Report& report) {
  const bool sound = is_sound(faults);
  report.set("sound", sound);
  report.set("faults", json_of(faults, false));
  report.set("notes", json_of(faults, true));
  for (const Fault& fault : faults)
    report.row((fault.severity == Severity::kNote ? "note: " : "FAULT: ") + fault.kind,
               fmt::format("{} at {}", format_count(fault.count), fault.where));
  report.row("result", sound ? "sound" : "not sound");
  const CommandResult done = finish(report, command.common);
  return done && !sound ? CommandResult(kFailure) : done;
}

// Adds what only a comparison with the original shows.
Result<void> compare(const CheckCommand& command, const TriangleMesh& mesh,
                     std::vector<Fault>& faults, Report& report) {
  const auto original = read_surface(input_path(command.against));
  if (!original) return tl::unexpected(original.error());
  const auto flipped = flipped_triangles(mesh, original->mesh, command.common.threads);
  report.count("flipped_triangles", "flipped triangles", flipped.size());
  if (!flipped.empty())
    faults.insert(faults.begin(),
                  {"flipped_triangle", flipped.size(),
                   fmt::format("triangle {}{}", flipped.front(), flipped.size() > 1 ? ", ..." : ""),
                   Severity::kFault});
  DistanceOptions options;
  options.samples = command.samples;
  options.vertices = true;
  options.threads = command.common.threads;
  const SurfaceDistanceReport distance = surface_distance(mesh, original->mesh, options);
  report.length("rms_error", "error, root mean square", distance.rms);
  report.length("max_error", "error, maximum", distance.hausdorff);
  report.set("diagonal", distance.diagonal);
  return {};
}

CommandResult check_mesh(const CheckCommand& command, const std::filesystem::path& path) {
  if (command.asks_for_fronts) wrong_usage("--fronts is for models");
  const Stopwatch watch;
  const auto imported = read_mesh_loudly(path);
  if (!imported) return tl::unexpected(imported.error());
  const TriangleMesh& mesh = imported->mesh;
  std::vector<Fault> faults = validate(mesh, command.common.threads);
  for (Fault& fault : faults)
    if (command.closed && fault.kind == "boundary_edge") fault.severity = Severity::kFault;
  Report report;
  report.text("type", "type", "mesh");
  report.count("vertices", "vertices", mesh.vertex_count());
  report.count("triangles", "triangles", mesh.triangle_count());
  if (!command.against.empty())
    if (auto compared = compare(command, mesh, faults, report); !compared)
      return tl::unexpected(compared.error());
  report.set("warnings", imported->warnings);
  report.seconds("seconds", "time", watch.seconds());
  return tell(command, faults, report);
}

template <class Model>
CommandResult check_levels(const CheckCommand& command, const std::filesystem::path& path,
                           const std::shared_ptr<const Model>& model) {
  if (command.asks_for_fronts && !HasFronts<Model>)
    wrong_usage(std::string("--fronts is for models with fronts (strips, vdpm, patchtree), not ") +
                ModelKind<Model>::kName);
  const Stopwatch watch;
  ModelCheckOptions options;
  options.fronts = command.fronts;
  options.threads = command.common.threads;
  options.progress = show_progress(path.filename().string());
  auto check = [&] {
    if constexpr (UniformModel<Model>)
      return varifold::check_model<InstanceOf<Model>>(model, options);
    else if constexpr (std::is_same_v<Model, FrameStrips>)
      return check_frame_strips(model, options);
    else
      return check_patch_tree(model, options);
  }();
  end_progress();
  if (!check) return fail_in(path.string(), std::move(check.error()));
  const std::uint32_t finest = model->finest_level();
  Report report;
  report.text("type", "type", "model");
  report.text("kind", "kind", ModelKind<Model>::kName);
  report.count("vertices", "vertices", model->vertex_count(finest));
  report.count("triangles", "triangles", model->triangle_count(finest));
  report.count("levels", "levels", std::uint64_t{finest} + 1);
  report.count("levels_checked", "levels checked", check->levels_checked);
  report.count("distances_checked", "errors measured again", check->distances_checked);
  if (HasFronts<Model>) report.count("fronts_checked", "fronts checked", check->fronts_checked);
  if constexpr (std::is_same_v<Model, PatchTree>)
    report.count("collapsed_triangles", "collapsed in fronts", check->collapsed_triangles);
  report.seconds("seconds", "time", watch.seconds());
  return tell(command, check->faults, report);
}

CommandResult check_model_file(const CheckCommand& command, const std::filesystem::path& path) {
  if (!command.against.empty()) wrong_usage("--against is for meshes");
  // Reading verifies the checksums of all chunks.
  const auto any = read_any_model(path);
  if (!any) return tl::unexpected(any.error());
  return std::visit([&](const auto& model) { return check_levels(command, path, model); }, *any);
}

}  // namespace

void add_check(CLI::App& app, CommandRunner& runner) {
  CLI::App* const command = app.add_subcommand("check", "Prove a mesh or a model sound");
  const auto options = std::make_shared<CheckCommand>();
  command->add_option("file", options->input, "A mesh or model file; - for a model from stdin")
      ->required()
      ->type_name("FILE");
  command
      ->add_option("--against", options->against,
                   "The mesh that this one was made from: looks for flipped triangles, measures")
      ->type_name("ORIGINAL");
  command->add_flag("--closed", options->closed, "Boundary edges are faults");
  command->add_option("--samples", options->samples, "With --against: points per direction")
      ->check(CLI::Range(1u, 100'000'000u))
      ->capture_default_str()
      ->type_name("N");
  const CLI::Option* const fronts =
      command
          ->add_option("--fronts", options->fronts,
                       "Models with fronts (strips, vdpm, patchtree): how many of them; 0: none")
          ->check(CLI::Range(0u, 1'000'000u))
          ->capture_default_str()
          ->type_name("N");
  runner.add_common(*command, options->common, true);
  runner.attach(*command, options->common, [options, fronts] {
    options->asks_for_fronts = fronts->count() > 0;
    const auto path = input_path(options->input);
    return is_model_file(path) ? check_model_file(*options, path) : check_mesh(*options, path);
  });
}

}  // namespace varifold::cli
