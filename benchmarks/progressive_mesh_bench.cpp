// Building a progressive mesh, and going to its levels with an index buffer that is ready to draw
// after every step.
#include <benchmark/benchmark.h>
#include <benchmarks/bench_meshes.h>
#include <benchmarks/benchmarks.h>
#include <benchmarks/level_tours.h>
#include <varifold/models/pm/build.h>
#include <varifold/models/pm/encoding.h>
#include <varifold/models/pm/instance.h>
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

namespace varifold::bench {

namespace {

using benchmark::Counter;
using benchmark::State;

std::shared_ptr<const ProgressiveMesh> model_of(const std::string& name) {
  static std::map<std::string, std::shared_ptr<const ProgressiveMesh>> made;
  auto& model = made[name];
  if (!model) model = std::make_shared<ProgressiveMesh>(build_progressive_mesh(detailed(name)));
  return model;
}

void build(State& state, const std::string& name) {
  const DetailedMesh& input = detailed(name);
  std::size_t bytes = 0;
  for (auto _ : state) bytes = build_progressive_mesh(input).bytes();
  state.counters["triangles/s"] =
      Counter(input.mesh.triangle_count(), Counter::kIsIterationInvariantRate);
  state.counters["bytes/vertex"] = static_cast<double>(bytes) / input.mesh.vertex_count();
}

void count_stream(State& state, std::size_t bytes, std::uint32_t vertices) {
  state.counters["vertices/s"] = Counter(vertices, Counter::kIsIterationInvariantRate);
  state.counters["bytes/vertex"] = static_cast<double>(bytes) / vertices;
}

void encode(State& state, const std::string& name, const EncodeOptions& options) {
  const auto model = model_of(name);
  std::size_t bytes = 0;
  for (auto _ : state) bytes = encode_progressive_mesh(*model, options).size();
  count_stream(state, bytes, model->data().mesh.vertex_count());
}

void decode(State& state, const std::string& name, const EncodeOptions& options) {
  const auto model = model_of(name);
  const std::vector<std::byte> bytes = encode_progressive_mesh(*model, options);
  for (auto _ : state) {
    const auto decoded = decode_progressive_mesh(bytes);
    if (!decoded) return state.SkipWithError(decoded.error().message.c_str());
  }
  count_stream(state, bytes.size(), model->data().mesh.vertex_count());
}

// Every tour begins and ends at full detail.
void tour(State& state, const std::string& name,
          std::vector<std::uint32_t> (*levels_for)(std::uint32_t)) {
  ProgressiveMeshInstance instance(model_of(name));
  const std::uint32_t finest = instance.model().finest_level();
  const std::vector<std::uint32_t> levels = levels_for(finest);
  const std::uint64_t steps = steps_of(levels, finest);
  instance.go_to_level(finest);
  for (auto _ : state) {
    for (const std::uint32_t level : levels) {
      instance.go_to_level(level);
      benchmark::DoNotOptimize(instance.draw_list());
    }
  }
  state.counters["collapses/s"] =
      Counter(static_cast<double>(steps), Counter::kIsIterationInvariantRate);
}

}  // namespace

void register_progressive_mesh() {
  for (const std::string& name : present({"bunny.ply", "igea.ply", "dragon.ply", "planet"})) {
    const auto add = [](const std::string& title, const auto& body) {
      benchmark::RegisterBenchmark(title.c_str(), body)->Unit(benchmark::kMillisecond);
    };
    add("build_pm/" + name, [=](State& state) { build(state, name); });
    for (const int bits : {0, 16}) {
      EncodeOptions options;
      options.position_bits = bits;
      const std::string suffix = bits == 0 ? "floats/" + name : "16_bits/" + name;
      add("encode_pm/" + suffix, [=](State& state) { encode(state, name, options); });
      add("decode_pm/" + suffix, [=](State& state) { decode(state, name, options); });
    }
    add("go_to_level/linear/" + name, [=](State& state) { tour(state, name, linear_levels); });
    add("go_to_level/random/" + name, [=](State& state) { tour(state, name, random_levels); });
  }
}

}  // namespace varifold::bench
