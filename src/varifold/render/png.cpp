#include <varifold/render/png.h>

#include <algorithm>
#include <array>
#include <climits>
#include <memory>
#include <string>

// NOLINTBEGIN(readability-identifier-naming): the names that stb looks for
#define STB_IMAGE_IMPLEMENTATION
#define STB_IMAGE_STATIC
#define STBI_ONLY_PNG
#define STBI_NO_STDIO
#define STBI_NO_LINEAR
#define STBI_NO_HDR
#define STBI_MAX_DIMENSIONS (1 << 14)
#include <stb/stb_image.h>

#define STB_IMAGE_WRITE_IMPLEMENTATION
#define STB_IMAGE_WRITE_STATIC
#define STBI_WRITE_NO_STDIO
// NOLINTEND(readability-identifier-naming)
#include <stb/stb_image_write.h>

namespace varifold {
namespace {

static_assert(STBI_MAX_DIMENSIONS == kMaxPictureSize);

template <class T>
using Pixels = std::unique_ptr<T, decltype(&stbi_image_free)>;

const stbi_uc* data_of(std::span<const std::byte> bytes) {
  return reinterpret_cast<const stbi_uc*>(bytes.data());
}

struct PngSize {
  int width = 0;
  int height = 0;
};

std::uint32_t big_endian(std::span<const std::byte> bytes, std::size_t offset) {
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < 4; ++i)
    value = value << 8 | std::to_integer<std::uint32_t>(bytes[offset + i]);
  return value;
}

/// Of a row before it was compressed, with its filter; at least.
std::uint64_t row_bytes(std::span<const std::byte> bytes, std::uint32_t width) {
  constexpr std::array<std::uint64_t, 7> kChannels{1, 1, 3, 1, 2, 1, 4};  // by type of colour
  const auto bits = std::to_integer<std::uint64_t>(bytes[24]);
  const auto color = std::to_integer<std::size_t>(bytes[25]);
  return 1 + width * bits * (color < kChannels.size() ? kChannels[color] : 1) / 8;
}

/// Checks what can be checked before anything is allocated.
Result<PngSize> checked_size(std::span<const std::byte> bytes) {
  constexpr std::array<unsigned char, 8> kSignature = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'};
  constexpr std::size_t kHeaderEnd = 33;  // signature, and the whole IHDR chunk
  const bool signed_png = bytes.size() >= kSignature.size() &&
                          std::equal(kSignature.begin(), kSignature.end(), data_of(bytes));
  if (!signed_png) return fail(ErrorKind::kInvalidInput, "not a PNG file");
  if (bytes.size() < kHeaderEnd)
    return fail(ErrorKind::kInvalidInput, "PNG: the file ends inside its header");
  if (bytes.size() > INT_MAX) return fail(ErrorKind::kUnsupported, "PNG: more than 2 GiB");
  const std::uint32_t width = big_endian(bytes, 16), height = big_endian(bytes, 20);
  if (width == 0 || height == 0) return fail(ErrorKind::kInvalidInput, "PNG: no pixels");
  if (width > kMaxPictureSize || height > kMaxPictureSize)
    return fail(ErrorKind::kUnsupported, "PNG: " + std::to_string(width) + " x " +
                                             std::to_string(height) + " pixels, at most " +
                                             std::to_string(kMaxPictureSize) + " a side");
  const PngSize size{static_cast<int>(width), static_cast<int>(height)};
  // Deflate shrinks at most 1032 times, so that a small file cannot ask for much memory.
  constexpr std::uint64_t kMostShrinking = 1032;
  if (row_bytes(bytes, width) * height > kMostShrinking * bytes.size())
    return fail(ErrorKind::kInvalidInput, "PNG: the file is too short for " +
                                              std::to_string(width) + " x " +
                                              std::to_string(height) + " pixels");
  return size;
}

tl::unexpected<Error> damaged() {
  const char* reason = stbi_failure_reason();
  return fail(ErrorKind::kInvalidInput, std::string("PNG: ") + (reason ? reason : "damaged"));
}

std::size_t pixel_count(const PngSize& size) {
  return static_cast<std::size_t>(size.width) * static_cast<std::size_t>(size.height);
}

/// The luminance of pixels with `channels` values each; alpha comes last and is left out.
template <class T>
std::vector<float> luminance(const T* values, int channels, std::size_t count) {
  constexpr float kWhite = static_cast<float>(static_cast<T>(~T{0}));
  std::vector<float> result(count);
  for (std::size_t i = 0; i < count; ++i) {
    const T* pixel = values + i * static_cast<std::size_t>(channels);
    // Rec. 709 weights; kept apart from grey, whose values must come through exactly.
    result[i] = channels < 3 ? static_cast<float>(pixel[0]) / kWhite
                             : (0.2126f * static_cast<float>(pixel[0]) +
                                0.7152f * static_cast<float>(pixel[1]) +
                                0.0722f * static_cast<float>(pixel[2])) /
                                   kWhite;
  }
  return result;
}

void append_bytes(void* context, void* data, int size) {
  auto& bytes = *static_cast<std::vector<std::byte>*>(context);
  const auto* first = static_cast<const std::byte*>(data);
  bytes.insert(bytes.end(), first, first + size);
}

}  // namespace

Result<std::vector<std::byte>> write_png(const Image8& image) {
  const PngSize size{image.width, image.height};
  if (image.width <= 0 || image.height <= 0 || image.rgb.size() != 3 * pixel_count(size))
    return fail(ErrorKind::kFailed, "PNG: the picture is empty");
  std::vector<std::byte> bytes;
  if (!stbi_write_png_to_func(append_bytes, &bytes, image.width, image.height, 3, image.rgb.data(),
                              3 * image.width))
    return fail(ErrorKind::kFailed, "PNG: the picture cannot be encoded");
  return bytes;
}

Result<Image8> read_png(std::span<const std::byte> bytes) {
  const auto size = checked_size(bytes);
  if (!size) return tl::unexpected<Error>(size.error());
  int width = 0, height = 0, channels = 0;
  const Pixels<stbi_uc> pixels(stbi_load_from_memory(data_of(bytes), static_cast<int>(bytes.size()),
                                                     &width, &height, &channels, 3),
                               stbi_image_free);
  if (!pixels) return damaged();
  Image8 image{size->width, size->height, {}};
  image.rgb.assign(pixels.get(), pixels.get() + 3 * pixel_count(*size));
  return image;
}

Result<HeightMap> read_height_map(std::span<const std::byte> bytes) {
  const auto size = checked_size(bytes);
  if (!size) return tl::unexpected<Error>(size.error());
  HeightMap map{size->width, size->height, {}};
  const auto count = static_cast<int>(bytes.size());
  int width = 0, height = 0, channels = 0;
  if (stbi_is_16_bit_from_memory(data_of(bytes), count)) {
    const Pixels<stbi_us> pixels(
        stbi_load_16_from_memory(data_of(bytes), count, &width, &height, &channels, 0),
        stbi_image_free);
    if (!pixels) return damaged();
    map.heights = luminance(pixels.get(), channels, pixel_count(*size));
  } else {
    const Pixels<stbi_uc> pixels(
        stbi_load_from_memory(data_of(bytes), count, &width, &height, &channels, 0),
        stbi_image_free);
    if (!pixels) return damaged();
    map.heights = luminance(pixels.get(), channels, pixel_count(*size));
  }
  return map;
}

}  // namespace varifold
