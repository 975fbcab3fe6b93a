#include <varifold/io/json_element.h>

#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

namespace varifold {
namespace {

using nlohmann::json;

constexpr std::uint64_t kLargestWhole = std::uint64_t{1} << 53;

/// Accepts everything and remembers where the parser gave up.
class FaultFinder : public nlohmann::json_sax<json> {
 public:
  bool null() override { return true; }
  bool boolean(bool /*value*/) override { return true; }
  bool number_integer(number_integer_t /*value*/) override { return true; }
  bool number_unsigned(number_unsigned_t /*value*/) override { return true; }
  bool number_float(number_float_t /*value*/, const string_t& /*text*/) override { return true; }
  bool string(string_t& /*value*/) override { return true; }
  bool binary(binary_t& /*value*/) override { return true; }
  bool start_object(std::size_t /*size*/) override { return true; }
  bool key(string_t& /*name*/) override { return true; }
  bool end_object() override { return true; }
  bool start_array(std::size_t /*size*/) override { return true; }
  bool end_array() override { return true; }
  bool parse_error(std::size_t at, const std::string& /*token*/,
                   const nlohmann::detail::exception& /*fault*/) override {
    position = at;
    return false;
  }
  std::size_t position = 0;
};

/// The position of the bracket that opens the level after kMostLevels, or npos. Every level costs
/// the parser far more memory than its byte, and no honest file has many.
std::size_t find_too_deep(std::string_view text) {
  constexpr std::size_t kMostLevels = 1000;
  std::size_t level = 0;
  bool in_string = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (c == '"') {
      in_string = !in_string;
    } else if (in_string) {
      if (c == '\\') ++i;
    } else if (c == '[' || c == '{') {
      if (++level > kMostLevels) return i;
    } else if (c == ']' || c == '}') {
      level -= level > 0 ? 1 : 0;
    }
  }
  return std::string_view::npos;
}

tl::unexpected<Error> bad_json(std::string_view text, std::size_t position,
                               std::string_view fault) {
  position = std::min(position, text.size());
  const auto lines =
      std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(position), '\n');
  return fail(ErrorKind::kInvalidInput,
              fmt::format("line {}, byte {}: {}", lines + 1, position, fault));
}

}  // namespace

const json* JsonElement::find(std::string_view key) const {
  if (!value_ || !value_->is_object()) return nullptr;
  const auto found = value_->find(key);
  return found == value_->end() ? nullptr : &*found;
}

std::string JsonElement::path_of(std::string_view key) const {
  std::string path = path_;
  if (!path.empty()) path += '.';
  return path += key;
}

void JsonElement::fault_at(const std::string& path, std::string_view what) const {
  faults_->set(ErrorKind::kInvalidInput, fmt::format("{}: {}", path, what));
}

void JsonElement::fault(const std::string& what, ErrorKind kind) const {
  faults_->set(kind, path_.empty() ? what : path_ + ": " + what);
}

JsonElement JsonElement::object(std::string_view key) const {
  const json* value = find(key);
  std::string path = path_of(key);
  if (value && !value->is_object()) {
    fault_at(path, "not an object");
    value = nullptr;
  }
  return {value, std::move(path), *faults_};
}

JsonElement JsonElement::array(std::string_view key) const {
  const json* value = find(key);
  std::string path = path_of(key);
  if (value && !value->is_array()) {
    fault_at(path, "not an array");
    value = nullptr;
  }
  return {value, std::move(path), *faults_};
}

JsonElement JsonElement::object_if(std::string_view key) const {
  const json* value = find(key);
  return {value && value->is_object() ? value : nullptr, path_of(key), *faults_};
}

std::vector<std::string> JsonElement::texts_if(std::string_view key) const {
  const json* const value = find(key);
  if (!value || !value->is_array()) return {};
  std::vector<std::string> texts;
  for (const json& item : *value) {
    if (!item.is_string()) return {};
    texts.push_back(item.get<std::string>());
  }
  return texts;
}

std::size_t JsonElement::size() const { return value_ && value_->is_array() ? value_->size() : 0; }

JsonElement JsonElement::item(std::size_t index) const {
  std::string path = fmt::format("{}[{}]", path_, index);
  const json* value = nullptr;
  if (index >= size()) {
    fault_at(path, fmt::format("no such element (there are {})", size()));
  } else if (!(*value_)[index].is_object()) {
    fault_at(path, "not an object");
  } else {
    value = &(*value_)[index];
  }
  return {value, std::move(path), *faults_};
}

std::uint64_t JsonElement::whole_item(std::size_t index) const {
  const std::string path = fmt::format("{}[{}]", path_, index);
  if (index < size()) return whole_value((*value_)[index], path);
  fault_at(path, "missing");
  return 0;
}

std::string JsonElement::text_item(std::size_t index) const {
  if (index < size() && (*value_)[index].is_string()) return (*value_)[index].get<std::string>();
  fault_at(fmt::format("{}[{}]", path_, index), "not a string");
  return {};
}

std::vector<std::string> JsonElement::keys() const {
  std::vector<std::string> keys;
  if (!value_ || !value_->is_object()) return keys;
  for (auto member = value_->begin(); member != value_->end(); ++member)
    keys.push_back(member.key());
  return keys;
}

std::uint64_t JsonElement::whole_value(const json& value, const std::string& path) const {
  if (value.is_number_unsigned() && value.get<std::uint64_t>() <= kLargestWhole)
    return value.get<std::uint64_t>();
  // Some exporters write whole numbers as 12.0.
  if (value.is_number_float()) {
    const double number = value.get<double>();
    if (number >= 0 && number <= static_cast<double>(kLargestWhole) && std::floor(number) == number)
      return static_cast<std::uint64_t>(number);
  }
  fault_at(path, "not a whole number of at least 0");
  return 0;
}

std::uint64_t JsonElement::whole(std::string_view key) const {
  if (const json* value = find(key)) return whole_value(*value, path_of(key));
  fault_at(path_of(key), "missing");
  return 0;
}

std::uint64_t JsonElement::whole(std::string_view key, std::uint64_t fallback) const {
  const json* const value = find(key);
  return value ? whole_value(*value, path_of(key)) : fallback;
}

double JsonElement::number(std::string_view key, double fallback) const {
  const json* const value = find(key);
  if (!value) return fallback;
  if (value->is_number()) return value->get<double>();
  fault_at(path_of(key), "not a number");
  return fallback;
}

bool JsonElement::boolean(std::string_view key, bool fallback) const {
  const json* const value = find(key);
  if (!value) return fallback;
  if (value->is_boolean()) return value->get<bool>();
  fault_at(path_of(key), "not true or false");
  return fallback;
}

std::string JsonElement::text(std::string_view key, std::string_view fallback) const {
  const json* const value = find(key);
  if (value && value->is_string()) return value->get<std::string>();
  if (value) fault_at(path_of(key), "not a string");
  return std::string(fallback);
}

bool JsonElement::numbers(std::string_view key, std::span<double> numbers) const {
  const json* const value = find(key);
  if (!value) return false;
  const bool fits =
      value->is_array() && value->size() == numbers.size() &&
      std::all_of(value->begin(), value->end(), [](const json& item) { return item.is_number(); });
  if (!fits) {
    fault_at(path_of(key), fmt::format("not an array of {} numbers", numbers.size()));
    return false;
  }
  for (std::size_t i = 0; i < numbers.size(); ++i) numbers[i] = (*value)[i].get<double>();
  return true;
}

Result<json> parse_json(std::string_view text) {
  if (const std::size_t at = find_too_deep(text); at != std::string_view::npos)
    return bad_json(text, at, "the JSON is nested too deeply");
  json parsed = json::parse(text.begin(), text.end(), nullptr, false);
  if (!parsed.is_discarded()) return parsed;
  FaultFinder finder;
  json::sax_parse(text.begin(), text.end(), &finder);
  return bad_json(text, finder.position, "not valid JSON");
}

}  // namespace varifold
