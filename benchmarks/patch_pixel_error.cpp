// Prints how many triangles patch trees and a cluster DAG need for the same measured error in
// pixels: the tables of docs/algorithms/patch_tree.md.
//
//   varifold_patch_pixel_error [-o CURVES.csv] [MESH...]
//
// Ends with a fault where a cut does not end where the original does.
#include <benchmarks/bench_meshes.h>
#include <benchmarks/cluster_dag.h>
#include <benchmarks/cut_pieces.h>
#include <benchmarks/pixel_error_tables.h>
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
#include <string>
#include <utility>
#include <vector>

namespace varifold::bench {
namespace {

constexpr int kViews = 4;  // of a kind
constexpr std::uint32_t kPoints = 30'000, kTries = 4'000'000;
constexpr double kAsked[] = {0.25, 0.354, 0.5, 0.707, 1, 1.414, 2, 2.828, 4, 5.657, 8};  // pixels

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
  all.push_back({kPeer, dag->stored_triangles(), seconds_since(start),
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

CutErrors measure(const Contender& contender, const std::vector<View>& views, Mode mode,
                  double asked) {
  CutErrors result;
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

std::vector<CutErrors> results_of(const std::string& name) {
  const TriangleMesh mesh = welded(bench::mesh(name));
  const Original original{mesh};
  const std::vector<Views> all = make_views(original);
  std::vector<CutErrors> results;
  for (const Contender& contender : make_contenders(mesh)) {
    std::printf("%s, %s: %u triangles, stored %.2f times, built in %.2f s, %.0fk triangles/s\n",
                name.c_str(), contender.name.c_str(), mesh.triangle_count(),
                static_cast<double>(contender.stored) / mesh.triangle_count(), contender.seconds,
                1e-3 * mesh.triangle_count() / contender.seconds);
    std::fflush(stdout);
    // Borders of open meshes move in patch trees; `varifold check` sees to those.
    const bool keeps_border = contender.name == kPeer || has_same_border(mesh, {});
    for (const Views& views : all)
      for (const Mode mode : {Mode::kFrustum, Mode::kSeen})
        for (const double asked : kAsked) {
          if (keeps_border && mode == Mode::kFrustum)
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
  std::vector<CutErrors> results;
  for (const std::string& name : present(names)) {
    const std::vector<CutErrors> more = results_of(name);
    results.insert(results.end(), more.begin(), more.end());
  }
  print_asked(results);
  print_equal(results, Mode::kFrustum, &CutErrors::drawn);
  print_equal(results, Mode::kFrustum, &CutErrors::inside);
  print_equal(results, Mode::kSeen, &CutErrors::drawn);
  if (curves != nullptr) write_curves(results, curves);
  return 0;
}
