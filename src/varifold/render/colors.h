// Colour spaces, and the ramp that shows levels of detail.
#pragma once

#include <varifold/base/math.h>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace varifold {

/// sRGB (IEC 61966-2-1) to linear, per channel, 0 to 1.
[[nodiscard]] inline Vec3 linear_from_srgb(const Vec3& c) {
  const auto channel = [](float v) {
    return v <= 0.04045f ? v / 12.92f : std::pow((v + 0.055f) / 1.055f, 2.4f);
  };
  return {channel(c.x), channel(c.y), channel(c.z)};
}

/// The sRGB colour of a level from 0 (coarsest, blue) over teal, yellow and orange to 1 (finest,
/// red). Values outside are clamped.
[[nodiscard]] inline Vec3 level_color(float level) {
  constexpr std::array<std::array<float, 3>, 5> kStops = {{{0.22f, 0.37f, 0.70f},
                                                           {0.20f, 0.64f, 0.67f},
                                                           {0.93f, 0.84f, 0.45f},
                                                           {0.94f, 0.58f, 0.30f},
                                                           {0.80f, 0.24f, 0.25f}}};
  const float place = std::clamp(level, 0.0f, 1.0f) * (kStops.size() - 1);
  const std::size_t stop = std::min(static_cast<std::size_t>(place), kStops.size() - 2);
  const float part = place - static_cast<float>(stop);
  const auto& a = kStops[stop];
  const auto& b = kStops[stop + 1];
  return {a[0] + part * (b[0] - a[0]), a[1] + part * (b[1] - a[1]), a[2] + part * (b[2] - a[2])};
}

}  // namespace varifold
