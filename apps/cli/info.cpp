// varifold info: what is in a mesh file or a model file.
#include <apps/cli/commands.h>
#include <apps/cli/index_report.h>
#include <apps/cli/input.h>
#include <fmt/format.h>
#include <varifold/io/container.h>
#include <varifold/mesh/rig_pose.h>
#include <varifold/mesh/topology.h>
#include <varifold/models/common/uniform_model.h>
#include <memory>

namespace varifold::cli {
namespace {

struct InfoCommand {
  CommonOptions common;
  std::string input;
};

Json json_of(const Vec3& v) { return Json::array({v.x, v.y, v.z}); }

std::string text_of(const Vec3& v) { return fmt::format("{:.6g}, {:.6g}, {:.6g}", v.x, v.y, v.z); }

void report_bounds(const Box& box, Report& report) {
  if (box.empty()) return;
  report.set(
      "bounds",
      {{"lower", json_of(box.lower)}, {"upper", json_of(box.upper)}, {"diagonal", box.diagonal()}});
  report.row("from", text_of(box.lower));
  report.row("to", text_of(box.upper));
}

void report_attributes(const TriangleMesh& mesh, Report& report) {
  report.set("attributes", attribute_names(mesh));
  report.row("attributes", joined(attribute_names(mesh)));
  Json materials = Json::array();
  std::vector<std::string> names;
  for (std::size_t m = 0; m < mesh.materials.size(); ++m) {
    std::uint64_t triangles = 0;
    for (const MaterialRange& range : mesh.ranges)
      if (range.material == m) triangles += range.triangle_count;
    materials.push_back({{"name", mesh.materials[m].name}, {"triangles", triangles}});
    names.push_back(mesh.materials[m].name.empty() ? fmt::format("#{}", m)
                                                   : mesh.materials[m].name);
  }
  report.set("materials", std::move(materials));
  report.row("materials", joined(names));
  report.set("images", mesh.images.size());
}

/// Rows where something moves, JSON always.
void report_motion(const TriangleMesh& mesh, Report& report) {
  const auto count = [&](const char* key, std::size_t number) {
    if (number > 0)
      report.count(key, key, number);
    else
      report.set(key, 0);
  };
  count("poses", mesh.poses.size());
  Json names = Json::array();
  for (const Pose& pose : mesh.poses) names.push_back(pose.name);
  report.set("pose_names", std::move(names));
  count("joints", mesh.rig ? mesh.rig->joints.size() : 0);
  count("animations", mesh.rig ? mesh.rig->animations.size() : 0);
  Json list = Json::array();
  if (mesh.rig) {
    for (const Animation& animation : mesh.rig->animations) {
      const TimeRange range = time_range(animation);
      list.push_back({{"name", animation.name},
                      {"first_second", range.first},
                      {"last_second", range.last},
                      {"channels", animation.channels.size()}});
      report.row(fmt::format("animation {}", list.size() - 1),
                 fmt::format("{}{:.6g} to {:.6g} s, {} channels",
                             animation.name.empty() ? "" : animation.name + ", ", range.first,
                             range.last, animation.channels.size()));
    }
  }
  report.set("animation_list", std::move(list));
}

void report_topology(const TopologyReport& topology, Report& report) {
  Json json;
  json["components"] = topology.components;
  json["closed"] = topology.closed;
  json["manifold"] = topology.manifold();
  json["oriented"] = topology.oriented();
  json["genus"] = topology.genus() ? Json(*topology.genus()) : Json();
  json["euler_characteristic"] = topology.euler_characteristic;
  json["positions"] = topology.classes;
  json["used_positions"] = topology.used_classes;
  json["edges"] = topology.edges;
  json["boundary_edges"] = topology.boundary_edges;
  json["boundary_loops"] = topology.boundary_loops;
  json["nonmanifold_edges"] = topology.nonmanifold_edges;
  json["nonmanifold_vertices"] = topology.nonmanifold_vertices;
  json["misoriented_edges"] = topology.misoriented_edges;
  json["degenerate_triangles"] = topology.degenerate_triangles;
  json["duplicate_triangles"] = topology.duplicate_triangles;
  report.set("topology", std::move(json));

  std::string surface = topology.closed ? "closed" : "open";
  surface += topology.manifold() ? ", manifold" : ", not manifold";
  surface += topology.oriented() ? "" : ", not oriented";
  if (topology.genus()) surface += fmt::format(", genus {}", *topology.genus());
  report.row("surface", surface);
  report.row("components", format_count(topology.components));
  const auto row = [&](const char* label, std::uint64_t count) {
    if (count > 0) report.row(label, format_count(count));
  };
  report.row("Euler characteristic", std::to_string(topology.euler_characteristic));
  row("boundary loops", topology.boundary_loops);
  row("boundary edges", topology.boundary_edges);
  row("non-manifold edges", topology.nonmanifold_edges);
  row("non-manifold vertices", topology.nonmanifold_vertices);
  row("misoriented edges", topology.misoriented_edges);
  row("degenerate triangles", topology.degenerate_triangles);
  row("duplicate triangles", topology.duplicate_triangles);
}

CommandResult mesh_info(const InfoCommand& command, const std::filesystem::path& path) {
  const auto imported = read_mesh_loudly(path);
  if (!imported) return tl::unexpected(imported.error());
  const TriangleMesh& mesh = imported->mesh;
  Report report;
  report.text("type", "type", "mesh");
  report.count("vertices", "vertices", mesh.vertex_count());
  report.count("triangles", "triangles", mesh.triangle_count());
  report_bounds(bounds(mesh), report);
  report_attributes(mesh, report);
  report_motion(mesh, report);
  report_topology(analyze_topology(mesh, weld_points(mesh), command.common.threads), report);
  report.set("warnings", imported->warnings);
  return finish(report, command.common);
}

void report_chunks(const Container& container, Report& report) {
  Json chunks = Json::array();
  for (const ChunkInfo& chunk : container.chunks()) {
    const std::string name = fourcc_name(chunk.tag);
    chunks.push_back({{"tag", name},
                      {"compressed", chunk.compressed},
                      {"file_bytes", chunk.stored_size},
                      {"raw_bytes", chunk.raw_size}});
    report.row("chunk " + name,
               format_bytes(chunk.stored_size) +
                   (chunk.compressed ? ", compressed from " + format_bytes(chunk.raw_size) : ""));
  }
  report.set("chunks", std::move(chunks));
}

template <class Model>
void report_levels(const Model& model, Report& report) {
  Json levels = Json::array();
  constexpr int kShown = 5;
  for (int i = 0; i < kShown; ++i) {
    const std::uint32_t level = model.level_for_fraction(static_cast<float>(i) / (kShown - 1));
    levels.push_back({{"level", level},
                      {"vertices", model.vertex_count(level)},
                      {"triangles", model.triangle_count(level)},
                      {"error", model.error(level)}});
    report.row(
        fmt::format("level {}", level),
        fmt::format("{} vertices, {} triangles, error {}", format_count(model.vertex_count(level)),
                    format_count(model.triangle_count(level)), format_number(model.error(level))));
  }
  report.set("level_samples", std::move(levels));
}

template <class Model>
void report_model(const std::shared_ptr<const Model>& shared, Report& report) {
  const Model& model = *shared;
  const TriangleMesh& mesh = model.attributes();
  const std::uint32_t finest = model.finest_level();
  report.text("type", "type", "model");
  report.text("kind", "kind", ModelKind<Model>::kName);
  if constexpr (requires { model.form_kind(); })
    report.text("form", "form", std::string(form_name(model.form_kind())));
  report.count("vertices", "vertices", mesh.vertex_count());
  report.count("triangles", "triangles", model.triangle_count(finest));
  report.count("base_vertices", "base vertices", model.vertex_count(0));
  report.count("base_triangles", "base triangles", model.triangle_count(0));
  report.count("levels", "levels", std::uint64_t{finest} + 1);
  report.length("base_error", "error of the base", model.error(0));
  report.length("full_error", "error of the full level", model.error(finest));
  report.set("error_is_measured", error_is_measured(model));
  if constexpr (requires { model.moves_vertices(); })
    report.set("moves_vertices", model.moves_vertices());
  Box box;
  for (const Vec3& p : mesh.positions) box.add(p);
  report_bounds(box, report);
  report_attributes(mesh, report);
  report_motion(mesh, report);
  report_levels(model, report);
  if constexpr (kDrawsStrips<Model>) report_index_samples(shared, report);
  report.bytes("model_bytes", "in memory", model.bytes());
  report.length("bytes_per_vertex", "bytes a vertex, memory",
                static_cast<double>(model.bytes()) / std::max(1u, mesh.vertex_count()));
}

CommandResult model_info(const InfoCommand& command, const std::filesystem::path& path) {
  const auto any = read_any_model(path);
  if (!any) return tl::unexpected(any.error());
  Report report;
  std::visit([&](const auto& model) { report_model(model, report); }, *any);
  const auto vertices =
      static_cast<double>(std::max<std::uint64_t>(1, report.values()["vertices"]));
  // What came through a pipe is gone.
  std::error_code no_file;
  const std::uint64_t file_bytes = std::filesystem::file_size(path, no_file);
  if (!no_file) {
    report.bytes("file_bytes", "file", file_bytes);
    report.length("file_bytes_per_vertex", "bytes a vertex, file",
                  static_cast<double>(file_bytes) / vertices);
    const auto container = Container::open(path);
    if (!container) return tl::unexpected(container.error());
    report_chunks(*container, report);
  }
  return finish(report, command.common);
}

}  // namespace

void add_info(CLI::App& app, CommandRunner& runner) {
  CLI::App* const command = app.add_subcommand("info", "Tell what is in a mesh or a model file");
  const auto options = std::make_shared<InfoCommand>();
  command->add_option("file", options->input, "A mesh or model file; - for a model from stdin")
      ->required()
      ->type_name("FILE");
  runner.add_common(*command, options->common, true);
  runner.attach(*command, options->common, [options] {
    const auto path = input_path(options->input);
    return is_model_file(path) ? model_info(*options, path) : mesh_info(*options, path);
  });
}

}  // namespace varifold::cli
