// The levels that the tests of `varifold bench` visit.
//
// Based on: [Ramos2008] 3.5 (the linear test), which has the tests from
// [RibellesChoverLopezHuerta1999].
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace varifold::cli {

struct BenchTest {
  std::string name = "linear";  ///< linear, exponential or random
  std::uint32_t steps = 1000;
  std::uint64_t seed = 1;  ///< of the random test
};

/// One level for each step, none above `finest`.
[[nodiscard]] std::vector<std::uint32_t> bench_path(const BenchTest& test, std::uint32_t finest);

}  // namespace varifold::cli
