#include <tests/render/pixel_counts.h>

#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

namespace varifold::test {

bool is_background(const DepthImage& depths, int x, int y) {
  return std::isinf(depths.depth(x, y));
}

int enclosed_background_pixels(const DepthImage& depths) {
  std::vector<bool> seen(depths.depths.size());
  std::vector<std::pair<int, int>> open;
  const auto visit = [&](int x, int y) {
    if (x < 0 || y < 0 || x >= depths.width || y >= depths.height) return;
    const auto i = static_cast<std::size_t>(y) * depths.width + x;
    if (seen[i] || !is_background(depths, x, y)) return;
    seen[i] = true;
    open.emplace_back(x, y);
  };
  for (int x = 0; x < depths.width; ++x) visit(x, 0), visit(x, depths.height - 1);
  for (int y = 0; y < depths.height; ++y) visit(0, y), visit(depths.width - 1, y);
  while (!open.empty()) {
    const auto [x, y] = open.back();
    open.pop_back();
    visit(x - 1, y), visit(x + 1, y), visit(x, y - 1), visit(x, y + 1);
  }
  int enclosed = 0;
  for (int y = 0; y < depths.height; ++y)
    for (int x = 0; x < depths.width; ++x)
      if (is_background(depths, x, y) && !seen[static_cast<std::size_t>(y) * depths.width + x])
        ++enclosed;
  return enclosed;
}

int magenta_pixels_inside(const Image8& image, const DepthImage& depths) {
  int count = 0;
  for (int y = 1; y + 1 < image.height; ++y)
    for (int x = 1; x + 1 < image.width; ++x) {
      bool inside = true;
      for (int dy = -1; dy <= 1; ++dy)
        for (int dx = -1; dx <= 1; ++dx) inside = inside && !is_background(depths, x + dx, y + dy);
      const std::uint8_t* p = image.pixel(x, y);
      if (inside && p[0] > p[1] + 50 && p[2] > p[1] + 50) ++count;
    }
  return count;
}

int red_pixels(const Image8& image) {
  int count = 0;
  for (std::size_t i = 0; i < image.rgb.size(); i += 3)
    if (image.rgb[i] > image.rgb[i + 1] + 60 && image.rgb[i] > image.rgb[i + 2] + 60) ++count;
  return count;
}

}  // namespace varifold::test
