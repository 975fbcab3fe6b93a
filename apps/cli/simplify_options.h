// The options of everything that simplifies, and how its end is told.
#pragma once

#include <apps/cli/context.h>
#include <apps/cli/report.h>
#include <varifold/simplify/simplify.h>
#include <CLI/CLI.hpp>
#include <filesystem>
#include <optional>
#include <string>

namespace varifold::cli {

struct SimplifyFlags {
  std::string placement = "kept";
  std::string metric = "quadric";
  std::optional<float> energy_samples;
  AttributeWeights weights;
};
void add_simplify_flags(CLI::App& command, SimplifyFlags& flags);
/// What attributes count; part of the flags above.
void add_weight_options(CLI::App& command, AttributeWeights& weights);

/// The library's options, without a target.
[[nodiscard]] SimplifyOptions simplify_options(const SimplifyFlags& flags,
                                               const CommonOptions& common,
                                               const std::filesystem::path& input);

/// kInvalidInput where all triangles of the input were degenerate, so that there is no surface.
[[nodiscard]] Result<void> check_any_left(const Simplification& result,
                                          const std::filesystem::path& input);

/// Adds stop_reason; where the simplifier is stuck also what was left, why, and what would help,
/// and says so on stderr.
void report_stop(const StopReport& stop, const std::filesystem::path& input, Report& report);

}  // namespace varifold::cli
