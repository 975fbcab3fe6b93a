// Colour spaces, the ramp that shows levels of detail, and colours that tell strips apart.
#pragma once

#include <varifold/base/math.h>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace varifold {

/// sRGB (IEC 61966-2-1) to linear, per channel, 0 to 1.
[[nodiscard]] inline Vec3 linear_from_srgb(const Vec3& c) {
  const auto channel = [](float v) {
    return v <= 0.04045f ? v / 12.92f : std::pow((v + 0.055f) / 1.055f, 2.4f);
  };
  return {channel(c.x), channel(c.y), channel(c.z)};
}

/// The sRGB colour of a level from 0 (coarsest, blue) over teal, green and yellow to 1 (finest,
/// orange); red is left to faults. Values outside are clamped.
[[nodiscard]] inline Vec3 level_color(float level) {
  constexpr std::array<std::array<float, 3>, 5> kStops = {{{0.27f, 0.35f, 0.72f},
                                                           {0.20f, 0.62f, 0.70f},
                                                           {0.50f, 0.78f, 0.47f},
                                                           {0.96f, 0.83f, 0.40f},
                                                           {0.92f, 0.50f, 0.22f}}};
  const float place = std::clamp(level, 0.0f, 1.0f) * (kStops.size() - 1);
  const std::size_t stop = std::min(static_cast<std::size_t>(place), kStops.size() - 2);
  const float part = place - static_cast<float>(stop);
  const auto& a = kStops[stop];
  const auto& b = kStops[stop + 1];
  return {a[0] + part * (b[0] - a[0]), a[1] + part * (b[1] - a[1]), a[2] + part * (b[2] - a[2])};
}

/// The sRGB colour of the strip of that number: neighbouring numbers differ clearly, by hue as well
/// as by brightness. The reds of faults are left out.
[[nodiscard]] inline Vec3 strip_color(std::uint32_t strip) {
  std::uint32_t hash = strip * 0x9e3779b9u;
  hash ^= hash >> 15u;
  hash *= 0x85ebca6bu;
  hash ^= hash >> 13u;
  // Hues from amber (45 degrees) round to magenta (300 degrees), as a part of the circle.
  const float hue = (45.0f + 255.0f * static_cast<float>(hash & 0xffffu) / 65535.0f) / 360.0f;
  const float saturation = 0.45f + 0.35f * static_cast<float>(hash >> 16u & 0xffu) / 255.0f;
  const float value = 0.62f + 0.36f * static_cast<float>(hash >> 24u) / 255.0f;
  const auto channel = [&](float offset) {
    const float place = std::fmod(hue * 6.0f + offset, 6.0f);
    return value * (1 - saturation * std::clamp(std::min(place, 4.0f - place), 0.0f, 1.0f));
  };
  return {channel(5), channel(3), channel(1)};
}

}  // namespace varifold
