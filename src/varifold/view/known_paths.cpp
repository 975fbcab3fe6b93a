#include <varifold/base/angle.h>
#include <varifold/view/known_paths.h>
#include <array>
#include <cmath>
#include <iterator>
#include <string>
#include <utility>

namespace varifold {
namespace {

CameraPath orbit(std::uint32_t frames, const KnownPathOptions& options) {
  const glm::dvec2 elevation = unit_circle(20, 360);
  CameraPath path;
  path.is_closed = true;
  path.frames = frames;
  path.interpolation = CameraPath::Interpolation::kLinear;  // a key for every frame
  for (std::uint32_t i = 0; i < frames; ++i) {
    const glm::dvec2 turn = unit_circle(i, frames);
    const double across = options.orbit_distance * elevation.x;
    CameraKey key;
    key.frame = i;
    key.eye = DVec3(across * turn.y, options.orbit_distance * elevation.y, across * turn.x);
    path.keys.push_back(key);
  }
  return path;
}

/// Keys at equal distances in time, the last one in the last frame.
CameraPath spread(std::uint32_t frames, std::vector<CameraKey> keys) {
  CameraPath path;
  path.frames = frames;
  const std::uint64_t last = keys.size() - 1;
  for (std::uint64_t i = 0; i <= last; ++i) {
    keys[i].frame = static_cast<std::uint32_t>(i * (frames - 1) / last);
    // Where there are fewer frames than keys, the first key of a frame stays.
    if (i == 0 || keys[i].frame > path.keys.back().frame) path.keys.push_back(keys[i]);
  }
  return path;
}

CameraPath fly_by(std::uint32_t frames, const KnownPathOptions& /*options*/) {
  // Along x, in front of the mesh and a little above; nearest in the middle.
  std::vector<CameraKey> keys;
  for (const double x : {-4.0, -2.6, -1.5, -0.7, 0.0, 0.7, 1.5, 2.6, 4.0}) {
    CameraKey key;
    key.eye = DVec3(x, 0.15 + 0.05 * (x < 0 ? -x : x), 0.65);
    key.target = DVec3(0.05 * x, 0, 0);
    keys.push_back(key);
  }
  return spread(frames, std::move(keys));
}

CameraPath dive(std::uint32_t frames, const KnownPathOptions& /*options*/) {
  // Towards the side that faces +z, from above. Equal times for equal ratios of the distance: 12
  // keys down and 12 up.
  constexpr int kSteps = 12;
  constexpr double kFar = 2.5, kRatio = 0.84889;  // 2.5 * ratio^12 = 0.35
  const double length = std::sqrt(0.3 * 0.3 + 0.4 * 0.4 + 1);
  const DVec3 direction = DVec3(0.3, 0.4, 1) / length;
  std::array<double, kSteps + 1> distances{kFar};
  for (int i = 0; i < kSteps; ++i) distances[i + 1] = distances[i] * kRatio;
  std::vector<CameraKey> keys;
  for (int i = -kSteps; i <= kSteps; ++i) {
    CameraKey key;
    key.eye = distances[kSteps - (i < 0 ? -i : i)] * direction;
    keys.push_back(key);
  }
  return spread(frames, std::move(keys));
}

struct Waypoint {
  double x, y, z;
};
// Upstream over the river, in diagonals of the terrain about its centre.
constexpr Waypoint kCanyon[] = {
    {0.3490, -0.0101, -0.3477},  {0.3343, -0.0047, -0.3291},  {0.3195, -0.0052, -0.3106},
    {0.3045, -0.0057, -0.2923},  {0.2890, -0.0063, -0.2744},  {0.2834, -0.0069, -0.2524},
    {0.2914, -0.0071, -0.2301},  {0.2887, -0.0076, -0.2070},  {0.2805, -0.0085, -0.1848},
    {0.2776, -0.0093, -0.1613},  {0.2699, -0.0097, -0.1394},  {0.2574, -0.0095, -0.1199},
    {0.2655, -0.0089, -0.0980},  {0.2741, -0.0082, -0.0760},  {0.2786, -0.0077, -0.0528},
    {0.2880, -0.0077, -0.0311},  {0.2996, -0.0078, -0.0105},  {0.3095, -0.0080, 0.0110},
    {0.3176, -0.0084, 0.0332},   {0.3242, -0.0091, 0.0559},   {0.3209, -0.0105, 0.0792},
    {0.3141, -0.0124, 0.1018},   {0.3109, -0.0144, 0.1253},   {0.3066, -0.0161, 0.1485},
    {0.2944, -0.0171, 0.1687},   {0.2794, -0.0173, 0.1870},   {0.2638, -0.0166, 0.2048},
    {0.2478, -0.0155, 0.2222},   {0.2269, -0.0143, 0.2325},   {0.2033, -0.0134, 0.2337},
    {0.1798, -0.0131, 0.2307},   {0.1575, -0.0131, 0.2231},   {0.1388, -0.0132, 0.2087},
    {0.1202, -0.0133, 0.1940},   {0.0999, -0.0134, 0.1819},   {0.0780, -0.0137, 0.1730},
    {0.0550, -0.0141, 0.1674},   {0.0315, -0.0147, 0.1643},   {0.0080, -0.0154, 0.1659},
    {-0.0156, -0.0161, 0.1681},  {-0.0384, -0.0166, 0.1626},  {-0.0542, -0.0169, 0.1453},
    {-0.0710, -0.0169, 0.1290},  {-0.0921, -0.0168, 0.1181},  {-0.1116, -0.0166, 0.1048},
    {-0.1242, -0.0165, 0.0851},  {-0.1314, -0.0167, 0.0625},  {-0.1389, -0.0169, 0.0401},
    {-0.1514, -0.0169, 0.0204},  {-0.1738, -0.0166, 0.0137},  {-0.1966, -0.0155, 0.0186},
    {-0.2169, -0.0140, 0.0308},  {-0.2358, -0.0125, 0.0450},  {-0.2511, -0.0117, 0.0344},
    {-0.2654, -0.0115, 0.0164},  {-0.2876, -0.0120, 0.0082},  {-0.3043, -0.0130, -0.0073},
    {-0.2993, -0.0144, -0.0297}, {-0.2852, -0.0160, -0.0488}, {-0.2707, -0.0176, -0.0674},
    {-0.2566, -0.0187, -0.0864}, {-0.2524, -0.0191, -0.1093}, {-0.2615, -0.0189, -0.1307},
    {-0.2809, -0.0180, -0.1442}, {-0.3028, -0.0169, -0.1529}, {-0.3262, -0.0159, -0.1568},
    {-0.3496, -0.0146, -0.1601},
};

CameraPath canyon(std::uint32_t frames, const KnownPathOptions& /*options*/) {
  // The view goes ahead to where the camera will be, and down.
  constexpr std::size_t kAhead = 2;
  constexpr double kDown = 0.012;
  std::vector<CameraKey> keys;
  for (std::size_t i = 0; i + kAhead < std::size(kCanyon); ++i) {
    const Waypoint &here = kCanyon[i], &there = kCanyon[i + kAhead];
    CameraKey key;
    key.eye = DVec3(here.x, here.y, here.z);
    key.target = DVec3(there.x, there.y - kDown, there.z);
    keys.push_back(key);
  }
  return spread(frames, std::move(keys));
}

struct KnownPath {
  std::string_view name;
  std::uint32_t frames;
  CameraPath (*make)(std::uint32_t frames, const KnownPathOptions& options);
};
constexpr std::array kPaths{KnownPath{"orbit", 360, orbit}, KnownPath{"fly_by", 300, fly_by},
                            KnownPath{"dive", 300, dive}, KnownPath{"canyon", 900, canyon}};

constexpr auto kNames = [] {
  std::array<std::string_view, kPaths.size()> names;
  for (std::size_t i = 0; i < names.size(); ++i) names[i] = kPaths[i].name;
  return names;
}();

}  // namespace

std::span<const std::string_view> known_path_names() { return kNames; }

Result<CameraPath> known_path(std::string_view name, const KnownPathOptions& options) {
  for (const KnownPath& known : kPaths) {
    if (known.name != name) continue;
    const std::uint32_t frames = options.frames.value_or(known.frames);
    if (frames < 2 || frames > kMaxPathFrames)
      return fail(ErrorKind::kInvalidInput,
                  "a path has 2 to " + std::to_string(kMaxPathFrames) + " frames");
    if (!(options.orbit_distance > 0) || !std::isfinite(options.orbit_distance))
      return fail(ErrorKind::kInvalidInput, "the distance of an orbit is not positive");
    CameraPath path = known.make(frames, options);
    path.name = name;
    path.width = options.width;
    path.height = options.height;
    for (CameraKey& key : path.keys) {
      key.fovy_degrees = options.fovy_degrees;
    }
    if (auto checked = check_camera_path(path); !checked)
      return tl::unexpected(std::move(checked.error()));
    return path;
  }
  std::string message = "there is no path '" + std::string(name) + "'; there are";
  for (const std::string_view known : kNames) message.append(" ").append(known);
  return fail(ErrorKind::kInvalidInput, message);
}

}  // namespace varifold
