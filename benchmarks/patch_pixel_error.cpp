// Prints how many triangles patch trees and a cluster DAG need for the same measured error in
// pixels: the tables of docs/algorithms/patch_tree.md.
//
//   varifold_patch_pixel_error [-o CURVES.csv] [MESH...]
//
// Ends with a fault where a cut does not end where the original does.
#include <benchmarks/bench_meshes.h>
#include <benchmarks/cluster_dag.h>
#include <benchmarks/cut_pieces.h>
#include <benchmarks/error_curve.h>
#include <benchmarks/views_of_mesh.h>
#include <varifold/mesh/weld.h>
#include <varifold/models/patch_tree/build.h>
#include <varifold/models/patch_tree/instance.h>
#include <varifold/view/known_paths.h>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace varifold::bench {
namespace {

constexpr int kViews = 4;  // of a kind
constexpr std::uint32_t kPoints = 30'000, kTries = 4'000'000;
constexpr std::uint32_t kPatchSizes[] = {128, 512, 1000};
constexpr double kAsked[] = {0.25, 0.354, 0.5, 0.707, 1, 1.414, 2, 2.828, 4, 5.657, 8};  // pixels

// What is compared: all that the frustum holds, or what is seen of it.
enum class Mode { kFrustum, kSeen };

struct View {
  ViewCriterion criterion;
  std::vector<DVec3> points[2];  // per mode
};

struct Views {
  const char* kind;
  std::vector<View> views;
};

struct Contender {
  std::string name;
  std::uint64_t stored = 0;
  double seconds = 0;  // to build, one thread
  std::function<Cut(const ViewCriterion&, Mode, float pixels)> cut;
};

// Of all views of a kind.
struct Result {
  std::string mesh, kind, model;
  Mode mode = Mode::kFrustum;
  double asked = 0, rms = 0, most_of_1000 = 0, max = 0;  // pixels
  double drawn = 0, inside = 0, all = 0;                 // triangles a view
};

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

TriangleMesh welded(const TriangleMesh& mesh) {
  const WeldMap weld = weld_exact(mesh.positions);
  TriangleMesh result;
  result.positions.resize(weld.class_count);
  for (std::size_t v = 0; v < mesh.positions.size(); ++v)
    result.positions[weld.class_of[v]] = mesh.positions[v];
  for (std::size_t t = 0; t < mesh.indices.size(); t += 3) {
    const std::uint32_t a = weld.class_of[mesh.indices[t]], b = weld.class_of[mesh.indices[t + 1]],
                        c = weld.class_of[mesh.indices[t + 2]];
    if (a != b && b != c && c != a) result.indices.insert(result.indices.end(), {a, b, c});
  }
  return without_unused_vertices(result);
}

View make_view(const Original& original, const Camera& camera, Random& random) {
  View view{ViewCriterion(camera), {}};
  for (std::uint32_t n = 0; n < kTries && view.points[0].size() < kPoints; ++n) {
    const Sampler::Sample sample = original.sampler.next(random);
    if (!contains(view.criterion.frustum, Vec3(sample.point))) continue;
    view.points[0].push_back(sample.point);
    if (original.shows(sample, view.criterion)) view.points[1].push_back(sample.point);
  }
  return view;
}

// From outside the surface, so many diagonals away from the point that is looked at.
Camera view_from(const Original& original, double diagonals, Random& random) {
  Camera camera;
  do {
    const Sampler::Sample seen = original.sampler.next(random);
    camera.target = Vec3(seen.point);
    camera.eye = camera.target + static_cast<float>(diagonals) * original.box.diagonal() *
                                     glm::normalize(seen.normal + 0.5f * random_direction(random));
    camera.up = random_direction(random);
    camera.width = 1920;
    camera.height = 1080;
    set_depth_range(camera, sphere_around(original.box));
  } while (!is_usable(camera) ||
           original.occluder.hides(camera.target, camera.eye, 1e-4f * original.box.diagonal()));
  return camera;
}

std::vector<Views> make_views(const Original& original) {
  Random random(1);
  std::vector<Views> all;
  for (const auto& [kind, diagonals] : {std::pair("near", 0.25), std::pair("middle", 0.8)}) {
    Views views{kind, {}};
    for (int i = 0; i < kViews; ++i)
      views.views.push_back(make_view(original, view_from(original, diagonals, random), random));
    all.push_back(std::move(views));
  }
  KnownPathOptions options;
  options.frames = kViews;
  Views orbit{"orbit", {}};
  const auto cameras = cameras_of(*known_path("orbit", options), original.box);
  for (const Camera& camera : *cameras) orbit.views.push_back(make_view(original, camera, random));
  all.push_back(std::move(orbit));
  return all;
}

Cut cut_of(const ClusterDag& dag, const ViewCriterion& view, float pixels) {
  Cut cut;
  cut.mesh.positions = dag.positions();
  for (const std::uint32_t c : dag.cut(view.scale, pixels)) {
    const Cluster& cluster = dag.clusters()[c];
    const auto corners = dag.indices_of(cluster);
    cut.pieces.push_back(
        {cut.mesh.triangle_count(), cluster.triangle_count, cluster.triangle_count});
    cut.mesh.indices.insert(cut.mesh.indices.end(), corners.begin(), corners.end());
  }
  return cut;
}

Cut cut_of(PatchTreeInstance& instance, const ViewCriterion& view, Mode mode, float pixels) {
  RefineCriteria criteria;
  criteria.view = view;
  criteria.view->back_weight = mode == Mode::kSeen ? 0 : 1;
  instance.adapt(criteria, {pixels});
  const DrawList list = instance.draw_list();
  std::map<std::uint32_t, std::vector<DrawRange>> ranges_of;  // by node
  for (std::size_t i = 0; i < list.ranges.size(); ++i)
    ranges_of[instance.nodes_of_ranges()[i]].push_back(list.ranges[i]);
  Cut cut;
  cut.mesh.positions.assign(list.positions.begin(), list.positions.end());
  for (const auto& [node, ranges] : ranges_of) {
    CutPiece piece{cut.mesh.triangle_count(), 0, instance.model().triangle_count_of(node)};
    for (const DrawRange& range : ranges) {
      const auto corners = list.indices.subspan(range.first_index, range.index_count);
      cut.mesh.indices.insert(cut.mesh.indices.end(), corners.begin(), corners.end());
      piece.triangle_count += range.index_count / 3;
    }
    cut.pieces.push_back(piece);
  }
  return cut;
}

std::vector<Contender> make_contenders(const TriangleMesh& mesh) {
  std::vector<Contender> all;
  auto start = std::chrono::steady_clock::now();
  const auto dag = std::make_shared<const ClusterDag>(mesh);
  all.push_back({"cluster DAG", dag->stored_triangles(), seconds_since(start),
                 [=](const ViewCriterion& view, Mode /*mode*/, float pixels) {
                   return cut_of(*dag, view, pixels);
                 }});
  for (const std::uint32_t size : kPatchSizes) {
    PatchTreeOptions options;
    options.triangles_per_patch = size;
    options.threads = 1;
    start = std::chrono::steady_clock::now();
    auto built = build_patch_tree(mesh, options);
    const double seconds = seconds_since(start);
    const auto tree = std::make_shared<const PatchTree>(std::move(built->tree));
    const auto instance = std::make_shared<PatchTreeInstance>(tree);
    all.push_back({"patches of " + std::to_string(size), tree->data().offsets.back().triangle,
                   seconds, [=](const ViewCriterion& view, Mode mode, float pixels) {
                     return cut_of(*instance, view, mode, pixels);
                   }});
  }
  return all;
}

void check_border(const Contender& contender, const Cut& cut, const TriangleMesh& original) {
  if (has_same_border(cut.mesh, original)) return;
  std::fprintf(stderr, "%s: a cut does not end where the original does\n", contender.name.c_str());
  std::exit(1);
}

Result measure(const Contender& contender, const std::vector<View>& views, Mode mode,
               double asked) {
  Result result;
  std::vector<double> pixels;
  double squares = 0;
  for (const View& view : views) {
    const Cut cut = contender.cut(view.criterion, mode, static_cast<float>(asked));
    const auto off = pixels_off(view.points[static_cast<int>(mode)], cut, view.criterion.scale);
    pixels.insert(pixels.end(), off.begin(), off.end());
    const Culling culling = mode == Mode::kSeen ? Culling::kFrustumAndTurned : Culling::kFrustum;
    result.drawn += static_cast<double>(drawn_triangles(cut, view.criterion, culling)) / kViews;
    result.inside += static_cast<double>(triangles_inside(cut, view.criterion)) / kViews;
    result.all += static_cast<double>(submitted_triangles(cut)) / kViews;
  }
  std::sort(pixels.begin(), pixels.end());
  for (const double p : pixels) squares += p * p;
  result.rms = std::sqrt(squares / static_cast<double>(pixels.size()));
  result.most_of_1000 =
      pixels[static_cast<std::size_t>(0.999 * static_cast<double>(pixels.size()))];
  result.max = pixels.back();
  result.mode = mode;
  result.model = contender.name;
  result.asked = asked;
  return result;
}

std::vector<Result> results_of(const std::string& name) {
  const TriangleMesh mesh = welded(bench::mesh(name));
  const Original original{mesh};
  const std::vector<Views> all = make_views(original);
  std::vector<Result> results;
  for (const Contender& contender : make_contenders(mesh)) {
    std::printf("%s, %s: %u triangles, stored %.2f times, built in %.2f s, %.0fk triangles/s\n",
                name.c_str(), contender.name.c_str(), mesh.triangle_count(),
                static_cast<double>(contender.stored) / mesh.triangle_count(), contender.seconds,
                1e-3 * mesh.triangle_count() / contender.seconds);
    std::fflush(stdout);
    // Borders of open meshes move in patch trees, whose own checks see to them.
    const bool is_kept = contender.name == "cluster DAG" || has_same_border(mesh, {});
    for (const Views& views : all)
      for (const Mode mode : {Mode::kFrustum, Mode::kSeen})
        for (const double asked : kAsked) {
          if (is_kept && mode == Mode::kFrustum)
            check_border(contender,
                         contender.cut(views.views[0].criterion, mode, static_cast<float>(asked)),
                         mesh);
          results.push_back(measure(contender, views.views, mode, asked));
          results.back().mesh = name;
          results.back().kind = views.kind;
        }
  }
  return results;
}

using Field = double Result::*;

// What is measured, the error where triangles are told, and the range of the mean.
struct Measure {
  Field field;
  const char* title;
  double told, low, high;  // pixels
};
constexpr Measure kMeasures[] = {{&Result::max, "max", 1, 0.5, 4},
                                 {&Result::most_of_1000, "99.9 %", 1, 0.5, 4},
                                 {&Result::rms, "RMS", 0.25, 0.125, 1}};

ErrorCurve curve_of(const std::vector<Result>& results, const Result& like, Field error,
                    Field triangles) {
  std::vector<CurvePoint> points;
  for (const Result& r : results)
    if (r.mesh == like.mesh && r.kind == like.kind && r.model == like.model && r.mode == like.mode)
      points.push_back({r.*error, r.*triangles});
  return ErrorCurve(std::move(points));
}

void print_asked(const std::vector<Result>& results) {
  std::printf(
      "\n| mesh | views | model | asked, px | max | 99.9 %% | RMS | drawn | inside | all |\n"
      "| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |\n");
  for (const Result& r : results)
    if (r.mode == Mode::kFrustum &&
        (r.asked == 0.5 || r.asked == 1 || r.asked == 2 || r.asked == 4))
      std::printf("| %s | %s | %s | %g | %.2f | %.2f | %.3f | %.0f | %.0f | %.0f |\n",
                  r.mesh.c_str(), r.kind.c_str(), r.model.c_str(), r.asked, r.max, r.most_of_1000,
                  r.rms, r.drawn, r.inside, r.all);
}

void print_number(const char* form, const std::optional<double>& number) {
  number ? std::printf(form, *number) : std::printf("-");
}

// Triangles of the peer for an error, and how many patch trees need for each of them: at that
// error, and in the mean over all errors of the range that both were measured at.
void print_equal(const std::vector<Result>& results, Mode mode, Field triangles) {
  std::printf("\n%s, %s\n\n| mesh | views | measured | cluster DAG",
              mode == Mode::kSeen ? "what is seen" : "what the frustum holds",
              triangles == &Result::drawn ? "triangles of pieces that are not culled"
                                          : "triangles inside the frustum");
  for (const std::uint32_t size : kPatchSizes) std::printf(" | patches of %u, mean", size);
  std::printf(" |\n| --- | --- | --- | --- | --- | --- | --- |\n");
  std::map<std::pair<std::string, std::size_t>, std::vector<double>> means;  // logarithms
  for (const Measure& measure : kMeasures) {
    for (const Result& r : results) {
      if (r.mode != mode || r.asked != 1 || r.model != "cluster DAG") continue;
      const ErrorCurve peer = curve_of(results, r, measure.field, triangles);
      const auto of_peer = peer.triangles_at(measure.told);
      std::printf("| %s | %s | %s %g px | ", r.mesh.c_str(), r.kind.c_str(), measure.title,
                  measure.told);
      print_number("%.0f", of_peer);
      for (std::size_t i = 0; i < std::size(kPatchSizes); ++i) {
        Result like = r;
        like.model = "patches of " + std::to_string(kPatchSizes[i]);
        const ErrorCurve own = curve_of(results, like, measure.field, triangles);
        const auto of_own = own.triangles_at(measure.told);
        const auto mean = mean_ratio(own, peer, measure.low, measure.high);
        std::printf(" | ");
        print_number("%.2f", of_own && of_peer ? std::optional(*of_own / *of_peer) : std::nullopt);
        std::printf(", ");
        print_number("%.2f", mean);
        if (mean) means[{measure.title, i}].push_back(std::log(*mean));
      }
      std::printf(" |\n");
    }
  }
  for (const Measure& measure : kMeasures) {
    std::printf("| all | all | %s | ", measure.title);
    for (std::size_t i = 0; i < std::size(kPatchSizes); ++i) {
      double sum = 0;
      const std::vector<double>& logarithms = means[{measure.title, i}];
      for (const double x : logarithms) sum += x / static_cast<double>(logarithms.size());
      std::printf(" | %.2f", std::exp(sum));
    }
    std::printf(" |\n");
  }
}

void write_curves(const std::vector<Result>& results, const char* path) {
  std::FILE* const file = std::fopen(path, "w");
  if (file == nullptr) return std::perror(path);
  std::fprintf(file, "mesh,views,seen,model,asked,max,most_of_1000,rms,drawn,inside,all\n");
  for (const Result& r : results)
    std::fprintf(file, "%s,%s,%d,%s,%g,%.4f,%.4f,%.5f,%.1f,%.1f,%.1f\n", r.mesh.c_str(),
                 r.kind.c_str(), r.mode == Mode::kSeen ? 1 : 0, r.model.c_str(), r.asked, r.max,
                 r.most_of_1000, r.rms, r.drawn, r.inside, r.all);
  std::fclose(file);
}

}  // namespace
}  // namespace varifold::bench

int main(int argc, char** argv) {
  using namespace varifold::bench;
  std::vector<std::string> names;
  const char* curves = nullptr;
  for (int i = 1; i < argc; ++i) {
    if (std::string(argv[i]) == "-o" && i + 1 < argc)
      curves = argv[++i];
    else
      names.emplace_back(argv[i]);
  }
  if (names.empty()) names = {"bunny.ply", "igea.ply", "armadillo.ply", "dragon.ply", "planet"};
  std::vector<Result> results;
  for (const std::string& name : present(names)) {
    const std::vector<Result> more = results_of(name);
    results.insert(results.end(), more.begin(), more.end());
  }
  print_asked(results);
  print_equal(results, Mode::kFrustum, &Result::drawn);
  print_equal(results, Mode::kFrustum, &Result::inside);
  print_equal(results, Mode::kSeen, &Result::drawn);
  if (curves != nullptr) write_curves(results, curves);
  return 0;
}
