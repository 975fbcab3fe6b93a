// Shorthands of the tests of files.
#pragma once

#include <gtest/gtest.h>

#include <varifold/base/bytes.h>
#include <varifold/base/result.h>
#include <varifold/io/imported_mesh.h>
#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace varifold::test {

/// Binary data as a text that grows by << : numbers in little-endian order.
class Binary {
 public:
  explicit Binary(std::string_view start = {}) { append_text(bytes_, start); }
  template <class T>
  Binary& number(T value) {
    append_little(bytes_, value);
    return *this;
  }
  template <class T>
  Binary& big(T value) {
    return number(reverse_bytes(value));
  }
  Binary& text(std::string_view more) {
    append_text(bytes_, more);
    return *this;
  }
  [[nodiscard]] const std::vector<std::byte>& bytes() const { return bytes_; }

 private:
  std::vector<std::byte> bytes_;
};

/// Fails the test unless what ImportedMesh guarantees holds.
inline void expect_sound(const TriangleMesh& mesh) {
  const std::size_t vertices = mesh.positions.size();
  EXPECT_EQ(mesh.indices.size() % 3, 0u);
  for (const std::uint32_t v : mesh.indices) ASSERT_LT(v, vertices);
  for (const std::size_t size : {mesh.normals.size(), mesh.texcoords.size(), mesh.colors.size()})
    EXPECT_TRUE(size == 0 || size == vertices);
  for (const Vec3& p : mesh.positions) ASSERT_TRUE(glm::length(p) >= 0);
  std::uint32_t covered = 0;
  for (const MaterialRange& range : mesh.ranges) {
    EXPECT_EQ(range.first_triangle, covered);
    EXPECT_LT(range.material, mesh.materials.size());
    covered += range.triangle_count;
  }
  EXPECT_EQ(covered, mesh.ranges.empty() ? 0 : mesh.triangle_count());
  for (const Material& material : mesh.materials)
    for (const std::uint32_t image : material.textures)
      EXPECT_TRUE(image == kNone || image < mesh.images.size());
}

inline void expect_same_geometry(const TriangleMesh& a, const TriangleMesh& b) {
  EXPECT_EQ(a.positions, b.positions);
  EXPECT_EQ(a.normals, b.normals);
  EXPECT_EQ(a.texcoords, b.texcoords);
  EXPECT_EQ(a.colors, b.colors);
  EXPECT_EQ(a.indices, b.indices);
}

/// Two triangles with a seam's worth of every attribute; values survive a round trip exactly.
inline TriangleMesh mesh_with_everything() {
  TriangleMesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1.0f / 3, 0}, {0, 1, 1e-7f}};
  mesh.normals = {{0, 0, 1}, {0, 1, 0}, {1, 0, 0}, {0, 0, -1}};
  mesh.texcoords = {{0, 0}, {1, 0}, {1, 0.1f}, {0, 1}};
  mesh.colors = {{1, 2, 3, 255}, {4, 5, 6, 128}, {255, 254, 253, 0}, {0, 0, 0, 255}};
  mesh.indices = {0, 1, 2, 0, 2, 3};
  return mesh;
}

/// The message of an error; fails the test where there is none, or where it has several lines.
template <class T>
std::string message_of(const Result<T>& result) {
  if (result) {
    ADD_FAILURE() << "expected an error";
    return {};
  }
  EXPECT_EQ(result.error().message.find('\n'), std::string::npos) << result.error().message;
  EXPECT_FALSE(result.error().message.empty());
  return result.error().message;
}

}  // namespace varifold::test

/// Binds the value of a Result, or fails the test with its message.
#define VARIFOLD_ASSERT_VALUE(variable, expression)                                \
  auto variable##_result = (expression);                                           \
  ASSERT_TRUE(variable##_result.has_value()) << variable##_result.error().message; \
  auto& variable = *variable##_result
