// What a frame of a patch tree costs before the device draws it: index arrays whose border
// triangles are rewritten against constant indices with a mask per patch.
#include <benchmark/benchmark.h>
#include <benchmarks/bench_meshes.h>
#include <benchmarks/benchmarks.h>
#include <varifold/base/random.h>
#include <varifold/models/patch_tree/build.h>
#include <varifold/models/patch_tree/instance.h>
#include <varifold/models/patch_tree/patch_draws.h>
#include <varifold/render/headless_context.h>
#include <varifold/render/renderer.h>
#include <varifold/strip/cache_order.h>
#include <varifold/strip/strip_measures.h>
#include <varifold/view/camera_path.h>
#include <varifold/view/known_paths.h>
#include <chrono>
#include <cstdint>
#include <map>
#include <memory>
#include <numeric>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace varifold::bench {

namespace {

using benchmark::Counter;
using benchmark::State;

using TreePointer = std::shared_ptr<const PatchTree>;

TreePointer tree_of(const std::string& name, std::uint32_t triangles_per_patch) {
  static std::map<std::pair<std::string, std::uint32_t>, TreePointer> trees;
  TreePointer& tree = trees[{name, triangles_per_patch}];
  if (tree) return tree;
  PatchTreeOptions options;
  options.triangles_per_patch = triangles_per_patch;
  auto built = build_patch_tree(mesh(name), options);
  tree = std::make_shared<const PatchTree>(built ? std::move(built->tree) : PatchTree());
  return tree;
}

std::vector<Camera> orbit(const PatchTree& tree) {
  Box box;
  for (const Vec3& p : tree.data().vertices.positions) box.add(p);
  KnownPathOptions options;
  options.orbit_distance = 1;
  const auto path = known_path("orbit", options);
  const auto cameras = path ? cameras_of(*path, box) : Result<std::vector<Camera>>();
  return cameras ? *cameras : std::vector<Camera>();
}

// As the paper draws: indices of 32 bits, those of borders written anew where they change.
class Arrays {
 public:
  Arrays(const TreePointer& tree, Renderer& renderer) : instance_(tree), renderer_(renderer) {
    name_ = *renderer.add(instance_.draw_list());
  }
  std::uint32_t adapt(const RefineCriteria& criteria) {
    return instance_.adapt(criteria).triangles;
  }
  void make_list() { list_ = instance_.draw_list(); }
  std::size_t upload() { return *renderer_.update(name_, list_); }
  void draw() { (void)renderer_.draw(name_, list_); }

 private:
  PatchTreeInstance instance_;
  Renderer& renderer_;
  GpuMesh name_{};
  DrawList list_;
};

// Constant indices, and a command per patch.
class Commands {
 public:
  Commands(const TreePointer& tree, Renderer& renderer)
      : front_(tree),
        draws_(std::make_shared<const PatchDrawTables>(tree, PatchMeasure::kPixels)),
        renderer_(renderer) {
    draws_.follow(front_.draws());
    name_ = *renderer.add(draws_.list());
  }
  std::uint32_t adapt(const RefineCriteria& criteria) {
    criteria_ = &criteria;
    return front_.adapt(criteria, {}).statistics.triangles;
  }
  void make_list() { draws_.follow(front_.draws()); }
  std::size_t upload() { return *renderer_.update(name_, draws_.list()); }
  void draw() {
    PatchStyle style;
    if (blends) style.morph = pixel_morph_range(criteria_->view->scale, 1);
    (void)renderer_.draw(name_, {}, style);
  }
  bool blends = false;

 private:
  PatchFront front_;
  PatchDraws draws_;
  Renderer& renderer_;
  GpuPatches name_{};
  const RefineCriteria* criteria_ = nullptr;
};

// Microseconds that the steps of a frame took, summed up.
class Steps {
 public:
  template <class Step>
  void time(double Steps::*sum, const Step& step) {
    const auto start = std::chrono::steady_clock::now();
    step();
    this->*sum +=
        std::chrono::duration<double, std::micro>(std::chrono::steady_clock::now() - start).count();
  }
  double adapt = 0, list = 0, upload = 0, draw = 0;
};

struct DrawCase {
  const char* name;
  bool is_drawn;  // in pictures of half that size; else up to the upload
  bool blends;
};

// Goes round at one pixel of 1920 x 1080; the time is that of a frame.
template <class Way>
void go_round(State& state, const TreePointer& tree, const DrawCase& which) {
  const auto context = HeadlessContext::create();
  auto renderer = context ? Renderer::create() : tl::unexpected(context.error());
  if (!renderer) return state.SkipWithError(renderer.error().message.c_str());
  const std::vector<Camera> cameras = orbit(*tree);
  if (cameras.empty()) return state.SkipWithError("no path");
  Way way(tree, *renderer);
  if constexpr (requires { way.blends; }) way.blends = which.blends;
  RefineCriteria criteria;
  Steps steps;
  std::uint64_t triangles = 0, bytes = 0;
  std::size_t frame = 0;
  const auto go = [&] {
    const Camera& camera = cameras[frame++ % cameras.size()];
    criteria.view.emplace(camera);
    steps.time(&Steps::adapt, [&] { triangles += way.adapt(criteria); });
    steps.time(&Steps::list, [&] { way.make_list(); });
    steps.time(&Steps::upload, [&] { bytes += way.upload(); });
    if (!which.is_drawn) return;
    Camera small = camera;
    small.width /= 2, small.height /= 2;
    (void)renderer->begin(small, {.samples = 1});
    renderer->finish();
    steps.time(&Steps::draw, [&] { way.draw(), renderer->finish(); });
  };
  go();  // the first frame is a jump
  steps = {};
  triangles = bytes = 0;
  for (auto _ : state) go();
  const auto per_frame = [&](double sum) { return Counter(sum, Counter::kAvgIterations); };
  state.counters["triangles"] = per_frame(static_cast<double>(triangles));
  state.counters["bytes"] = per_frame(static_cast<double>(bytes));
  state.counters["adapt_us"] = per_frame(steps.adapt);
  state.counters["list_us"] = per_frame(steps.list);
  state.counters["upload_us"] = per_frame(steps.upload);
  if (which.is_drawn) state.counters["draw_us"] = per_frame(steps.draw);
}

// The corners of the leaves, patch by patch, with their triangles in random order.
struct ShuffledPatches {
  std::vector<std::uint16_t> corners;
  struct Patch {
    std::size_t first, count;
    std::uint32_t vertices;
  };
  std::vector<Patch> patches;

  explicit ShuffledPatches(const PatchTree& tree) {
    Random random(1);
    const PatchTreeData& data = tree.data();
    for (std::uint32_t n = data.topology.first_of_level[tree.finest_level()]; n < tree.node_count();
         ++n) {
      const std::uint32_t first = data.offsets[n].triangle, count = tree.triangle_count_of(n);
      std::vector<std::uint32_t> order(count);
      std::iota(order.begin(), order.end(), first);
      for (std::uint32_t i = count; i > 1; --i) std::swap(order[i - 1], order[random.below(i)]);
      patches.push_back({corners.size(), 3 * std::size_t{count}, tree.vertex_count_of(n)});
      for (const std::uint32_t t : order)
        for (std::size_t k = 0; k < 3; ++k) corners.push_back(data.corners[3 * std::size_t{t} + k]);
    }
  }
  // Of a cache of 16 vertices, first in first out, empty at the begin of each patch.
  [[nodiscard]] CacheMeasures measures() const {
    CacheMeasures sum;
    for (const Patch& patch : patches) {
      const std::vector<std::uint32_t> indices(
          corners.begin() + static_cast<std::ptrdiff_t>(patch.first),
          corners.begin() + static_cast<std::ptrdiff_t>(patch.first + patch.count));
      const DrawRange range{.index_count = static_cast<std::uint32_t>(patch.count)};
      const CacheMeasures one = measure_cache(indices, {&range, 1}, 16);
      sum.misses += one.misses;
      sum.triangles += one.triangles;
      sum.vertices += one.vertices;
    }
    return sum;
  }
};

// Time and gain of ordering; an item is a triangle.
void order_patches(State& state, const std::string& name, std::uint32_t per_patch) {
  const ShuffledPatches shuffled(*tree_of(name, per_patch));
  ShuffledPatches ordered = shuffled;
  CacheOrder order;
  for (auto _ : state) {
    state.PauseTiming();
    ordered.corners = shuffled.corners;
    state.ResumeTiming();
    for (const ShuffledPatches::Patch& patch : ordered.patches)
      order.reorder(std::span(ordered.corners).subspan(patch.first, patch.count), patch.vertices);
  }
  const CacheMeasures before = shuffled.measures(), after = ordered.measures();
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(after.triangles));
  state.counters["acmr_shuffled"] = before.acmr();
  state.counters["acmr_ordered"] = after.acmr();
  state.counters["vertices"] =
      static_cast<double>(after.vertices) / static_cast<double>(after.triangles);
}

}  // namespace

void register_patch_draws() {
  const std::string name = "planet";
  for (const std::uint32_t per_patch : {128u, 512u, 1000u})
    benchmark::RegisterBenchmark(("patch_cache_order/" + std::to_string(per_patch)).c_str(),
                                 [=](State& state) { order_patches(state, "planet", per_patch); })
        ->Unit(benchmark::kMillisecond);
  for (const std::uint32_t per_patch : {128u, 1000u}) {
    const auto add = [&](const DrawCase& which, bool arrays) {
      const std::string full =
          "patch_draws/" + std::string(which.name) + "/" + std::to_string(per_patch);
      benchmark::RegisterBenchmark(full.c_str(),
                                   [=](State& state) {
                                     const TreePointer tree = tree_of(name, per_patch);
                                     if (arrays)
                                       go_round<Arrays>(state, tree, which);
                                     else
                                       go_round<Commands>(state, tree, which);
                                   })
          ->Unit(benchmark::kMicrosecond)
          ->UseRealTime()
          ->Iterations(which.is_drawn ? 60 : 720);
    };
    add({"arrays", false, false}, true);
    add({"commands", false, false}, false);
    add({"arrays_drawn", true, false}, true);
    add({"commands_drawn", true, false}, false);
    add({"commands_blended", true, true}, false);
  }
}

}  // namespace varifold::bench
