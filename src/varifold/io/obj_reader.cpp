// Based on: the OBJ section of Wavefront's "Advanced Visualizer" manual, and what exporters made
// of it (colours behind positions, spaces in material names).
#include <fmt/format.h>
#include <varifold/base/bytes.h>
#include <varifold/io/import_check.h>
#include <varifold/io/obj.h>
#include <varifold/io/obj_materials.h>
#include <varifold/io/polygon.h>
#include <varifold/io/resource_file.h>
#include <varifold/io/text_scanner.h>
#include <varifold/io/wedge_table.h>
#include <algorithm>
#include <array>
#include <cmath>
#include <unordered_map>
#include <unordered_set>

namespace varifold {
namespace {

/// The text with every backslash that continues a line, and the end of that line, as blanks; all
/// positions stay. Empty where there is none.
std::string join_continued_lines(std::string_view text) {
  std::string joined;
  for (std::size_t at = text.find('\\'); at != text.npos; at = text.find('\\', at + 1)) {
    std::size_t end = at + 1;
    if (end < text.size() && text[end] == '\r') ++end;
    if (end < text.size() && text[end] == '\n') ++end;
    if (end == at + 1) continue;
    if (joined.empty()) joined = text;
    std::fill(joined.begin() + static_cast<std::ptrdiff_t>(at),
              joined.begin() + static_cast<std::ptrdiff_t>(end), ' ');
  }
  return joined;
}

/// One kind of list that faces index, and the largest index met, which may come before the entry.
template <class T>
struct IndexedList {
  std::string_view what;
  std::vector<T> values;
  std::uint32_t largest = 0;   ///< one more than the largest index
  std::size_t largest_at = 0;  ///< where it stands in the text
};

class ObjReader {
 public:
  ObjReader(std::string_view file, std::string_view joined, const std::filesystem::path& folder,
            FaceReading faces)
      : file_(file), text_(joined), folder_(folder), faces_(faces) {}

  Result<ImportedMesh> read() {
    while (!text_.at_end()) {
      const std::string_view keyword = text_.token_in_line();
      if (auto done = read_statement(keyword); !done) return tl::unexpected(done.error());
      text_.line();
    }
    if (!is_obj_) return fail(ErrorKind::kInvalidInput, "not a single OBJ statement");
    return finish();
  }

 private:
  [[nodiscard]] tl::unexpected<Error> bad(const std::string& fault) const {
    return bad_at(text_.position(), fault);
  }
  [[nodiscard]] tl::unexpected<Error> bad_at(std::size_t position, const std::string& fault) const {
    return fail(ErrorKind::kInvalidInput,
                fmt::format("line {}: {}", TextScanner(file_).line_of(position), fault));
  }

  Result<void> read_statement(std::string_view keyword) {
    if (keyword.empty() || keyword.front() == '#') return {};
    bool known = true;
    Result<void> done;
    if (keyword == "v") {
      done = read_position();
    } else if (keyword == "f" || keyword == "fo") {
      done = read_face();
    } else if (keyword == "vt") {
      done = read_texcoord();
    } else if (keyword == "vn") {
      done = read_normal();
    } else if (keyword == "usemtl") {
      use_material(rest_of_line());
    } else if (keyword == "mtllib") {
      read_library(rest_of_line());
    } else if (keyword == "p" || keyword == "l") {
      ++points_and_lines_;
    } else if (keyword != "g" && keyword != "o" && keyword != "s") {
      if (unknown_count_++ == 0) unknown_ = in_quotes(keyword);
      known = false;
    }
    is_obj_ = is_obj_ || known;
    return done;
  }

  std::string rest_of_line() {
    text_.skip_blanks();
    TextScanner ahead = text_;
    std::string_view rest = ahead.line();
    while (!rest.empty() && TextScanner::is_blank(rest.back())) rest.remove_suffix(1);
    text_.advance(rest.size());
    return std::string(rest);
  }

  // --- numbers ---

  /// Whether the line, but for a comment, ends here.
  bool line_ends() {
    text_.skip_blanks();
    return text_.at_end() || TextScanner::is_line_end(text_.peek()) || text_.peek() == '#';
  }

  /// Reads up to values.size() numbers, at least `least`; returns how many there were.
  Result<std::size_t> read_floats(std::string_view keyword, std::size_t least,
                                  std::span<float> values) {
    std::size_t count = 0;
    while (count < values.size() && !line_ends()) {
      if (!text_.float_here(values[count])) {
        TextScanner ahead = text_;
        return bad("expected a number instead of " + in_quotes(ahead.token_in_line()));
      }
      ++count;
    }
    if (count < least) return bad(fmt::format("'{}' needs {} numbers", keyword, least));
    return count;
  }

  Result<void> read_position() {
    std::array<float, 7> numbers{};
    const auto count = read_floats("v", 3, numbers);
    if (!count) return tl::unexpected(count.error());
    if (!std::isfinite(numbers[0]) || !std::isfinite(numbers[1]) || !std::isfinite(numbers[2]))
      return bad("position is not finite");
    if (positions_.values.size() >= kNone - 1)
      return fail(ErrorKind::kUnsupported, "more vertices than 32 bits can count");
    positions_.values.emplace_back(numbers[0], numbers[1], numbers[2]);
    if (*count < 6) {
      if (!colors_.empty()) colors_.emplace_back(255, 255, 255, 255);
      return {};
    }
    // Six numbers: x y z r g b. Seven: colours with alpha.
    if (colors_.empty()) colors_.assign(positions_.values.size() - 1, Color(255, 255, 255, 255));
    if (*count == 6) numbers[6] = 1;
    for (std::size_t i = 3; i < numbers.size(); ++i)
      if (!std::isfinite(numbers[i])) ++colors_not_finite_;
    colors_.emplace_back(color_byte(numbers[3]), color_byte(numbers[4]), color_byte(numbers[5]),
                         color_byte(numbers[6]));
    return {};
  }

  Result<void> read_texcoord() {
    std::array<float, 2> numbers{};
    const auto count = read_floats("vt", 1, numbers);
    if (!count) return tl::unexpected(count.error());
    texcoords_.values.emplace_back(numbers[0], 1 - numbers[1]);
    return {};
  }

  Result<void> read_normal() {
    std::array<float, 3> numbers{};
    const auto count = read_floats("vn", 3, numbers);
    if (!count) return tl::unexpected(count.error());
    normals_.values.emplace_back(numbers[0], numbers[1], numbers[2]);
    return {};
  }

  // --- faces ---

  Result<void> read_face() {
    corners_.clear();
    while (!line_ends()) {
      Wedge wedge;
      if (auto done = read_corner(wedge); !done) return done;
      corners_.push_back(number_of(wedge));
    }
    if (corners_.size() < 3) {
      polygons_.drop();
      return {};
    }
    polygons_.add(corners_);
    if (has_materials_) material_of_.resize(mesh_.indices.size() / 3, material_);
    return {};
  }

  /// v, v/vt, v//vn or v/vt/vn; "v/" and "v//" are taken as v.
  Result<void> read_corner(Wedge& wedge) {
    if (auto done = read_index(positions_, wedge.position); !done) return done;
    if (text_.peek() == '/') {
      text_.advance(1);
      if (text_.peek() != '/' && !at_corner_end())
        if (auto done = read_index(texcoords_, wedge.texcoord); !done) return done;
    }
    if (text_.peek() == '/') {
      text_.advance(1);
      if (!at_corner_end())
        if (auto done = read_index(normals_, wedge.normal); !done) return done;
    }
    if (!at_corner_end()) {
      TextScanner ahead = text_;
      return bad("unexpected " + in_quotes(ahead.token_in_line()) + " in a face");
    }
    return {};
  }
  [[nodiscard]] bool at_corner_end() const {
    return text_.at_end() || TextScanner::is_space(text_.peek());
  }

  template <class T>
  Result<void> read_index(IndexedList<T>& list, std::uint32_t& index) {
    std::int64_t value = 0;
    if (!text_.digits_here(value)) {
      TextScanner ahead = text_;
      return bad("expected an index instead of " + in_quotes(ahead.token_in_line()));
    }
    const auto count = static_cast<std::int64_t>(list.values.size());
    // Negative indices count back from the newest entry, -1.
    const std::int64_t resolved = value < 0 ? value + count : value - 1;
    if (resolved < 0 || resolved >= kNone - 1)
      return bad(fmt::format("{} index {} is out of range ({} so far)", list.what, value, count));
    index = static_cast<std::uint32_t>(resolved);
    if (index >= list.largest) {
      list.largest = index + 1;
      list.largest_at = text_.position();
    }
    return {};
  }

  /// While no face has texture coordinates or normals, vertices are the file's positions.
  std::uint32_t number_of(const Wedge& wedge) {
    const bool is_plain = wedge.texcoord == kNone && wedge.normal == kNone;
    if (!has_wedges_) {
      if (is_plain) return wedge.position;
      has_wedges_ = true;
      for (std::vector<std::uint32_t>* indices : {&mesh_.indices, &corners_})
        for (std::uint32_t& index : *indices) index = wedges_.find_or_add({index, kNone, kNone});
    }
    return wedges_.find_or_add(wedge);
  }

  // --- materials ---

  void use_material(const std::string& name) {
    if (!has_materials_ && !mesh_.indices.empty()) {
      // Triangles before the first usemtl have a material without a name.
      material_names_.emplace_back();
      material_ids_.emplace("", 0);
      material_of_.assign(mesh_.indices.size() / 3, 0);
    }
    has_materials_ = true;
    const auto [found, is_new] =
        material_ids_.try_emplace(name, static_cast<std::uint32_t>(material_names_.size()));
    if (is_new) material_names_.push_back(name);
    material_ = found->second;
  }

  /// The name may have spaces, or there may be several names: the whole is tried first.
  void read_library(const std::string& names) {
    if (!libraries_.insert(names).second) return;
    auto whole = open_resource(folder_, names);
    if (whole) {
      library_.add(as_text(whole->bytes()));
      return;
    }
    TextScanner words(names);
    for (auto name = words.token(); !name.empty(); name = words.token()) {
      auto file = open_resource(folder_, name);
      if (file)
        library_.add(as_text(file->bytes()));
      else if (missing_libraries_++ < kMostWarnings)
        warnings_.push_back("material file " + file.error().message);
    }
  }

  // --- the end ---

  Result<ImportedMesh> finish() {
    if (auto checked = check_largest(positions_); !checked) return tl::unexpected(checked.error());
    if (auto checked = check_largest(texcoords_); !checked) return tl::unexpected(checked.error());
    if (auto checked = check_largest(normals_); !checked) return tl::unexpected(checked.error());
    if (has_wedges_) {
      split_vertices();
    } else {
      mesh_.positions = std::move(positions_.values);
      mesh_.colors = std::move(colors_);
    }
    if (faces_ == FaceReading::kForUse) polygons_.cut_concave();
    const auto without_normal =
        static_cast<std::size_t>(std::count(has_no_normal_.begin(), has_no_normal_.end(), true));
    if (without_normal > 0) fill_missing_normals(mesh_, has_no_normal_);
    set_materials();

    ImportedMesh imported;
    imported.mesh = std::move(mesh_);
    imported.warnings = std::move(warnings_);
    imported.file_vertices = std::move(file_vertices_);
    polygons_.warn(imported);
    warn_count(imported, unused_, "vertices that no face uses were dropped");
    warn_count(imported, without_texcoord_, "vertices without texture coordinate got (0, 0)");
    warn_count(imported, without_normal, "vertices without normal got that of their triangles");
    warn_count(imported, colors_not_finite_, "components of colours that are not finite became 0");
    warn_count(imported, points_and_lines_, "point and line elements were dropped");
    warn_count(imported, unknown_count_, "lines were not understood, the first being " + unknown_);
    return finish_import(std::move(imported));
  }

  template <class T>
  Result<void> check_largest(const IndexedList<T>& list) const {
    if (list.largest <= list.values.size()) return {};
    return bad_at(list.largest_at, fmt::format("{} index {} is out of range (the file has {})",
                                               list.what, list.largest, list.values.size()));
  }

  void split_vertices() {
    const std::vector<Wedge>& wedges = wedges_.wedges();
    std::vector<bool> is_used(positions_.values.size(), false);
    mesh_.positions.reserve(wedges.size());
    if (texcoords_.largest > 0) mesh_.texcoords.reserve(wedges.size());
    if (normals_.largest > 0) mesh_.normals.reserve(wedges.size());
    file_vertices_.reserve(wedges.size());
    for (const Wedge& wedge : wedges) {
      file_vertices_.push_back(wedge.position);
      is_used[wedge.position] = true;
      mesh_.positions.push_back(positions_.values[wedge.position]);
      if (!colors_.empty()) mesh_.colors.push_back(colors_[wedge.position]);
      if (texcoords_.largest > 0) {
        const bool given = wedge.texcoord != kNone;
        mesh_.texcoords.push_back(given ? texcoords_.values[wedge.texcoord] : Vec2(0));
        without_texcoord_ += given ? 0 : 1;
      }
      if (normals_.largest > 0) {
        const bool given = wedge.normal != kNone;
        mesh_.normals.push_back(given ? normals_.values[wedge.normal] : Vec3(0));
        has_no_normal_.push_back(!given);
      }
    }
    unused_ = static_cast<std::size_t>(std::count(is_used.begin(), is_used.end(), false));
  }

  void set_materials() {
    if (!has_materials_ || faces_ == FaceReading::kAsInFile) return;
    std::size_t unknown = 0;
    for (const std::string& name : material_names_)
      unknown += library_.append_to(mesh_, name) || name.empty() ? 0 : 1;
    if (unknown > 0)
      warnings_.push_back(fmt::format("{} materials are in no material file", unknown));
    set_triangle_materials(mesh_, material_of_);
  }

  static constexpr std::size_t kMostWarnings = 10;

  std::string_view file_;
  TextScanner text_;
  const std::filesystem::path& folder_;
  FaceReading faces_;
  bool is_obj_ = false;

  IndexedList<Vec3> positions_{"vertex", {}, 0, 0};
  IndexedList<Vec2> texcoords_{"texture coordinate", {}, 0, 0};
  IndexedList<Vec3> normals_{"normal", {}, 0, 0};
  std::vector<Color> colors_;

  TriangleMesh mesh_;
  PolygonCollector polygons_{mesh_};
  std::vector<std::uint32_t> corners_;
  WedgeTable wedges_;
  bool has_wedges_ = false;

  bool has_materials_ = false;
  std::uint32_t material_ = 0;
  std::vector<std::uint32_t> material_of_;
  std::vector<std::string> material_names_;
  std::unordered_map<std::string, std::uint32_t> material_ids_;
  obj::MaterialLibrary library_;
  std::unordered_set<std::string> libraries_;  ///< what followed mtllib so far

  std::vector<std::string> warnings_;
  std::size_t colors_not_finite_ = 0;
  std::size_t points_and_lines_ = 0;
  std::size_t unknown_count_ = 0;
  std::size_t missing_libraries_ = 0;
  std::size_t unused_ = 0;
  std::size_t without_texcoord_ = 0;
  std::vector<bool> has_no_normal_;
  std::vector<std::uint32_t> file_vertices_;
  std::string unknown_;
};

}  // namespace

Result<ImportedMesh> read_obj(std::span<const std::byte> file, const std::filesystem::path& folder,
                              FaceReading faces) {
  std::string_view text = as_text(file);
  if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
  const std::string joined = join_continued_lines(text);
  return ObjReader(text, joined.empty() ? text : std::string_view(joined), folder, faces).read();
}

}  // namespace varifold
