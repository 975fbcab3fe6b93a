#include <apps/cli/context.h>
#include <apps/cli/input.h>
#include <apps/cli/level_options.h>
#include <varifold/io/camera_path_file.h>
#include <varifold/mesh/triangle_mesh.h>
#include <varifold/view/known_paths.h>
#include <algorithm>
#include <charconv>
#include <cmath>
#include <glm/common.hpp>
#include <map>
#include <string_view>
#include <utility>

namespace varifold::cli {

namespace {

// So many numbers as the vector has, with commas between; nothing else.
template <class Vector>
std::optional<Vector> parse_vector(std::string_view text) {
  constexpr int kLength = Vector::length();
  Vector point{0};
  for (int axis = 0; axis < kLength; ++axis) {
    const char* const end = text.data() + text.size();
    const auto [next, error] = std::from_chars(text.data(), end, point[axis]);
    if (error != std::errc() || !std::isfinite(point[axis])) return std::nullopt;
    text = {next, static_cast<std::size_t>(end - next)};
    if (axis + 1 == kLength) break;
    if (!text.starts_with(',')) return std::nullopt;
    text.remove_prefix(1);
  }
  return text.empty() ? std::optional(point) : std::nullopt;
}

std::optional<PictureSize> parse_size(std::string_view text) {
  const std::size_t cross = text.find('x');
  if (cross == text.npos) return std::nullopt;
  const auto parse = [](std::string_view part, int& value) {
    const auto [next, error] = std::from_chars(part.data(), part.data() + part.size(), value);
    return error == std::errc() && next == part.data() + part.size() && value > 0 && value <= 16384;
  };
  PictureSize size;
  const bool is_size =
      parse(text.substr(0, cross), size.width) && parse(text.substr(cross + 1), size.height);
  return is_size ? std::optional(size) : std::nullopt;
}

template <class Vector, class Set>
CLI::Option* add_vector(CLI::App& command, const std::string& name, const std::string& form,
                        const std::string& help, const Set& set) {
  return command
      .add_option_function<std::string>(
          name,
          [name, form, set](const std::string& text) {
            const auto vector = parse_vector<Vector>(text);
            if (!vector) wrong_usage(name + ": '" + text + "' is not of the form " + form);
            set(*vector);
          },
          help)
      ->type_name(form);
}

template <class Set>
void add_point(CLI::App& command, const std::string& name, const std::string& help,
               const Set& set) {
  add_vector<Vec3>(command, name, "X,Y,Z", help, set);
}

}  // namespace

CLI::Option* add_size_option(CLI::App& command, const std::string& help,
                             const std::function<void(PictureSize)>& set) {
  return command
      .add_option_function<std::string>(
          "--size",
          [set](const std::string& text) {
            const auto size = parse_size(text);
            if (!size) wrong_usage("--size: '" + text + "' is not a size such as 1280x960");
            set(*size);
          },
          help)
      ->type_name("WxH");
}

Result<CameraPath> find_camera_path(const std::string& argument) {
  const auto names = known_path_names();
  if (std::find(names.begin(), names.end(), argument) != names.end()) return known_path(argument);
  return read_camera_path(input_path(argument));
}

void add_view_options(CLI::App& command, ViewOptions& options) {
  add_point(command, "--eye", "Where the camera stands (default: the whole mesh in view)",
            [&](const Vec3& p) { options.eye = p; });
  add_point(command, "--target", "The point it looks at (default: the middle of the mesh)",
            [&](const Vec3& p) { options.target = p; });
  add_point(command, "--up", "The direction that is up in the picture (default 0,1,0)",
            [&](const Vec3& p) { options.up = p; });
  command.add_option("--fovy", options.fovy_degrees, "Vertical angle of view")
      ->check(CLI::Range(0.01, 179.0))
      ->check(finite_number())
      ->capture_default_str()
      ->type_name("DEGREES");
  add_size_option(command, "Size of the picture in pixels (default 1280x960, or the path's)",
                  [&](PictureSize size) {
                    options.width = size.width;
                    options.height = size.height;
                    options.has_size = true;
                  });
  command.add_option("--azimuth", options.azimuth_degrees, "Without --eye: turn around --up")
      ->check(CLI::Range(-360.0, 360.0))
      ->check(finite_number())
      ->capture_default_str()
      ->type_name("DEGREES");
  command.add_option("--elevation", options.elevation_degrees, "Without --eye: angle above")
      ->check(CLI::Range(-90.0, 90.0))
      ->check(finite_number())
      ->capture_default_str()
      ->type_name("DEGREES");
  CLI::Option* const path = command
                                .add_option("--path", options.path,
                                            "A camera path: orbit, fly_by, dive, canyon or a file")
                                ->type_name("FILE.json");
  for (const char* const other :
       {"--eye", "--target", "--up", "--fovy", "--azimuth", "--elevation"})
    path->excludes(command.get_option(other));
  command.add_option("--frame", options.frame, "The frame of the path")
      ->needs(path)
      ->capture_default_str()
      ->type_name("N");
}

void add_place_options(CLI::App& command, PlaceOptions& options) {
  const std::string group = "PLACES (models with fronts: strips, vdpm, patchtree)";
  add_vector<Vec4>(command, "--sphere", "X,Y,Z,R", "Full detail in this ball", [&](const Vec4& s) {
    options.sphere = s;
  })->group(group);
  add_vector<Vec4>(command, "--plane", "A,B,C,D", "Full detail where Ax + By + Cz + D >= 0",
                   [&](const Vec4& p) { options.plane = p; })
      ->group(group);
  add_vector<Vec3>(command, "--light", "X,Y,Z",
                   "Direction to a light: less detail where its shading hardly changes",
                   [&](const Vec3& l) { options.light = l; })
      ->group(group);
  const std::map<std::string, DeviationMeasure> measures{{"seen", DeviationMeasure::kSeen},
                                                         {"length", DeviationMeasure::kLength}};
  command
      .add_option_function<std::string>(
          "--deviation",
          [&options, measures](const std::string& name) { options.deviation = measures.at(name); },
          "What --pixels bounds (models of kind vdpm): deviations as they are seen from the eye, "
          "or "
          "their lengths")
      ->check(CLI::IsMember({"seen", "length"}))
      ->default_str("seen")
      ->group("LEVEL");
}

RefineCriteria make_criteria(const PlaceOptions& places, const Camera* camera) {
  RefineCriteria criteria;
  if (camera) criteria.view.emplace(*camera);
  if (criteria.view) criteria.view->deviation = places.deviation;
  if (places.light && criteria.view) {
    criteria.view->light.emplace();
    criteria.view->light->to_light = normalize_or_zero(*places.light);
  }
  if (places.sphere) {
    if (places.sphere->w < 0) wrong_usage("--sphere: the radius is negative");
    criteria.sphere = Sphere{Vec3(*places.sphere), places.sphere->w};
  }
  if (places.plane) {
    const float length = glm::length(Vec3(*places.plane));
    if (!(length > 0)) wrong_usage("--plane: the normal is zero");
    criteria.plane = Plane{Vec3(*places.plane) / length, places.plane->w / length};
  }
  return criteria;
}

namespace {

Result<Camera> camera_of_path(const ViewOptions& options, const Box& box) {
  auto path = find_camera_path(options.path);
  if (!path) return tl::unexpected(std::move(path.error()));
  if (options.frame >= path->frames)
    wrong_usage("--frame: " + options.path + " has frames 0 to " +
                std::to_string(path->frames - 1));
  if (options.has_size) {
    path->width = options.width;
    path->height = options.height;
  }
  auto camera = camera_at(*path, options.frame, box);
  if (!camera) return fail_in(options.path, std::move(camera.error()));
  return camera;
}

}  // namespace

Result<Camera> make_camera(const ViewOptions& options, std::span<const Vec3> points) {
  Box box;
  for (const Vec3& p : points) box.add(p);
  if (!options.path.empty()) return camera_of_path(options, box);
  FrameOptions framing;
  framing.width = options.width;
  framing.height = options.height;
  framing.fovy_degrees = options.fovy_degrees;
  framing.up = options.up;
  framing.azimuth_degrees = options.azimuth_degrees;
  framing.elevation_degrees = options.elevation_degrees;
  Camera camera = frame(points, framing);
  if (options.eye) camera.eye = *options.eye;
  if (options.target || options.eye) camera.target = options.target.value_or(box.center());
  if (options.target || options.eye) set_depth_range(camera, sphere_around(box));
  if (!is_usable(camera))
    wrong_usage(
        "the camera cannot see: --eye and --target are one point, or --up is along the view");
  return camera;
}

void add_level_options(CLI::App& command, LevelOptions& options) {
  const std::string group = "LEVEL";
  command.add_option("--lod", options.lod, "1 = full detail, 0 = base")
      ->check(CLI::Range(0.0, 1.0))
      ->check(finite_number())
      ->type_name("F")
      ->group(group);
  command.add_option("--level", options.level, "The level of this number; 0 = base")
      ->type_name("K")
      ->group(group);
  command
      .add_option("--triangles", options.triangles,
                  "At most so many triangles; of a patch tree the mixture of levels of least error")
      ->type_name("N")
      ->group(group);
  command.add_option("--vertices", options.vertices, "At most so many vertices")
      ->type_name("N")
      ->group(group);
  command.add_option("--error", options.error, "At most this error, in model units")
      ->check(CLI::NonNegativeNumber)
      ->check(finite_number())
      ->type_name("E")
      ->group(group);
  command
      .add_option("--pixels", options.pixels,
                  "At most this error in pixels, as the camera sees it; also with --triangles")
      ->check(CLI::NonNegativeNumber)
      ->check(finite_number())
      ->type_name("T")
      ->group(group);
}

void check_level_options(const LevelOptions& options) {
  const int asked = (options.lod ? 1 : 0) + (options.vertices ? 1 : 0) + (options.error ? 1 : 0) +
                    (options.level ? 1 : 0) + (options.pixels || options.triangles ? 1 : 0);
  if (asked > 1)
    wrong_usage(
        "one LEVEL only: --lod, --level, --triangles, --vertices, --error or --pixels (with "
        "--triangles)");
}

void warn_of_base(const std::string& input, const LevelOptions& options,
                  std::uint32_t base_vertices, std::uint32_t base_triangles) {
  const auto warn = [&](std::uint32_t base, const char* elements) {
    print_message(input + ": warning: the base has " + format_count(base) + " " + elements +
                  "; there is nothing coarser");
  };
  if (options.triangles && *options.triangles < base_triangles) warn(base_triangles, "triangles");
  if (options.vertices && *options.vertices < base_vertices) warn(base_vertices, "vertices");
}

Vec3 nearest_point(std::span<const Vec3> points, const Vec3& eye) {
  Box box;
  for (const Vec3& p : points) box.add(p);
  return glm::clamp(eye, box.lower, box.upper);
}

}  // namespace varifold::cli
