// Camera paths: the frames of a flight, the same on every machine.
#pragma once

#include <varifold/base/math.h>
#include <varifold/base/result.h>
#include <varifold/view/camera.h>
#include <cstdint>
#include <string>
#include <vector>

namespace varifold {

/// The most frames of a path, and the longest side of its pictures in pixels.
inline constexpr std::uint32_t kMaxPathFrames = 1'000'000;
inline constexpr int kMaxPathSize = 16384;

/// Where the camera stands at one frame. Lengths are in the units of the path.
struct CameraKey {
  std::uint32_t frame = 0;
  DVec3 eye{0, 0, 2};
  DVec3 target{0};
  DVec3 up{0, 1, 0};  ///< a direction: any length
  double fovy_degrees = 30;
};

/// Key frames and how the camera moves between them.
struct CameraPath {
  /// kDiagonals: lengths are in diagonals of the mesh's bounding box, about its centre, so that one
  /// path serves any mesh. kModel: coordinates of the model.
  enum class Units { kDiagonals, kModel };
  /// kSmooth: cubic Hermite curves through the keys whose tangents are the differences of the two
  /// neighbouring keys (Catmull-Rom, on the frames of the keys).
  enum class Interpolation { kLinear, kSmooth };

  std::string name;
  Units units = Units::kDiagonals;
  Interpolation interpolation = Interpolation::kSmooth;
  /// After the last key the camera goes on to the first, which it would reach at frame `frames`;
  /// otherwise it rests at the last key.
  bool is_closed = false;
  std::uint32_t frames = 1;
  int width = 1920, height = 1080;  ///< pixels
  std::vector<CameraKey> keys;      ///< by frame, strictly ascending; the first at frame 0
};

/// Whether sizes, frames and keys are within their bounds and all numbers finite; says what is
/// not. Cameras that cannot see are found by camera_at. O(keys).
[[nodiscard]] Result<void> check_camera_path(const CameraPath& path);

/// The camera of a frame, for a mesh with these bounds; its depth range encloses them.
///
/// Computed in double precision with +, -, *, / and square roots alone, which IEEE 754 fixes to the
/// bit, in the order of the source, and rounded to float at the end: the same path, bounds and
/// frame give the same camera on any machine.
///
/// `path` passes check_camera_path; frame < path.frames. Errors: kInvalidInput, naming the frame,
/// where the camera could not see: eye and target are one point, up is along the view, the angle of
/// view is not between 0 and 180 degrees, coordinates beyond float, or relative units and a mesh
/// without extent. O(log keys).
[[nodiscard]] Result<Camera> camera_at(const CameraPath& path, std::uint32_t frame,
                                       const Box& bounds);

/// All frames; the first error. O(frames log keys).
[[nodiscard]] Result<std::vector<Camera>> cameras_of(const CameraPath& path, const Box& bounds);

}  // namespace varifold
