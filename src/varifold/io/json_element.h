// Checked access to JSON of unknown origin: wrong types never throw and never assert.
#pragma once

#include <varifold/base/result.h>
#include <cstddef>
#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace varifold {

/// The first fault that was met; later ones are dropped.
class FirstFault {
 public:
  void set(ErrorKind kind, std::string message) {
    if (!error_) error_ = Error{kind, std::move(message)};
  }
  [[nodiscard]] bool any() const { return error_.has_value(); }
  [[nodiscard]] tl::unexpected<Error> take() { return tl::unexpected<Error>(std::move(*error_)); }

 private:
  std::optional<Error> error_;
};

/// A value of a JSON document together with its place in it, such as "nodes[3].children", or a
/// place where nothing is. Readers take what they expect and go on with the fallback where it is
/// missing or of another type; the latter also notes a fault, kInvalidInput, with the place first.
class JsonElement {
 public:
  JsonElement(const nlohmann::json* value, std::string path, FirstFault& faults)
      : value_(value), path_(std::move(path)), faults_(&faults) {}

  [[nodiscard]] bool exists() const { return value_ != nullptr; }
  [[nodiscard]] bool has(std::string_view key) const { return find(key) != nullptr; }
  [[nodiscard]] const std::string& path() const { return path_; }

  /// The member `key`, which must be an object (an array) where it is present.
  [[nodiscard]] JsonElement object(std::string_view key) const;
  [[nodiscard]] JsonElement array(std::string_view key) const;
  /// Members that may hold anything, such as extras: nothing, without a fault, where it is not an
  /// object (an array of strings).
  [[nodiscard]] JsonElement object_if(std::string_view key) const;
  [[nodiscard]] std::vector<std::string> texts_if(std::string_view key) const;

  /// Of an array: its length, 0 where nothing is; and an item, which must be an object.
  [[nodiscard]] std::size_t size() const;
  [[nodiscard]] JsonElement item(std::size_t index) const;
  /// Items of an array that must be whole numbers >= 0, or strings.
  [[nodiscard]] std::uint64_t whole_item(std::size_t index) const;
  [[nodiscard]] std::string text_item(std::size_t index) const;
  /// The names of the members of an object.
  [[nodiscard]] std::vector<std::string> keys() const;

  /// Members. Whole numbers are >= 0 and at most 2^53; without a fallback they are required.
  [[nodiscard]] std::uint64_t whole(std::string_view key) const;
  [[nodiscard]] std::uint64_t whole(std::string_view key, std::uint64_t fallback) const;
  [[nodiscard]] double number(std::string_view key, double fallback) const;
  [[nodiscard]] bool boolean(std::string_view key, bool fallback) const;
  [[nodiscard]] std::string text(std::string_view key, std::string_view fallback = {}) const;
  /// Exactly numbers.size() numbers, or nothing: then the numbers stay. False where nothing is.
  bool numbers(std::string_view key, std::span<double> numbers) const;

  /// Notes a fault of this element.
  void fault(const std::string& what, ErrorKind kind = ErrorKind::kInvalidInput) const;

 private:
  [[nodiscard]] const nlohmann::json* find(std::string_view key) const;
  [[nodiscard]] std::string path_of(std::string_view key) const;
  [[nodiscard]] std::uint64_t whole_value(const nlohmann::json& value,
                                          const std::string& path) const;
  void fault_at(const std::string& path, std::string_view what) const;

  const nlohmann::json* value_;
  std::string path_;
  FirstFault* faults_;
};

/// Parses a JSON text. Errors: kInvalidInput naming line and byte of the fault.
[[nodiscard]] Result<nlohmann::json> parse_json(std::string_view text);

}  // namespace varifold
