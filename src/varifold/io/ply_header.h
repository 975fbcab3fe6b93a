// The header of PLY files.
#pragma once

#include <varifold/base/result.h>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace varifold::ply {

enum class Encoding { kAscii, kBinaryLittle, kBinaryBig };
enum class Type { kInt8, kUint8, kInt16, kUint16, kInt32, kUint32, kFloat32, kFloat64 };

[[nodiscard]] std::size_t size_of(Type type);
[[nodiscard]] inline bool is_float(Type type) { return type >= Type::kFloat32; }

struct Property {
  std::string name;
  Type type = Type::kFloat32;  ///< of the value, or of the items of the list
  bool is_list = false;
  Type count_type = Type::kUint8;  ///< of the list's length
};

struct Element {
  std::string name;
  std::uint64_t count = 0;
  std::vector<Property> properties;

  /// The fewest bytes that one row takes in binary: with all lists empty.
  [[nodiscard]] std::size_t least_row_bytes() const;
  [[nodiscard]] bool has_list() const;
  /// The position among the properties, or kNone.
  [[nodiscard]] std::uint32_t find(std::string_view name_of_property) const;
};

struct Header {
  Encoding encoding = Encoding::kAscii;
  std::vector<Element> elements;
  std::string texture_file;  ///< from a comment "TextureFile"; may be empty
  std::size_t body = 0;      ///< position of the first byte after the header
};

/// Errors: kInvalidInput, "line N: ...". Promises nothing about the counts.
[[nodiscard]] Result<Header> read_header(std::string_view file);

}  // namespace varifold::ply
