#include <benchmarks/level_tours.h>

#include <benchmarks/bench_meshes.h>
#include <varifold/base/random.h>
#include <varifold/simplify/simplify.h>
#include <map>
#include <utility>

namespace varifold::bench {

const DetailedMesh& detailed(const std::string& name) {
  static std::map<std::string, DetailedMesh> made;
  const auto found = made.find(name);
  if (found != made.end()) return found->second;
  SimplifyOptions options;
  options.measure_error = false;
  auto result = simplify(mesh(name), options);
  return made.emplace(name, result ? std::move(result->detailed) : DetailedMesh{}).first->second;
}

std::vector<std::uint32_t> linear_levels_down(std::uint32_t finest) {
  constexpr std::uint32_t kSteps = 1000;
  std::vector<std::uint32_t> levels;
  for (std::uint32_t i = kSteps; i-- > 0;)
    levels.push_back(static_cast<std::uint32_t>(std::uint64_t{finest} * i / kSteps));
  return levels;
}

std::vector<std::uint32_t> linear_levels(std::uint32_t finest) {
  std::vector<std::uint32_t> levels = linear_levels_down(finest);
  for (auto i = levels.size() - 1; i-- > 0;) levels.push_back(levels[i]);
  levels.push_back(finest);
  return levels;
}

std::vector<std::uint32_t> random_levels(std::uint32_t finest) {
  Random random(1);
  std::vector<std::uint32_t> levels;
  for (int i = 0; i < 100; ++i) levels.push_back(random.below(finest + 1));
  levels.push_back(finest);
  return levels;
}

std::uint64_t steps_of(const std::vector<std::uint32_t>& levels, std::uint32_t finest) {
  std::uint64_t steps = 0;
  std::uint32_t at = finest;
  for (const std::uint32_t level : levels) {
    steps += level > at ? level - at : at - level;
    at = level;
  }
  return steps;
}

}  // namespace varifold::bench
