#include <varifold/render/image_difference.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <string>

namespace varifold {
namespace {

std::string size_text(const Image8& image) {
  return std::to_string(image.width) + " x " + std::to_string(image.height);
}

}  // namespace

Result<ImageDifference> image_difference(const Image8& a, const Image8& b, int threshold) {
  if (a.width != b.width || a.height != b.height || a.rgb.size() != b.rgb.size())
    return fail(ErrorKind::kInvalidInput,
                "pictures of different size: " + size_text(a) + " and " + size_text(b));
  ImageDifference result;
  if (a.rgb.empty()) return result;

  std::uint64_t squares = 0, above = 0;
  for (std::size_t i = 0; i < a.rgb.size(); i += 3) {
    int most = 0;
    for (std::size_t channel = i; channel < i + 3; ++channel) {
      const int difference = std::abs(int{a.rgb[channel]} - int{b.rgb[channel]});
      squares += static_cast<std::uint64_t>(difference) * static_cast<std::uint64_t>(difference);
      most = std::max(most, difference);
    }
    result.max = std::max(result.max, most);
    if (most > threshold) ++above;
  }
  const auto channels = static_cast<double>(a.rgb.size());
  result.rms = std::sqrt(static_cast<double>(squares) / channels);
  result.part_above = static_cast<double>(above) / (channels / 3);
  return result;
}

}  // namespace varifold
