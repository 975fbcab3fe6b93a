#include <fmt/format.h>
#include <varifold/base/bytes.h>
#include <varifold/io/camera_path_file.h>
#include <varifold/io/json_element.h>
#include <varifold/io/mapped_file.h>
#include <algorithm>
#include <array>
#include <cmath>
#include <initializer_list>
#include <nlohmann/json.hpp>
#include <utility>

namespace varifold {
namespace {

constexpr std::string_view kVersionKey = "varifold_camera_path";
constexpr std::uint64_t kVersion = 1;

/// A misspelt member would silently mean its default, so unknown ones are faults.
void check_members(const JsonElement& element, std::initializer_list<std::string_view> known) {
  for (const std::string& key : element.keys())
    if (std::find(known.begin(), known.end(), key) == known.end())
      element.fault("unknown member '" + key + "'");
}

DVec3 vector_of(const JsonElement& element, std::string_view key, const DVec3& fallback) {
  std::array<double, 3> numbers{fallback.x, fallback.y, fallback.z};
  element.numbers(key, numbers);
  return {numbers[0], numbers[1], numbers[2]};
}

/// One of two words; the first where nothing is.
bool is_second(const JsonElement& element, std::string_view key,
               std::array<std::string_view, 2> words) {
  const std::string word = element.text(key, words[0]);
  if (word != words[0] && word != words[1])
    element.fault(fmt::format("{}: not '{}' or '{}'", key, words[0], words[1]));
  return word == words[1];
}

std::uint32_t frame_number(std::uint64_t number) {
  return static_cast<std::uint32_t>(std::min<std::uint64_t>(number, kNone));
}

void read_size(const JsonElement& root, CameraPath& path) {
  std::array<double, 2> size{static_cast<double>(path.width), static_cast<double>(path.height)};
  root.numbers("size", size);
  for (const double side : size)
    if (!(side >= 1 && side <= kMaxPathSize) || std::floor(side) != side)
      return root.fault(fmt::format("size: not two whole numbers from 1 to {}", kMaxPathSize));
  path.width = static_cast<int>(size[0]);
  path.height = static_cast<int>(size[1]);
}

void read_keys(const JsonElement& root, CameraPath& path) {
  CameraKey defaults;
  defaults.target = vector_of(root, "target", defaults.target);
  defaults.up = vector_of(root, "up", defaults.up);
  defaults.fovy_degrees = root.number("fovy_degrees", defaults.fovy_degrees);
  const JsonElement keys = root.array("keys");
  path.keys.reserve(keys.size());
  std::uint64_t next = 0;
  for (std::size_t i = 0; i < keys.size(); ++i) {
    const JsonElement element = keys.item(i);
    if (!element.exists()) return;
    check_members(element, {"frame", "eye", "target", "up", "fovy_degrees"});
    if (!element.has("eye")) element.fault("there is no eye");
    CameraKey key;
    key.frame = frame_number(element.whole("frame", next));
    key.eye = vector_of(element, "eye", key.eye);
    key.target = vector_of(element, "target", defaults.target);
    key.up = vector_of(element, "up", defaults.up);
    key.fovy_degrees = element.number("fovy_degrees", defaults.fovy_degrees);
    path.keys.push_back(key);
    next = std::uint64_t{key.frame} + 1;
  }
  path.frames = frame_number(root.whole("frames", next));
}

std::string text_of(const DVec3& v) { return fmt::format("[{}, {}, {}]", v.x, v.y, v.z); }

}  // namespace

Result<CameraPath> parse_camera_path(std::string_view text) {
  const auto json = parse_json(text);
  if (!json) return tl::unexpected(json.error());
  if (!json->is_object()) return fail(ErrorKind::kInvalidInput, "not a camera path: no object");
  FirstFault faults;
  const JsonElement root(&*json, "", faults);
  if (!root.has(kVersionKey))
    return fail(ErrorKind::kInvalidInput, fmt::format("not a camera path: no '{}'", kVersionKey));
  const std::uint64_t version = root.whole(kVersionKey);
  if (!faults.any() && version != kVersion)
    return fail(ErrorKind::kUnsupported,
                fmt::format("{}: version {}; known is {}", kVersionKey, version, kVersion));
  check_members(root, {kVersionKey, "name", "units", "interpolation", "closed", "frames", "size",
                       "target", "up", "fovy_degrees", "keys"});
  CameraPath path;
  path.name = root.text("name");
  if (is_second(root, "units", {"diagonals", "model"})) path.units = CameraPath::Units::kModel;
  if (is_second(root, "interpolation", {"smooth", "linear"}))
    path.interpolation = CameraPath::Interpolation::kLinear;
  path.is_closed = root.boolean("closed", false);
  read_size(root, path);
  read_keys(root, path);
  if (faults.any()) return faults.take();
  if (auto checked = check_camera_path(path); !checked)
    return tl::unexpected(std::move(checked.error()));
  return path;
}

Result<CameraPath> read_camera_path(const std::filesystem::path& file) {
  const auto mapped = MappedFile::open(file);
  if (!mapped) return tl::unexpected(mapped.error());
  auto path = parse_camera_path(as_text(mapped->bytes()));
  if (!path) return fail_in(file.string(), std::move(path.error()));
  return path;
}

std::string format_camera_path(const CameraPath& path) {
  using nlohmann::json;
  const bool is_relative = path.units == CameraPath::Units::kDiagonals;
  const bool is_smooth = path.interpolation == CameraPath::Interpolation::kSmooth;
  const CameraKey defaults = path.keys.empty() ? CameraKey{} : path.keys.front();
  const std::string name = json(path.name).dump(-1, ' ', false, json::error_handler_t::replace);
  std::string text = fmt::format(
      "{{\n  \"{}\": {},\n  \"name\": {},\n  \"units\": \"{}\",\n  \"interpolation\": \"{}\",\n"
      "  \"closed\": {},\n  \"frames\": {},\n  \"size\": [{}, {}],\n  \"target\": {},\n"
      "  \"up\": {},\n  \"fovy_degrees\": {},\n  \"keys\": [\n",
      kVersionKey, kVersion, name, is_relative ? "diagonals" : "model",
      is_smooth ? "smooth" : "linear", path.is_closed, path.frames, path.width, path.height,
      text_of(defaults.target), text_of(defaults.up), defaults.fovy_degrees);
  for (std::size_t i = 0; i < path.keys.size(); ++i) {
    const CameraKey& key = path.keys[i];
    text += fmt::format("    {{\"frame\": {}, \"eye\": {}", key.frame, text_of(key.eye));
    if (key.target != defaults.target) text += ", \"target\": " + text_of(key.target);
    if (key.up != defaults.up) text += ", \"up\": " + text_of(key.up);
    if (key.fovy_degrees != defaults.fovy_degrees)
      text += fmt::format(", \"fovy_degrees\": {}", key.fovy_degrees);
    text += i + 1 < path.keys.size() ? "},\n" : "}\n";
  }
  return text + "  ]\n}\n";
}

}  // namespace varifold
