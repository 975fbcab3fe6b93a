// The camera paths that come with the project.
#pragma once

#include <varifold/base/result.h>
#include <varifold/view/camera_path.h>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

namespace varifold {

struct KnownPathOptions {
  std::optional<std::uint32_t> frames;  ///< at least 2; keys move in proportion
  int width = 1920, height = 1080;
  std::optional<double> fovy_degrees;  ///< 30; 50 for the canyon
  double orbit_distance = 2;           ///< of "orbit": diagonals from the centre, > 0
};

/// "orbit", "fly_by", "dive", "canyon".
[[nodiscard]] std::span<const std::string_view> known_path_names();

/// orbit: once around the mesh, its axis up, 20 degrees above the horizon, 360 frames of one
/// degree. fly_by: past the mesh, from far to near to far, the view held on it; 300 frames. dive:
/// from 2.5 diagonals to 0.35 and back, each stretch in the same time; 300 frames. canyon: low over
/// the Grand Canyon's elevation map (generate terrain --heightmap); 900 frames.
///
/// All are relative to the bounds of the mesh. kInvalidInput where there is no such name, or where
/// the options give no path.
[[nodiscard]] Result<CameraPath> known_path(std::string_view name,
                                            const KnownPathOptions& options = {});

}  // namespace varifold
