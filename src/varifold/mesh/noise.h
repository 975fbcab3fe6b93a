// Seeded gradient noise, the same on every system.
#pragma once

#include <varifold/base/math.h>
#include <cstdint>

namespace varifold {

/// Smooth noise over space that is zero at the points of the integer lattice.
/// Based on: [Perlin2002].
class GradientNoise {
 public:
  explicit GradientNoise(std::uint64_t seed);

  /// Value at p, in (-1.1, 1.1), mostly within +-0.7; wavelength about 2. |p| below 2^30.
  [[nodiscard]] double operator()(const DVec3& p) const;

 private:
  std::uint32_t seed_low_;
  std::uint32_t seed_high_;
};

/// Octaves of noise, each of twice the frequency and `gain` times the amplitude of the one before.
struct FractalOptions {
  double frequency = 1;  ///< lattice cells per model unit of the first octave
  double gain = 0.5;
  int octaves = 8;
};

/// Two sums over the same octaves.
struct FractalNoise {
  double smooth = 0;  ///< rolling hills, about +-1
  double ridged = 0;  ///< sharp crests: high where the noise changes its sign, about +-1
};

/// Cost: `octaves` evaluations of the noise, about 30 ns each.
[[nodiscard]] FractalNoise fractal_noise(const GradientNoise& noise, const DVec3& p,
                                         const FractalOptions& options);

}  // namespace varifold
