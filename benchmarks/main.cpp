// Meshes that are not there are left out: VARIFOLD_MESHES names the folder of real ones.
#include <benchmark/benchmark.h>
#include <benchmarks/benchmarks.h>

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
  varifold::bench::register_simplify();
  varifold::bench::register_progressive_mesh();
  varifold::bench::register_strips();
  varifold::bench::register_lodstrips();
  varifold::bench::register_strip_framework();
  varifold::bench::register_front_strips();
  varifold::bench::register_patch_draws();
  varifold::bench::register_io();
  varifold::bench::register_measure();
  benchmark::RunSpecifiedBenchmarks();
  benchmark::Shutdown();
  return 0;
}
