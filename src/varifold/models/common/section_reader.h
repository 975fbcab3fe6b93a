// Taking numbers off the front of a span of bytes that nobody has checked yet.
#pragma once

#include <varifold/base/bytes.h>
#include <varifold/base/result.h>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace varifold {

/// After the first value that is not there, good() is false and all further values are zero or
/// empty; nothing is allocated beyond what the bytes can hold.
class SectionReader {
 public:
  /// `offset`: where the section stands in the whole, for messages.
  explicit SectionReader(std::span<const std::byte> bytes, std::size_t offset = 0)
      : bytes_(bytes), offset_(offset) {}

  template <class T>
  T take() {
    if (!has(sizeof(T))) return T{};
    const T value = load<T>(bytes_.data() + at_);
    at_ += sizeof(T);
    return value;
  }
  std::span<const std::byte> take_bytes(std::uint64_t count) {
    if (!has(count)) return {};
    const auto taken = bytes_.subspan(at_, static_cast<std::size_t>(count));
    at_ += static_cast<std::size_t>(count);
    return taken;
  }
  std::string_view take_string() { return as_text(take_bytes(take<std::uint32_t>())); }

  /// A number of elements that take at least `least_size` bytes each; 0 where there is no room.
  std::uint32_t take_count(std::size_t least_size) {
    const auto count = take<std::uint32_t>();
    return has(std::uint64_t{count} * least_size) ? count : 0;
  }
  /// `count` numbers in a row.
  template <class T>
  std::vector<T> take_array(std::uint64_t count) {
    std::vector<T> values;
    if (!has(count * sizeof(T))) return values;
    values.resize(static_cast<std::size_t>(count));
    for (T& value : values) value = take<T>();
    return values;
  }
  /// For values that are there but mean nothing.
  void fail_here() { good_ = false; }
  [[nodiscard]] bool good() const { return good_; }
  [[nodiscard]] bool at_end() const { return at_ == bytes_.size(); }
  [[nodiscard]] std::size_t position() const { return offset_ + at_; }
  [[nodiscard]] std::size_t remaining() const { return bytes_.size() - at_; }
  [[nodiscard]] tl::unexpected<Error> fault(const std::string& what) const {
    return fail(ErrorKind::kInvalidInput, "byte " + std::to_string(position()) + ": " + what);
  }

 private:
  bool has(std::uint64_t count) {
    if (good_ && count > bytes_.size() - at_) good_ = false;
    return good_;
  }

  std::span<const std::byte> bytes_;
  std::size_t offset_;
  std::size_t at_ = 0;
  bool good_ = true;
};

/// The components of a vector.
template <class V>
inline void take_vector(SectionReader& section, V& values, int count) {
  for (int i = 0; i < count; ++i) values[i] = section.take<std::decay_t<decltype(values[i])>>();
}
template <class V>
inline void append_vector(std::vector<std::byte>& bytes, const V& values, int count) {
  for (int i = 0; i < count; ++i) append_little(bytes, values[i]);
}

/// The other direction: `values` in a row, little-endian.
template <class T>
inline void append_array(std::vector<std::byte>& bytes, std::span<const T> values) {
  bytes.reserve(bytes.size() + values.size_bytes());
  for (const T value : values) append_little(bytes, value);
}

}  // namespace varifold
