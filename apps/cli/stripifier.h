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
};
void add_stripifier_options(CLI::App& command, StripifierOptions& options);

[[nodiscard]] TriangleStrips make_strips(const DetailedMesh& detailed,
                                         const StripifierOptions& options);

/// Indices a triangle, restarts between strips among them.
[[nodiscard]] double indices_per_triangle(const TriangleStrips& strips, std::uint32_t triangles);

}  // namespace varifold::cli
