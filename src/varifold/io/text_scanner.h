// A cursor over text: tokens and numbers, and the line where it stands.
#pragma once

#include <fast_float/fast_float.h>
#include <algorithm>
#include <charconv>
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace varifold {

/// Reads tokens that are separated by blanks. Lines end with LF, CRLF or CR. Never reads past the
/// text. Numbers are read as the "C" locale writes them, correctly rounded; a leading plus sign,
/// "nan" and "inf" are allowed in floats.
class TextScanner {
 public:
  explicit TextScanner(std::string_view text)
      : begin_(text.data()), at_(text.data()), end_(text.data() + text.size()) {}

  [[nodiscard]] bool at_end() const { return at_ == end_; }
  [[nodiscard]] char peek() const { return at_ == end_ ? '\0' : *at_; }
  [[nodiscard]] std::size_t position() const { return static_cast<std::size_t>(at_ - begin_); }
  [[nodiscard]] std::size_t remaining() const { return static_cast<std::size_t>(end_ - at_); }
  void advance(std::size_t count) { at_ += std::min(count, remaining()); }

  static bool is_line_end(char c) { return c == '\n' || c == '\r'; }
  static bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\v' || c == '\f'; }
  static bool is_space(char c) { return is_blank(c) || is_line_end(c); }

  void skip_blanks() {
    while (at_ != end_ && is_blank(*at_)) ++at_;
  }
  void skip_space() {
    while (at_ != end_ && is_space(*at_)) ++at_;
  }

  /// The characters up to the next space, after any space; empty at the end of the text.
  std::string_view token() {
    skip_space();
    return token_here();
  }
  /// The same within the line: empty at its end.
  std::string_view token_in_line() {
    skip_blanks();
    return token_here();
  }

  /// The rest of the line without its end, and moves to the next line.
  std::string_view line() {
    const char* const first = at_;
    while (at_ != end_ && !is_line_end(*at_)) ++at_;
    const std::string_view result(first, static_cast<std::size_t>(at_ - first));
    if (at_ != end_ && *at_++ == '\r' && at_ != end_ && *at_ == '\n') ++at_;
    return result;
  }

  /// Reads a float that stands right here and ends at a space or the end of the text. Too large
  /// numbers become infinite. On failure the cursor stays.
  bool float_here(float& value) {
    const char* const first = at_ != end_ && *at_ == '+' ? at_ + 1 : at_;
    const auto [last, error] = fast_float::from_chars(first, end_, value);
    if (error == std::errc::invalid_argument || (last != end_ && !is_space(*last))) return false;
    at_ = last;
    return true;
  }
  /// Reads a whole number that stands right here and ends at a space or the end of the text.
  bool integer_here(std::int64_t& value) {
    const char* const first = at_ != end_ && *at_ == '+' ? at_ + 1 : at_;
    const auto [last, error] = std::from_chars(first, end_, value);
    if (error != std::errc() || (last != end_ && !is_space(*last))) return false;
    at_ = last;
    return true;
  }

  /// Reads a whole number that stands right here, whatever follows it.
  bool digits_here(std::int64_t& value) {
    const auto [last, error] = std::from_chars(at_, end_, value);
    if (error != std::errc()) return false;
    at_ = last;
    return true;
  }

  /// The number of the line of a position, from 1. O(position): for messages.
  [[nodiscard]] std::size_t line_of(std::size_t position) const {
    std::size_t count = 1;
    for (const char* c = begin_; c != begin_ + position; ++c)
      if (*c == '\n' || (*c == '\r' && (c + 1 == end_ || c[1] != '\n'))) ++count;
    return count;
  }

 private:
  std::string_view token_here() {
    const char* const first = at_;
    while (at_ != end_ && !is_space(*at_)) ++at_;
    return {first, static_cast<std::size_t>(at_ - first)};
  }

  const char* begin_;
  const char* at_;
  const char* end_;
};

}  // namespace varifold
