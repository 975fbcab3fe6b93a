// The strips of full detail that models of strips are built from, as the command line asks.
#pragma once

#include <varifold/simplify/collapse_sequence.h>
#include <varifold/strip/triangle_strips.h>
#include <CLI/CLI.hpp>
#include <cstdint>
#include <optional>
#include <string>

namespace varifold::cli {

struct StripifierOptions {
  std::string name = "length";
  std::string heuristic = "rows";            ///< of the kind length, like the two that follow
  bool keep_ends = false;                    ///< strips whose ends meet are not joined
  std::uint64_t seed = 1;                    ///< of the heuristic random
  std::optional<std::uint32_t> cache_size;   ///< 16 where it is not given
  std::optional<std::uint32_t> max_indices;  ///< of a strip; 0: no limit
  std::uint32_t usual_max_indices = 0;       ///< where it is not given
  friend bool operator==(const StripifierOptions&, const StripifierOptions&) = default;
};
void add_stripifier_options(CLI::App& command, StripifierOptions& options);
/// Wrong usage where options were given that the stripifier has no use for.
void check_stripifier_options(const StripifierOptions& options);

/// Strips of all triangles of the full level, by material ranges.
[[nodiscard]] TriangleStrips make_strips(const DetailedMesh& detailed,
                                         const StripifierOptions& options);

}  // namespace varifold::cli
