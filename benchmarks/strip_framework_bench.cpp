// Building a strips framework, going to its levels and fronts, and filtering what is drawn.
#include <benchmark/benchmark.h>
#include <benchmarks/bench_meshes.h>
#include <benchmarks/benchmarks.h>
#include <varifold/base/random.h>
#include <varifold/models/strips/build.h>
#include <varifold/models/strips/instance.h>
#include <varifold/simplify/simplify.h>
#include <varifold/strip/stripify.h>
#include <varifold/view/camera.h>
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace varifold::bench {

namespace {

using benchmark::Counter;
using benchmark::State;

struct Input {
  DetailedMesh detailed;
  TriangleStrips strips;
};

const Input& input(const std::string& name) {
  static std::map<std::string, Input> made;
  const auto found = made.find(name);
  if (found != made.end()) return found->second;
  SimplifyOptions options;
  options.measure_error = false;
  auto result = simplify(without_attributes(mesh(name)), options);
  Input input;
  if (result) input.detailed = std::move(result->detailed);
  input.strips = stripify(input.detailed.mesh);
  return made.emplace(name, std::move(input)).first->second;
}

std::shared_ptr<const StripFramework> framework_of(const std::string& name) {
  static std::map<std::string, std::shared_ptr<const StripFramework>> made;
  auto& model = made[name];
  if (!model)
    model = std::make_shared<StripFramework>(
        build_strip_framework(input(name).detailed, input(name).strips));
  return model;
}

void build(State& state, const std::string& name) {
  const Input& from = input(name);
  std::size_t bytes = 0;
  for (auto _ : state) bytes = build_strip_framework(from.detailed, from.strips).bytes();
  const double vertices = from.detailed.mesh.vertex_count();
  state.counters["triangles/s"] =
      Counter(from.detailed.mesh.triangle_count(), Counter::kIsIterationInvariantRate);
  state.counters["bytes/vertex"] = static_cast<double>(bytes) / vertices;
}

void seek(State& state, const std::string& name, bool draw) {
  StripFrameworkInstance instance(framework_of(name));
  const std::uint32_t finest = instance.model().finest_level();
  Random random(1);
  std::vector<std::uint32_t> levels;
  for (int i = 0; i < 100; ++i) levels.push_back(random.below(finest + 1));
  std::uint64_t steps = 0;
  for (std::size_t i = 0; i < levels.size(); ++i) {
    const std::uint32_t before = levels[i == 0 ? levels.size() - 1 : i - 1];
    steps += levels[i] > before ? levels[i] - before : before - levels[i];
  }
  instance.go_to_level(levels.back());
  for (auto _ : state) {
    for (const std::uint32_t level : levels) {
      instance.go_to_level(level);
      if (draw) benchmark::DoNotOptimize(instance.draw_list());
    }
  }
  state.counters["collapses/s"] =
      Counter(static_cast<double>(steps), Counter::kIsIterationInvariantRate);
}

// All pages are filtered again.
void draw_all(State& state, const std::string& name) {
  StripFrameworkInstance instance(framework_of(name));
  const std::uint32_t finest = instance.model().finest_level();
  for (auto _ : state) {
    state.PauseTiming();
    instance.go_to_level(0);
    static_cast<void>(instance.draw_list());
    instance.go_to_level(finest / 2);
    state.ResumeTiming();
    benchmark::DoNotOptimize(instance.draw_list());
  }
  state.counters["slots/s"] =
      Counter(instance.model().slot_count(), Counter::kIsIterationInvariantRate);
}

// A camera that goes round the mesh, close by, in 100 frames.
void orbit(State& state, const std::string& name, bool draw) {
  StripFrameworkInstance instance(framework_of(name));
  const Box box = bounds(input(name).detailed.mesh);
  std::vector<RefineCriteria> frames;
  for (int i = 0; i < 100; ++i) {
    FrameOptions options;
    options.azimuth_degrees = 3.6f * static_cast<float>(i);
    Camera camera = frame(box, options);
    camera.eye = camera.target + 0.5f * (camera.eye - camera.target);
    set_depth_range(camera, sphere_around(box));
    frames.emplace_back();
    frames.back().view.emplace(camera);
  }
  std::uint64_t changes = 0;
  for (auto _ : state) {
    for (const RefineCriteria& criteria : frames) {
      const FrontStatistics statistics = instance.adapt(criteria);
      changes += statistics.splits + statistics.collapses;
      if (draw) benchmark::DoNotOptimize(instance.draw_list());
    }
  }
  state.counters["frames/s"] = Counter(100, Counter::kIsIterationInvariantRate);
  state.counters["changes/frame"] =
      Counter(static_cast<double>(changes) / 100, Counter::kAvgIterations);
}

}  // namespace

void register_strip_framework() {
  for (const std::string& name : present({"cow.obj", "bunny.ply", "igea.ply"})) {
    const auto add = [](const std::string& title, const auto& body) {
      benchmark::RegisterBenchmark(title.c_str(), body)->Unit(benchmark::kMillisecond);
    };
    add("build_strips/" + name, [=](State& state) { build(state, name); });
    add("strips/go_to_level/" + name, [=](State& state) { seek(state, name, false); });
    add("strips/go_to_level_draw/" + name, [=](State& state) { seek(state, name, true); });
    add("strips/draw_list/" + name, [=](State& state) { draw_all(state, name); });
    add("strips/adapt/" + name, [=](State& state) { orbit(state, name, false); });
    add("strips/adapt_draw/" + name, [=](State& state) { orbit(state, name, true); });
  }
}

}  // namespace varifold::bench
