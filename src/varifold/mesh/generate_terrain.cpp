#include <varifold/base/parallel.h>
#include <varifold/mesh/generators.h>
#include <varifold/mesh/noise.h>
#include <varifold/mesh/normals.h>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>

namespace varifold {

namespace {

/// Computes fn(column, row) -> position for a grid of samples and joins them by triangles that
/// face up; the diagonals alternate so that the grid has no direction of its own.
template <class Position>
TriangleMesh height_grid(std::uint32_t columns, std::uint32_t rows, int threads,
                         const Position& position) {
  TriangleMesh mesh;
  mesh.positions.resize(std::size_t{columns} * rows);
  mesh.texcoords.resize(mesh.positions.size());
  mesh.indices.resize(6 * (std::size_t{columns} - 1) * (rows - 1));
  const std::size_t rows_per_piece = std::max(1u, 4096 / columns);
  parallel_for(threads, rows, rows_per_piece, [&](std::size_t begin, std::size_t end) {
    for (std::size_t row = begin; row < end; ++row) {
      for (std::uint32_t column = 0; column < columns; ++column) {
        const std::size_t v = row * columns + column;
        mesh.positions[v] = position(column, static_cast<std::uint32_t>(row));
        mesh.texcoords[v] = Vec2(static_cast<float>(column) / static_cast<float>(columns - 1),
                                 static_cast<float>(row) / static_cast<float>(rows - 1));
      }
      if (row + 1 == rows) continue;
      std::uint32_t* out = &mesh.indices[6 * row * (columns - 1)];
      for (std::uint32_t column = 0; column + 1 < columns; ++column) {
        const auto a = static_cast<std::uint32_t>(row * columns + column);
        const std::uint32_t b = a + 1, c = a + columns, d = c + 1;
        const std::uint32_t even[6] = {a, c, d, a, d, b};
        const std::uint32_t odd[6] = {a, c, b, b, c, d};
        out = std::copy_n((row + column) % 2 == 0 ? even : odd, 6, out);
      }
    }
  });

  // Every vertex is a position class of its own: no need to weld.
  WeldMap weld;
  weld.class_count = mesh.vertex_count();
  weld.class_of.resize(weld.class_count);
  std::iota(weld.class_of.begin(), weld.class_of.end(), 0u);
  NormalOptions normals;
  normals.weight = NormalWeight::kArea;
  normals.threads = threads;
  compute_normals(mesh, weld, normals);
  return mesh;
}

}  // namespace

TriangleMesh terrain(const TerrainOptions& options) {
  const double wanted = std::min(options.triangles, kMaxGeneratedTriangles);
  const auto cells = static_cast<std::uint32_t>(std::max(1ll, std::llround(std::sqrt(wanted / 2))));
  const GradientNoise noise(options.seed);
  FractalOptions fractal;
  fractal.frequency = 1.3;
  fractal.gain = 0.45;
  fractal.octaves = 2;
  // The finest octave still has about three samples to a lattice cell.
  for (double frequency = fractal.frequency * 4; frequency * 6 <= cells; frequency *= 2)
    ++fractal.octaves;

  return height_grid(cells + 1, cells + 1, options.threads,
                     [&](std::uint32_t column, std::uint32_t row) {
                       const double x = 2.0 * column / cells - 1;
                       const double z = 2.0 * row / cells - 1;
                       const FractalNoise sum = fractal_noise(noise, DVec3(x, 0.5, z), fractal);
                       // Ridges where the land is high, rolling ground where it is low.
                       const double mountains = std::clamp(0.5 + 1.5 * sum.smooth, 0.0, 1.0);
                       const double height = 0.45 * sum.smooth + 0.4 * mountains * sum.ridged;
                       return Vec3(DVec3(x, 2 * options.relief * std::clamp(height, -1.0, 1.0), z));
                     });
}

namespace {

Result<void> check_height_field(const HeightField& field) {
  const std::size_t samples = std::size_t{field.width} * field.height;
  if (field.width < 2 || field.height < 2)
    return fail(ErrorKind::kInvalidInput, "a height field needs at least 2 x 2 samples");
  if (field.heights.size() != samples)
    return fail(ErrorKind::kInvalidInput, "a height field of " + std::to_string(field.width) +
                                              " x " + std::to_string(field.height) +
                                              " samples has " +
                                              std::to_string(field.heights.size()) + " heights");
  if (samples > kMaxGeneratedTriangles / 2)
    return fail(ErrorKind::kUnsupported, "a height field of " + std::to_string(samples) +
                                             " samples: more than " +
                                             std::to_string(kMaxGeneratedTriangles / 2));
  if (!(field.spacing > 0) || !std::isfinite(field.spacing) || !(field.row_spacing >= 0) ||
      !std::isfinite(field.row_spacing) || !std::isfinite(field.height_scale))
    return fail(ErrorKind::kInvalidInput, "a height field needs a positive spacing");
  for (std::size_t i = 0; i < samples; ++i)
    if (!std::isfinite(field.heights[i] * field.height_scale))
      return fail(ErrorKind::kInvalidInput,
                  "height " + std::to_string(i) + " of a height field is not finite");
  return {};
}

}  // namespace

Result<TriangleMesh> terrain(const HeightField& field, int threads) {
  if (auto checked = check_height_field(field); !checked)
    return tl::unexpected(std::move(checked.error()));
  const double spacing = field.spacing;
  const double row_spacing = field.row_spacing > 0 ? field.row_spacing : field.spacing;
  const double left = -0.5 * spacing * (field.width - 1);
  const double far = -0.5 * row_spacing * (field.height - 1);
  return height_grid(field.width, field.height, threads,
                     [&](std::uint32_t column, std::uint32_t row) {
                       const std::size_t sample = std::size_t{row} * field.width + column;
                       return Vec3(static_cast<float>(left + spacing * column),
                                   field.heights[sample] * field.height_scale,
                                   static_cast<float>(far + row_spacing * row));
                     });
}

}  // namespace varifold
