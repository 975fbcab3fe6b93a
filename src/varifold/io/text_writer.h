// Appends text and numbers to a byte buffer.
#pragma once

#include <varifold/base/bytes.h>
#include <array>
#include <charconv>
#include <cstddef>
#include <string_view>
#include <vector>

namespace varifold {

/// Numbers are written as the "C" locale does; floats with the fewest digits that read back as the
/// same float.
class TextWriter {
 public:
  template <class... Parts>
  void write(const Parts&... parts) {
    (append(parts), ...);
  }
  [[nodiscard]] std::vector<std::byte> take() { return std::move(bytes_); }

 private:
  void append(std::string_view text) { append_text(bytes_, text); }
  void append(const std::string& text) { append_text(bytes_, text); }
  void append(const char* text) { append_text(bytes_, text); }
  void append(char c) { bytes_.push_back(static_cast<std::byte>(c)); }
  template <class Number>
  void append(Number number) {
    std::array<char, 32> digits{};
    const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), number).ptr;
    append_text(bytes_, {digits.data(), static_cast<std::size_t>(end - digits.data())});
  }

  std::vector<std::byte> bytes_;
};

}  // namespace varifold
