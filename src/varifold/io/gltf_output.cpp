#include <varifold/io/gltf_output.h>

#include <varifold/base/bytes.h>
#include <algorithm>
#include <cmath>
#include <limits>

namespace varifold::gltf {
namespace {

constexpr int kUint8 = 5121;
constexpr int kUint16 = 5123;
constexpr int kUint32 = 5125;
constexpr int kFloat32 = 5126;
constexpr std::uint32_t kJsonChunk = 0x4e4f534a;    // "JSON"
constexpr std::uint32_t kBinaryChunk = 0x004e4942;  // "BIN\0"

void pad(std::vector<std::byte>& bytes, char filler) {
  while (bytes.size() % 4 != 0) bytes.push_back(static_cast<std::byte>(filler));
}

template <class T>
std::vector<std::byte> little(std::span<const T> values) {
  std::vector<std::byte> bytes(values.size_bytes());
  std::byte* at = bytes.data();
  for (const T value : values) {
    store_little(at, value);
    at += sizeof(T);
  }
  return bytes;
}

void append_chunk(std::vector<std::byte>& file, std::uint32_t type,
                  const std::vector<std::byte>& bytes) {
  append_little(file, static_cast<std::uint32_t>(bytes.size()));
  append_little(file, type);
  file.insert(file.end(), bytes.begin(), bytes.end());
}

}  // namespace

float finite_or(float value, float fallback) { return std::isfinite(value) ? value : fallback; }

std::size_t Output::add_view(std::span<const std::byte> bytes, Target target) {
  OutputJson view = {{"buffer", 0}, {"byteOffset", binary_.size()}, {"byteLength", bytes.size()}};
  if (target != Target::kNone) view["target"] = static_cast<int>(target);
  document["bufferViews"].push_back(std::move(view));
  binary_.insert(binary_.end(), bytes.begin(), bytes.end());
  pad(binary_, '\0');
  return document["bufferViews"].size() - 1;
}

std::size_t Output::add_accessor(int component_type, const char* type, std::size_t count,
                                 std::size_t view) {
  document["accessors"].push_back(
      {{"bufferView", view}, {"componentType", component_type}, {"count", count}, {"type", type}});
  return document["accessors"].size() - 1;
}

std::size_t Output::add_floats(std::span<const float> values, const char* type, std::size_t width,
                               Target target) {
  return add_accessor(kFloat32, type, values.size() / width, add_view(little(values), target));
}

std::size_t Output::add_offsets(const std::vector<Vec3>& offsets) {
  std::vector<std::uint32_t> places;
  std::vector<float> values;
  for (std::size_t i = 0; i < offsets.size(); ++i) {
    if (offsets[i] == Vec3(0)) continue;
    places.push_back(static_cast<std::uint32_t>(i));
    values.insert(values.end(), {offsets[i].x, offsets[i].y, offsets[i].z});
  }
  // Four words each instead of three for every vertex.
  if (4 * places.size() >= 3 * offsets.size()) {
    const std::size_t accessor = add_vectors(offsets, "VEC3");
    set_bounds({&offsets[0][0], 3 * offsets.size()}, 3);
    return accessor;
  }
  OutputJson accessor = {{"componentType", kFloat32}, {"count", offsets.size()}, {"type", "VEC3"}};
  if (!places.empty())
    accessor["sparse"] = {
        {"count", places.size()},
        {"indices",
         {{"bufferView", add_view(little<std::uint32_t>(places), Target::kNone)},
          {"componentType", kUint32}}},
        {"values", {{"bufferView", add_view(little<float>(values), Target::kNone)}}}};
  document["accessors"].push_back(std::move(accessor));
  values.insert(values.end(), {0.0f, 0.0f, 0.0f});
  set_bounds(values, 3);
  return document["accessors"].size() - 1;
}

std::size_t Output::add_bytes(std::span<const std::uint8_t> values, const char* type,
                              std::size_t width, bool normalized) {
  const std::size_t accessor = add_accessor(kUint8, type, values.size() / width,
                                            add_view(std::as_bytes(values), Target::kVertices));
  if (normalized) document["accessors"].back()["normalized"] = true;
  return accessor;
}

std::size_t Output::add_shorts(std::span<const std::uint16_t> values, const char* type,
                               std::size_t width) {
  return add_accessor(kUint16, type, values.size() / width,
                      add_view(little(values), Target::kVertices));
}

std::size_t Output::add_indices(std::span<const std::uint32_t> indices, std::size_t vertex_count) {
  if (vertex_count > std::numeric_limits<std::uint16_t>::max())
    return add_accessor(kUint32, "SCALAR", indices.size(),
                        add_view(little(indices), Target::kIndices));
  const std::vector<std::uint16_t> shorts(indices.begin(), indices.end());
  return add_accessor(kUint16, "SCALAR", indices.size(),
                      add_view(little<std::uint16_t>(shorts), Target::kIndices));
}

void Output::set_bounds(std::span<const float> values, std::size_t width) {
  OutputJson& accessor = document["accessors"].back();
  for (std::size_t column = 0; column < width; ++column) {
    float lower = values[column];
    float upper = lower;
    for (std::size_t i = column; i < values.size(); i += width) {
      lower = std::min(lower, values[i]);
      upper = std::max(upper, values[i]);
    }
    accessor["min"].push_back(lower);
    accessor["max"].push_back(upper);
  }
}

Result<std::vector<std::byte>> Output::assemble() {
  if (!binary_.empty()) document["buffers"] = OutputJson::array({{{"byteLength", binary_.size()}}});
  constexpr std::size_t kHeaders = 12 + 8 + 8;
  const std::string text =
      document.dump(-1, ' ', false, OutputJson::error_handler_t::replace);  // never throws
  std::vector<std::byte> json(as_bytes(text).begin(), as_bytes(text).end());
  pad(json, ' ');
  const std::size_t size = kHeaders - (binary_.empty() ? 8 : 0) + json.size() + binary_.size();
  if (size > std::numeric_limits<std::uint32_t>::max())
    return fail(ErrorKind::kFailed, "the file would be longer than the 4 GiB of a GLB");

  std::vector<std::byte> file;
  file.reserve(size);
  append_text(file, "glTF");
  append_little(file, std::uint32_t{2});
  append_little(file, static_cast<std::uint32_t>(size));
  append_chunk(file, kJsonChunk, json);
  if (!binary_.empty()) append_chunk(file, kBinaryChunk, binary_);
  return file;
}

}  // namespace varifold::gltf
