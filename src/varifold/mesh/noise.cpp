// Based on: [Perlin2002].
// Differs: lattice points are hashed instead of looked up in a permutation table, so that the noise
// has no period and takes a seed.
#include <varifold/base/random.h>
#include <varifold/mesh/noise.h>
#include <cmath>

namespace varifold {

namespace {

std::uint32_t scramble(std::uint32_t h) {
  h ^= h >> 16;
  h *= 0x7feb352du;
  h ^= h >> 15;
  h *= 0x846ca68bu;
  return h ^ (h >> 16);
}

/// Dot product of (x, y, z) with one of the twelve directions to the edges of a cube.
double along_gradient(std::uint32_t hash, double x, double y, double z) {
  static constexpr double kGradients[16][3] = {
      {1, 1, 0},
      {-1, 1, 0},
      {1, -1, 0},
      {-1, -1, 0},
      {1, 0, 1},
      {-1, 0, 1},
      {1, 0, -1},
      {-1, 0, -1},
      {0, 1, 1},
      {0, -1, 1},
      {0, 1, -1},
      {0, -1, -1},
      // Four of them again, a tetrahedron, so that the choice costs no division.
      {1, 1, 0},
      {0, -1, 1},
      {-1, 1, 0},
      {0, -1, -1}};
  const double* g = kGradients[hash >> 28];
  return g[0] * x + g[1] * y + g[2] * z;
}

double fade(double t) { return t * t * t * (t * (t * 6 - 15) + 10); }

double lerp(double t, double a, double b) { return a + t * (b - a); }

}  // namespace

GradientNoise::GradientNoise(std::uint64_t seed) {
  const std::uint64_t bits = Random(seed).next();
  seed_low_ = static_cast<std::uint32_t>(bits);
  seed_high_ = static_cast<std::uint32_t>(bits >> 32);
}

double GradientNoise::operator()(const DVec3& p) const {
  const double fx = std::floor(p.x), fy = std::floor(p.y), fz = std::floor(p.z);
  const auto cell = [](double f) {
    return static_cast<std::uint32_t>(static_cast<std::int32_t>(f));
  };
  const std::uint32_t x = cell(fx) * 0x8da6b343u + seed_low_;
  const std::uint32_t y = cell(fy) * 0xd8163841u + seed_high_;
  const std::uint32_t z = cell(fz) * 0xcb1ab31fu;
  const double u = p.x - fx, v = p.y - fy, w = p.z - fz;

  double values[8];
  for (std::uint32_t corner = 0; corner < 8; ++corner) {
    const std::uint32_t cx = corner & 1, cy = (corner >> 1) & 1, cz = corner >> 2;
    const std::uint32_t hash =
        scramble((x + cx * 0x8da6b343u) ^ (y + cy * 0xd8163841u) ^ (z + cz * 0xcb1ab31fu));
    values[corner] = along_gradient(hash, u - cx, v - cy, w - cz);
  }
  const double s = fade(u), t = fade(v);
  const double low = lerp(t, lerp(s, values[0], values[1]), lerp(s, values[2], values[3]));
  const double high = lerp(t, lerp(s, values[4], values[5]), lerp(s, values[6], values[7]));
  return lerp(fade(w), low, high);
}

FractalNoise fractal_noise(const GradientNoise& noise, const DVec3& p,
                           const FractalOptions& options) {
  FractalNoise sum;
  DVec3 q = p * options.frequency;
  double amplitude = 1;
  for (int octave = 0; octave < options.octaves; ++octave) {
    const double value = noise(q);
    sum.smooth += amplitude * value;
    sum.ridged += amplitude * (0.5 - 2 * std::abs(value));
    amplitude *= options.gain;
    // A turn by the rotation with rows (3 6 2), (-6 2 3), (2 -3 6) over 7 and a shift: the zeros
    // of the octaves must not fall together.
    q = DVec3(3 * q.x + 6 * q.y + 2 * q.z, -6 * q.x + 2 * q.y + 3 * q.z,
              2 * q.x - 3 * q.y + 6 * q.z) *
            (2.0 / 7.0) +
        DVec3(17.17, -31.31, 47.47);
  }
  return sum;
}

}  // namespace varifold
