// The whole collapse sequence, with its history, against meshoptimizer's way to 1 %.
#include <benchmark/benchmark.h>
#include <benchmarks/bench_meshes.h>
#include <benchmarks/benchmarks.h>
#include <benchmarks/peers.h>
#include <varifold/simplify/simplify.h>
#include <string>

namespace varifold::bench {

namespace {

using benchmark::Counter;
using benchmark::State;

// Input triangles a second.
void count_triangles(State& state, const TriangleMesh& mesh) {
  state.counters["triangles/s"] =
      Counter(mesh.triangle_count(), Counter::kIsIterationInvariantRate, Counter::kIs1000);
}

void whole_sequence(State& state, const std::string& name, const SimplifyOptions& options) {
  const TriangleMesh& input = mesh(name);
  double scratch = 0;
  for (auto _ : state) {
    const auto result = simplify(input, options);
    if (!result) return state.SkipWithError(result.error().message.c_str());
    scratch = static_cast<double>(result->scratch_bytes) / input.vertex_count();
  }
  count_triangles(state, input);
  state.counters["scratch_bytes/vertex"] = scratch;
}

void meshoptimizer_to_1_percent(State& state, const std::string& name) {
  const TriangleMesh& input = mesh(name);
  for (auto _ : state)
    benchmark::DoNotOptimize(meshoptimizer_simplify(input, input.triangle_count() / 100));
  count_triangles(state, input);
}

template <class Body>
void add(const std::string& name, const Body& body) {
  benchmark::RegisterBenchmark(name.c_str(), body)
      ->Unit(benchmark::kMillisecond)
      ->UseRealTime()
      ->MeasureProcessCPUTime();
}

void add_sequences(const std::string& name) {
  for (const int threads : {1, 2}) {
    SimplifyOptions options;
    options.measure_error = false;
    options.threads = threads;
    const std::string suffix = "/" + name + "/threads:" + std::to_string(threads);
    add("simplify" + suffix, [=](State& state) { whole_sequence(state, name, options); });
    options.measure_error = true;
    add("simplify_and_measure" + suffix,
        [=](State& state) { whole_sequence(state, name, options); });
  }
}

}  // namespace

void register_simplify() {
  for (const std::string& name :
       present({"bunny.ply", "armadillo.ply", "igea.ply", "dragon.ply", "planet"})) {
    add_sequences(name);
    add("meshoptimizer_simplify/" + name,
        [=](State& state) { meshoptimizer_to_1_percent(state, name); });
    SimplifyOptions optimal;
    optimal.placement = Placement::kOptimal;
    optimal.measure_error = false;
    optimal.threads = 1;
    add("simplify_optimal/" + name, [=](State& state) { whole_sequence(state, name, optimal); });
  }
  add_sequences("planet_attributes");
}

}  // namespace varifold::bench
