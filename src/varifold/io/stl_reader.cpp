#include <fmt/format.h>
#include <varifold/base/bytes.h>
#include <varifold/io/import_check.h>
#include <varifold/io/polygon.h>
#include <varifold/io/stl.h>
#include <varifold/io/text_scanner.h>
#include <varifold/mesh/weld.h>
#include <array>
#include <cctype>
#include <cmath>

namespace varifold {
namespace {

constexpr std::size_t kHeaderBytes = 84;  // 80 of any text and the number of triangles
constexpr std::size_t kFacetBytes = 50;   // normal, three corners, two attribute bytes

bool is_finite(const Vec3& p) {
  return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z);
}

bool starts_with_word(std::string_view text, std::string_view word) {
  if (text.size() < word.size()) return false;
  for (std::size_t i = 0; i < word.size(); ++i)
    if (std::tolower(static_cast<unsigned char>(text[i])) != word[i]) return false;
  return true;
}

/// Makes one vertex of all corners at one place.
void weld_corners(TriangleMesh& mesh) {
  const WeldMap weld = weld_exact(mesh.positions);
  std::vector<Vec3> welded(weld.class_count);
  // Backwards, so that the first corner of a class has the last word (0 and -0 are one place).
  for (std::size_t v = mesh.positions.size(); v-- > 0;)
    welded[weld.class_of[v]] = mesh.positions[v];
  for (std::uint32_t& index : mesh.indices) index = weld.class_of[index];
  mesh.positions = std::move(welded);
}

Result<ImportedMesh> read_binary(std::span<const std::byte> file) {
  if (file.size() < kHeaderBytes)
    return fail(ErrorKind::kInvalidInput,
                fmt::format("byte {}: the file ends in the header", file.size()));
  const std::uint64_t count = load<std::uint32_t>(file.data() + 80);
  const std::size_t there = (file.size() - kHeaderBytes) / kFacetBytes;
  if (count > there)
    return fail(
        ErrorKind::kInvalidInput,
        fmt::format("byte 80: {} facets are announced, but the file ends after {}", count, there));
  if (3 * count >= kNone)
    return fail(ErrorKind::kUnsupported, "more corners than 32 bits can count");

  ImportedMesh imported;
  TriangleMesh& mesh = imported.mesh;
  mesh.positions.resize(3 * count);
  mesh.indices.resize(3 * count);
  std::size_t with_attributes = 0;
  for (std::size_t facet = 0; facet < count; ++facet) {
    const std::byte* from = file.data() + kHeaderBytes + facet * kFacetBytes + sizeof(Vec3);
    for (std::size_t corner = 3 * facet; corner < 3 * facet + 3; ++corner, from += sizeof(Vec3)) {
      const Vec3 p(load<float>(from), load<float>(from + 4), load<float>(from + 8));
      if (!is_finite(p))
        return fail(ErrorKind::kInvalidInput,
                    fmt::format("facet {}: position is not finite", facet));
      mesh.positions[corner] = p;
      mesh.indices[corner] = static_cast<std::uint32_t>(corner);
    }
    with_attributes += load<std::uint16_t>(from) != 0 ? 1 : 0;
  }
  warn_count(imported, with_attributes, "facets have attribute bytes, which were dropped");
  warn_count(imported, file.size() - kHeaderBytes - count * kFacetBytes,
             "bytes after the last facet");
  weld_corners(mesh);
  return finish_import(std::move(imported));
}

/// Reads "facet normal ... outer loop vertex ... endloop endfacet", in any case of letters.
class AsciiReader {
 public:
  explicit AsciiReader(std::string_view text) : text_(text) {}

  Result<ImportedMesh> read() {
    for (std::string_view word = next_word(); !word.empty(); word = next_word()) {
      if (is(word, "solid") || is(word, "endsolid")) {
        is_open_ = is(word, "solid");
        text_.line();
      } else if (is(word, "facet")) {
        if (auto done = read_facet(); !done) return tl::unexpected(done.error());
      } else {
        return unexpected(word);
      }
    }
    ImportedMesh imported;
    if (is_open_) imported.warnings.emplace_back("no 'endsolid' at the end");
    polygons_.cut_concave();
    polygons_.warn(imported);
    weld_corners(mesh_);
    imported.mesh = std::move(mesh_);
    return finish_import(std::move(imported));
  }

 private:
  std::string_view next_word() {
    text_.skip_space();
    word_at_ = text_.position();
    return text_.token();
  }
  static bool is(std::string_view word, std::string_view keyword) {
    return word.size() == keyword.size() && starts_with_word(word, keyword);
  }
  [[nodiscard]] tl::unexpected<Error> bad(const std::string& fault) const {
    return fail(ErrorKind::kInvalidInput,
                fmt::format("line {}: {}", text_.line_of(word_at_), fault));
  }
  [[nodiscard]] tl::unexpected<Error> unexpected(std::string_view word) const {
    if (word.empty()) return bad("the file ends inside a facet");
    return bad("unexpected " + in_quotes(word));
  }

  Result<void> expect(std::string_view keyword) {
    const std::string_view word = next_word();
    if (!is(word, keyword)) return unexpected(word);
    return {};
  }

  Result<void> read_facet() {
    if (auto done = expect("normal"); !done) return done;
    // The normal is not used, so that it may be anything.
    for (int i = 0; i < 3; ++i)
      if (const auto word = next_word(); word.empty()) return unexpected(word);
    if (auto done = expect("outer"); !done) return done;
    if (auto done = expect("loop"); !done) return done;

    corners_.clear();
    std::string_view word = next_word();
    for (; is(word, "vertex"); word = next_word())
      if (auto done = read_corner(); !done) return done;
    if (!is(word, "endloop")) return unexpected(word);
    if (corners_.size() < 3)
      polygons_.drop();
    else
      polygons_.add(corners_);
    return expect("endfacet");
  }

  Result<void> read_corner() {
    std::array<float, 3> p{};
    for (float& coordinate : p) {
      text_.skip_space();
      word_at_ = text_.position();
      if (text_.float_here(coordinate)) continue;
      TextScanner ahead = text_;
      const std::string_view word = ahead.token();
      if (word.empty()) return unexpected(word);
      return bad("expected a number instead of " + in_quotes(word));
    }
    const Vec3 position(p[0], p[1], p[2]);
    if (!is_finite(position)) return bad("position is not finite");
    if (mesh_.positions.size() >= kNone - 1)
      return fail(ErrorKind::kUnsupported, "more corners than 32 bits can count");
    corners_.push_back(mesh_.vertex_count());
    mesh_.positions.push_back(position);
    return {};
  }

  TextScanner text_;
  std::size_t word_at_ = 0;
  bool is_open_ = false;
  TriangleMesh mesh_;
  PolygonCollector polygons_{mesh_};
  std::vector<std::uint32_t> corners_;
};

}  // namespace

bool has_binary_stl_size(std::span<const std::byte> file) {
  if (file.size() < kHeaderBytes) return false;
  const std::uint64_t count = load<std::uint32_t>(file.data() + 80);
  return file.size() == kHeaderBytes + kFacetBytes * count;
}

Result<ImportedMesh> read_stl(std::span<const std::byte> file) {
  std::string_view text = as_text(file);
  if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
  text.remove_prefix(std::min(text.find_first_not_of(" \t\r\n"), text.size()));
  const bool is_text =
      starts_with_word(text, "solid") && text.substr(0, 512).find('\0') == std::string_view::npos;
  if (has_binary_stl_size(file) || !is_text) return read_binary(file);
  return AsciiReader(as_text(file)).read();
}

}  // namespace varifold
