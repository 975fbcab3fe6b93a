#include <varifold/render/flip.h>

#include <varifold/render/colors.h>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <numbers>
#include <numeric>
#include <span>

namespace varifold {

namespace {

constexpr float kPi = std::numbers::pi_v<float>;

// Linear sRGB to CIE XYZ (IEC 61966-2-1), by columns; the white of both is D65.
const glm::mat3 kXyzOfRgb(0.41239080f, 0.21263901f, 0.01933082f, 0.35758434f, 0.71516868f,
                          0.11919478f, 0.18048079f, 0.07219232f, 0.95053215f);
const glm::mat3 kRgbOfXyz = glm::inverse(kXyzOfRgb);
const Vec3 kWhite = kXyzOfRgb * Vec3(1);

// The opponent space of the filters: lightness, red to green, blue to yellow, all linear in XYZ.
Vec3 opponent_of(const Vec3& rgb) {
  const Vec3 xyz = kXyzOfRgb * rgb / kWhite;
  return {116 * xyz.y - 16, 500 * (xyz.x - xyz.y), 200 * (xyz.y - xyz.z)};
}
Vec3 rgb_of_opponent(const Vec3& color) {
  const float y = (color.x + 16) / 116;
  return kRgbOfXyz * (Vec3(y + color.y / 500, y, y - color.z / 200) * kWhite);
}

// CIE L*a*b*; the chroma less where it is dark, as in Hunt's effect.
Vec3 hunt_lab_of(const Vec3& rgb) {
  constexpr float kDelta = 6.0f / 29;
  const auto compress = [](float t) {
    return t > kDelta * kDelta * kDelta ? std::cbrt(t) : t / (3 * kDelta * kDelta) + 4.0f / 29;
  };
  const Vec3 xyz = kXyzOfRgb * rgb / kWhite;
  const float x = compress(xyz.x), y = compress(xyz.y), z = compress(xyz.z);
  const float lightness = 116 * y - 16;
  return {lightness, 0.01f * lightness * 500 * (x - y), 0.01f * lightness * 200 * (y - z)};
}

float hyab(const Vec3& a, const Vec3& b) {
  return std::abs(a.x - b.x) + std::hypot(a.y - b.y, a.z - b.z);
}

// The difference of colours as 0 to 1: what is most between colours of a screen, that of green and
// blue, is 1; small differences take most of the range.
float spread(float difference) {
  constexpr float kExponent = 0.7f, kKnee = 0.4f, kKneeValue = 0.95f;
  static const float most =
      std::pow(hyab(hunt_lab_of({0, 1, 0}), hunt_lab_of({0, 0, 1})), kExponent);
  const float part = std::pow(difference, kExponent) / most;
  if (part < kKnee) return part / kKnee * kKneeValue;
  return std::min(1.0f, kKneeValue + (part - kKnee) / (1 - kKnee) * (1 - kKneeValue));
}

struct Channel {
  int width = 0, height = 0;
  std::vector<float> values;
};

using Weights = std::vector<float>;  // of an odd number of neighbours

// The sums of weighted neighbours in a row and then in a column; beyond the border lies what is at
// the border.
Channel filter(const Channel& in, const Weights& along_x, const Weights& along_y) {
  const auto sum = [](const Channel& from, const Weights& weights, int step_x, int step_y) {
    Channel to{from.width, from.height, std::vector<float>(from.values.size())};
    const int radius = static_cast<int>(weights.size() / 2);
    std::size_t i = 0;
    for (int y = 0; y < from.height; ++y)
      for (int x = 0; x < from.width; ++x, ++i)
        for (std::size_t k = 0; k < weights.size(); ++k) {
          const int away = static_cast<int>(k) - radius;
          const int column = std::clamp(x + away * step_x, 0, from.width - 1);
          const int row = std::clamp(y + away * step_y, 0, from.height - 1);
          to.values[i] +=
              weights[k] *
              from.values[static_cast<std::size_t>(row) * static_cast<std::size_t>(from.width) +
                          static_cast<std::size_t>(column)];
        }
    return to;
  };
  return sum(sum(in, along_x, 1, 0), along_y, 0, 1);
}

// exp(-x^2 / scale) for whole x / step.
Weights bell(int radius, float step, float scale) {
  Weights weights;
  for (int k = -radius; k <= radius; ++k) {
    const float x = static_cast<float>(k) * step;
    weights.push_back(std::exp(-x * x / scale));
  }
  return weights;
}
float sum_of(const Weights& weights) {
  return std::accumulate(weights.begin(), weights.end(), 0.0f);
}
Weights scaled(Weights weights, float factor) {
  for (float& w : weights) w *= factor;
  return weights;
}

// How well the eye sees a channel's detail, as a sum of two bells (a, b) in the space of degrees.
struct Sensitivity {
  std::array<float, 2> a, b;
};
constexpr std::array<Sensitivity, 3> kSensitivities = {
    {{{1, 0}, {0.0047f, 1e-5f}}, {{1, 0}, {0.0053f, 1e-5f}}, {{34.1f, 13.5f}, {0.04f, 0.025f}}}};

Channel blurred(const Channel& in, const Sensitivity& sensitivity, float pixels_per_degree) {
  constexpr float kWidest = 0.04f;
  const int radius =
      static_cast<int>(std::ceil(3 * std::sqrt(kWidest / (2 * kPi * kPi)) * pixels_per_degree));
  Channel out{in.width, in.height, std::vector<float>(in.values.size())};
  std::array<Weights, 2> bells;
  std::array<float, 2> shares{};
  float all = 0;
  for (std::size_t i = 0; i < 2; ++i) {
    if (sensitivity.a[i] == 0) continue;
    bells[i] = bell(radius, 1 / pixels_per_degree, sensitivity.b[i] / (kPi * kPi));
    const float sum = sum_of(bells[i]);
    shares[i] = sensitivity.a[i] * std::sqrt(kPi / sensitivity.b[i]) * sum * sum;
    all += shares[i];
  }
  for (std::size_t i = 0; i < 2; ++i) {
    if (shares[i] == 0) continue;
    const Weights weights = scaled(bells[i], 1 / sum_of(bells[i]));
    const Channel part = filter(in, weights, weights);
    for (std::size_t p = 0; p < out.values.size(); ++p)
      out.values[p] += shares[i] / all * part.values[p];
  }
  return out;
}

// What is above 0 sums up to 1, what is below to -1.
Weights balanced(Weights weights) {
  float above = 0, below = 0;
  for (const float w : weights) (w > 0 ? above : below) += std::abs(w);
  for (float& w : weights) w /= w > 0 ? above : below;
  return weights;
}

// How strong edges and points are in the lightness: lengths of the first and of the second
// derivatives by x and by y, over as much as an edge is wide to the eye.
struct Features {
  std::vector<float> edges, points;
};
Features features_of(const Channel& lightness, float pixels_per_degree) {
  constexpr float kDegrees = 0.082f;
  const float deviation = 0.5f * kDegrees * pixels_per_degree;
  const int radius = static_cast<int>(std::ceil(3 * deviation));
  const Weights smooth = bell(radius, 1, 2 * deviation * deviation);
  Weights first = smooth, second = smooth;
  for (std::size_t k = 0; k < smooth.size(); ++k) {
    const auto x = static_cast<float>(static_cast<int>(k) - radius);
    first[k] *= -x;
    second[k] *= x * x / (deviation * deviation) - 1;
  }
  const Weights even = scaled(smooth, 1 / sum_of(smooth));
  const auto lengths = [&](const Weights& derivative) {
    const Channel by_x = filter(lightness, derivative, even);
    const Channel by_y = filter(lightness, even, derivative);
    std::vector<float> all(by_x.values.size());
    for (std::size_t i = 0; i < all.size(); ++i)
      all[i] = std::hypot(by_x.values[i], by_y.values[i]);
    return all;
  };
  return {lengths(balanced(first)), lengths(balanced(second))};
}

// A picture as it is seen: its colours without the detail that the eye misses, and its features.
struct SeenPicture {
  std::vector<Vec3> colors;  // Lab
  Features features;
};
SeenPicture see(const Image8& image, float pixels_per_degree) {
  const std::size_t pixels = image.rgb.size() / 3;
  std::array<Channel, 3> channels;
  channels.fill({image.width, image.height, std::vector<float>(pixels)});
  Channel lightness = channels[0];
  for (std::size_t i = 0; i < pixels; ++i) {
    const Vec3 srgb = Vec3(image.rgb[3 * i], image.rgb[3 * i + 1], image.rgb[3 * i + 2]) / 255.0f;
    const Vec3 color = opponent_of(linear_from_srgb(srgb));
    for (int c = 0; c < 3; ++c) channels[static_cast<std::size_t>(c)].values[i] = color[c];
    lightness.values[i] = (color.x + 16) / 116;
  }
  SeenPicture seen;
  for (std::size_t c = 0; c < 3; ++c)
    channels[c] = blurred(channels[c], kSensitivities[c], pixels_per_degree);
  for (std::size_t i = 0; i < pixels; ++i) {
    const Vec3 color{channels[0].values[i], channels[1].values[i], channels[2].values[i]};
    seen.colors.push_back(hunt_lab_of(glm::clamp(rgb_of_opponent(color), 0.0f, 1.0f)));
  }
  seen.features = features_of(lightness, pixels_per_degree);
  return seen;
}

}  // namespace

Result<std::vector<float>> flip_differences(const Image8& a, const Image8& b,
                                            const FlipOptions& options) {
  if (a.width != b.width || a.height != b.height || a.rgb.size() != b.rgb.size())
    return fail(ErrorKind::kInvalidInput, "pictures of different size");
  const SeenPicture seen_a = see(a, options.pixels_per_degree);
  const SeenPicture seen_b = see(b, options.pixels_per_degree);
  std::vector<float> differences(seen_a.colors.size());
  for (std::size_t i = 0; i < differences.size(); ++i) {
    const float color = spread(hyab(seen_a.colors[i], seen_b.colors[i]));
    const float edge = std::abs(seen_a.features.edges[i] - seen_b.features.edges[i]);
    const float point = std::abs(seen_a.features.points[i] - seen_b.features.points[i]);
    const float feature =
        std::sqrt(std::min(1.0f, std::max(edge, point) / std::numbers::sqrt2_v<float>));
    differences[i] = std::pow(color, 1 - feature);
  }
  return differences;
}

Result<double> flip_difference(const Image8& a, const Image8& b, const FlipOptions& options) {
  const auto differences = flip_differences(a, b, options);
  if (!differences) return tl::unexpected(differences.error());
  if (differences->empty()) return 0.0;
  return std::accumulate(differences->begin(), differences->end(), 0.0) /
         static_cast<double>(differences->size());
}

}  // namespace varifold
