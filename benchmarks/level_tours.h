// Sequences of levels to go to, and the meshes whose levels they are.
#pragma once

#include <varifold/simplify/collapse_sequence.h>
#include <cstdint>
#include <string>
#include <vector>

namespace varifold::bench {

/// A mesh of bench_meshes.h numbered by its sequence; made once.
[[nodiscard]] const DetailedMesh& detailed(const std::string& name);

/// Tours begin and end at full detail. Down in 1,000 equal steps, and up again.
[[nodiscard]] std::vector<std::uint32_t> linear_levels(std::uint32_t finest);
/// Down alone.
[[nodiscard]] std::vector<std::uint32_t> linear_levels_down(std::uint32_t finest);
/// 100 levels anywhere.
[[nodiscard]] std::vector<std::uint32_t> random_levels(std::uint32_t finest);

/// Collapses and splits of a tour.
[[nodiscard]] std::uint64_t steps_of(const std::vector<std::uint32_t>& levels,
                                     std::uint32_t finest);

}  // namespace varifold::bench
