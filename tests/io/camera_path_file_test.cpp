// Camera paths as JSON: what comes out is what went in, and faults are told by their place.
#include <gtest/gtest.h>

#include <tests/io/io_support.h>
#include <tests/support/test_files.h>
#include <varifold/base/random.h>
#include <varifold/io/camera_path_file.h>
#include <varifold/view/known_paths.h>
#include <fstream>
#include <string>

namespace varifold {
namespace {

using test::message_of;

constexpr const char* kSmall = R"({"varifold_camera_path": 1, "keys": [{"eye": [0, 0, 2]}]})";

std::string with(const std::string& members) {
  return R"({"varifold_camera_path": 1, )" + members + "}";
}

void expect_same(const CameraPath& a, const CameraPath& b) {
  EXPECT_EQ(a.name, b.name);
  EXPECT_EQ(a.units, b.units);
  EXPECT_EQ(a.interpolation, b.interpolation);
  EXPECT_EQ(a.is_closed, b.is_closed);
  EXPECT_EQ(a.frames, b.frames);
  EXPECT_EQ(a.width, b.width);
  EXPECT_EQ(a.height, b.height);
  ASSERT_EQ(a.keys.size(), b.keys.size());
  for (std::size_t i = 0; i < a.keys.size(); ++i) {
    EXPECT_EQ(a.keys[i].frame, b.keys[i].frame);
    EXPECT_EQ(a.keys[i].eye, b.keys[i].eye);
    EXPECT_EQ(a.keys[i].target, b.keys[i].target);
    EXPECT_EQ(a.keys[i].up, b.keys[i].up);
    EXPECT_EQ(a.keys[i].fovy_degrees, b.keys[i].fovy_degrees);
  }
}

TEST(CameraPathFile, KnownPathsComeBackExactly) {
  for (const std::string_view name : known_path_names()) {
    const auto path = known_path(name);
    ASSERT_TRUE(path);
    VARIFOLD_ASSERT_VALUE(read, parse_camera_path(format_camera_path(*path)));
    expect_same(read, *path);
  }
}

TEST(CameraPathFile, RandomPathsComeBackExactly) {
  Random random(5);
  for (int round = 0; round < 50; ++round) {
    CameraPath path;
    path.name = "with \"quotes\"\n";
    path.units = CameraPath::Units::kModel;
    path.is_closed = round % 2 == 0;
    path.frames = 2000;
    const auto vector = [&] {
      const auto number = [&] { return (random.uniform() - 0.5) * 1e4; };
      return DVec3(number(), number(), number());
    };
    for (std::uint32_t frame = 0; frame < 1000; frame += 1 + random.below(99))
      path.keys.push_back({frame, vector(), vector(), vector(), 180 * random.uniform()});
    VARIFOLD_ASSERT_VALUE(read, parse_camera_path(format_camera_path(path)));
    expect_same(read, path);
  }
}

TEST(CameraPathFile, TheFilesOfTheProjectAreThoseOfTheGenerator) {
  for (const std::string_view name : known_path_names()) {
    const auto path = known_path(name);
    std::ifstream file("examples/paths/" + std::string(name) + ".json");
    const std::string text{std::istreambuf_iterator<char>(file), {}};
    EXPECT_EQ(text, format_camera_path(*path)) << name << ": varifold generate path writes it anew";
  }
}

TEST(CameraPathFile, Defaults) {
  VARIFOLD_ASSERT_VALUE(path, parse_camera_path(kSmall));
  EXPECT_EQ(path.frames, 1u);
  EXPECT_EQ(path.width, 1920);
  EXPECT_EQ(path.units, CameraPath::Units::kDiagonals);
  EXPECT_EQ(path.keys[0].up, DVec3(0, 1, 0));
  EXPECT_EQ(path.keys[0].fovy_degrees, 30);
  // Frames count up from the key before; keys take what the path says.
  VARIFOLD_ASSERT_VALUE(
      more, parse_camera_path(with(
                R"("target": [1, 2, 3], "fovy_degrees": 50, "keys": [{"eye": [0, 0, 2]},)"
                R"({"frame": 5, "eye": [0, 0, 3], "fovy_degrees": 60}, {"eye": [0, 0, 4]}])")));
  EXPECT_EQ(more.frames, 7u);
  EXPECT_EQ(more.keys[2].frame, 6u);
  EXPECT_EQ(more.keys[1].fovy_degrees, 60);
  EXPECT_EQ(more.keys[2].fovy_degrees, 50);
  EXPECT_EQ(more.keys[2].target, DVec3(1, 2, 3));
}

TEST(CameraPathFile, FaultsNameTheirPlace) {
  const auto refused = [](const std::string& text, const std::string& part) {
    const std::string message = message_of(parse_camera_path(text));
    EXPECT_NE(message.find(part), std::string::npos) << message;
  };
  const std::string key = R"("keys": [{"eye": [0, 0, 2]}])";
  refused("", "not valid JSON");
  refused("[1]", "not a camera path");
  refused("{}", "not a camera path");
  refused(R"({"varifold_camera_path": 2})", "version 2");
  refused(R"({"varifold_camera_path": "1"})", "varifold_camera_path: not a whole number");
  refused(with(R"("keys": [])"), "frames: 0");
  refused(with(R"("frames": 3)"), "keys: there are none");
  refused(with(R"("keys": {})"), "keys: not an array");
  refused(with(R"("keys": [5])"), "keys[0]: not an object");
  refused(with(R"("keys": [{"target": [0, 0, 2]}])"), "keys[0]: there is no eye");
  refused(with(R"("keys": [{"eye": [0, 2]}])"), "keys[0].eye: not an array of 3 numbers");
  refused(with(R"("keys": [{"eye": [0, 0, "2"]}])"), "keys[0].eye");
  refused(with(R"("keys": [{"eye": [0, 0, 2], "fov": 3}])"), "keys[0]: unknown member 'fov'");
  refused(with(R"("keys": [{"eye": [0, 0, 2], "frame": -1}])"), "keys[0].frame");
  refused(with(R"("keys": [{"eye": [0, 0, 2], "frame": 4}])"), "not that of frame 0");
  refused(with(R"("keys": [{"eye": [0, 0, 2]}, {"eye": [0, 0, 2], "frame": 0}])"), "keys[1]");
  refused(with(R"("keys": [{"eye": [0, 0, 2]}, {"eye": [0, 0, 2], "frame": 1e15}])"), "frames");
  refused(with(R"("keys": [{"eye": [0, 0, 1e999]}])"), "not valid JSON");
  refused(with(R"("keys": [{"eye": [0, 0, NaN]}])"), "not valid JSON");
  refused(with(R"("frames": 1e18, )" + key), "frames: not a whole number");
  refused(with(R"("frames": 5000000, )" + key), "frames: 5000000");
  refused(with(R"("size": [0, 5], )" + key), "size");
  refused(with(R"("size": [1.5, 5], )" + key), "size");
  refused(with(R"("units": "metres", )" + key), "units: not 'diagonals' or 'model'");
  refused(with(R"("interpolation": 5, )" + key), "interpolation: not a string");
  refused(with(R"("closed": 1, )" + key), "closed: not true or false");
  refused(with(R"("speed": 1, )" + key), "unknown member 'speed'");
  refused(std::string(100000, '['), "nested too deeply");
}

TEST(CameraPathFile, CutAndDamagedFilesAreErrorsOrPaths) {
  const std::string whole = format_camera_path(*known_path("fly_by"));
  for (std::size_t size = 0; size + 2 < whole.size(); ++size)
    (void)message_of(parse_camera_path(std::string_view(whole).substr(0, size)));
  Random random(3);
  for (int i = 0; i < 3000; ++i) {
    std::string damaged = whole;
    for (int k = 0; k < 3; ++k)
      damaged[random.below(static_cast<std::uint32_t>(damaged.size()))] =
          static_cast<char>(random.below(256));
    const auto path = parse_camera_path(damaged);
    EXPECT_TRUE(!path || check_camera_path(*path));
  }
}

TEST(CameraPathFile, ErrorsBeginWithTheFile) {
  const test::TemporaryFolder folder;
  const auto file = folder.file("p.json");
  EXPECT_EQ(message_of(read_camera_path(file)).find(file.string()), 0u);
  std::ofstream(file) << "{";
  EXPECT_EQ(message_of(read_camera_path(file)).find(file.string()), 0u);
  std::ofstream(file) << kSmall;
  EXPECT_TRUE(read_camera_path(file));
}

}  // namespace
}  // namespace varifold
