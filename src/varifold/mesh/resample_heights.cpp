// Height fields at other resolutions.
#include <varifold/base/parallel.h>
#include <varifold/mesh/generators.h>
#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

namespace varifold {

namespace {

/// The weights of one new sample: those of the old samples from `first` on.
struct Tent {
  std::size_t first = 0;
  std::vector<double> weights;
};

std::vector<Tent> tents(std::uint32_t before, std::uint32_t after) {
  const double step = static_cast<double>(before - 1) / (after - 1);
  const double reach = std::max(1.0, step);
  std::vector<Tent> result(after);
  for (std::uint32_t i = 0; i < after; ++i) {
    // The last one exactly in the corner, whatever the rounding.
    const double place = i + 1 == after ? before - 1 : step * i;
    const auto first = static_cast<std::int64_t>(std::ceil(place - reach));
    const auto last = static_cast<std::int64_t>(std::floor(place + reach));
    Tent& tent = result[i];
    tent.first = static_cast<std::size_t>(std::max<std::int64_t>(first, 0));
    const auto end = std::min<std::int64_t>(last, before - 1);
    double sum = 0;
    for (auto sample = static_cast<std::int64_t>(tent.first); sample <= end; ++sample) {
      const double away = static_cast<double>(sample) - place;
      tent.weights.push_back(std::max(0.0, 1 - (away < 0 ? -away : away) / reach));
      sum += tent.weights.back();
    }
    for (double& weight : tent.weights) weight /= sum;
  }
  return result;
}

}  // namespace

HeightField resample(const HeightField& field, std::uint32_t width, std::uint32_t height,
                     int threads) {
  assert(field.width >= 2 && field.height >= 2 && width >= 2 && height >= 2);
  HeightField result = field;
  const double across = static_cast<double>(field.spacing) * (field.width - 1);
  const double along =
      static_cast<double>(field.row_spacing > 0 ? field.row_spacing : field.spacing) *
      (field.height - 1);
  result.width = width;
  result.height = height;
  result.spacing = static_cast<float>(across / (width - 1));
  result.row_spacing = static_cast<float>(along / (height - 1));

  // Along the rows first, then across them.
  const std::vector<Tent> columns = tents(field.width, width), rows = tents(field.height, height);
  std::vector<float> narrow(std::size_t{width} * field.height);
  const std::size_t piece = std::max(1u, 4096 / width);
  parallel_for(threads, field.height, piece, [&](std::size_t begin, std::size_t end) {
    for (std::size_t row = begin; row < end; ++row) {
      for (std::size_t column = 0; column < width; ++column) {
        const Tent& tent = columns[column];
        double sum = 0;
        for (std::size_t k = 0; k < tent.weights.size(); ++k)
          sum += tent.weights[k] * field.heights[row * field.width + tent.first + k];
        narrow[row * width + column] = static_cast<float>(sum);
      }
    }
  });
  result.heights.assign(std::size_t{width} * height, 0);
  parallel_for(threads, height, piece, [&](std::size_t begin, std::size_t end) {
    for (std::size_t row = begin; row < end; ++row) {
      const Tent& tent = rows[row];
      for (std::size_t column = 0; column < width; ++column) {
        double sum = 0;
        for (std::size_t k = 0; k < tent.weights.size(); ++k)
          sum += tent.weights[k] * narrow[(tent.first + k) * width + column];
        result.heights[row * width + column] = static_cast<float>(sum);
      }
    }
  });
  return result;
}

}  // namespace varifold
