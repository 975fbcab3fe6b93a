// Stripifiers against meshoptimizer's: speed, indices a triangle and cache misses.
#include <benchmark/benchmark.h>
#include <benchmarks/bench_meshes.h>
#include <benchmarks/benchmarks.h>
#include <benchmarks/peers.h>
#include <varifold/strip/strip_measures.h>
#include <varifold/strip/stripify.h>
#include <string>
#include <vector>

namespace varifold::bench {

namespace {

using benchmark::Counter;
using benchmark::State;

void report(State& state, const TriangleMesh& mesh, std::span<const std::uint32_t> indices,
            std::span<const DrawRange> ranges) {
  const IndexMeasures measures = measure_indices(indices, ranges);
  state.counters["triangles/s"] =
      Counter(mesh.triangle_count(), Counter::kIsIterationInvariantRate, Counter::kIs1000);
  state.counters["indices/triangle"] = measures.indices_per_triangle();
  state.counters["strips"] = static_cast<double>(measures.strips);
  state.counters["swaps"] = static_cast<double>(measures.swaps);
  for (const std::uint32_t size : {16u, 24u, 32u}) {
    const CacheMeasures cache = measure_cache(indices, ranges, size);
    state.counters["acmr" + std::to_string(size)] = cache.acmr();
    state.counters["atvr" + std::to_string(size)] = cache.atvr();
  }
}

void strips(State& state, const std::string& name, const StripifyOptions& options) {
  const TriangleMesh& input = mesh(name);
  TriangleStrips result;
  for (auto _ : state) result = stripify(input, options);
  const JoinedStrips joined = join_strips(result, input, StripJoin::kRestart);
  report(state, input, joined.indices, joined.ranges);
}

// `order` makes an index buffer of the mesh.
template <class Order>
void peer(State& state, const std::string& name, Primitive primitive, const Order& order) {
  const TriangleMesh& input = mesh(name);
  std::vector<std::uint32_t> indices;
  for (auto _ : state) indices = order(input);
  const DrawRange range{0, static_cast<std::uint32_t>(indices.size()), primitive};
  report(state, input, indices, {&range, 1});
}

template <class Body>
void add(const std::string& name, const Body& body) {
  benchmark::RegisterBenchmark(name.c_str(), body)->Unit(benchmark::kMillisecond)->UseRealTime();
}

void add_length_first(const std::string& name) {
  const struct {
    const char* name;
    StripHeuristic heuristic;
  } heuristics[] = {
      {"first", StripHeuristic::kFirst},
      {"random", StripHeuristic::kRandom},
      {"look_ahead", StripHeuristic::kLookAhead},
      {"alternate", StripHeuristic::kAlternate},
      {"sequential", StripHeuristic::kSequential},
      {"straight", StripHeuristic::kStraight},
      {"rows", StripHeuristic::kRows},
  };
  for (const auto& h : heuristics) {
    for (const bool join_ends : {false, true}) {
      const std::string joined = join_ends ? "/joined" : "";
      const StripifyOptions options{.heuristic = h.heuristic, .join_ends = join_ends};
      add("stripify/" + name + "/" + h.name + joined,
          [=](State& state) { strips(state, name, options); });
    }
  }
}

}  // namespace

void register_strips() {
  for (const std::string& name : present({"cow.obj", "bunny.ply", "igea.ply", "armadillo.ply"})) {
    add_length_first(name);
    for (const std::uint32_t size : {16u, 24u}) {
      const StripifyOptions options{.method = StripMethod::kCacheAware, .cache_size = size};
      add("stripify/" + name + "/cache:" + std::to_string(size),
          [=](State& state) { strips(state, name, options); });
    }
    add("meshoptimizer_strips/" + name,
        [=](State& state) { peer(state, name, Primitive::kStrips, meshoptimizer_strips); });
    add("meshoptimizer_cache_order/" + name,
        [=](State& state) { peer(state, name, Primitive::kTriangles, meshoptimizer_cache_order); });
  }
}

}  // namespace varifold::bench
