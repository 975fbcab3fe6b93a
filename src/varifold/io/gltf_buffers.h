// Buffers, buffer views and accessors of glTF.
#pragma once

#include <varifold/io/json_element.h>
#include <varifold/io/mapped_file.h>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <vector>

namespace varifold::gltf {

/// The two parts of a .glb file; of a .gltf file all is JSON.
struct Parts {
  std::span<const std::byte> json;
  std::optional<std::span<const std::byte>> binary;
  std::size_t trailing_bytes = 0;
};

/// Errors: kInvalidInput, "byte N: ...".
[[nodiscard]] Result<Parts> split_file(std::span<const std::byte> file);

/// glTF's codes for the types of components.
enum class ComponentType : std::uint32_t {
  kInt8 = 5120,
  kUint8 = 5121,
  kInt16 = 5122,
  kUint16 = 5123,
  kUint32 = 5125,
  kFloat32 = 5126,
};

/// Elements at equal distances in memory, all inside their buffer.
struct Elements {
  ComponentType type = ComponentType::kFloat32;
  const std::byte* data = nullptr;  ///< null: all zero
  std::size_t stride = 0;
  std::size_t count = 0;
};

/// An accessor whose bounds have been checked.
struct Accessor {
  Elements elements;
  unsigned components = 1;
  bool normalized = false;
  /// Sparse replacements: element indices[i], which is < elements.count, becomes values[i].
  Elements sparse_indices;
  Elements sparse_values;
};

/// Loads buffers when they are first asked for.
class BufferStore {
 public:
  BufferStore(const JsonElement& root, const Parts& parts, const std::filesystem::path& folder,
              FirstFault& faults);

  /// The bytes of a buffer view; empty, with a fault, where it is broken.
  [[nodiscard]] std::span<const std::byte> view(std::uint64_t index, std::size_t* stride = nullptr);

  /// An accessor; without elements, and with a fault, where it is broken.
  [[nodiscard]] Accessor accessor(std::uint64_t index);

  /// The bytes of the file and of all buffers loaded so far: what the size of results is judged by.
  [[nodiscard]] std::size_t total_bytes() const { return total_bytes_; }

 private:
  struct Buffer {
    bool is_loaded = false;
    std::span<const std::byte> bytes;
    std::vector<std::byte> decoded;
    std::optional<MappedFile> file;
  };
  std::span<const std::byte> buffer(std::uint64_t index);
  void load(const JsonElement& element, std::uint64_t index, Buffer& buffer);
  Elements elements(const JsonElement& place, ComponentType type, std::size_t element_bytes,
                    std::uint64_t count);
  void read_sparse(const JsonElement& element, std::size_t element_bytes, Accessor& accessor);

  JsonElement root_;
  const Parts& parts_;
  const std::filesystem::path& folder_;
  FirstFault* faults_;
  std::vector<Buffer> buffers_;
  std::size_t total_bytes_;
};

/// All elements as floats, `accessor.components` each, normalised where the accessor says so.
[[nodiscard]] std::vector<float> decode_floats(const Accessor& accessor);

/// All elements of an accessor of whole numbers with one component each.
[[nodiscard]] std::vector<std::uint32_t> decode_indices(const Accessor& accessor);

}  // namespace varifold::gltf
