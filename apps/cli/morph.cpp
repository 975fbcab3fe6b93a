// varifold morph: one connectivity for two shapes.
#include <apps/cli/commands.h>
#include <apps/cli/input.h>
#include <varifold/measure/surface_distance.h>
#include <varifold/morph/repair_sphere.h>
#include <varifold/morph/supermesh.h>
#include <algorithm>
#include <array>
#include <fstream>
#include <memory>
#include <sstream>

namespace varifold::cli {
namespace {

struct MorphCommand {
  CommonOptions common;
  std::array<std::string, 2> inputs;
  std::string output, features, boundary = "auto";
  double tolerance = SupermeshOptions().tolerance;
  std::uint32_t samples = 100'000;
  bool no_repair = false, fit = false;
};

// Two numbers of vertices a line; the rest of a line after # is a comment.
Result<std::vector<FeaturePoint>> read_features(const std::string& name) {
  std::vector<FeaturePoint> features;
  if (name.empty()) return features;
  std::ifstream file(name);
  if (!file) return fail(ErrorKind::kUnreadable, name + ": cannot be opened");
  std::string line;
  for (int number = 1; std::getline(file, line); ++number) {
    std::istringstream words(line.substr(0, line.find('#')));
    std::int64_t in_a = 0, in_b = 0;
    std::string rest;
    if (!(words >> std::ws) || words.eof()) continue;
    if (!(words >> in_a >> in_b) || words >> rest || std::min(in_a, in_b) < 0 ||
        std::max(in_a, in_b) >= kNone)
      return fail(ErrorKind::kInvalidInput,
                  name + ": line " + std::to_string(number) + " is not two vertices");
    features.emplace_back(static_cast<std::uint32_t>(in_a), static_cast<std::uint32_t>(in_b));
  }
  return features;
}

// Tells on stderr what was mended.
void print_repair(const std::filesystem::path& path, const RepairReport& done, bool has_features) {
  std::string list;
  const auto add = [&](std::uint32_t count, const char* what) {
    if (count == 0) return;
    if (!list.empty()) list.append(", ");
    list.append(format_count(count)).append(" ").append(what);
  };
  add(done.dropped_triangles, "triangles dropped");
  add(done.cut_edges, "non-manifold edges cut");
  add(done.split_points, "points split");
  add(done.dropped_components, "components dropped");
  add(done.closed_holes, "holes closed");
  add(done.cut_handles, "handles cut");
  if (done.turned) list.append(list.empty() ? "" : ", ").append("turned inside out");
  print_message("varifold: " + path.string() + ": repaired: " + list);
  if (has_features)
    print_message("varifold: " + path.string() + ": its vertices have other numbers now");
}

using Meshes = std::array<TriangleMesh, 2>;
using Repaired = std::array<RepairedSphere, 2>;

// A hole that is shorter than this part of a circle around as much area is one to be closed.
constexpr double kLeastOpenness = 0.25;

Result<Repaired> repair_both(const Meshes& meshes, const MorphCommand& command, bool keeps_hole) {
  Repaired repaired;
  RepairOptions options;
  options.keep_longest_hole = keeps_hole;
  for (std::size_t i = 0; i < 2; ++i) {
    auto one = repair_to_sphere(meshes[i], options);
    if (!one) return fail_in(input_path(command.inputs[i]).string(), std::move(one.error()));
    repaired[i] = std::move(*one);
  }
  return repaired;
}

// Mends both, as discs if that is what they are or what is wanted.
Result<Meshes> repair(Meshes meshes, const MorphCommand& command, bool has_features) {
  bool are_discs = command.boundary == "keep";
  Result<Repaired> repaired = fail(ErrorKind::kFailed, "");
  if (command.boundary != "close") {
    repaired = repair_both(meshes, command, true);
    if (!repaired) return tl::unexpected(std::move(repaired.error()));
    are_discs = are_discs || ((*repaired)[0].report.openness >= kLeastOpenness &&
                              (*repaired)[1].report.openness >= kLeastOpenness);
  }
  if (!are_discs) repaired = repair_both(meshes, command, false);
  if (!repaired) return tl::unexpected(std::move(repaired.error()));
  for (std::size_t i = 0; i < 2; ++i) {
    // A mesh that needs nothing keeps its numbers, which features refer to.
    const RepairReport& done = (*repaired)[i].report;
    if (!done.changed()) continue;
    print_repair(input_path(command.inputs[i]), done, has_features);
    meshes[i] = std::move((*repaired)[i].mesh);
  }
  return meshes;
}

Result<Meshes> read_both(const MorphCommand& command, bool has_features) {
  Meshes meshes;
  for (std::size_t i = 0; i < 2; ++i) {
    auto imported = read_surface(input_path(command.inputs[i]));
    if (!imported) return tl::unexpected(std::move(imported.error()));
    meshes[i] = std::move(imported->mesh);
  }
  if (command.no_repair) return meshes;
  return repair(std::move(meshes), command, has_features);
}

struct Ends {
  double maximum = 0, rms = 0;  // of both shapes, as a part of the diagonal
};

// How far both ends of the morph are from the inputs, in both directions.
Ends report_ends(const TriangleMesh& supermesh, const Meshes& inputs, const MorphCommand& command,
                 Report& report) {
  DistanceOptions options;
  options.samples = command.samples;
  options.vertices = true;
  options.threads = command.common.threads;
  Ends ends;
  Json maxima = Json::array(), means = Json::array();
  for (std::size_t i = 0; i < 2; ++i) {
    TriangleMesh shape;
    shape.positions = i == 0 ? supermesh.positions : supermesh.poses[0].positions;
    shape.indices = supermesh.indices;
    const SurfaceDistanceReport distance = surface_distance(shape, inputs[i], options);
    const double scale = distance.diagonal > 0 ? 1 / distance.diagonal : 0;
    maxima.push_back(distance.hausdorff * scale);
    means.push_back(distance.rms * scale);
    ends.maximum = std::max(ends.maximum, distance.hausdorff * scale);
    ends.rms = std::max(ends.rms, distance.rms * scale);
  }
  report.set("max_errors", maxima);
  report.set("rms_errors", means);
  return ends;
}

void report_supermesh(const Supermesh& super, Report& report) {
  const SupermeshReport& told = super.report;
  const std::uint64_t inputs = std::uint64_t{told.input_triangles[0]} + told.input_triangles[1];
  report.count("vertices", "vertices", super.mesh.vertex_count());
  report.count("triangles", "triangles", super.mesh.triangle_count());
  report.set("input_vertices", {told.input_vertices[0], told.input_vertices[1]});
  report.set("input_triangles", {told.input_triangles[0], told.input_triangles[1]});
  report.row("of both inputs", format_count(inputs));
  report.count("overlay_triangles", "laid over each other", told.overlay_triangles);
  report.set("discs", told.are_discs);
  report.set("crossings", told.crossings);
  report.set("flipped_on_sphere", told.flipped_on_sphere);
  report.set("feature_distance", told.feature_distance);
  report.set("embed_seconds", told.embed_seconds);
  report.set("overlay_seconds", told.overlay_seconds);
  report.set("reduce_seconds", told.reduce_seconds);
}

CommandResult run_morph(const MorphCommand& command) {
  const auto output = output_path(command.output);
  if (auto writable = check_mesh_output(output, command.common); !writable)
    return tl::unexpected(writable.error());
  const Stopwatch watch;
  SupermeshOptions options;
  auto features = read_features(command.features);
  if (!features) return tl::unexpected(std::move(features.error()));
  options.features = std::move(*features);
  auto read = read_both(command, !options.features.empty());
  if (!read) return tl::unexpected(std::move(read.error()));
  Meshes& inputs = *read;
  options.tolerance = command.tolerance;
  options.fit = command.fit;
  options.threads = command.common.threads;
  options.progress = show_progress(command.inputs[0]);
  auto super = build_supermesh(inputs[0], inputs[1], options);
  end_progress();
  if (!super) return tl::unexpected(std::move(super.error()));
  super->mesh.poses[0].name = input_path(command.inputs[1]).stem().string();
  if (super->report.feature_distance > 0)
    print_message("varifold: features bar each other's way and do not all meet");
  const double seconds = watch.seconds();
  if (auto written = write_mesh_loudly(super->mesh, output); !written)
    return tl::unexpected(written.error());

  for (Vec3& p : inputs[1].positions) p = super->report.moved_b(p);
  Report report;
  report_supermesh(*super, report);
  const Ends ends = report_ends(super->mesh, inputs, command, report);
  report.length("max_error", "error of both ends, maximum (of the diagonal)", ends.maximum);
  report.length("rms", "error of both ends, root mean square", ends.rms);
  report.seconds("seconds", "time", seconds);
  return finish(report, command.common, output);
}

}  // namespace

void add_morph(CLI::App& app, CommandRunner& runner) {
  CLI::App* const command =
      app.add_subcommand("morph", "Make one mesh of two shapes that turns the one into the other");
  const auto options = std::make_shared<MorphCommand>();
  command
      ->add_option("a", options->inputs[0], "The shape at rest: closed or a disc, without handles")
      ->required()
      ->type_name("A");
  command->add_option("b", options->inputs[1], "The shape of its pose")->required()->type_name("B");
  command
      ->add_option("--features", options->features,
                   "A text file: each line a vertex of A and the vertex of B that it becomes")
      ->type_name("FILE");
  command
      ->add_option("--tolerance", options->tolerance,
                   "How far each shape may be off, as a part of its diagonal; 0: no reduction")
      ->check(CLI::Range(0.0, 1.0))
      ->check(finite_number())
      ->capture_default_str()
      ->type_name("T");
  command->add_flag("--no-repair", options->no_repair,
                    "Refuse meshes that are no closed manifolds or discs instead of mending them");
  command
      ->add_option("--boundary", options->boundary,
                   "keep: the longest hole of both stays open, so that they are discs; close: none "
                   "does; auto: keep, if these holes are long")
      ->check(CLI::IsMember({"auto", "keep", "close"}))
      ->capture_default_str()
      ->type_name("WHAT");
  command->add_flag("--fit", options->fit,
                    "Turn B by multiples of 90 degrees, scale and move it to where A is");
  command->add_option("--samples", options->samples, "Points per direction to measure the ends at")
      ->check(CLI::Range(1u, 100'000'000u))
      ->capture_default_str()
      ->type_name("N");
  command->add_option("-o,--output", options->output, "The mesh file; only .glb holds both shapes")
      ->required()
      ->type_name("SUPER");
  runner.add_common(*command, options->common, true);
  runner.attach(*command, options->common, [options] { return run_morph(*options); });
}

}  // namespace varifold::cli
