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
    {0.3490, 0.0027, -0.3477},   {0.3342, 0.0031, -0.3291},   {0.3194, 0.0032, -0.3104},
    {0.3043, 0.0036, -0.2921},   {0.2893, 0.0040, -0.2737},   {0.2847, 0.0046, -0.2511},
    {0.2907, 0.0051, -0.2281},   {0.2876, 0.0053, -0.2047},   {0.2804, 0.0054, -0.1821},
    {0.2768, 0.0057, -0.1586},   {0.2674, 0.0064, -0.1370},   {0.2592, 0.0076, -0.1154},
    {0.2675, 0.0088, -0.0933},   {0.2749, 0.0096, -0.0708},   {0.2808, 0.0099, -0.0477},
    {0.2908, 0.0100, -0.0262},   {0.3021, 0.0101, -0.0053},   {0.3115, 0.0099, 0.0165},
    {0.3195, 0.0096, 0.0389},    {0.3235, 0.0092, 0.0622},    {0.3189, 0.0082, 0.0854},
    {0.3132, 0.0062, 0.1085},    {0.3099, 0.0032, 0.1320},    {0.3031, -0.0001, 0.1547},
    {0.2898, -0.0026, 0.1743},   {0.2746, -0.0036, 0.1925},   {0.2588, -0.0033, 0.2104},
    {0.2412, -0.0025, 0.2261},   {0.2187, -0.0020, 0.2331},   {0.1949, -0.0021, 0.2327},
    {0.1716, -0.0024, 0.2283},   {0.1504, -0.0026, 0.2178},   {0.1318, -0.0026, 0.2030},
    {0.1124, -0.0026, 0.1893},   {0.0914, -0.0028, 0.1783},   {0.0689, -0.0031, 0.1707},
    {0.0456, -0.0035, 0.1660},   {0.0219, -0.0038, 0.1648},   {-0.0017, -0.0042, 0.1671},
    {-0.0254, -0.0048, 0.1663},  {-0.0460, -0.0056, 0.1551},  {-0.0617, -0.0062, 0.1373},
    {-0.0811, -0.0062, 0.1238},  {-0.1017, -0.0057, 0.1120},  {-0.1184, -0.0049, 0.0953},
    {-0.1279, -0.0043, 0.0736},  {-0.1353, -0.0041, 0.0510},  {-0.1447, -0.0039, 0.0293},
    {-0.1638, -0.0035, 0.0160},  {-0.1873, -0.0027, 0.0159},  {-0.2088, -0.0017, 0.0258},
    {-0.2284, -0.0009, 0.0393},  {-0.2484, -0.0005, 0.0399},  {-0.2617, -0.0006, 0.0203},
    {-0.2828, -0.0009, 0.0097},  {-0.3014, -0.0010, -0.0043}, {-0.2999, -0.0005, -0.0271},
    {-0.2867, 0.0006, -0.0468},  {-0.2721, 0.0016, -0.0656},  {-0.2583, 0.0020, -0.0849},
    {-0.2531, 0.0015, -0.1077},  {-0.2619, 0.0004, -0.1294},  {-0.2807, -0.0007, -0.1437},
    {-0.3027, -0.0018, -0.1524}, {-0.3261, -0.0029, -0.1568}, {-0.3496, -0.0037, -0.1601},
};

CameraPath canyon(std::uint32_t frames, const KnownPathOptions& /*options*/) {
  // The view goes ahead to where the camera will be, and down.
  constexpr std::size_t kAhead = 4;
  constexpr double kDown = 0.02;
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
  double fovy_degrees;
  CameraPath (*make)(std::uint32_t frames, const KnownPathOptions& options);
};
constexpr std::array kPaths{KnownPath{"orbit", 360, 30, orbit},
                            KnownPath{"fly_by", 300, 30, fly_by}, KnownPath{"dive", 300, 30, dive},
                            KnownPath{"canyon", 900, 50, canyon}};

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
      key.fovy_degrees = options.fovy_degrees.value_or(known.fovy_degrees);
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
