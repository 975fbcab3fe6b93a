// Every file of benchmarks registers its own with Google Benchmark.
#pragma once

namespace varifold::bench {

void register_simplify();
void register_progressive_mesh();
void register_strip_framework();
void register_io();
void register_measure();
void register_strips();
void register_lodstrips();
void register_front_strips();
void register_patch_draws();

}  // namespace varifold::bench
