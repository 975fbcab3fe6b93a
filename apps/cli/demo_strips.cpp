#include <apps/cli/demo_strips.h>
#include <apps/cli/demo_tour.h>
#include <fmt/format.h>
#include <varifold/io/mesh_file.h>
#include <varifold/io/model_file.h>
#include <varifold/measure/check_model.h>
#include <varifold/mesh/generators.h>
#include <varifold/models/lodstrips/build.h>
#include <varifold/simplify/simplify.h>
#include <varifold/strip/strip_measures.h>
#include <varifold/strip/stripify.h>
#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <utility>

namespace varifold::cli {
namespace {

using SharedStrips = std::shared_ptr<const LodStrips>;

constexpr std::uint32_t kTriangles = 40'000;
constexpr const char* kName = "planet_strips";

struct Share {
  double of_triangles;
  bool is_drawn;
};
constexpr std::array<Share, 5> kShares = {
    {{1, true}, {0.5, false}, {0.25, false}, {0.1, true}, {0.02, true}}};

// With a restart between any two strips, whether the form draws them in one range or in many.
double indices_per_triangle(const SubmittedIndices& sent, std::uint32_t triangles) {
  const std::uint64_t restarts = std::max<std::uint64_t>(1, sent.strips) - 1;
  return static_cast<double>(sent.vertices + restarts) / std::max(1u, triangles);
}

Result<void> check(const DemoPlace& place, const SharedStrips& model, DemoStripForm& form) {
  ModelCheckOptions options;
  options.threads = place.common.threads;
  options.spread_levels = 16;
  options.progress = show_progress(form.file);
  auto report = check_model<LodStripsInstance>(model, options);
  if (!report) return tl::unexpected(std::move(report.error()));
  form.levels_checked = report->levels_checked;
  form.faults = std::move(report->faults);
  return {};
}

// Builds, writes and checks one form.
Result<SharedStrips> show_form(const DemoPlace& place, const DetailedMesh& detailed,
                               LodStripsForm kind, DemoStrips& shown) {
  if (auto going = check_interrupted(place.folder); !going) return tl::unexpected(going.error());
  DemoStripForm form;
  form.name = form_name(kind);
  form.file = kind == LodStripsForm::kBlocks ? fmt::format("{}.vfm", kName)
                                             : fmt::format("{}_{}.vfm", kName, form.name);
  LodStripsOptions options;
  options.form = kind;
  const auto model = std::make_shared<const LodStrips>(build_lod_strips(detailed, options));
  const auto written = write_model(*model, place.folder / form.file);
  if (!written) return tl::unexpected(written.error());
  form.model_bytes = model->bytes();
  form.instance_bytes = LodStripsInstance(model).bytes();
  form.file_bytes = written->file_bytes;
  if (auto checked = check(place, model, form); !checked) return tl::unexpected(checked.error());
  const std::string flag =
      kind == LodStripsForm::kBlocks ? "" : fmt::format("--form {} ", form.name);
  tell(place,
       fmt::format("  $ varifold build lodstrips {}{} -o {}", flag, shown.mesh_file, form.file));
  tell(place, fmt::format("  $ varifold check {}", form.file));
  tell(place, fmt::format("  {} in the file; {} levels checked: {}", format_bytes(form.file_bytes),
                          form.levels_checked, is_sound(form.faults) ? "sound" : "NOT SOUND"));
  shown.forms.push_back(std::move(form));
  return model;
}

Camera camera_for(const TriangleMesh& mesh) {
  FrameOptions framing;
  framing.width = 800;
  framing.height = 640;
  return frame(mesh.positions, framing);
}

Result<void> draw(const DemoPlace& place, LodStripsInstance& instance, DemoStripLevel& level) {
  DrawStyle style;
  style.color_mode = ColorMode::kStrip;
  level.picture = fmt::format("{}_{}.png", kName, level.triangles);
  return place.painter->paint(instance.draw_list(), camera_for(instance.model().attributes()),
                              style, place.folder / level.picture);
}

// One level of all forms: they are of one sequence, so it has the same triangles in each.
Result<DemoStripLevel> show_level(const DemoPlace& place, const Share& share,
                                  std::vector<LodStripsInstance>& instances) {
  const LodStrips& model = instances.front().model();
  const std::uint32_t number = model.level_for_triangles(static_cast<std::uint32_t>(
      std::lround(share.of_triangles * model.triangle_count(model.finest_level()))));
  DemoStripLevel level;
  level.share = share.of_triangles;
  level.triangles = model.triangle_count(number);
  for (LodStripsInstance& instance : instances) {
    instance.go_to_level(number);
    const SubmittedIndices sent = submitted_indices(instance.draw_list());
    level.indices.push_back(indices_per_triangle(sent, level.triangles));
    if (level.indices.size() == 1) level.strips = sent.strips;
  }
  LodStripsInstance& drawn = instances.front();
  level.fresh_indices = measure_strips(stripify(drawn.extract())).indices_per_triangle();
  if (share.is_drawn && place.painter != nullptr)
    if (auto done = draw(place, drawn, level); !done) return tl::unexpected(done.error());
  return level;
}

void tell_bytes(const DemoPlace& place, const char* name, std::uint64_t DemoStripForm::*bytes,
                const DemoStrips& shown) {
  std::string line = fmt::format("  {:>19}", name);
  for (const DemoStripForm& form : shown.forms)
    line += fmt::format("{:>9.1f}", per_vertex(form.*bytes, shown));
  tell(place, line);
}

Result<void> show_levels(const DemoPlace& place, const std::vector<SharedStrips>& models,
                         DemoStrips& shown) {
  std::vector<LodStripsInstance> instances;
  std::string head = fmt::format("  {:>9} triangles", "");
  for (const SharedStrips& model : models) {
    instances.emplace_back(model);
    head += fmt::format("{:>9}", form_name(model->form_kind()));
  }
  tell(place, head + "    fresh  (indices a triangle)");
  for (const Share& share : kShares) {
    if (auto going = check_interrupted(place.folder); !going) return going;
    auto level = show_level(place, share, instances);
    if (!level) return tl::unexpected(std::move(level.error()));
    std::string line = fmt::format("  {:>9} triangles", format_count(level->triangles));
    for (const double indices : level->indices) line += fmt::format("{:>9.2f}", indices);
    tell(place, line + fmt::format("{:>9.2f}", level->fresh_indices));
    shown.levels.push_back(std::move(*level));
  }
  tell_bytes(place, "bytes a vertex", &DemoStripForm::model_bytes, shown);
  tell_bytes(place, "and an instance", &DemoStripForm::instance_bytes, shown);
  return {};
}

Result<Simplification> make_sequence(const DemoPlace& place, DemoStrips& shown) {
  PlanetOptions options;
  options.triangles = kTriangles;
  options.threads = place.common.threads;
  const TriangleMesh mesh = planet(options);
  shown.vertices = mesh.vertex_count();
  shown.triangles = mesh.triangle_count();
  shown.mesh_file = fmt::format("{}.ply", kName);
  tell(place, fmt::format("Triangle strips: {} triangles", format_count(shown.triangles)));
  tell(place, fmt::format("  $ varifold generate planet --triangles {} -o {}", kTriangles,
                          shown.mesh_file));
  if (auto written = write_mesh(mesh, place.folder / shown.mesh_file); !written)
    return tl::unexpected(written.error());
  SimplifyOptions simplify_options;
  simplify_options.threads = place.common.threads;
  simplify_options.progress = show_progress(kName);
  return simplify(mesh, simplify_options);
}

}  // namespace

Result<DemoStrips> show_strips(const DemoPlace& place) {
  const Stopwatch watch;
  DemoStrips shown;
  const auto simplified = make_sequence(place, shown);
  if (!simplified) return tl::unexpected(simplified.error());
  std::vector<SharedStrips> models;
  for (const LodStripsForm kind : kLodStripsForms) {
    auto model = show_form(place, simplified->detailed, kind, shown);
    if (!model) return tl::unexpected(std::move(model.error()));
    models.push_back(std::move(*model));
  }
  if (auto done = show_levels(place, models, shown); !done) return tl::unexpected(done.error());
  tell(place, fmt::format("  $ varifold render {} --color strip --triangles {} -o strips.png",
                          shown.forms.front().file, shown.levels.back().triangles));
  shown.seconds = watch.seconds();
  return shown;
}

}  // namespace varifold::cli
