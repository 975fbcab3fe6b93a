// The measured error of all levels, and the distance between two surfaces.
#include <benchmark/benchmark.h>
#include <benchmarks/bench_meshes.h>
#include <benchmarks/benchmarks.h>
#include <benchmarks/peers.h>
#include <varifold/measure/surface_distance.h>
#include <varifold/simplify/deviation.h>
#include <varifold/simplify/simplify.h>
#include <string>
#include <utility>

namespace varifold::bench {

namespace {

using benchmark::Counter;
using benchmark::State;

void deviation(State& state, const std::string& name, int threads) {
  SimplifyOptions options;
  options.measure_error = false;
  auto result = simplify(mesh(name), options);
  if (!result) return state.SkipWithError(result.error().message.c_str());
  for (auto _ : state) benchmark::DoNotOptimize(measure_deviation(result->detailed, {threads, {}}));
  state.counters["vertices/s"] =
      Counter(result->detailed.mesh.vertex_count(), Counter::kIsIterationInvariantRate);
}

void distance(State& state, const std::string& name) {
  const TriangleMesh& fine = mesh(name);
  const TriangleMesh coarse = meshoptimizer_simplify(fine, fine.triangle_count() / 10);
  DistanceOptions options;
  options.threads = 1;
  for (auto _ : state) benchmark::DoNotOptimize(surface_distance(fine, coarse, options));
  state.counters["samples/s"] = Counter(2.0 * options.samples, Counter::kIsIterationInvariantRate);
}

}  // namespace

void register_measure() {
  for (const std::string& name : present({"bunny.ply", "igea.ply", "planet"})) {
    for (const int threads : {1, 2})
      benchmark::RegisterBenchmark(
          ("measure_deviation/" + name + "/threads:" + std::to_string(threads)).c_str(),
          [=](State& state) { deviation(state, name, threads); })
          ->Unit(benchmark::kMillisecond)
          ->UseRealTime();
    benchmark::RegisterBenchmark(("surface_distance/" + name).c_str(), [=](State& state) {
      distance(state, name);
    })->Unit(benchmark::kMillisecond);
  }
}

}  // namespace varifold::bench
