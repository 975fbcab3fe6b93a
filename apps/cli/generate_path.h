// varifold generate path: the camera paths that come with the project, as files.
#pragma once

#include <apps/cli/context.h>
#include <apps/cli/level_options.h>
#include <cstdint>
#include <optional>
#include <string>

namespace varifold::cli {

struct PathOptions {
  std::string name;
  std::optional<std::uint32_t> frames;
  std::optional<double> distance, fovy_degrees;
  PictureSize size{1920, 1080};
};
void add_path_options(CLI::App& command, PathOptions& options);

[[nodiscard]] CommandResult generate_path(const PathOptions& options, const std::string& output,
                                          const CommonOptions& common);

}  // namespace varifold::cli
