// Meshes made by code: the embedded data of the tool, the tests and the benchmarks.
//
// All of them: counter-clockwise triangles seen from outside, unit normals, no unused
// vertex, the number of triangles nearest to the wanted one that the shape
// allows, and the same bytes for any number of threads on every system. Time and memory O(n).
// y points up; the shapes are a few units large and stand around the origin.
#pragma once

#include <varifold/base/result.h>
#include <varifold/mesh/triangle_mesh.h>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

namespace varifold {

struct GeneratorOptions {
  std::uint32_t triangles = 100'000;  ///< wanted; each shape has a smallest number
  std::uint64_t seed = 1;             ///< planet and terrain only
  int threads = 0;                    ///< 0 = all
};

/// The most triangles that a generator makes.
inline constexpr std::uint32_t kMaxGeneratedTriangles = 200'000'000;

struct PlanetOptions : GeneratorOptions {
  float relief = 0.12f;  ///< bound of the heights, up and down; the mean radius is about 1
  bool colors_by_height = false;
};

/// The "Rough Planet": a sphere of radius about 1 with continents, basins and mountains, rough
/// down to the size of its triangles. Closed, genus 0, one vertex per position; the 20 f^2
/// triangles are those of an icosahedron whose edges are cut into f parts. A star-shaped surface,
/// so it never meets itself. Finer planets of a seed add detail to the same continents.
[[nodiscard]] TriangleMesh planet(const PlanetOptions& options = {});

struct TerrainOptions : GeneratorOptions {
  float relief = 0.15f;  ///< half of the bound of the heights, up and down; the side is 2
};

/// A square height field over [-1, 1]^2 with hills and ridges; open; texture coordinates.
[[nodiscard]] TriangleMesh terrain(const TerrainOptions& options = {});

/// A height map: row 0 is the far edge (lowest z), column 0 the left one (lowest x).
struct HeightField {
  std::uint32_t width = 0;     ///< samples per row, at least 2
  std::uint32_t height = 0;    ///< rows, at least 2
  std::vector<float> heights;  ///< width * height, row by row
  float spacing = 1;           ///< model units between neighbouring samples, > 0
  float height_scale = 1;      ///< model units per unit of `heights`
  float row_spacing = 0;       ///< between neighbouring rows where that differs from `spacing`
};

/// The same ground with other numbers of samples, both at least 2. Each is a mean of the old
/// samples around it, weighted by a tent as wide as the farther spacing of the two: linear
/// interpolation where there are more samples than before, smoothed where there are fewer; corners
/// stay at their places. The same bits for any number of threads. The field must be one that
/// terrain() takes. O(samples before and after).
[[nodiscard]] HeightField resample(const HeightField& field, std::uint32_t width,
                                   std::uint32_t height, int threads = 0);

/// The surface of a height map, one vertex per sample, centred in x and z; open; texture
/// coordinates. kInvalidInput when a size does not fit or a height is not finite.
[[nodiscard]] Result<TriangleMesh> terrain(const HeightField& field, int threads = 0);

/// Sphere of radius 1 in rings and sectors. Closed by position; the texture coordinates have a
/// seam along a meridian and one vertex per sector at the poles. At least 6 triangles.
[[nodiscard]] TriangleMesh sphere(const GeneratorOptions& options = {});

/// The same sphere as two materials, north and south of the equator, each with a texture
/// coordinate chart of its own: seams along the equator and a meridian. At least 12 triangles.
[[nodiscard]] TriangleMesh seamed_sphere(const GeneratorOptions& options = {});

/// Torus about the y axis with radii 1 and 0.4; closed by position, genus 1, two seams.
[[nodiscard]] TriangleMesh torus(const GeneratorOptions& options = {});

struct KnotOptions : GeneratorOptions {
  std::uint32_t p = 2;  ///< turns about the axis; p and q without a common divisor, 1 to 16
  std::uint32_t q = 3;  ///< turns through the hole
};

/// A tube along the (p, q) torus knot; closed by position, genus 1, two seams.
[[nodiscard]] TriangleMesh knot(const KnotOptions& options = {});

/// The square [-1, 1]^2 of the x-z plane, facing up, as a grid; open; texture coordinates.
[[nodiscard]] TriangleMesh plane(const GeneratorOptions& options = {});

/// The cube [-1, 1]^3 with grids as faces: sharp edges by split normals, a texture coordinate
/// chart per face; closed by position. 12 n^2 triangles.
[[nodiscard]] TriangleMesh box(const GeneratorOptions& options = {});

/// The names that generate() knows, as the command line shows them.
[[nodiscard]] std::span<const std::string_view> generator_names();

/// The shape of that name with its default options. kInvalidInput, with the list of names, when
/// there is none, or when the number of triangles is 0 or above kMaxGeneratedTriangles.
[[nodiscard]] Result<TriangleMesh> generate(std::string_view shape,
                                            const GeneratorOptions& options = {});

}  // namespace varifold
