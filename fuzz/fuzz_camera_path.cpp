#include <fuzz/fuzz_support.h>
#include <varifold/base/bytes.h>
#include <varifold/io/camera_path_file.h>
#include <algorithm>

using namespace varifold;

// A path is one that keeps its rules, survives being written, and whose frames see or say why not.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto path = parse_camera_path(as_text(fuzz::bytes(data, size)));
  if (!path) {
    fuzz::require(path.error().message.find('\n') == std::string::npos);
    return 0;
  }
  fuzz::require(check_camera_path(*path).has_value());
  fuzz::require(parse_camera_path(format_camera_path(*path)).has_value());
  const Box box{Vec3(-1), Vec3(1, 2, 3)};
  for (std::uint32_t frame = 0; frame < std::min(path->frames, 50u); ++frame) {
    const auto camera = camera_at(*path, frame, box);
    fuzz::require(!camera || is_usable(*camera));
  }
  return 0;
}
