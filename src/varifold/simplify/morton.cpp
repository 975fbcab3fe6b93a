#include <varifold/simplify/morton.h>

#include <algorithm>

namespace varifold {

namespace {

std::uint32_t spread_bits(std::uint32_t x) {
  x = (x | x << 16) & 0x030000ffu;
  x = (x | x << 8) & 0x0300f00fu;
  x = (x | x << 4) & 0x030c30c3u;
  return (x | x << 2) & 0x09249249u;
}

struct Keyed {
  std::uint32_t key, id;
};

// One pass of a least-significant-digit radix sort.
void sort_by_digit(const std::vector<Keyed>& from, std::vector<Keyed>& to, int shift) {
  constexpr std::uint32_t kDigit = 1024;
  std::uint32_t first[kDigit + 1] = {};
  for (const Keyed& k : from) ++first[((k.key >> shift) & (kDigit - 1)) + 1];
  for (std::uint32_t i = 0; i < kDigit; ++i) first[i + 1] += first[i];
  for (const Keyed& k : from) to[first[(k.key >> shift) & (kDigit - 1)]++] = k;
}

}  // namespace

std::vector<std::uint32_t> morton_order(std::span<const Vec3> positions,
                                        std::span<const std::uint32_t> chosen, const Box& box) {
  const Vec3 extent = box.empty() ? Vec3(0) : box.upper - box.lower;
  const float longest = std::max({extent.x, extent.y, extent.z});
  const float scale = longest > 0 ? 1023.0f / longest : 0.0f;

  std::vector<Keyed> keyed, buffer(chosen.size());
  keyed.reserve(chosen.size());
  for (const std::uint32_t id : chosen) {
    const Vec3 cell = (positions[id] - box.lower) * scale;
    const auto digit = [](float x) {
      return spread_bits(static_cast<std::uint32_t>(std::clamp(x, 0.0f, 1023.0f)));
    };
    keyed.push_back({digit(cell.x) | digit(cell.y) << 1 | digit(cell.z) << 2, id});
  }
  sort_by_digit(keyed, buffer, 0);
  sort_by_digit(buffer, keyed, 10);
  sort_by_digit(keyed, buffer, 20);

  std::vector<std::uint32_t> order;
  order.reserve(chosen.size());
  for (const Keyed& k : buffer) order.push_back(k.id);
  return order;
}

}  // namespace varifold
