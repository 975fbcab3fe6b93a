#include <varifold/models/strips/front.h>

#include <algorithm>
#include <array>
#include <bit>

namespace varifold {

namespace {

// Positive floats have the order of their bits; three groups of these, the highest first.
struct Digit {
  std::uint32_t shift, bits;
};
constexpr std::array<Digit, 3> kDigits{{{21, 11}, {10, 11}, {0, 10}}};

}  // namespace

float StepUrgencies::tolerance(const StripFramework& model, const AdaptOptions& options) const {
  const float least = std::max(options.tolerance, 0.0f);
  const std::uint32_t base = model.triangle_count(0);
  if (options.max_triangles >= model.triangle_count(model.finest_level())) return least;
  // So many triangles may come with splits. Going from the greatest urgency down, find the one
  // whose steps would be too many: digit by digit.
  std::uint32_t left = options.max_triangles > base ? options.max_triangles - base : 0;
  std::uint32_t prefix = 0, known = 0;  // the digits found, and a mask of their bits
  for (const Digit digit : kDigits) {
    std::array<std::uint32_t, 2048> triangles{};
    const std::uint32_t mask = (1u << digit.bits) - 1;
    for (std::uint32_t k = 0; k < raised_.size(); ++k) {
      const auto bits = std::bit_cast<std::uint32_t>(raised_[k]);
      if ((bits & known) == prefix)
        triangles[bits >> digit.shift & mask] += model.levels().step(k).triangles;
    }
    std::uint32_t value = mask;
    while (value > 0 && triangles[value] <= left) left -= triangles[value--];
    prefix |= value << digit.shift;
    known |= mask << digit.shift;
  }
  return std::max(least, std::bit_cast<float>(prefix));
}

}  // namespace varifold
