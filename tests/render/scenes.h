// What the tests of this folder draw, and what they draw it with.
#pragma once

#include <gtest/gtest.h>

#include <varifold/mesh/triangle_mesh.h>
#include <varifold/render/headless_context.h>
#include <varifold/render/renderer.h>
#include <optional>
#include <vector>

namespace varifold::test {

/// A test with an OpenGL context; skipped, saying why, where there is none.
class RenderTest : public ::testing::Test {
 protected:
  void SetUp() override;
  [[nodiscard]] Renderer& renderer() { return *renderer_; }

  /// Draws a mesh; an empty picture and a failure of the test when that fails.
  [[nodiscard]] Image8 picture_of(const TriangleMesh& mesh, const DrawStyle& style = {},
                                  const PictureOptions& options = plain_background());
  [[nodiscard]] DepthImage depths_of(const TriangleMesh& mesh);

  /// One bright colour, so that goldens stay small.
  [[nodiscard]] static PictureOptions plain_background();

  /// Looks at the cube [-1, 1]^3 from another side.
  void turn_camera(float azimuth_degrees);

  Camera camera;  ///< set by SetUp to look at [-1, 1]^3, 256 x 256

 private:
  std::optional<HeadlessContext> context_;
  std::optional<Renderer> renderer_;
};

/// Four triangles around the origin, no normals.
[[nodiscard]] TriangleMesh tetrahedron();

/// The cube [-1, 1]^3 with a material, a colour, for each face.
[[nodiscard]] TriangleMesh colored_cube();

/// A sphere of radius 1 with normals.
[[nodiscard]] TriangleMesh round_sphere(std::uint32_t triangles);

/// A band of three rows bent into a quarter pipe: each row one strip, restarts between them, and
/// each row a range with a level of its own.
struct StripBand {
  std::vector<Vec3> positions;
  std::vector<std::uint32_t> indices;
  std::vector<DrawRange> ranges;
  [[nodiscard]] DrawList list() const;
};
[[nodiscard]] StripBand strip_band();

/// The same triangles as a list, one range, in the winding that the strips stand for.
[[nodiscard]] StripBand as_triangles(const StripBand& band);

}  // namespace varifold::test
