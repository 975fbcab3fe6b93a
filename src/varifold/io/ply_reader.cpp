// Based on: [Turk1994] the PLY polygon file format.
#include <fmt/format.h>
#include <varifold/base/bytes.h>
#include <varifold/io/import_check.h>
#include <varifold/io/ply.h>
#include <varifold/io/ply_columns.h>
#include <varifold/io/ply_header.h>
#include <varifold/io/polygon.h>
#include <varifold/io/text_scanner.h>
#include <algorithm>
#include <array>

namespace varifold {
namespace {

using ply::Column;
using ply::Element;
using ply::Encoding;
using ply::Property;
using ply::Type;

/// Walks over the body of a PLY file, element after element.
class BodyReader {
 public:
  BodyReader(const ply::Header& header, std::span<const std::byte> file, FaceReading faces)
      : header_(header), file_(file), faces_(faces), at_(header.body), text_(as_text(file)) {
    text_.advance(header.body);
  }

  Result<ImportedMesh> read() {
    for (const Element& element : header_.elements)
      if (element.name == "vertex") vertex_count_ = element.count;
    bool has_vertices = false;
    for (const Element& element : header_.elements) {
      has_vertices = has_vertices || element.name == "vertex";
      if (auto done = read_element(element); !done) return tl::unexpected(done.error());
    }
    if (!has_vertices) return fail(ErrorKind::kInvalidInput, "no element 'vertex'");
    return finish();
  }

 private:
  [[nodiscard]] bool is_ascii() const { return header_.encoding == Encoding::kAscii; }

  [[nodiscard]] tl::unexpected<Error> bad(const std::string& fault) const {
    const std::string place = is_ascii() ? fmt::format("line {}", text_.line_of(text_.position()))
                                         : fmt::format("byte {}", at_);
    return fail(ErrorKind::kInvalidInput, place + ": " + fault);
  }
  [[nodiscard]] tl::unexpected<Error> ends_in(const Element& element, std::uint64_t row) const {
    return bad(fmt::format("the file ends in row {} of the {} rows of element {}", row,
                           element.count, in_quotes(element.name)));
  }

  Result<void> read_element(const Element& element) {
    if (auto fits = check_count(element); !fits) return fits;
    if (element.name == "vertex") return read_vertices(element);
    const bool is_face = element.name == "face";
    if (!is_face && element.name != "tristrips") {
      if (element.count > 0)
        warnings_.push_back("element " + in_quotes(element.name) + " was dropped");
      return skip_rows(element);
    }

    std::uint32_t list = element.find("vertex_indices");
    if (list == kNone) list = element.find("vertex_index");
    if (list == kNone || !element.properties[list].is_list) {
      if (element.count > 0)
        warnings_.push_back("element " + in_quotes(element.name) + " has no list 'vertex_indices'");
      return skip_rows(element);
    }
    if (ply::is_float(element.properties[list].type))
      return bad("the vertex indices of element '" + element.name + "' are floats");
    if (element.find("texcoord") != kNone)
      warnings_.emplace_back("texture coordinates of faces ('texcoord') were dropped");
    if (is_ascii()) return read_lists_ascii(element, list, is_face);
    return read_lists_binary(element, list, is_face);
  }

  /// No array may be sized by a count that the bytes left cannot hold.
  Result<void> check_count(const Element& element) {
    if (element.properties.empty()) return {};
    // In text every value takes a digit and, but for the last, a space.
    const std::uint64_t least =
        is_ascii() ? 2 * element.properties.size() : element.least_row_bytes();
    const std::uint64_t left = is_ascii() ? text_.remaining() + 1 : file_.size() - at_;
    if (element.count > left / least)
      return bad(fmt::format("element {} has {} rows, but there are only {} bytes left",
                             in_quotes(element.name), element.count, left - (is_ascii() ? 1 : 0)));
    if (element.name == "vertex" && element.count >= kNone)
      return fail(ErrorKind::kUnsupported, "more vertices than 32 bits can count");
    return {};
  }

  // --- vertices ---

  Result<void> read_vertices(const Element& element) {
    auto columns = ply::bind_columns(element, mesh_, colors_not_finite_);
    if (!columns) return tl::unexpected(columns.error());
    warn_of_unused(element, *columns);
    if (is_ascii()) return read_vertices_ascii(element, *columns);
    if (element.has_list()) return read_vertices_with_lists(element, *columns);
    read_vertices_of_equal_size(element, *columns);
    return {};
  }

  void warn_of_unused(const Element& element, const std::vector<Column>& columns) {
    constexpr std::size_t kMostNames = 10;
    std::string names;
    std::size_t count = 0;
    auto column = columns.begin();
    for (std::uint32_t p = 0; p < element.properties.size() && element.count > 0; ++p) {
      if (column != columns.end() && column->property == p) {
        ++column;
      } else if (count++ < kMostNames) {
        names += ' ';
        names += in_quotes(element.properties[p].name);
      }
    }
    if (count > 0)
      warnings_.push_back(fmt::format("{} properties of the vertices were dropped:{}{}", count,
                                      names, count > kMostNames ? " ..." : ""));
  }

  void read_vertices_of_equal_size(const Element& element, const std::vector<Column>& columns) {
    const std::size_t row_bytes = element.least_row_bytes();
    std::vector<std::size_t> offsets;
    std::size_t offset = 0;
    for (const Property& property : element.properties) {
      offsets.push_back(offset);
      offset += ply::size_of(property.type);
    }
    // Column by column, in blocks that stay in the cache.
    constexpr std::size_t kBlock = 1024;
    for (std::size_t row = 0; row < element.count; row += kBlock) {
      const std::size_t rows = std::min<std::size_t>(kBlock, element.count - row);
      for (const Column& column : columns)
        ply::decode_column(column, element.properties[column.property].type, header_.encoding,
                           {file_.data() + at_ + row * row_bytes + offsets[column.property],
                            row_bytes, row, rows});
    }
    at_ += element.count * row_bytes;
  }

  Result<void> read_vertices_with_lists(const Element& element,
                                        const std::vector<Column>& columns) {
    for (std::uint64_t row = 0; row < element.count; ++row) {
      auto column = columns.begin();
      for (std::uint32_t p = 0; p < element.properties.size(); ++p) {
        const std::size_t value_at = at_;
        if (!skip_value(element.properties[p])) return ends_in(element, row);
        if (column == columns.end() || column->property != p) continue;
        (column++)->store(row, ply::load_float(element.properties[p].type, header_.encoding,
                                               file_.data() + value_at));
      }
    }
    return {};
  }

  Result<void> read_vertices_ascii(const Element& element, const std::vector<Column>& columns) {
    for (std::uint64_t row = 0; row < element.count; ++row) {
      auto column = columns.begin();
      for (std::uint32_t p = 0; p < element.properties.size(); ++p) {
        if (column == columns.end() || column->property != p) {
          if (auto skipped = skip_text(element, p, row); !skipped) return skipped;
          continue;
        }
        float value = 0;
        text_.skip_space();
        if (!text_.float_here(value)) return bad_token(element, row);
        (column++)->store(row, value);
      }
    }
    return {};
  }

  // --- lists of vertex indices ---

  Result<void> read_lists_ascii(const Element& element, std::uint32_t list, bool is_face) {
    std::vector<std::uint32_t> corners;
    for (std::uint64_t row = 0; row < element.count; ++row) {
      for (std::uint32_t p = 0; p < element.properties.size(); ++p) {
        if (p != list) {
          if (auto skipped = skip_text(element, p, row); !skipped) return skipped;
          continue;
        }
        std::int64_t count = 0;
        text_.skip_space();
        if (!text_.integer_here(count)) return bad_token(element, row);
        corners.clear();
        for (std::int64_t i = 0; i < count; ++i) {
          std::int64_t index = 0;
          text_.skip_space();
          if (!text_.integer_here(index)) return bad_token(element, row);
          if (auto added = add_corner(index, is_face, corners); !added) return added;
        }
        add_list(corners, is_face);
      }
    }
    return {};
  }

  Result<void> read_lists_binary(const Element& element, std::uint32_t list, bool is_face) {
    const Property& property = element.properties[list];
    const std::size_t index_bytes = ply::size_of(property.type);
    if (is_face) mesh_.indices.reserve(std::min<std::uint64_t>(3 * element.count, file_.size()));
    std::vector<std::uint32_t> corners;
    const bool is_usual = is_face && element.properties.size() == 1 && index_bytes == 4 &&
                          ply::size_of(property.count_type) == 1;
    for (std::uint64_t row = 0; row < element.count; ++row) {
      if (is_usual) row += read_triangles(element.count - row);
      if (row == element.count) break;
      for (std::uint32_t p = 0; p < element.properties.size(); ++p) {
        const std::size_t value_at = at_;
        if (!skip_value(element.properties[p])) return ends_in(element, row);
        if (p != list) continue;
        corners.clear();
        for (std::size_t from = value_at + ply::size_of(property.count_type); from < at_;
             from += index_bytes) {
          const std::int64_t index =
              ply::load_integer(property.type, header_.encoding, file_.data() + from);
          if (auto added = add_corner(index, is_face, corners); !added) return added;
        }
        add_list(corners, is_face);
      }
    }
    return {};
  }

  /// The usual row: a 1-byte count, which is 3, and three 4-byte indices. Reads at most `rows` of
  /// these, up to the first that is otherwise, and returns their number.
  std::uint64_t read_triangles(std::uint64_t rows) {
    return header_.encoding == Encoding::kBinaryBig
               ? read_triangles_of_order<std::endian::big>(rows)
               : read_triangles_of_order<std::endian::little>(rows);
  }
  template <std::endian kOrder>
  std::uint64_t read_triangles_of_order(std::uint64_t rows) {
    constexpr std::size_t kRowBytes = 13;
    const std::byte* from = file_.data() + at_;
    rows = std::min<std::uint64_t>(rows, (file_.size() - at_) / kRowBytes);
    std::uint64_t row = 0;
    for (; row < rows && *from == std::byte{3}; ++row, from += kRowBytes) {
      const std::array<std::uint32_t, 3> corners{load<std::uint32_t, kOrder>(from + 1),
                                                 load<std::uint32_t, kOrder>(from + 5),
                                                 load<std::uint32_t, kOrder>(from + 9)};
      if (std::max({corners[0], corners[1], corners[2]}) >= vertex_count_) break;
      mesh_.indices.insert(mesh_.indices.end(), corners.begin(), corners.end());
    }
    at_ += row * kRowBytes;
    return row;
  }

  Result<void> add_corner(std::int64_t index, bool is_face, std::vector<std::uint32_t>& corners) {
    const bool ends_strip = index == -1 && !is_face;
    if (!ends_strip && (index < 0 || static_cast<std::uint64_t>(index) >= vertex_count_))
      return bad(
          fmt::format("vertex index {} is out of range ({} vertices)", index, vertex_count_));
    corners.push_back(ends_strip ? kNone : static_cast<std::uint32_t>(index));
    return {};
  }

  void add_list(const std::vector<std::uint32_t>& corners, bool is_face) {
    if (!is_face)
      add_strips(corners);
    else if (corners.size() < 3)
      polygons_.drop();
    else
      polygons_.add(corners);
  }

  void add_strips(const std::vector<std::uint32_t>& strip) {
    std::size_t first = 0;  // of the current strip
    for (std::size_t i = 0; i < strip.size(); ++i) {
      if (strip[i] == kNone) first = i + 1;
      if (i < first + 2) continue;
      std::uint32_t a = strip[i - 2];
      std::uint32_t b = strip[i - 1];
      if ((i - first) % 2 == 1) std::swap(a, b);
      if (a != b && b != strip[i] && strip[i] != a)
        mesh_.indices.insert(mesh_.indices.end(), {a, b, strip[i]});
    }
  }

  // --- what is not wanted ---

  Result<void> skip_rows(const Element& element) {
    if (element.properties.empty()) return {};
    if (!is_ascii() && !element.has_list()) {
      at_ += element.count * element.least_row_bytes();
      return {};
    }
    for (std::uint64_t row = 0; row < element.count; ++row) {
      for (std::uint32_t p = 0; p < element.properties.size(); ++p) {
        if (is_ascii()) {
          if (auto skipped = skip_text(element, p, row); !skipped) return skipped;
        } else if (!skip_value(element.properties[p])) {
          return ends_in(element, row);
        }
      }
    }
    return {};
  }

  /// Moves over a binary value or list; false, without moving, where the file ends before.
  bool skip_value(const Property& property) {
    const std::size_t left = file_.size() - at_;
    const std::size_t bytes = ply::size_of(property.type);
    if (!property.is_list) {
      if (bytes > left) return false;
      at_ += bytes;
      return true;
    }
    const std::size_t count_bytes = ply::size_of(property.count_type);
    if (count_bytes > left) return false;
    const std::int64_t count =
        ply::load_integer(property.count_type, header_.encoding, file_.data() + at_);
    const auto items = static_cast<std::uint64_t>(std::max<std::int64_t>(count, 0));
    if (items > (left - count_bytes) / bytes) return false;
    at_ += count_bytes + items * bytes;
    return true;
  }

  Result<void> skip_text(const Element& element, std::uint32_t property, std::uint64_t row) {
    std::int64_t items = 1;
    if (element.properties[property].is_list) {
      text_.skip_space();
      if (!text_.integer_here(items)) return bad_token(element, row);
    }
    for (std::int64_t i = 0; i < items; ++i)
      if (text_.token().empty()) return ends_in(element, row);
    return {};
  }

  tl::unexpected<Error> bad_token(const Element& element, std::uint64_t row) {
    if (text_.at_end()) return ends_in(element, row);
    TextScanner rest = text_;
    return bad("expected a number instead of " + in_quotes(rest.token()));
  }

  // --- the end ---

  Result<ImportedMesh> finish() {
    text_.skip_space();
    const std::size_t left = is_ascii() ? text_.remaining() : file_.size() - at_;
    if (left > 0) warnings_.push_back(fmt::format("{} bytes after the last element", left));
    if (auto checked = check_positions(mesh_); !checked) return tl::unexpected(checked.error());
    if (faces_ == FaceReading::kForUse) polygons_.cut_concave();
    if (!header_.texture_file.empty() && mesh_.has_texcoords()) add_texture();
    ImportedMesh imported;
    imported.warnings = std::move(warnings_);
    warn_count(imported, colors_not_finite_, "components of colours that are not finite became 0");
    polygons_.warn(imported);
    imported.mesh = std::move(mesh_);
    return finish_import(std::move(imported));
  }

  /// Images begin at the lower left for PLY's programs, at the upper left in TriangleMesh.
  void add_texture() {
    for (Vec2& texcoord : mesh_.texcoords) texcoord.y = 1 - texcoord.y;
    Image image;
    image.uri = header_.texture_file;
    mesh_.images.push_back(std::move(image));
    Material material;
    material.textures[static_cast<std::size_t>(TextureUse::kBaseColor)] = 0;
    mesh_.materials.push_back(std::move(material));
    if (!mesh_.indices.empty()) mesh_.ranges.push_back({0, 0, mesh_.triangle_count()});
  }

  const ply::Header& header_;
  std::span<const std::byte> file_;
  FaceReading faces_;
  std::size_t at_;    ///< in binary files
  TextScanner text_;  ///< in ASCII files
  std::uint64_t vertex_count_ = 0;
  TriangleMesh mesh_;
  PolygonCollector polygons_{mesh_};
  std::vector<std::string> warnings_;
  std::size_t colors_not_finite_ = 0;
};

}  // namespace

Result<ImportedMesh> read_ply(std::span<const std::byte> file, FaceReading faces) {
  auto header = ply::read_header(as_text(file));
  if (!header) return tl::unexpected(header.error());
  return BodyReader(*header, file, faces).read();
}

}  // namespace varifold
