#include <varifold/io/gltf_buffers.h>

#include <fmt/format.h>
#include <varifold/base/bytes.h>
#include <varifold/io/base64.h>
#include <varifold/io/import_check.h>
#include <varifold/io/resource_file.h>
#include <algorithm>
#include <array>
#include <string_view>

namespace varifold::gltf {
namespace {

constexpr std::size_t kGlbHeaderBytes = 12;
constexpr std::size_t kChunkHeaderBytes = 8;
constexpr std::uint32_t kJsonChunk = 0x4e4f534a;    // "JSON"
constexpr std::uint32_t kBinaryChunk = 0x004e4942;  // "BIN\0"

struct ElementType {
  std::string_view name;
  unsigned components;
};
constexpr std::array<ElementType, 7> kElementTypes{
    {{"SCALAR", 1}, {"VEC2", 2}, {"VEC3", 3}, {"VEC4", 4}, {"MAT2", 4}, {"MAT3", 9}, {"MAT4", 16}}};

/// 0 for an unknown type.
std::size_t size_of(ComponentType type) {
  switch (type) {
    case ComponentType::kInt8:
    case ComponentType::kUint8:
      return 1;
    case ComponentType::kInt16:
    case ComponentType::kUint16:
      return 2;
    case ComponentType::kUint32:
    case ComponentType::kFloat32:
      return 4;
  }
  return 0;
}

bool is_index_type(ComponentType type) {
  return type == ComponentType::kUint8 || type == ComponentType::kUint16 ||
         type == ComponentType::kUint32;
}

/// The component type of a place, with a fault where it is unknown.
ComponentType component_type(const JsonElement& place) {
  const auto type = static_cast<ComponentType>(place.whole("componentType") & 0xffffffffu);
  if (size_of(type) == 0) place.fault("unknown componentType");
  return type;
}

tl::unexpected<Error> bad_glb(std::size_t position, std::string_view fault) {
  return fail(ErrorKind::kInvalidInput, fmt::format("byte {}: {}", position, fault));
}

}  // namespace

Result<Parts> split_file(std::span<const std::byte> file) {
  Parts parts;
  if (!as_text(file).starts_with("glTF")) {
    parts.json = as_text(file).starts_with("\xEF\xBB\xBF") ? file.subspan(3) : file;
    return parts;
  }
  if (file.size() < kGlbHeaderBytes) return bad_glb(file.size(), "the file ends in the header");
  const auto version = load<std::uint32_t>(file.data() + 4);
  if (version != 2)
    return fail(ErrorKind::kUnsupported, fmt::format("byte 4: version {} of GLB, not 2", version));
  const std::size_t length = load<std::uint32_t>(file.data() + 8);
  if (length > file.size())
    return bad_glb(8,
                   fmt::format("the file should have {} bytes, but has {}", length, file.size()));
  parts.trailing_bytes = file.size() - length;

  std::size_t at = kGlbHeaderBytes;
  for (int chunk = 0; at < length; ++chunk) {
    if (length - at < kChunkHeaderBytes) return bad_glb(at, "the file ends in a chunk header");
    const std::size_t size = load<std::uint32_t>(file.data() + at);
    const auto type = load<std::uint32_t>(file.data() + at + 4);
    if (size > length - at - kChunkHeaderBytes)
      return bad_glb(at, fmt::format("a chunk of {} bytes goes past the end of the file", size));
    const auto bytes = file.subspan(at + kChunkHeaderBytes, size);
    if (chunk == 0 && type != kJsonChunk) return bad_glb(at, "the first chunk is not JSON");
    if (chunk == 0) parts.json = bytes;
    if (chunk == 1 && type == kBinaryChunk) parts.binary = bytes;
    at += kChunkHeaderBytes + size;
  }
  if (parts.json.empty()) return bad_glb(at, "no JSON chunk");
  return parts;
}

BufferStore::BufferStore(const JsonElement& root, const Parts& parts,
                         const std::filesystem::path& folder, FirstFault& faults)
    : root_(root),
      parts_(parts),
      folder_(folder),
      faults_(&faults),
      buffers_(root.array("buffers").size()),
      total_bytes_(parts.json.size() + (parts.binary ? parts.binary->size() : 0)) {}

std::span<const std::byte> BufferStore::buffer(std::uint64_t index) {
  const JsonElement element = root_.array("buffers").item(index);
  if (faults_->any()) return {};
  Buffer& found = buffers_[index];
  if (!found.is_loaded) load(element, index, found);
  found.is_loaded = true;
  return found.bytes;
}

void BufferStore::load(const JsonElement& element, std::uint64_t index, Buffer& target) {
  const std::uint64_t length = element.whole("byteLength");
  const std::string uri = element.text("uri");
  if (!element.has("uri")) {
    if (index != 0 || !parts_.binary) return element.fault("has no 'uri', and no chunk of a GLB");
    target.bytes = *parts_.binary;
  } else if (uri.starts_with("data:")) {
    auto decoded = decode_data_uri(uri);
    if (!decoded) return element.fault("has a malformed data: URI");
    target.decoded = std::move(decoded->bytes);
    target.bytes = target.decoded;
  } else {
    auto file = open_resource(folder_, decode_percent(uri));
    if (!file) return element.fault("file " + file.error().message, file.error().kind);
    target.file = std::move(*file);
    target.bytes = target.file->bytes();
    total_bytes_ += target.bytes.size();
  }
  if (target.bytes.size() < length) {
    const std::size_t there = target.bytes.size();
    target.bytes = {};
    return element.fault(fmt::format("should have {} bytes, but has {}", length, there));
  }
  target.bytes = target.bytes.first(length);
}

std::span<const std::byte> BufferStore::view(std::uint64_t index, std::size_t* stride) {
  const JsonElement element = root_.array("bufferViews").item(index);
  const std::uint64_t buffer_index = element.whole("buffer");
  const std::uint64_t offset = element.whole("byteOffset", 0);
  const std::uint64_t length = element.whole("byteLength");
  if (stride) *stride = element.whole("byteStride", 0);
  if (faults_->any()) return {};
  const auto bytes = buffer(buffer_index);
  if (faults_->any()) return {};
  if (offset > bytes.size() || length > bytes.size() - offset) {
    element.fault(fmt::format("{} bytes past the end of buffers[{}]",
                              offset + length - bytes.size(), buffer_index));
    return {};
  }
  return bytes.subspan(offset, length);
}

Elements BufferStore::elements(const JsonElement& place, ComponentType type,
                               std::size_t element_bytes, std::uint64_t count) {
  const std::uint64_t view_index = place.whole("bufferView");
  const std::uint64_t offset = place.whole("byteOffset", 0);
  std::size_t stride = 0;
  const auto bytes = view(view_index, &stride);
  if (faults_->any()) return {};
  if (stride == 0) stride = element_bytes;
  if (stride < element_bytes) {
    place.fault(fmt::format("byteStride {} is less than the {} bytes of an element", stride,
                            element_bytes));
    return {};
  }
  if (count == 0) return {type, nullptr, stride, 0};
  // Divisions, because count * stride may not fit 64 bits.
  const std::uint64_t left = offset <= bytes.size() ? bytes.size() - offset : 0;
  const bool fits = element_bytes <= left && (count - 1) <= (left - element_bytes) / stride;
  if (!fits) {
    const double end = static_cast<double>(offset) +
                       static_cast<double>(count - 1) * static_cast<double>(stride) +
                       static_cast<double>(element_bytes);
    place.fault(fmt::format("{:.0f} bytes past the end of bufferViews[{}]",
                            end - static_cast<double>(bytes.size()), view_index));
    return {};
  }
  return {type, bytes.data() + offset, stride, static_cast<std::size_t>(count)};
}

Accessor BufferStore::accessor(std::uint64_t index) {
  const JsonElement element = root_.array("accessors").item(index);
  const ComponentType type = component_type(element);
  const std::uint64_t count = element.whole("count");
  const std::string type_name = element.text("type");
  const auto* const found =
      std::find_if(kElementTypes.begin(), kElementTypes.end(),
                   [&](const ElementType& candidate) { return candidate.name == type_name; });
  if (found == kElementTypes.end()) element.fault("unknown type " + in_quotes(type_name));
  if (faults_->any()) return {};

  Accessor result;
  result.components = found->components;
  result.normalized = element.boolean("normalized", false);
  const std::size_t element_bytes = size_of(type) * result.components;
  if (element.has("bufferView")) {
    result.elements = elements(element, type, element_bytes, count);
  } else {
    // Zeros take no room in the file, so that any count could be claimed.
    constexpr std::size_t kAlwaysAllowed = 1 << 16;
    if (count > total_bytes_ + kAlwaysAllowed)
      element.fault(fmt::format("{} elements without a buffer view", count));
    result.elements = {type, nullptr, element_bytes, static_cast<std::size_t>(count)};
  }
  if (element.has("sparse")) read_sparse(element, element_bytes, result);
  if (faults_->any()) return {};
  return result;
}

void BufferStore::read_sparse(const JsonElement& element, std::size_t element_bytes,
                              Accessor& accessor) {
  const JsonElement sparse = element.object("sparse");
  const std::uint64_t count = sparse.whole("count");
  const JsonElement indices = sparse.object("indices");
  const JsonElement values = sparse.object("values");
  const ComponentType index_type = component_type(indices);
  if (!is_index_type(index_type)) indices.fault("componentType is not one of indices");
  if (faults_->any()) return;
  accessor.sparse_indices = elements(indices, index_type, size_of(index_type), count);
  accessor.sparse_values = elements(values, accessor.elements.type, element_bytes, count);
  if (faults_->any()) return;
  for (const std::uint32_t at : decode_indices({accessor.sparse_indices, 1, false, {}, {}}))
    if (at >= accessor.elements.count)
      return indices.fault(
          fmt::format("index {} is out of range ({} elements)", at, accessor.elements.count));
}

namespace {

/// Calls action with a zero of the C++ type of the components.
template <class Action>
void with_type(ComponentType type, Action action) {
  switch (type) {
    case ComponentType::kInt8:
      return action(std::int8_t{});
    case ComponentType::kUint8:
      return action(std::uint8_t{});
    case ComponentType::kInt16:
      return action(std::int16_t{});
    case ComponentType::kUint16:
      return action(std::uint16_t{});
    case ComponentType::kUint32:
      return action(std::uint32_t{});
    case ComponentType::kFloat32:
      return action(float{});
  }
}

template <class T>
float to_float(T value, bool normalized) {
  if constexpr (std::is_floating_point_v<T>) {
    return value;
  } else {
    if (!normalized) return static_cast<float>(value);
    const float scaled =
        static_cast<float>(value) / static_cast<float>(std::numeric_limits<T>::max());
    return std::max(scaled, -1.0f);
  }
}

/// Decodes `elements` to the places that place_of(i) tells.
template <class PlaceOf>
void decode_to(const Elements& elements, const Accessor& accessor, float* values,
               PlaceOf place_of) {
  if (!elements.data) return;
  with_type(elements.type, [&]<class T>(T) {
    for (std::size_t i = 0; i < elements.count; ++i) {
      const std::byte* from = elements.data + i * elements.stride;
      float* const to = values + place_of(i) * accessor.components;
      for (unsigned c = 0; c < accessor.components; ++c, from += sizeof(T))
        to[c] = to_float(load<T>(from), accessor.normalized);
    }
  });
}

}  // namespace

std::vector<float> decode_floats(const Accessor& accessor) {
  std::vector<float> values(accessor.elements.count * accessor.components);
  decode_to(accessor.elements, accessor, values.data(), [](std::size_t i) { return i; });
  if (accessor.sparse_indices.count > 0) {
    const auto places = decode_indices({accessor.sparse_indices, 1, false, {}, {}});
    decode_to(accessor.sparse_values, accessor, values.data(),
              [&](std::size_t i) { return places[i]; });
  }
  return values;
}

std::vector<std::uint32_t> decode_indices(const Accessor& accessor) {
  std::vector<std::uint32_t> values(accessor.elements.count);
  const auto decode = [&](const Elements& elements, auto place_of) {
    if (!elements.data) return;
    with_type(elements.type, [&]<class T>(T) {
      for (std::size_t i = 0; i < elements.count; ++i)
        values[place_of(i)] = static_cast<std::uint32_t>(
            static_cast<std::int64_t>(load<T>(elements.data + i * elements.stride)));
    });
  };
  decode(accessor.elements, [](std::size_t i) { return i; });
  if (accessor.sparse_indices.count > 0) {
    const auto places = decode_indices({accessor.sparse_indices, 1, false, {}, {}});
    decode(accessor.sparse_values, [&](std::size_t i) { return places[i]; });
  }
  return values;
}

}  // namespace varifold::gltf
