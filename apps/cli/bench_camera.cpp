#include <apps/cli/bench_camera.h>
#include <fmt/format.h>
#include <varifold/base/bytes.h>
#include <varifold/base/checksum.h>
#include <cmath>

namespace varifold::cli {
namespace {

/// The least value that is not below `part` of all values; 0 where there are none.
double percentile(std::vector<double> values, double part) {
  if (values.empty()) return 0;
  std::sort(values.begin(), values.end());
  const double rank = std::ceil(part * static_cast<double>(values.size()));
  return values[static_cast<std::size_t>(std::max(rank, 1.0)) - 1];
}

void add_percentiles(const std::string& name, const std::vector<double>& seconds, Json& result) {
  for (const auto& [suffix, part] :
       {std::pair{"_p50", 0.5}, {"_p90", 0.9}, {"_p99", 0.99}, {"_max", 1.0}})
    result[name + suffix] = 1e3 * percentile(seconds, part);
}

template <class Value>
double sum_of(std::span<const CameraFrame> frames, const Value& value) {
  double sum = 0;
  for (const CameraFrame& frame : frames) sum += static_cast<double>(value(frame));
  return sum;
}

template <class Value>
double greatest(std::span<const CameraFrame> frames, const Value& value) {
  double most = 0;
  for (const CameraFrame& frame : frames) most = std::max<double>(most, value(frame));
  return most;
}

/// The same on any machine where the fronts are the same.
std::string frames_checksum(std::span<const CameraFrame> frames) {
  std::vector<std::byte> bytes;
  for (const CameraFrame& frame : frames)
    for (const std::uint32_t number :
         {frame.splits, frame.collapses, frame.vertices, frame.triangles})
      append_little(bytes, number);
  return fmt::format("{:016x}", checksum(bytes));
}

Json frame_list(std::span<const CameraFrame> frames, bool is_drawn) {
  Json list = Json::array();
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const CameraFrame& frame = frames[i];
    list.push_back({{"frame", i},
                    {"triangles", frame.triangles},
                    {"vertices", frame.vertices},
                    {"splits", frame.splits},
                    {"collapses", frame.collapses},
                    {"forced_splits", frame.forced_splits},
                    {"moving_vertices", frame.moving},
                    {"turned_triangles", frame.turned},
                    {"turned_seen", frame.turned_seen},
                    {"tolerance_pixels", frame.tolerance},
                    {"indices_submitted", frame.indices},
                    {"strips", frame.measures.strips},
                    {"patches", frame.patches},
                    {"from_roots_ms", 1e3 * frame.from_roots_seconds},
                    {"changed_bytes", frame.changed_bytes},
                    {"adapt_ms", 1e3 * frame.adapt_seconds},
                    {"draw_list_ms", 1e3 * frame.list_seconds},
                    {"upload_ms", is_drawn ? Json(1e3 * frame.upload_seconds) : Json()},
                    {"uploaded_bytes", is_drawn ? Json(frame.uploaded_bytes) : Json()},
                    {"drawing_ms", is_drawn ? Json(1e3 * frame.draw_seconds) : Json()},
                    {"jump_pixels", frame.jumps.vertex_pixels},
                    {"surface_jump_pixels", frame.jumps.surface_pixels}});
  }
  return list;
}

// The first frame comes from the base and belongs to no motion.
void add_times(std::span<const CameraFrame> frames, Json& result) {
  const auto later = frames.subspan(1);
  std::vector<double> adapting, listing;
  for (const CameraFrame& frame : later) {
    adapting.push_back(frame.adapt_seconds);
    listing.push_back(frame.list_seconds);
  }
  const double seconds = sum_of(later, [](const auto& f) { return f.adapt_seconds; });
  const double vertices = sum_of(later, [](const auto& f) { return f.vertices; });
  const double splits = sum_of(later, [](const auto& f) { return f.splits; });
  const double collapses = sum_of(later, [](const auto& f) { return f.collapses; });
  const double count = std::max<double>(1, static_cast<double>(later.size()));
  const auto per_second = [&](double number) { return seconds > 0 ? number / seconds : 0; };
  result["adapt_ms_first"] = 1e3 * frames[0].adapt_seconds;
  result["adapt_ms_mean"] = 1e3 * seconds / count;
  add_percentiles("adapt_ms", adapting, result);
  result["adapt_ns_per_vertex"] = vertices > 0 ? 1e9 * seconds / vertices : 0;
  add_percentiles("draw_list_ms", listing, result);
  result["splits"] = static_cast<std::uint64_t>(splits);
  result["collapses"] = static_cast<std::uint64_t>(collapses);
  result["splits_per_second"] = per_second(splits);
  result["collapses_per_second"] = per_second(collapses);
}

// Triangles, indices and misses of all frames; what changes, after the first.
void add_lists(const CameraTest& test, std::span<const CameraFrame> frames, Json& result) {
  const auto later = frames.subspan(1);
  const auto mean = [](std::span<const CameraFrame> some, const auto& value) {
    return sum_of(some, value) / std::max<double>(1, static_cast<double>(some.size()));
  };
  const auto triangles = [](const CameraFrame& f) { return f.measures.triangles; };
  const double all = std::max(1.0, sum_of(frames, triangles));
  const double strips = sum_of(frames, [](const auto& f) { return f.measures.strips; });
  result["strips"] = test.lists.strips;
  result["strips_mean"] = strips / static_cast<double>(frames.size());
  result["triangles_per_strip"] = strips > 0 ? Json(all / strips) : Json();
  const auto indices = [](const CameraFrame& f) { return f.measures.indices; };
  result["indices_per_triangle"] = sum_of(frames, indices) / all;
  const auto misses_16 = [&](const CameraFrame& f) { return f.acmr_16 * triangles(f); };
  const auto misses_24 = [&](const CameraFrame& f) { return f.acmr_24 * triangles(f); };
  result["acmr_16"] = sum_of(frames, misses_16) / all;
  result["acmr_24"] = sum_of(frames, misses_24) / all;
  const double seconds = sum_of(later, [](const auto& f) { return f.list_seconds; });
  const double drawn = sum_of(later, triangles);
  result["draw_list_ns_per_triangle"] = drawn > 0 ? 1e9 * seconds / drawn : 0;
  result["changed_bytes_mean"] = mean(later, [](const auto& f) { return f.changed_bytes; });
}

void add_fronts(const CameraTest& test, std::span<const CameraFrame> frames, Json& result) {
  const auto count = static_cast<double>(frames.size());
  const auto triangles = [](const CameraFrame& f) { return f.triangles; };
  std::uint32_t least = kNone;
  for (const CameraFrame& frame : frames) least = std::min(least, frame.triangles);
  result["triangles_mean"] = sum_of(frames, triangles) / count;
  result["triangles_min"] = least;
  result["triangles_max"] = static_cast<std::uint64_t>(greatest(frames, triangles));
  result["vertices_mean"] = sum_of(frames, [](const auto& f) { return f.vertices; }) / count;
  const auto forced = [](const CameraFrame& f) { return f.forced_splits; };
  result["forced_splits_mean"] = sum_of(frames, forced) / count;
  const auto moving = [](const CameraFrame& f) { return f.moving; };
  result["morph_frames"] = test.morph_frames;
  result["moving_vertices_mean"] = sum_of(frames, moving) / count;
  result["moving_vertices_max"] = static_cast<std::uint64_t>(greatest(frames, moving));
  const auto tolerance = [](const CameraFrame& f) { return f.tolerance; };
  result["tolerance_pixels_mean"] = sum_of(frames, tolerance) / count;
  result["tolerance_pixels_max"] = greatest(frames, tolerance);
  const double goal = test.triangles ? *test.triangles : 0;
  const auto off_goal = [&](const CameraFrame& f) {
    return goal > 0 ? std::abs(f.triangles - goal) / goal : 0;
  };
  result["triangles_goal"] = test.triangles ? Json(*test.triangles) : Json();
  result["goal_error_mean"] = test.triangles ? Json(sum_of(frames, off_goal) / count) : Json();
  result["goal_error_max"] = test.triangles ? Json(greatest(frames, off_goal)) : Json();
}

// Null where nothing is drawn. The first frame uploads all.
void add_uploads(std::span<const CameraFrame> frames, bool is_drawn, Json& result) {
  const auto later = frames.subspan(1);
  std::vector<double> uploading, drawing;
  for (const CameraFrame& frame : later) {
    uploading.push_back(frame.upload_seconds);
    drawing.push_back(frame.draw_seconds);
  }
  const double bytes = sum_of(later, [](const auto& f) { return f.uploaded_bytes; }) /
                       std::max<double>(1, static_cast<double>(later.size()));
  result["upload_ms_p50"] = is_drawn ? Json(1e3 * percentile(uploading, 0.5)) : Json();
  result["uploaded_bytes_mean"] = is_drawn ? Json(bytes) : Json();
  result["drawing_ms_p50"] = is_drawn ? Json(1e3 * percentile(drawing, 0.5)) : Json();
}

// Null where a model has no patches.
void add_patches(const CameraTest& test, std::span<const CameraFrame> frames, Json& result) {
  std::vector<double> seconds;
  for (const CameraFrame& frame : frames.subspan(1)) seconds.push_back(frame.from_roots_seconds);
  const double patches = sum_of(frames, [](const auto& f) { return f.patches; });
  if (patches == 0) {
    for (const char* const key :
         {"patches_mean", "from_roots_ms_p50", "from_roots_ms_p99", "morph_band",
          "moving_vertices_part", "turned_per_million_triangles", "turned_seen_mean"})
      result[key] = Json();
    return;
  }
  const auto part_of = [&](const auto& value, const auto& all) {
    return sum_of(frames, value) / std::max(1.0, sum_of(frames, all));
  };
  result["morph_band"] = test.morph_band ? Json(*test.morph_band) : Json();
  result["moving_vertices_part"] = part_of([](const auto& f) { return f.moving; },
                                           [](const auto& f) { return f.drawn_vertices; });
  result["turned_per_million_triangles"] = 1e6 * part_of([](const auto& f) { return f.turned; },
                                                         [](const auto& f) { return f.triangles; });
  result["turned_seen_mean"] = sum_of(frames, [](const auto& f) { return f.turned_seen; }) /
                               static_cast<double>(frames.size());
  result["patches_mean"] = patches / static_cast<double>(frames.size());
  add_percentiles("from_roots_ms", seconds, result);
}

void add_jumps(std::span<const CameraFrame> frames, Json& result) {
  const auto add = [&](const std::string& name, const auto& value) {
    std::size_t worst = 0;
    std::vector<double> jumps;
    for (std::size_t i = 1; i < frames.size(); ++i) {
      jumps.push_back(value(frames[i]));
      if (value(frames[i]) > value(frames[worst])) worst = i;
    }
    result["max_" + name + "_pixels"] = value(frames[worst]);
    result["max_" + name + "_frame"] = worst;
    result[name + "_pixels_p50"] = percentile(jumps, 0.5);
    result[name + "_pixels_p99"] = percentile(std::move(jumps), 0.99);
  };
  add("jump", [](const CameraFrame& f) { return f.jumps.vertex_pixels; });
  add("surface_jump", [](const CameraFrame& f) { return f.jumps.surface_pixels; });
}

}  // namespace

void add_camera_test_options(CLI::App& command, CameraTest& test) {
  const std::string group = "CAMERA (--test camera)";
  command.add_option("--path", test.path, "The camera path: orbit, fly_by, dive, canyon or a file")
      ->type_name("FILE.json")
      ->group(group);
  command.add_option("--pixels", test.pixels, "At most this error in pixels (default 1)")
      ->check(CLI::NonNegativeNumber)
      ->type_name("T")
      ->group(group);
  command
      .add_flag("--strips", test.lists.strips,
                "Draw triangle strips, made anew in each frame (view-dependent meshes)")
      ->group(group);
  command
      .add_option("--morph", test.morph_frames,
                  "Splits and collapses take so many frames (view-dependent meshes)")
      ->check(CLI::Range(0u, 255u))
      ->type_name("N")
      ->group(group);
  command.add_option("--triangles", test.triangles, "At most so many triangles a frame")
      ->check(CLI::Range(1u, kNone - 1))
      ->type_name("N")
      ->group(group);
  add_size_option(command, "Size of the picture in pixels (default: that of the path)",
                  [&](PictureSize size) { test.size = size; })
      ->group(group);
  command.add_flag("--per-frame", test.per_frame, "List all frames in the JSON")->group(group);
  command
      .add_flag("--paper-priority", test.paper_priority,
                "Patch trees: by the mean squared distance over the squared distance to the eye, "
                "with --triangles")
      ->group(group);
  command
      .add_option(
          "--morph-band", test.morph_band,
          "Patch trees: vertices blend into the next coarser level from this many times the "
          "tolerance down to it")
      ->check(CLI::Range(1.01f, 16.0f))
      ->check(finite_number())
      ->type_name("B")
      ->group(group);
  command.add_flag("--no-frustum", test.no_frustum, "Full detail outside of the picture too")
      ->group(group);
  command.add_flag("--no-orientation", test.no_orientation, "Full detail on back faces too")
      ->group(group);
}

Result<CameraPath> camera_test_path(const CameraTest& test) {
  auto path = find_camera_path(test.path);
  if (!path) return path;
  if (test.size) {
    path->width = test.size->width;
    path->height = test.size->height;
  }
  return path;
}

Json camera_result(const CameraTest& test, const CameraPath& path,
                   std::span<const CameraFrame> frames, bool is_drawn) {
  const double adapting = sum_of(frames, [](const auto& f) { return f.adapt_seconds; });
  const double listing = sum_of(frames, [](const auto& f) { return f.list_seconds; });
  const double drawing = sum_of(frames, [](const auto& f) { return f.draw_seconds; });
  Json result{{"test", "camera"},
              {"steps", frames.size()},
              {"path", path.name.empty() ? test.path : path.name},
              {"frames", frames.size()},
              {"width", path.width},
              {"height", path.height},
              {"pixels", test.tolerance()},
              {"seconds_total", adapting + listing + drawing},
              {"seconds_extraction", adapting + listing},
              {"seconds_drawing", is_drawn ? Json(drawing) : Json()}};
  add_times(frames, result);
  add_fronts(test, frames, result);
  add_patches(test, frames, result);
  add_jumps(frames, result);
  add_lists(test, frames, result);
  add_uploads(frames, is_drawn, result);
  result["indices_submitted"] =
      static_cast<std::uint64_t>(sum_of(frames, [](const auto& f) { return f.indices; }));
  result["frames_checksum"] = frames_checksum(frames);
  if (test.per_frame) result["per_frame"] = frame_list(frames, is_drawn);
  return result;
}

void ListMeasures::next(const DrawList& list, CameraFrame& frame) {
  frame.measures = measure_indices(list.indices, list.ranges);
  frame.acmr_16 = measure_cache(list.indices, list.ranges, 16).acmr();
  frame.acmr_24 = measure_cache(list.indices, list.ranges, 24).acmr();
  // Elements beyond what there was are new in any case.
  const auto count = [](std::span<const ElementRange> ranges, std::uint64_t known,
                        std::uint64_t size) {
    std::uint64_t sum = size - std::min(known, size);
    for (const ElementRange& range : ranges)
      if (range.first < known) sum += std::min<std::uint64_t>(range.count, known - range.first);
    return sum;
  };
  const std::size_t bytes_per_vertex = sizeof(Vec3) + (list.normals.empty() ? 0 : sizeof(Vec3)) +
                                       (list.texcoords.empty() ? 0 : sizeof(Vec2)) +
                                       (list.colors.empty() ? 0 : sizeof(Color));
  frame.changed_bytes =
      bytes_per_vertex * count(list.changed_vertices, vertices_, list.positions.size()) +
      sizeof(std::uint32_t) * count(list.changed_indices, indices_, list.indices.size());
  vertices_ = list.positions.size();
  indices_ = list.indices.size();
}

std::string camera_row(const Json& result) {
  const auto number = [&](const char* key) { return result[key].get<double>(); };
  if (!result["patches_mean"].is_null())
    return fmt::format(
        "{}: {} frames, {:.0f} triangles in {:.0f} patches, {:.4f} ms a frame ({:.4f} at 99 %), "
        "{:.4f} ms from the roots, {:.1f} splits and {:.1f} merges a frame, surface jumps {:.2f} "
        "pixels at most",
        result["kind"].get<std::string>(), result["frames"].get<std::uint64_t>(),
        number("triangles_mean"), number("patches_mean"), number("adapt_ms_p50"),
        number("adapt_ms_p99"), number("from_roots_ms_p50"),
        number("splits") / std::max(1.0, number("frames") - 1),
        number("collapses") / std::max(1.0, number("frames") - 1),
        number("max_surface_jump_pixels"));
  return fmt::format(
      "{}: {} frames, {:.0f} triangles, {:.3f} ms a frame ({:.3f} at 99 %), {:.1f} ns a vertex, "
      "{:.0f} splits and {:.0f} collapses a frame, surface jumps {:.2f} pixels at most",
      result["kind"].get<std::string>(), result["frames"].get<std::uint64_t>(),
      number("triangles_mean"), number("adapt_ms_p50"), number("adapt_ms_p99"),
      number("adapt_ns_per_vertex"), number("splits") / std::max(1.0, number("frames") - 1),
      number("collapses") / std::max(1.0, number("frames") - 1), number("max_surface_jump_pixels"));
}

}  // namespace varifold::cli
