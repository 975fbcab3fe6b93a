#include <apps/cli/report.h>
#include <fmt/format.h>
#include <algorithm>
#include <array>

namespace varifold::cli {

std::string format_count(std::uint64_t count) {
  const std::string digits = std::to_string(count);
  std::string text;
  for (std::size_t i = 0; i < digits.size(); ++i) {
    if (i > 0 && (digits.size() - i) % 3 == 0) text += ',';
    text += digits[i];
  }
  return text;
}

std::string format_bytes(std::uint64_t bytes) {
  constexpr std::array<const char*, 5> kUnits{"B", "kB", "MB", "GB", "TB"};
  if (bytes < 1000) return fmt::format("{} B", bytes);
  auto value = static_cast<double>(bytes);
  std::size_t unit = 0;
  while (value >= 999.5 && unit + 1 < kUnits.size()) {
    value /= 1000;
    ++unit;
  }
  return fmt::format("{:.3g} {}", value, kUnits[unit]);
}

std::string format_number(double value) { return fmt::format("{:.4g}", value); }

std::string format_seconds(double seconds) { return fmt::format("{:.3f} s", seconds); }

void Report::count(const std::string& key, const std::string& label, std::uint64_t value) {
  set(key, value);
  row(label, format_count(value));
}

void Report::bytes(const std::string& key, const std::string& label, std::uint64_t value) {
  set(key, value);
  row(label, format_bytes(value));
}

void Report::length(const std::string& key, const std::string& label, double value) {
  set(key, value);
  row(label, format_number(value));
}

void Report::seconds(const std::string& key, const std::string& label, double value) {
  set(key, value);
  row(label, format_seconds(value));
}

void Report::text(const std::string& key, const std::string& label, const std::string& value) {
  set(key, value);
  row(label, value);
}

bool Report::print(bool json, std::FILE* out) const {
  if (json) return print_json(values_, out);
  std::size_t width = 0;
  for (const auto& [label, text] : rows_) width = std::max(width, label.size());
  for (const auto& [label, text] : rows_) {
    const std::string line = fmt::format("{:<{}}  {}\n", label, width, text);
    if (std::fwrite(line.data(), 1, line.size(), out) != line.size()) return false;
  }
  return std::fflush(out) == 0;
}

bool print_json(const Json& value, std::FILE* out) {
  const std::string text = value.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n";
  return std::fwrite(text.data(), 1, text.size(), out) == text.size() && std::fflush(out) == 0;
}

}  // namespace varifold::cli
