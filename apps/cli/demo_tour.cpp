#include <apps/cli/demo_tour.h>
#include <fmt/format.h>
#include <varifold/io/container.h>
#include <varifold/io/mesh_file.h>
#include <varifold/io/model_file.h>
#include <varifold/measure/check_model.h>
#include <varifold/measure/surface_distance.h>
#include <varifold/models/pm/build.h>
#include <varifold/models/pm/instance.h>
#include <varifold/render/mesh_draw_list.h>
#include <varifold/simplify/simplify.h>
#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

namespace varifold::cli {

void tell(const DemoPlace& place, const std::string& line) {
  end_progress();
  if (!place.common.json) fmt::print("{}\n", line);
  std::fflush(stdout);
}

namespace {

using SharedModel = std::shared_ptr<const ProgressiveMesh>;

std::filesystem::path model_path(const DemoPlace& place, const DemoShape& shape) {
  return place.folder / (shape.name + ".vfm");
}

Camera camera_for(const DemoShape& shape, const TriangleMesh& mesh) {
  FrameOptions framing;
  framing.width = shape.picture_width;
  framing.height = shape.picture_width * 4 / 5;
  framing.elevation_degrees = shape.elevation_degrees;
  return frame(mesh.positions, framing);
}

DrawStyle style_for(const DemoShape& shape, const MeshDrawList& materials) {
  DrawStyle style;
  style.color_mode = shape.color_by_material ? ColorMode::kMaterial : ColorMode::kVertexColor;
  style.material_colors = materials.material_colors();
  return style;
}

Result<SharedModel> build(const DemoPlace& place, const TriangleMesh& mesh, DemoModel& shown) {
  const Stopwatch watch;
  SimplifyOptions options;
  options.threads = place.common.threads;
  options.progress = show_progress(shown.shape.name);
  auto simplified = simplify(mesh, options);
  if (!simplified) return tl::unexpected(std::move(simplified.error()));
  shown.simplify_seconds = simplified->collapse_seconds;
  auto model =
      std::make_shared<const ProgressiveMesh>(build_progressive_mesh(simplified->detailed));
  const auto written = write_model(*model, model_path(place, shown.shape));
  if (!written) return tl::unexpected(written.error());
  shown.build_seconds = watch.seconds();
  shown.model_bytes = model->bytes();
  shown.file_bytes = written->file_bytes;
  shown.levels = model->finest_level() + 1;
  shown.base_triangles = model->triangle_count(0);
  return model;
}

Result<void> check(const DemoPlace& place, const SharedModel& model, DemoModel& shown) {
  const Stopwatch watch;
  ModelCheckOptions options;
  options.threads = place.common.threads;
  options.spread_levels = 16;
  options.progress = show_progress(shown.shape.name);
  auto report = check_progressive_mesh(model, options);
  if (!report) return tl::unexpected(std::move(report.error()));
  shown.check_seconds = watch.seconds();
  shown.levels_checked = report->levels_checked;
  shown.faults = std::move(report->faults);
  return {};
}

// Both pictures of a level.
Result<void> draw(const DemoPlace& place, const DemoModel& shown, ProgressiveMeshInstance& instance,
                  DemoLevel& level) {
  if (place.painter == nullptr) return {};
  const TriangleMesh& mesh = instance.model().data().mesh;
  const Camera camera = camera_for(shown.shape, mesh);
  const MeshDrawList materials(mesh);
  DrawStyle style = style_for(shown.shape, materials);
  const std::string name = fmt::format("{}_{}", shown.shape.name, level.triangles);
  level.shaded = name + ".png";
  level.wired = name + "_wire.png";
  const DrawList list = instance.draw_list();
  if (auto done = place.painter->paint(list, camera, style, place.folder / level.shaded); !done)
    return done;
  style.wireframe = true;
  style.shading = Shading::kFlat;
  return place.painter->paint(list, camera, style, place.folder / level.wired);
}

Result<DemoLevel> show_level(const DemoPlace& place, const DemoModel& shown,
                             const TriangleMesh& original, ProgressiveMeshInstance& instance) {
  DemoLevel level;
  level.level = instance.level();
  level.vertices = instance.vertex_count();
  level.triangles = instance.triangle_count();
  level.error = instance.model().error(level.level);
  const Stopwatch watch;
  const TriangleMesh mesh = without_unused_vertices(instance.extract());
  level.mesh_file = fmt::format("{}_{}.{}", shown.shape.name, level.triangles,
                                shown.shape.color_by_material ? "glb" : "ply");
  if (auto written = write_mesh(mesh, place.folder / level.mesh_file); !written)
    return tl::unexpected(written.error());
  level.extract_seconds = watch.seconds();
  if (level.level < instance.model().finest_level()) {
    DistanceOptions options;
    options.samples = 50'000;
    options.threads = place.common.threads;
    const SurfaceDistanceReport distance = surface_distance(mesh, original, options);
    level.rms = distance.rms;
    level.maximum = distance.hausdorff;
  }
  if (auto drawn = draw(place, shown, instance, level); !drawn)
    return tl::unexpected(drawn.error());
  return level;
}

// The stream in a shape's model file.
Result<std::vector<std::byte>> read_stream(const DemoPlace& place, const DemoShape& shape) {
  auto container = Container::open(model_path(place, shape));
  if (!container) return tl::unexpected(std::move(container.error()));
  const auto bytes = container->find(kProgressiveMeshStream);
  if (!bytes) return tl::unexpected(bytes.error());
  return std::vector<std::byte>(bytes->begin(), bytes->end());
}

Result<void> show_levels(const DemoPlace& place, const SharedModel& model,
                         const TriangleMesh& original, DemoModel& shown) {
  const auto stream = read_stream(place, shown.shape);
  if (!stream) return tl::unexpected(stream.error());
  ProgressiveMeshInstance instance(model);
  for (const double share : shown.shape.shares) {
    if (auto done = check_interrupted(place.folder); !done) return done;
    instance.go_to_level(model->level_for_triangles(
        static_cast<std::uint32_t>(std::lround(share * model->triangle_count()))));
    auto level = show_level(place, shown, original, instance);
    if (!level) return tl::unexpected(std::move(level.error()));
    const auto prefix = progressive_mesh_prefix(*stream, level->level);
    if (!prefix) return tl::unexpected(prefix.error());
    level->stream_bytes = *prefix;
    tell(place, fmt::format("  {:>9} triangles  error {:<10.3g} {:>8} of the file  {}",
                            format_count(level->triangles), level->error,
                            format_bytes(level->stream_bytes), level->mesh_file));
    shown.shown.push_back(std::move(*level));
  }
  return {};
}

}  // namespace

Result<DemoModel> show_shape(const DemoPlace& place, const DemoShape& shape,
                             const TriangleMesh& mesh) {
  DemoModel shown;
  shown.shape = shape;
  shown.vertices = mesh.vertex_count();
  shown.triangles = mesh.triangle_count();
  shown.diagonal = bounds(mesh).diagonal();
  tell(place, fmt::format("{}: {} triangles", shape.title, format_count(shown.triangles)));
  const std::string file = shape.name + (shape.color_by_material ? ".glb" : ".ply");
  tell(place, fmt::format("  $ {} -o {}", shape.command, file));
  if (auto written = write_mesh(mesh, place.folder / file); !written)
    return tl::unexpected(written.error());
  shown.mesh_bytes = std::filesystem::file_size(place.folder / file);

  const auto model = build(place, mesh, shown);
  if (!model) return tl::unexpected(model.error());
  tell(place, fmt::format("  $ varifold build pm {} -o {}.vfm", file, shape.name));
  tell(place,
       fmt::format("  built in {} ({} the collapses), {} in the file, {} levels",
                   format_seconds(shown.build_seconds), format_seconds(shown.simplify_seconds),
                   format_bytes(shown.file_bytes), format_count(shown.levels)));
  if (auto checked = check(place, *model, shown); !checked) return tl::unexpected(checked.error());
  tell(place, fmt::format("  $ varifold check {}.vfm", shape.name));
  tell(place, fmt::format("  {} levels checked: {}", shown.levels_checked,
                          is_sound(shown.faults) ? "sound" : "NOT SOUND"));
  if (auto done = show_levels(place, *model, mesh, shown); !done)
    return tl::unexpected(done.error());
  return shown;
}

Result<std::vector<DemoPrefix>> show_stream(const DemoPlace& place, const DemoShape& shape) {
  const auto stream = read_stream(place, shape);
  if (!stream) return tl::unexpected(stream.error());
  std::vector<DemoPrefix> prefixes;
  tell(place, "The file arrives over a slow line");
  for (const double part : {0.01, 0.04, 0.15, 0.5}) {
    const auto bytes = static_cast<std::size_t>(part * static_cast<double>(stream->size()));
    auto arrived = decode_progressive_mesh(std::span(*stream).first(bytes));
    if (!arrived) return tl::unexpected(std::move(arrived.error()));
    const auto model = std::make_shared<const ProgressiveMesh>(std::move(*arrived));
    ProgressiveMeshInstance instance(model);
    instance.go_to_level(model->finest_level());
    DemoPrefix prefix{part,
                      bytes,
                      instance.vertex_count(),
                      instance.triangle_count(),
                      model->error(model->finest_level()),
                      {}};
    if (place.painter != nullptr) {
      const TriangleMesh& mesh = model->data().mesh;
      const MeshDrawList materials(mesh);
      prefix.picture = fmt::format("{}_stream_{:.0f}.png", shape.name, 100 * part);
      if (auto done =
              place.painter->paint(instance.draw_list(), camera_for(shape, mesh),
                                   style_for(shape, materials), place.folder / prefix.picture);
          !done)
        return tl::unexpected(done.error());
    }
    tell(place,
         fmt::format("  {:>3.0f} %: {:>8} -> {:>9} triangles, error {:.3g}", 100 * part,
                     format_bytes(prefix.bytes), format_count(prefix.triangles), prefix.error));
    prefixes.push_back(std::move(prefix));
  }
  return prefixes;
}

namespace {

// Where the instances of the row stand: along a line that goes off to the right, ever farther.
std::vector<Vec3> crowd_places() {
  std::vector<Vec3> places;
  float depth = 0, step = 3.5f;
  for (int i = 0; i < 9; ++i, step *= 1.6f) {
    places.push_back({0.75f * depth + (i > 0 ? 0.8f : 0.0f), 0.06f * depth, -depth});
    depth += step;
  }
  return places;
}

Camera crowd_camera(const std::vector<Vec3>& places) {
  Camera camera;
  camera.width = 1600;
  camera.height = 560;
  camera.fovy_degrees = 25;
  camera.eye = {0.9f, 0.8f, 6.6f};
  camera.target = {2.35f, 0.15f, 0};
  const float radius = 3 + glm::length(places.back());
  set_depth_range(camera, Sphere{Vec3(0), radius});
  return camera;
}

}  // namespace

Result<DemoCrowd> show_crowd(const DemoPlace& place, const DemoShape& shape) {
  auto read = read_progressive_mesh(model_path(place, shape));
  if (!read) return tl::unexpected(std::move(read.error()));
  const auto model = std::make_shared<const ProgressiveMesh>(std::move(*read));
  Sphere ball{Vec3(0), 0};
  for (const Vec3& p : model->data().mesh.positions)
    ball.radius = std::max(ball.radius, glm::length(p));
  const std::vector<Vec3> places = crowd_places();
  const Camera camera = crowd_camera(places);
  const PixelScale scale(camera);

  // The coarsest level whose error is at most one pixel at the nearest point.
  DemoCrowd crowd;
  std::vector<Painter::Item> items;
  std::vector<std::unique_ptr<ProgressiveMeshInstance>> instances;
  for (const Vec3& at : places) {
    const float pixel = scale.pixel_size(distance_to(Sphere{at, ball.radius}, camera.eye));
    auto instance = std::make_unique<ProgressiveMeshInstance>(model);
    instance->go_to_level(model->level_for_error(pixel));
    crowd.triangles += instance->triangle_count();
    crowd.full_triangles += model->triangle_count();
    Painter::Item item{instance->draw_list(), {}};
    item.style.color_mode = ColorMode::kVertexColor;
    item.style.placement[3] = Vec4(at, 1);
    items.push_back(item);
    instances.push_back(std::move(instance));
  }
  crowd.instances = static_cast<std::uint32_t>(items.size());
  crowd.picture = shape.name + "_crowd.png";
  if (auto done = place.painter->paint(items, camera, place.folder / crowd.picture); !done)
    return tl::unexpected(done.error());
  for (Painter::Item& item : items) {
    item.style.wireframe = true;
    item.style.shading = Shading::kFlat;
    item.style.color_mode = ColorMode::kPlain;
  }
  crowd.wired_picture = shape.name + "_crowd_wire.png";
  if (auto done = place.painter->paint(items, camera, place.folder / crowd.wired_picture); !done)
    return tl::unexpected(done.error());
  tell(place, fmt::format("{} of them at an error of one pixel: {} triangles instead of {}",
                          crowd.instances, format_count(crowd.triangles),
                          format_count(crowd.full_triangles)));
  return crowd;
}

}  // namespace varifold::cli
