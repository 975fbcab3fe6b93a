// varifold build lodstrips --sequences: an order of collapses for each frame, or for groups of
// them.
#pragma once

#include <apps/cli/build_common.h>
#include <cstdint>
#include <optional>
#include <string>

namespace varifold::cli {

struct FrameOptions {
  std::string sequences;                ///< "frames", or how many
  std::optional<std::uint32_t> frames;  ///< from the shape at rest to pose 1
  [[nodiscard]] bool empty() const { return sequences.empty(); }
};
void add_frame_options(CLI::App& command, FrameOptions& options);

[[nodiscard]] CommandResult run_build_frames(const BuildOptions& build, const FrameOptions& frames);

}  // namespace varifold::cli
