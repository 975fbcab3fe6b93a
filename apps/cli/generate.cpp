// varifold generate: the embedded data as mesh files, and camera paths.
#include <apps/cli/commands.h>
#include <apps/cli/generate_path.h>
#include <apps/cli/input.h>
#include <apps/cli/level_options.h>
#include <varifold/io/mapped_file.h>
#include <varifold/mesh/generators.h>
#include <varifold/render/png.h>
#include <algorithm>
#include <cmath>
#include <memory>
#include <numeric>
#include <optional>

namespace varifold::cli {
namespace {

struct GenerateOptions {
  CommonOptions common;
  std::string shape, output, heightmap;
  std::optional<std::uint32_t> triangles;
  std::uint64_t seed = 1;
  std::optional<float> relief;
  std::optional<float> height_scale;
  std::optional<PictureSize> size;
  bool colors = false;
  std::uint32_t p = 2, q = 3;
  PathOptions path;
};

/// Samples for about so many triangles, with the sides in the proportion of the picture's.
PictureSize size_for_triangles(std::uint32_t triangles, const HeightMap& map) {
  const double cells = std::sqrt(0.5 * triangles * (map.width - 1.0) / (map.height - 1.0));
  const auto columns = std::max(1.0, std::round(cells));
  const auto rows = std::max(1.0, std::round(0.5 * triangles / columns));
  return {static_cast<int>(columns) + 1, static_cast<int>(rows) + 1};
}

Result<TriangleMesh> from_height_map(const GenerateOptions& options) {
  const auto file = MappedFile::open(input_path(options.heightmap));
  if (!file) return tl::unexpected(file.error());
  auto map = read_height_map(file->bytes());
  if (!map) return fail_in(options.heightmap, std::move(map.error()));
  HeightField field;
  field.width = static_cast<std::uint32_t>(map->width);
  field.height = static_cast<std::uint32_t>(map->height);
  field.heights = std::move(map->heights);
  // As large as the fractal terrain: the longer side is 2, heights reach over twice the relief.
  field.spacing = 2.0f / static_cast<float>(std::max(1u, std::max(field.width, field.height) - 1));
  field.height_scale =
      2 * options.height_scale.value_or(options.relief.value_or(TerrainOptions().relief));
  if (map->width >= 2 && map->height >= 2 && (options.size || options.triangles)) {
    const PictureSize size =
        options.size ? *options.size : size_for_triangles(*options.triangles, *map);
    field = resample(field, static_cast<std::uint32_t>(size.width),
                     static_cast<std::uint32_t>(size.height), options.common.threads);
  }
  auto mesh = terrain(field, options.common.threads);
  if (!mesh) return fail_in(options.heightmap, std::move(mesh.error()));
  return mesh;
}

template <class Options>
Options base_options(const GenerateOptions& options) {
  Options result;
  result.triangles = options.triangles.value_or(result.triangles);
  result.seed = options.seed;
  result.threads = options.common.threads;
  return result;
}

Result<TriangleMesh> make_shape(const GenerateOptions& options) {
  if (!options.heightmap.empty()) return from_height_map(options);
  if (options.shape == "planet") {
    auto planet_options = base_options<PlanetOptions>(options);
    planet_options.relief = options.relief.value_or(planet_options.relief);
    planet_options.colors_by_height = options.colors;
    return planet(planet_options);
  }
  if (options.shape == "terrain") {
    auto terrain_options = base_options<TerrainOptions>(options);
    terrain_options.relief = options.relief.value_or(terrain_options.relief);
    return terrain(terrain_options);
  }
  if (options.shape == "knot") {
    auto knot_options = base_options<KnotOptions>(options);
    knot_options.p = options.p;
    knot_options.q = options.q;
    return knot(knot_options);
  }
  return generate(options.shape, base_options<GeneratorOptions>(options));
}

void check_shape_options(const CLI::App& command, const GenerateOptions& options) {
  const auto only_for = [&](const char* option, std::initializer_list<const char*> shapes) {
    if (command.count(option) == 0) return;
    if (std::find(shapes.begin(), shapes.end(), options.shape) == shapes.end())
      wrong_usage(std::string(option) + " means nothing to a " + options.shape);
  };
  only_for("--seed", {"planet", "terrain"});
  only_for("--relief", {"planet", "terrain"});
  only_for("--colors", {"planet"});
  only_for("--heightmap", {"terrain"});
  only_for("--size", {"terrain", "path"});
  only_for("--height-scale", {"terrain"});
  if (options.shape == "terrain" && options.heightmap.empty() &&
      (options.size || options.height_scale))
    wrong_usage("--size and --height-scale need a --heightmap");
  if (options.size && (options.size->width < 2 || options.size->height < 2))
    wrong_usage("--size: a terrain has at least 2x2 samples");
  if (options.triangles && options.shape == "path") wrong_usage("a path has no --triangles");
  for (const char* const option : {"--frames", "--fovy", "--distance"}) only_for(option, {"path"});
  if (options.shape != "path" && !options.path.name.empty())
    wrong_usage("'" + options.path.name + "': a " + options.shape + " has no name");
  only_for("--p", {"knot"});
  only_for("--q", {"knot"});
  if (std::gcd(options.p, options.q) != 1) wrong_usage("--p and --q have a common divisor");
}

CommandResult run_generate(GenerateOptions& options) {
  if (options.shape == "path") {
    if (options.size) options.path.size = *options.size;
    return generate_path(options.path, options.output, options.common);
  }
  const auto output = output_path(options.output);
  if (auto writable = check_mesh_output(output, options.common); !writable)
    return tl::unexpected(writable.error());
  const Stopwatch watch;
  const auto mesh = make_shape(options);
  if (!mesh) return tl::unexpected(mesh.error());
  if (auto written = write_mesh_loudly(*mesh, output); !written)
    return tl::unexpected(written.error());
  Report report;
  report.text("shape", "shape", options.shape);
  report.count("vertices", "vertices", mesh->vertex_count());
  report.count("triangles", "triangles", mesh->triangle_count());
  report.set("attributes", attribute_names(*mesh));
  report.row("attributes", joined(attribute_names(*mesh)));
  report.seconds("seconds", "time", watch.seconds());
  return finish(report, options.common, output);
}

}  // namespace

void add_generate(CLI::App& app, CommandRunner& runner) {
  CLI::App* const command = app.add_subcommand("generate", "Make a mesh by code, or a camera path");
  const auto options = std::make_shared<GenerateOptions>();
  std::vector<std::string> shapes(generator_names().begin(), generator_names().end());
  shapes.emplace_back("path");
  command->add_option("shape", options->shape, "The shape")
      ->required()
      ->check(CLI::IsMember(shapes))
      ->type_name("SHAPE");
  auto* const triangles =
      command->add_option("--triangles", options->triangles, "How many, about (default 100000)")
          ->check(CLI::Range(1u, kMaxGeneratedTriangles))
          ->type_name("N");
  add_path_options(*command, options->path);
  command->add_option("--seed", options->seed, "planet, terrain: another one")
      ->capture_default_str()
      ->type_name("S");
  auto* const relief =
      command->add_option("--relief", options->relief, "planet, terrain: bound of the heights")
          ->check(CLI::Range(0.0, 100.0))
          ->check(finite_number())
          ->type_name("R");
  command->add_flag("--colors", options->colors, "planet: vertex colours by height");
  command
      ->add_option("--heightmap", options->heightmap,
                   "terrain: heights from an 8 or 16 bit picture; a vertex a pixel without --size "
                   "and --triangles")
      ->type_name("PNG");
  command
      ->add_option("--height-scale", options->height_scale,
                   "heightmap: the height of white, in parts of the longer side (default 0.15)")
      ->check(CLI::Range(0.0, 100.0))
      ->excludes(relief)
      ->type_name("S");
  add_size_option(*command, "heightmap: vertices; path: pixels (default 1920x1080)",
                  [options = options.get()](PictureSize size) { options->size = size; })
      ->excludes(triangles);
  command->add_option("--p", options->p, "knot: turns about the axis")
      ->check(CLI::Range(1u, 16u))
      ->capture_default_str();
  command->add_option("--q", options->q, "knot: turns through the hole")
      ->check(CLI::Range(1u, 16u))
      ->capture_default_str();
  command
      ->add_option("-o,--output", options->output,
                   "The mesh file: .ply, .obj or .glb; of a path: .json")
      ->required()
      ->type_name("MESH");
  runner.add_common(*command, options->common, true);
  runner.attach(*command, options->common, [options, command] {
    check_shape_options(*command, *options);
    return run_generate(*options);
  });
}

}  // namespace varifold::cli
