// LodStrips over static strips: building, sizes, and going to levels with buffers that are ready to
// draw after every step.
#include <benchmark/benchmark.h>
#include <benchmarks/bench_meshes.h>
#include <benchmarks/benchmarks.h>
#include <benchmarks/level_tours.h>
#include <varifold/mesh/vertex_arrays.h>
#include <varifold/models/lodstrips/block_cursor.h>
#include <varifold/models/lodstrips/grouped_cursor.h>
#include <varifold/models/lodstrips/static_build.h>
#include <varifold/models/lodstrips/thesis_cursor.h>
#include <varifold/strip/strip_measures.h>
#include <varifold/strip/stripify.h>
#include <cstdio>
#include <map>
#include <string>
#include <vector>

namespace varifold::bench {

namespace {

using benchmark::Counter;
using benchmark::State;

struct Thesis {
  static constexpr const char* kName = "thesis";
  static ThesisForm build(const DetailedMesh& d, const TriangleStrips& s) {
    return build_thesis_form(d, s);
  }
  static ThesisCursor cursor(const ThesisForm& form, const LevelTable& table,
                             const TriangleMesh& mesh) {
    return {form, table, mesh};
  }
};
struct Grouped {
  static constexpr const char* kName = "grouped";
  static GroupedForm build(const DetailedMesh& d, const TriangleStrips& s) {
    return build_grouped_form(d, s);
  }
  static GroupedCursor cursor(const GroupedForm& form, const LevelTable& table,
                              const TriangleMesh& mesh) {
    return {form, table, mesh};
  }
};

struct Blocks {
  static constexpr const char* kName = "blocks";
  static BlockForm build(const DetailedMesh& d, const TriangleStrips&) {
    return build_block_form(d);
  }
  static BlockCursor cursor(const BlockForm& form, const LevelTable& table,
                            const TriangleMesh& mesh) {
    return {form, table, mesh, StripBuffer::kInPlace};
  }
};
struct CompactBlocks : Blocks {
  static constexpr const char* kName = "compact blocks";
  static BlockCursor cursor(const BlockForm& form, const LevelTable& table,
                            const TriangleMesh& mesh) {
    return {form, table, mesh, StripBuffer::kCompact};
  }
};

struct Source {
  std::string mesh;
  StripifyOptions options;
};

template <class Form>
void build(State& state, const Source& source) {
  const DetailedMesh& input = detailed(source.mesh);
  std::size_t bytes = 0;
  for (auto _ : state) bytes = Form::build(input, stripify(input.mesh, source.options)).bytes();
  bytes += vertex_bytes(input.mesh) + LevelTable(input.sequence).bytes();
  state.counters["triangles/s"] =
      Counter(input.mesh.triangle_count(), Counter::kIsIterationInvariantRate);
  state.counters["bytes/vertex"] = static_cast<double>(bytes) / input.mesh.vertex_count();
}

template <class Form>
void tour(State& state, const Source& source,
          std::vector<std::uint32_t> (*levels_for)(std::uint32_t)) {
  const DetailedMesh& input = detailed(source.mesh);
  const LevelTable table(input.sequence);
  const auto form = Form::build(input, stripify(input.mesh, source.options));
  auto cursor = Form::cursor(form, table, input.mesh);
  cursor.go_to_level(table.finest_level());
  const std::vector<std::uint32_t> levels = levels_for(table.finest_level());
  const std::uint64_t steps = steps_of(levels, table.finest_level());
  DrawList list;
  for (auto _ : state) {
    for (const std::uint32_t level : levels) {
      cursor.go_to_level(level);
      cursor.fill(list);
      benchmark::DoNotOptimize(list);
    }
    if (cursor.level() == table.finest_level()) continue;
    state.PauseTiming();
    cursor.go_to_level(table.finest_level());
    cursor.fill(list);
    state.ResumeTiming();
  }
  state.counters["collapses/s"] =
      Counter(static_cast<double>(steps), Counter::kIsIterationInvariantRate);
}

// Steps as small as those from frame to frame: 200 times ten levels down and up again. Microseconds
// a step with its draw list.
template <class Form>
void small_steps(State& state, const Source& source, std::uint32_t divisor) {
  constexpr std::uint32_t kStops = 200, kLevels = 10;
  const DetailedMesh& input = detailed(source.mesh);
  const LevelTable table(input.sequence);
  const auto form = Form::build(input, stripify(input.mesh, source.options));
  auto cursor = Form::cursor(form, table, input.mesh);
  const std::uint32_t start = table.finest_level() / divisor;
  DrawList list;
  const auto stop_at = [&](std::uint32_t level) {
    cursor.go_to_level(level);
    cursor.fill(list);
    benchmark::DoNotOptimize(list);
  };
  stop_at(start);
  for (auto _ : state) {
    for (std::uint32_t i = 1; i <= kStops; ++i) stop_at(start - i * kLevels);
    for (std::uint32_t i = kStops; i-- > 0;) stop_at(start - i * kLevels);
  }
  state.counters["ranges"] = static_cast<double>(list.ranges.size());
  state.counters["us/step"] =
      Counter(2e-6 * kStops, Counter::kIsIterationInvariantRate | Counter::kInvert);
}

// How strips decline: counters named by the percentage of the vertices.
void decline(State& state, const Source& source) {
  const DetailedMesh& input = detailed(source.mesh);
  const LevelTable table(input.sequence);
  const GroupedForm form = build_grouped_form(input, stripify(input.mesh, source.options));
  GroupedCursor cursor(form, table, input.mesh);
  DrawList list;
  for (auto _ : state) cursor.fill(list);
  for (const std::uint32_t percent : {100u, 75u, 50u, 25u, 10u, 5u, 1u}) {
    const std::uint64_t vertices = std::uint64_t{input.mesh.vertex_count()} * percent / 100;
    cursor.go_to_level(table.level_for_vertices(static_cast<std::uint32_t>(vertices)));
    cursor.fill(list);
    const IndexMeasures measures = measure_indices(list.indices, list.ranges);
    const auto drawn = static_cast<double>(measures.indices + measures.strips - 1);
    char name[16];
    std::snprintf(name, sizeof name, "%03u%%", percent);
    state.counters[name] = drawn / static_cast<double>(measures.triangles);
    state.counters[std::string(name) + "acmr16"] =
        measure_cache(list.indices, list.ranges, 16).acmr();
  }
}

template <class Form>
void add_form(const std::string& suffix, const Source& source) {
  const auto add = [](const std::string& title, const auto& body) {
    benchmark::RegisterBenchmark(title.c_str(), body)->Unit(benchmark::kMillisecond);
  };
  const std::string name = std::string(Form::kName) + "/" + suffix;
  add("build_lodstrips/" + name, [=](State& state) { build<Form>(state, source); });
  add("lodstrips/linear_down/" + name,
      [=](State& state) { tour<Form>(state, source, linear_levels_down); });
  add("lodstrips/linear/" + name, [=](State& state) { tour<Form>(state, source, linear_levels); });
  add("lodstrips/random/" + name, [=](State& state) { tour<Form>(state, source, random_levels); });
}

}  // namespace

void register_lodstrips() {
  for (const std::string& name : present({"bunny.ply", "dragon.ply"}))
    for (const std::uint32_t divisor : {1u, 4u}) {
      const Source source{name, {.max_indices = kStaticStripIndices}};
      const std::string suffix = name + "/1:" + std::to_string(divisor);
      const auto add = [&](const std::string& form,
                           void (*run)(State&, const Source&, std::uint32_t)) {
        benchmark::RegisterBenchmark(("lodstrips/small_steps/" + form + "/" + suffix).c_str(),
                                     [=](State& state) { run(state, source, divisor); });
      };
      add("thesis", small_steps<Thesis>);
      add("grouped", small_steps<Grouped>);
      add("blocks", small_steps<Blocks>);
    }
  for (const std::string& name : present({"bunny.ply", "armadillo.ply", "igea.ply"})) {
    add_form<Blocks>(name, {name, {}});
    add_form<CompactBlocks>(name, {name, {}});
    for (const std::uint32_t most : {0u, 32u, 64u, 128u}) {
      const Source source{name, {.max_indices = most}};
      const std::string suffix = name + "/max:" + std::to_string(most);
      add_form<Thesis>(suffix, source);
      add_form<Grouped>(suffix, source);
      benchmark::RegisterBenchmark(("lodstrips/decline/" + suffix).c_str(),
                                   [=](State& state) { decline(state, source); });
    }
  }
}

}  // namespace varifold::bench
