// Base64 (RFC 4648), as data: URIs use it.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace varifold {

/// The bytes of a base64 text of the standard or the URL alphabet, with or without padding; nothing
/// where it has other characters or an impossible length. O(n).
[[nodiscard]] std::optional<std::vector<std::byte>> decode_base64(std::string_view text);

/// The text with every %XX replaced by the byte that it stands for.
[[nodiscard]] std::string decode_percent(std::string_view text);

/// What follows "data:": the media type and the bytes.
struct DataUri {
  std::string media_type;
  std::vector<std::byte> bytes;
};

/// Decodes a data: URI, base64 or percent-encoded; nothing where it is malformed.
[[nodiscard]] std::optional<DataUri> decode_data_uri(std::string_view uri);

}  // namespace varifold
