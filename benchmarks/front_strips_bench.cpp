// View-dependent meshes on an orbit: adapting and drawing triangles, or strips made anew.
#include <benchmark/benchmark.h>
#include <benchmarks/bench_meshes.h>
#include <benchmarks/benchmarks.h>
#include <varifold/models/vdpm/build.h>
#include <varifold/models/vdpm/instance.h>
#include <varifold/simplify/simplify.h>
#include <varifold/view/camera_path.h>
#include <varifold/view/known_paths.h>
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

namespace varifold::bench {

namespace {

using benchmark::Counter;
using benchmark::State;

std::shared_ptr<const ViewDependentMesh> model_of(const std::string& name) {
  static std::map<std::string, std::shared_ptr<const ViewDependentMesh>> models;
  auto& model = models[name];
  if (!model)
    model = std::make_shared<const ViewDependentMesh>(
        build_view_dependent_mesh(simplify(without_attributes(mesh(name)), {})->detailed));
  return model;
}

std::vector<Camera> orbit(const ViewDependentMesh& model, double distance) {
  Box box;
  for (const Vec3& p : model.attributes().positions) box.add(p);
  KnownPathOptions options;
  options.orbit_distance = distance;
  const auto path = known_path("orbit", options);
  const auto cameras = path ? cameras_of(*path, box) : Result<std::vector<Camera>>();
  return cameras ? *cameras : std::vector<Camera>();
}

enum class Draw { kNothing, kTriangles, kStrips };

// Goes round at one pixel; the time is that of a frame.
void go_round(State& state, const std::string& name, double distance, Draw draw) {
  ViewDependentInstance instance(model_of(name));
  const std::vector<Camera> cameras = orbit(instance.model(), distance);
  if (cameras.empty()) return state.SkipWithError("no path");
  RefineCriteria criteria;
  criteria.view.emplace(cameras.back());
  (void)instance.adapt(criteria);
  std::size_t frame = 0;
  std::uint64_t triangles = 0;
  for (auto _ : state) {
    criteria.view.emplace(cameras[frame++ % cameras.size()]);
    triangles += instance.adapt(criteria).triangles;
    if (draw == Draw::kTriangles) benchmark::DoNotOptimize(instance.draw_list());
    if (draw == Draw::kStrips) benchmark::DoNotOptimize(instance.draw_strips());
  }
  const auto all = static_cast<double>(triangles);
  state.counters["triangles"] = Counter(all, Counter::kAvgIterations);
  state.counters["s/triangle"] = Counter(all, Counter::kIsRate | Counter::kInvert);
}

}  // namespace

void register_front_strips() {
  for (const std::string& name : present({"bunny.ply", "igea.ply"})) {
    for (const double distance : {2.0, 0.6}) {
      for (const auto& [what, draw] : {std::pair{"adapt", Draw::kNothing},
                                       {"triangles", Draw::kTriangles},
                                       {"strips", Draw::kStrips}}) {
        const std::string title = std::string("front_strips/") + what + "/" + name + "/" +
                                  std::to_string(distance).substr(0, 3);
        benchmark::RegisterBenchmark(title.c_str(),
                                     [=](State& state) { go_round(state, name, distance, draw); })
            ->Unit(benchmark::kMicrosecond)
            ->Iterations(1440);
      }
    }
  }
}

}  // namespace varifold::bench
