#include <apps/cli/bench_path.h>
#include <varifold/base/random.h>

namespace varifold::cli {
namespace {

// Equal strides from full detail to the base and back.
std::vector<std::uint32_t> linear_path(std::uint32_t finest, std::uint32_t steps) {
  std::vector<std::uint32_t> path;
  for (std::uint32_t i = 0; i < steps; ++i) {
    const double t = 2.0 * (i + 1) / steps;
    path.push_back(static_cast<std::uint32_t>(finest * (t <= 1 ? 1 - t : t - 1)));
  }
  return path;
}

// Down and up again like an object that goes away at a steady speed: the detail that it needs falls
// with the square of its distance, here from one to thirty times the nearest.
std::vector<std::uint32_t> exponential_path(std::uint32_t finest, std::uint32_t steps) {
  std::vector<std::uint32_t> path;
  for (std::uint32_t i = 0; i < steps; ++i) {
    const double t = 2.0 * (i + 1) / steps;
    const double distance = 1 + 29 * (t <= 1 ? t : 2 - t);
    path.push_back(static_cast<std::uint32_t>(finest / (distance * distance)));
  }
  return path;
}

std::vector<std::uint32_t> random_path(std::uint32_t finest, const BenchTest& test) {
  Random random(test.seed);
  std::vector<std::uint32_t> path(test.steps);
  for (std::uint32_t& level : path) level = random.below(finest + 1);
  return path;
}

}  // namespace

std::vector<std::uint32_t> bench_path(const BenchTest& test, std::uint32_t finest) {
  if (test.name == "linear") return linear_path(finest, test.steps);
  if (test.name == "exponential") return exponential_path(finest, test.steps);
  return random_path(finest, test);
}

}  // namespace varifold::cli
