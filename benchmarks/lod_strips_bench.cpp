// Building LodStrips, and going to their levels with buffers that are ready to draw after each.
#include <benchmark/benchmark.h>
#include <benchmarks/bench_meshes.h>
#include <benchmarks/benchmarks.h>
#include <varifold/base/random.h>
#include <varifold/models/lodstrips/build.h>
#include <varifold/models/lodstrips/lod_strips.h>
#include <varifold/simplify/simplify.h>
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

const DetailedMesh& detailed(const std::string& name) {
  static std::map<std::string, DetailedMesh> made;
  const auto found = made.find(name);
  if (found != made.end()) return found->second;
  SimplifyOptions options;
  options.measure_error = false;
  auto result = simplify(mesh(name), options);
  return made.emplace(name, result ? std::move(result->detailed) : DetailedMesh{}).first->second;
}

std::shared_ptr<const LodStrips> model_of(const std::string& name, LodStripsForm form) {
  static std::map<std::pair<std::string, LodStripsForm>, std::shared_ptr<const LodStrips>> made;
  auto& model = made[{name, form}];
  if (!model) model = std::make_shared<LodStrips>(build_lod_strips(detailed(name), {form}));
  return model;
}

void build(State& state, const std::string& name, LodStripsForm form) {
  const DetailedMesh& input = detailed(name);
  std::size_t bytes = 0;
  for (auto _ : state) bytes = build_lod_strips(input, {form}).bytes();
  state.counters["triangles/s"] =
      Counter(input.mesh.triangle_count(), Counter::kIsIterationInvariantRate);
  state.counters["bytes/vertex"] = static_cast<double>(bytes) / input.mesh.vertex_count();
}

std::vector<std::uint32_t> random_levels(std::uint32_t finest) {
  Random random(1);
  std::vector<std::uint32_t> levels(300);
  for (std::uint32_t& level : levels) level = random.below(finest + 1);
  return levels;
}

std::vector<std::uint32_t> linear_levels(std::uint32_t finest) {
  constexpr std::uint32_t kSteps = 1000;
  std::vector<std::uint32_t> levels;
  for (std::uint32_t i = kSteps; i-- > 0;)
    levels.push_back(static_cast<std::uint32_t>(std::uint64_t{finest} * i / (kSteps - 1)));
  return levels;
}

void walk(State& state, const std::string& name, LodStripsForm form, StripBuffer buffer,
          std::vector<std::uint32_t> (*path)(std::uint32_t)) {
  const auto model = model_of(name, form);
  LodStripsInstance instance(model, buffer);
  const std::vector<std::uint32_t> levels = path(model->finest_level());
  std::uint64_t collapses = 0;
  for (auto _ : state) {
    for (const std::uint32_t level : levels) {
      const std::uint32_t before = instance.level();
      instance.go_to_level(level);
      benchmark::DoNotOptimize(instance.draw_list().indices.size());
      collapses += level > before ? level - before : before - level;
    }
  }
  state.counters["collapses/s"] = Counter(static_cast<double>(collapses), Counter::kIsRate);
  state.counters["instance bytes/vertex"] =
      static_cast<double>(instance.bytes()) / model->attributes().vertex_count();
}

}  // namespace

void register_lod_strips() {
  const auto add = [](const std::string& title, const auto& body) {
    benchmark::RegisterBenchmark(title.c_str(), body)->Unit(benchmark::kMillisecond);
  };
  for (const std::string& name : present({"bunny.ply", "igea.ply", "planet"})) {
    for (const LodStripsForm form : kLodStripsForms) {
      const std::string suffix = std::string(form_name(form)) + "/" + name;
      add("build_lod_strips/" + suffix, [=](State& state) { build(state, name, form); });
      for (const StripBuffer buffer : {StripBuffer::kInPlace, StripBuffer::kCompact}) {
        if (buffer == StripBuffer::kCompact && form != LodStripsForm::kBlocks) continue;
        const std::string how = buffer == StripBuffer::kCompact ? "compact/" : "";
        add("lod_strips/random/" + how + suffix,
            [=](State& state) { walk(state, name, form, buffer, random_levels); });
        add("lod_strips/linear/" + how + suffix,
            [=](State& state) { walk(state, name, form, buffer, linear_levels); });
      }
    }
  }
}

}  // namespace varifold::bench
