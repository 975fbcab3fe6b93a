#include <varifold/io/ply_header.h>

#include <fmt/format.h>
#include <varifold/base/math.h>
#include <varifold/io/import_check.h>
#include <varifold/io/text_scanner.h>
#include <algorithm>
#include <array>
#include <charconv>

namespace varifold::ply {
namespace {

/// Names are compared with all earlier ones; no honest file has this many.
constexpr std::size_t kMostNames = 1000;

struct TypeName {
  std::string_view name;
  Type type;
};
constexpr std::array<TypeName, 16> kTypeNames{{
    {"char", Type::kInt8},
    {"int8", Type::kInt8},
    {"uchar", Type::kUint8},
    {"uint8", Type::kUint8},
    {"short", Type::kInt16},
    {"int16", Type::kInt16},
    {"ushort", Type::kUint16},
    {"uint16", Type::kUint16},
    {"int", Type::kInt32},
    {"int32", Type::kInt32},
    {"uint", Type::kUint32},
    {"uint32", Type::kUint32},
    {"float", Type::kFloat32},
    {"float32", Type::kFloat32},
    {"double", Type::kFloat64},
    {"float64", Type::kFloat64},
}};

/// Reads one header line after the other into a Header.
class HeaderParser {
 public:
  explicit HeaderParser(std::string_view file) : file_(file), text_(file) {}

  Result<Header> parse() {
    if (TextScanner(next_line()).token() != "ply") return bad("does not begin with 'ply'");
    const bool ends_with_return = file_[text_.position() - 1] == '\r';
    bool has_encoding = false;
    while (!text_.at_end()) {
      TextScanner line(next_line());
      const std::string_view word = line.token();
      if (word == "end_header") {
        if (!has_encoding) return bad("no 'format' line before 'end_header'");
        return finish(ends_with_return);
      }
      has_encoding = has_encoding || word == "format";
      if (auto read = read_line(word, line); !read) return tl::unexpected(read.error());
    }
    return bad("the file ends inside the header (no 'end_header')");
  }

 private:
  std::string_view next_line() {
    ++line_number_;
    return text_.line();
  }
  [[nodiscard]] tl::unexpected<Error> bad(std::string_view fault) const {
    return fail(ErrorKind::kInvalidInput, fmt::format("line {}: {}", line_number_, fault));
  }

  /// In a file of lines that end with CR alone, an LF after the header belongs to the body.
  Header finish(bool ends_with_return) {
    header_.body = text_.position();
    if (ends_with_return && file_[header_.body - 1] == '\n') --header_.body;
    return std::move(header_);
  }

  Result<void> read_line(std::string_view word, TextScanner& line) {
    if (word == "format") return read_format(line);
    if (word == "element") return read_element(line);
    if (word == "property") return read_property(line);
    if (word == "comment") {
      if (line.token() == "TextureFile") {
        line.skip_space();
        header_.texture_file = std::string(line.line());
      }
      return {};
    }
    if (word == "obj_info" || word.empty()) return {};
    return bad("unknown keyword " + in_quotes(word));
  }

  Result<void> read_format(TextScanner& line) {
    const std::string_view name = line.token();
    if (name == "ascii") {
      header_.encoding = Encoding::kAscii;
    } else if (name == "binary_little_endian") {
      header_.encoding = Encoding::kBinaryLittle;
    } else if (name == "binary_big_endian") {
      header_.encoding = Encoding::kBinaryBig;
    } else {
      return bad("unknown format " + in_quotes(name));
    }
    const std::string_view version = line.token();
    if (version != "1.0") return bad("unknown version " + in_quotes(version));
    return {};
  }

  Result<void> read_element(TextScanner& line) {
    Element element;
    element.name = std::string(line.token());
    const std::string_view count = line.token();
    const auto [last, error] =
        std::from_chars(count.data(), count.data() + count.size(), element.count);
    if (element.name.empty() || error != std::errc() || last != count.data() + count.size())
      return bad("'element' needs a name and a count");
    if (header_.elements.size() == kMostNames) return bad("too many elements");
    for (const Element& other : header_.elements)
      if (other.name == element.name) return bad("element " + in_quotes(element.name) + " twice");
    header_.elements.push_back(std::move(element));
    return {};
  }

  Result<void> read_property(TextScanner& line) {
    if (header_.elements.empty()) return bad("'property' before any 'element'");
    Property property;
    std::string_view word = line.token();
    if (word == "list") {
      property.is_list = true;
      if (auto read = read_type(line.token(), property.count_type); !read) return read;
      if (is_float(property.count_type)) return bad("the count of a list must be a whole number");
      word = line.token();
    }
    if (auto read = read_type(word, property.type); !read) return read;
    property.name = std::string(line.token());
    if (property.name.empty()) return bad("'property' needs a name");
    Element& element = header_.elements.back();
    if (element.properties.size() == kMostNames) return bad("too many properties");
    if (element.find(property.name) != kNone)
      return bad("property " + in_quotes(property.name) + " twice");
    element.properties.push_back(std::move(property));
    return {};
  }

  Result<void> read_type(std::string_view word, Type& type) const {
    const auto* const found =
        std::find_if(kTypeNames.begin(), kTypeNames.end(),
                     [&](const TypeName& candidate) { return candidate.name == word; });
    if (found == kTypeNames.end()) return bad("unknown type " + in_quotes(word));
    type = found->type;
    return {};
  }

  std::string_view file_;
  TextScanner text_;
  Header header_;
  std::size_t line_number_ = 0;
};

}  // namespace

std::size_t size_of(Type type) {
  constexpr std::array<std::size_t, 8> kSizes{1, 1, 2, 2, 4, 4, 4, 8};
  return kSizes[static_cast<std::size_t>(type)];
}

std::size_t Element::least_row_bytes() const {
  std::size_t bytes = 0;
  for (const Property& property : properties)
    bytes += size_of(property.is_list ? property.count_type : property.type);
  return bytes;
}

bool Element::has_list() const {
  return std::any_of(properties.begin(), properties.end(),
                     [](const Property& property) { return property.is_list; });
}

std::uint32_t Element::find(std::string_view name_of_property) const {
  for (std::uint32_t i = 0; i < properties.size(); ++i)
    if (properties[i].name == name_of_property) return i;
  return kNone;
}

Result<Header> read_header(std::string_view file) { return HeaderParser(file).parse(); }

}  // namespace varifold::ply
