// What a command tells: one JSON object for scripts, or a short table for people.
#pragma once

#include <cstdint>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

namespace varifold::cli {

using Json = nlohmann::ordered_json;

/// "1,234,567"
[[nodiscard]] std::string format_count(std::uint64_t count);
/// "12.3 MB"
[[nodiscard]] std::string format_bytes(std::uint64_t bytes);
/// Lengths, ratios: four significant digits.
[[nodiscard]] std::string format_number(double value);
/// "0.012 s"
[[nodiscard]] std::string format_seconds(double seconds);

/// Collects keys for scripts and rows for people, in the order of their coming.
class Report {
 public:
  /// For scripts only.
  void set(const std::string& key, Json value) { values_[key] = std::move(value); }
  /// For people only.
  void row(std::string label, std::string text) {
    rows_.emplace_back(std::move(label), std::move(text));
  }
  /// For both, in the usual form of its sort.
  void count(const std::string& key, const std::string& label, std::uint64_t value);
  void bytes(const std::string& key, const std::string& label, std::uint64_t value);
  void length(const std::string& key, const std::string& label, double value);
  void seconds(const std::string& key, const std::string& label, double value);
  void text(const std::string& key, const std::string& label, const std::string& value);

  [[nodiscard]] const Json& values() const { return values_; }
  /// Writes the one or the other form; false where the output does not take it.
  [[nodiscard]] bool print(bool json, std::FILE* out) const;

 private:
  Json values_ = Json::object();
  std::vector<std::pair<std::string, std::string>> rows_;
};

/// Writes a JSON object on a line of its own. Bytes that are no UTF-8 are replaced.
[[nodiscard]] bool print_json(const Json& value, std::FILE* out);

}  // namespace varifold::cli
