// The strips of full detail that models of strips are built from, as the command line asks.
#pragma once

#include <varifold/simplify/collapse_sequence.h>
#include <varifold/strip/triangle_strips.h>
#include <CLI/CLI.hpp>
#include <cstdint>
#include <string>

namespace varifold::cli {

struct StripifierOptions {
  std::string name = "length";
  std::uint32_t cache_size = 16;
  std::uint32_t max_indices = 0;  ///< of a strip; 0: no limit
  friend bool operator==(const StripifierOptions&, const StripifierOptions&) = default;
};
void add_stripifier_options(CLI::App& command, StripifierOptions& options);

/// Strips of all triangles of the full level, by material ranges.
[[nodiscard]] TriangleStrips make_strips(const DetailedMesh& detailed,
                                         const StripifierOptions& options);

}  // namespace varifold::cli
