// Camera paths as JSON; docs/formats/camera_path.md.
#pragma once

#include <varifold/base/result.h>
#include <varifold/view/camera_path.h>
#include <filesystem>
#include <string>
#include <string_view>

namespace varifold {

/// Errors: kInvalidInput, naming the line and byte or the member; kUnsupported for a version of the
/// format that is not known. The path passes check_camera_path. O(text).
[[nodiscard]] Result<CameraPath> parse_camera_path(std::string_view text);

/// The same of a file. Errors begin with its name; kUnreadable where it cannot be read.
[[nodiscard]] Result<CameraPath> read_camera_path(const std::filesystem::path& file);

/// One key a line, numbers with as many digits as they need to be read back exactly.
[[nodiscard]] std::string format_camera_path(const CameraPath& path);

}  // namespace varifold
