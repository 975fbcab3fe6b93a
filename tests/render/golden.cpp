#include <gtest/gtest.h>

#include <tests/render/golden.h>
#include <varifold/render/image_difference.h>
#include <varifold/render/png.h>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <span>
#include <string_view>
#include <vector>

namespace varifold::test {
namespace {

namespace fs = std::filesystem;

std::vector<char> read_file(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

void write_picture(const Image8& image, const fs::path& path) {
  fs::create_directories(path.parent_path());
  const auto bytes = write_png(image);
  ASSERT_TRUE(bytes) << bytes.error().message;
  std::ofstream(path, std::ios::binary)
      .write(reinterpret_cast<const char*>(bytes->data()),
             static_cast<std::streamsize>(bytes->size()));
}

bool updating() {
  const char* wish = std::getenv("VARIFOLD_UPDATE_GOLDENS");
  return wish && std::string_view(wish) == "1";
}

}  // namespace

void expect_golden(const Image8& image, const std::string& name) {
  constexpr int kThreshold = 40;
  constexpr double kMaxRms = 3.0, kMaxPartAbove = 0.01;
  const fs::path path = fs::path("tests/render/golden") / (name + ".png");
  if (updating()) return write_picture(image, path);

  const std::vector<char> file = read_file(path);
  const auto golden = read_png(std::as_bytes(std::span(file)));
  ASSERT_TRUE(golden) << path << ": " << golden.error().message;
  const auto difference = image_difference(image, *golden, kThreshold);
  ASSERT_TRUE(difference) << path << ": " << difference.error().message;
  EXPECT_LE(difference->rms, kMaxRms) << path;
  EXPECT_LE(difference->part_above, kMaxPartAbove) << path;
  if (::testing::Test::HasFailure()) write_picture(image, "build/golden_failures/" + name + ".png");
}

}  // namespace varifold::test
