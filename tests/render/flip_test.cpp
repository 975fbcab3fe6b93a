#include <gtest/gtest.h>

#include <varifold/base/random.h>
#include <varifold/render/flip.h>
#include <algorithm>
#include <array>
#include <cmath>

namespace varifold {
namespace {

using Color = std::array<std::uint8_t, 3>;

Image8 plain(int width, int height, const Color& color) {
  Image8 image{width, height,
               std::vector<std::uint8_t>(3 * static_cast<std::size_t>(width) *
                                         static_cast<std::size_t>(height))};
  for (std::size_t i = 0; i < image.rgb.size(); ++i) image.rgb[i] = color[i % 3];
  return image;
}
void set(Image8& image, int x, int y, const Color& color) {
  std::copy(color.begin(), color.end(), image.rgb.begin() + 3 * (y * image.width + x));
}
Image8 noise(int width, int height, std::uint64_t seed) {
  Image8 image = plain(width, height, {0, 0, 0});
  Random random(seed);
  for (std::uint8_t& v : image.rgb) v = static_cast<std::uint8_t>(random.below(256));
  return image;
}

TEST(Flip, OfAPictureAndItselfIsNothing) {
  const Image8 image = noise(40, 30, 1);
  const auto differences = flip_differences(image, image);
  ASSERT_TRUE(differences);
  ASSERT_EQ(differences->size(), 1200u);
  for (const float d : *differences) EXPECT_EQ(d, 0);
}

TEST(Flip, DoesNotAskForTheOrderAndStaysBetween0And1) {
  for (std::uint64_t seed = 0; seed < 4; ++seed) {
    const Image8 a = noise(50, 20, seed), b = noise(50, 20, seed + 100);
    const auto there = flip_differences(a, b), back = flip_differences(b, a);
    EXPECT_EQ(*there, *back);
    for (const float d : *there) EXPECT_TRUE(d > 0 && d <= 1) << d;
  }
}

// Plain pictures have neither detail nor features: what is left is the formula of two colours. By
// hand from their coordinates in L*a*b*: green (87.735, -86.183, 83.180), blue (32.297, 79.188,
// -107.860), grey 128 L* = 53.585; with chroma times L* / 100, green to blue is 203.4, so its power
// of 0.7 is 41.28 (the greatest), that of white to black, 100^0.7 = 25.12, that of grey to black
// 53.585^0.7 = 16.24.
TEST(Flip, OfPlainPicturesIsTheFormulaOfTheirColours) {
  const auto of = [](const Color& a, const Color& b) {
    const auto differences = flip_differences(plain(30, 25, a), plain(30, 25, b));
    for (const float d : *differences) EXPECT_NEAR(d, differences->front(), 2e-4);
    return differences->front();
  };
  EXPECT_NEAR(of({0, 255, 0}, {0, 0, 255}), 1, 1e-3);
  EXPECT_NEAR(of({0, 0, 0}, {255, 255, 255}), 0.95 + (25.12 / 41.28 - 0.4) / 0.6 * 0.05, 1e-3);
  EXPECT_NEAR(of({0, 0, 0}, {128, 128, 128}), 16.24 / 41.28 / 0.4 * 0.95, 2e-3);
}

TEST(Flip, GrowsWithTheDifference) {
  const Image8 grey = plain(40, 40, {100, 100, 100});
  double before = 0;
  for (int step = 1; step <= 12; ++step) {
    Image8 other = grey;
    for (int y = 15; y < 25; ++y)
      for (int x = 15; x < 25; ++x) {
        const auto value = static_cast<std::uint8_t>(100 + 12 * step);
        set(other, x, y, {value, value, value});
      }
    const double difference = *flip_difference(grey, other);
    EXPECT_GT(difference, before) << step;
    before = difference;
  }
}

// The eye does not tell a board of single pixels from the grey that it averages to, but it does
// when it is near.
TEST(Flip, DetailThatTheEyeMissesCountsLittle) {
  Image8 board = plain(64, 64, {0, 0, 0});
  for (int y = 0; y < 64; ++y)
    for (int x = 0; x < 64; ++x)
      if ((x + y) % 2 == 0) set(board, x, y, {255, 255, 255});
  const Image8 grey = plain(64, 64, {188, 188, 188});  // half of the light
  const auto middle = [&](float pixels_per_degree) {
    return (*flip_differences(board, grey, {pixels_per_degree}))[32 * 64 + 32];
  };
  EXPECT_LT(middle(120), 0.02f);
  EXPECT_GT(middle(10), 0.3f);
}

// A line that is as light as its surroundings on average still is an edge.
TEST(Flip, EdgesCountMoreThanColoursAlone) {
  const Image8 grey = plain(60, 60, {120, 120, 120});
  Image8 line = grey, plane = plain(60, 60, {160, 160, 160});
  for (int y = 0; y < 60; ++y)
    for (int x = 30; x < 60; ++x) set(line, x, y, {160, 160, 160});
  const auto edges = flip_differences(grey, line), colors = flip_differences(grey, plane);
  // At the line the colours are blurred to half of the difference; the edge makes more of it.
  EXPECT_GT((*edges)[30 * 60 + 30], 1.1f * (*colors)[30 * 60 + 30]);
  EXPECT_NEAR((*edges)[30 * 60 + 55], (*colors)[30 * 60 + 55], 1e-3f);
  EXPECT_NEAR((*edges)[30 * 60 + 5], 0, 1e-3f);
}

TEST(Flip, RefusesDifferentSizesAndTakesEmptyPictures) {
  EXPECT_EQ(flip_difference(plain(1, 2, {}), plain(2, 1, {})).error().kind,
            ErrorKind::kInvalidInput);
  EXPECT_EQ(*flip_difference(Image8{}, Image8{}), 0);
}

}  // namespace
}  // namespace varifold
