// varifold demo: the tour of all of it on embedded data.
#include <apps/cli/commands.h>
#include <apps/cli/demo_page.h>
#include <apps/cli/demo_strips.h>
#include <apps/cli/demo_tour.h>
#include <fmt/format.h>
#include <varifold/base/bytes.h>
#include <varifold/io/output_file.h>
#include <varifold/mesh/generators.h>
#include <memory>
#include <utility>

namespace varifold::cli {
namespace {

struct DemoCommand {
  CommonOptions common;
  std::string folder = "demo";
  std::uint32_t triangles = 300'000;
};

struct Station {
  DemoShape shape;
  TriangleMesh mesh;
};

template <class Options>
Options with_size(std::uint32_t triangles, int threads) {
  Options options;
  options.triangles = triangles;
  options.threads = threads;
  return options;
}

Station planet_station(const DemoCommand& command) {
  auto options = with_size<PlanetOptions>(command.triangles, command.common.threads);
  options.colors_by_height = true;
  return {{"planet",
           "The Rough Planet",
           "A displaced sphere, rough down to the size of its triangles. Every level is a prefix "
           "of one vertex buffer and one index buffer.",
           fmt::format("varifold generate planet --triangles {} --colors", command.triangles),
           {1, 0.25, 0.05, 0.01, 0.002},
           20,
           false,
           800},
          planet(options)};
}

Station knot_station(const DemoCommand& command) {
  auto options = with_size<KnotOptions>(40'000, command.common.threads);
  options.p = 3;
  options.q = 5;
  return {{"knot",
           "A tube with two seams",
           "The texture coordinates break along two seams; both sides of a seam collapse in one "
           "step, so nothing tears.",
           "varifold generate knot --triangles 40000 --p 3 --q 5",
           {1, 0.15, 0.03},
           35},
          knot(options)};
}

Station sphere_station(const DemoCommand& command) {
  Station station{{"seamed_sphere",
                   "Two materials",
                   "Each half has a material and a chart of its own. The border between them keeps "
                   "its place at every level.",
                   "varifold generate seamed_sphere --triangles 20000",
                   {1, 0.2, 0.06},
                   20,
                   true},
                  seamed_sphere(with_size<GeneratorOptions>(20'000, command.common.threads))};
  return station;
}

Station terrain_station(const DemoCommand& command) {
  return {{"terrain",
           "A landscape",
           "An open surface: its border collapses along itself, and its corners stay.",
           "varifold generate terrain --triangles 120000",
           {1, 0.1, 0.01},
           35},
          terrain(with_size<TerrainOptions>(120'000, command.common.threads))};
}

Station box_station(const DemoCommand& command) {
  return {{"box",
           "Sharp edges",
           "Split normals keep the edges sharp, and flat faces need next to nothing.",
           "varifold generate box --triangles 12000",
           {1, 0.1, 0.01},
           25},
          box(with_size<GeneratorOptions>(12'000, command.common.threads))};
}

using StationMaker = Station (*)(const DemoCommand&);
constexpr StationMaker kStations[] = {planet_station, knot_station, sphere_station, terrain_station,
                                      box_station};

Result<DemoResult> tour(const DemoPlace& place, const DemoCommand& command) {
  DemoResult result;
  for (const StationMaker make : kStations) {
    if (auto done = check_interrupted(place.folder); !done) return tl::unexpected(done.error());
    const Station station = make(command);
    auto shown = show_shape(place, station.shape, station.mesh);
    if (!shown) return tl::unexpected(std::move(shown.error()));
    result.models.push_back(std::move(*shown));
    tell(place, "");
  }
  if (auto done = check_interrupted(place.folder); !done) return tl::unexpected(done.error());
  auto strips = show_strips(place);
  if (!strips) return tl::unexpected(std::move(strips.error()));
  result.strips = std::move(*strips);
  tell(place, "");
  auto prefixes = show_stream(place, result.models.front().shape);
  if (!prefixes) return tl::unexpected(std::move(prefixes.error()));
  result.prefixes = std::move(*prefixes);
  if (place.painter == nullptr) return result;
  result.device = place.painter->device();
  auto crowd = show_crowd(place, result.models.front().shape);
  if (!crowd) return tl::unexpected(std::move(crowd.error()));
  result.crowd = std::move(*crowd);
  return result;
}

Json json_of(const DemoModel& model) {
  Json levels = Json::array();
  for (const DemoLevel& level : model.shown)
    levels.push_back({{"triangles", level.triangles},
                      {"vertices", level.vertices},
                      {"error", level.error},
                      {"rms_error", level.rms},
                      {"max_error", level.maximum},
                      {"stream_bytes", level.stream_bytes},
                      {"seconds", level.extract_seconds},
                      {"mesh", level.mesh_file}});
  return {{"name", model.shape.name},         {"triangles", model.triangles},
          {"seconds", model.build_seconds},   {"simplify_seconds", model.simplify_seconds},
          {"model_bytes", model.model_bytes}, {"file_bytes", model.file_bytes},
          {"sound", is_sound(model.faults)},  {"levels", std::move(levels)}};
}

Json json_of(const DemoStrips& strips) {
  Json forms = Json::array(), levels = Json::array();
  for (const DemoStripForm& form : strips.forms)
    forms.push_back({{"name", form.name},
                     {"file", form.file},
                     {"bytes_per_vertex", per_vertex(form.model_bytes, strips)},
                     {"instance_bytes_per_vertex", per_vertex(form.instance_bytes, strips)},
                     {"file_bytes_per_vertex", per_vertex(form.file_bytes, strips)},
                     {"sound", is_sound(form.faults)}});
  for (const DemoStripLevel& level : strips.levels) {
    Json indices = Json::object();
    for (std::size_t i = 0; i < strips.forms.size(); ++i)
      indices[strips.forms[i].name] = level.indices[i];
    indices["fresh"] = level.fresh_indices;
    levels.push_back({{"share", level.share},
                      {"triangles", level.triangles},
                      {"strips", level.strips},
                      {"indices_per_triangle", std::move(indices)},
                      {"picture", level.picture}});
  }
  return {{"mesh", strips.mesh_file},      {"vertices", strips.vertices},
          {"triangles", strips.triangles}, {"seconds", strips.seconds},
          {"forms", std::move(forms)},     {"levels", std::move(levels)}};
}

CommandResult conclude(const DemoCommand& command, const DemoResult& result, double seconds) {
  Report report;
  Json models = Json::array();
  bool sound = true;
  for (const DemoModel& model : result.models) {
    models.push_back(json_of(model));
    sound = sound && is_sound(model.faults);
  }
  for (const DemoStripForm& form : result.strips.forms) sound = sound && is_sound(form.faults);
  report.set("folder", command.folder);
  report.set("models", std::move(models));
  report.set("strips", json_of(result.strips));
  report.set("sound", sound);
  report.set("device", result.device);
  report.text("page", "look at", (std::filesystem::path(command.folder) / "index.html").string());
  report.seconds("seconds", "time", seconds);
  const CommandResult done = finish(report, command.common);
  return done && !sound ? CommandResult(kFailure) : done;
}

Result<void> make_folder(const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) return fail(ErrorKind::kFailed, folder.string() + ": " + error.message());
  return {};
}

CommandResult run_demo(const DemoCommand& command) {
  const Stopwatch watch;
  DemoPlace place{command.folder, command.common, nullptr};
  if (auto made = make_folder(place.folder); !made) return tl::unexpected(made.error());
  auto painter = Painter::create();
  if (painter) {
    painter->options().supersampling = 2;
    painter->options().ambient_occlusion = true;
    place.painter = &*painter;
    tell(place, "Pictures by " + painter->device());
  } else {
    print_message("no pictures: " + painter.error().message);
  }
  const auto result = tour(place, command);
  if (!result) return tl::unexpected(result.error());
  const auto page = demo_page(*result, place.folder);
  if (!page) return tl::unexpected(page.error());
  if (auto written = write_file(place.folder / "index.html", as_bytes(*page)); !written)
    return tl::unexpected(written.error());
  return conclude(command, *result, watch.seconds());
}

}  // namespace

void add_demo(CLI::App& app, CommandRunner& runner) {
  CLI::App* const command =
      app.add_subcommand("demo", "The tour: build, check and draw embedded data, make a page");
  const auto options = std::make_shared<DemoCommand>();
  command->add_option("-o,--output", options->folder, "The folder for pictures, meshes and page")
      ->capture_default_str()
      ->type_name("FOLDER");
  command->add_option("--triangles", options->triangles, "Of the planet")
      ->check(CLI::Range(10'000u, 20'000'000u))
      ->capture_default_str()
      ->type_name("N");
  runner.add_common(*command, options->common, true);
  runner.attach(*command, options->common, [options] { return run_demo(*options); });
}

}  // namespace varifold::cli
