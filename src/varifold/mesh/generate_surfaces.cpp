// Surfaces with a formula: sphere, torus, knot, plane and box.
#include <varifold/base/angle.h>
#include <varifold/mesh/generators.h>
#include <algorithm>
#include <cmath>

namespace varifold {

namespace {

struct Point {
  DVec3 position;
  DVec3 normal;
};

std::uint32_t nearest(double x) { return static_cast<std::uint32_t>(std::llround(x)); }

/// Columns and rows of a grid with about the wanted number of quads, `aspect` columns to a row.
struct GridSize {
  std::uint32_t columns;
  std::uint32_t rows;

  GridSize(double quads, double aspect, std::uint32_t least_columns, std::uint32_t least_rows) {
    rows = std::max(least_rows, nearest(std::sqrt(quads / aspect)));
    columns = std::max(least_columns, nearest(quads / rows));
  }
};

double wanted_quads(const GeneratorOptions& options) {
  return std::min(options.triangles, kMaxGeneratedTriangles) / 2.0;
}

/// Which ends of the rows of a grid are one point (the poles of a sphere).
struct Poles {
  bool first_row = false;
  bool last_row = false;
};

/// Appends (columns + 1) x (rows + 1) vertices fn(column, row) and the triangles between them. Seen
/// from outside columns go right and rows go down. A pole has one vertex and one triangle per
/// column.
template <class Surface>
void add_grid(TriangleMesh& mesh, const GridSize& size, const Poles& poles, const Surface& fn) {
  const std::uint32_t columns = size.columns, rows = size.rows;
  const auto is_pole = [&](std::uint32_t row) {
    return (row == 0 && poles.first_row) || (row == rows && poles.last_row);
  };
  std::vector<std::uint32_t> row_start(rows + 1);
  for (std::uint32_t row = 0; row <= rows; ++row) {
    row_start[row] = mesh.vertex_count();
    const std::uint32_t count = is_pole(row) ? columns : columns + 1;
    for (std::uint32_t column = 0; column < count; ++column) {
      const Point point = fn(column, row);
      mesh.positions.push_back(Vec3(point.position));
      mesh.normals.push_back(Vec3(point.normal));
      // The vertex of a pole stands in the middle of its sector.
      const double u = (column + (is_pole(row) ? 0.5 : 0.0)) / columns;
      mesh.texcoords.push_back(Vec2(glm::dvec2(u, static_cast<double>(row) / rows)));
    }
  }
  for (std::uint32_t row = 0; row < rows; ++row)
    for (std::uint32_t column = 0; column < columns; ++column) {
      const std::uint32_t a = row_start[row] + column, b = a + 1;
      const std::uint32_t c = row_start[row + 1] + column, d = c + 1;
      if (is_pole(row)) {
        mesh.indices.insert(mesh.indices.end(), {a, c, d});
      } else if (is_pole(row + 1)) {
        mesh.indices.insert(mesh.indices.end(), {a, c, b});
      } else {
        mesh.indices.insert(mesh.indices.end(), {a, c, d, a, d, b});
      }
    }
}

/// 0..count onto [-1, 1], exactly symmetric.
double centered(std::uint32_t i, std::uint32_t count) {
  return (2.0 * i - count) / static_cast<double>(count);
}

/// Points of a unit circle, one per step, the last equal to the first.
std::vector<glm::dvec2> circle(std::uint32_t steps) {
  std::vector<glm::dvec2> points(steps + 1);
  for (std::uint32_t i = 0; i <= steps; ++i) points[i] = unit_circle(i, steps);
  return points;
}

/// The unit sphere between two polar angles, given as rows of `rings` from the north pole down.
struct SphereBand {
  std::uint32_t sectors;
  std::uint32_t rings;
  std::uint32_t first_ring;
  std::uint32_t last_ring;
};

void add_sphere_band(TriangleMesh& mesh, const SphereBand& band) {
  const std::vector<glm::dvec2> around = circle(band.sectors);
  GridSize size(1, 1, band.sectors, band.last_ring - band.first_ring);
  size.columns = band.sectors;
  const Poles poles{band.first_ring == 0, band.last_ring == band.rings};
  add_grid(mesh, size, poles, [&](std::uint32_t column, std::uint32_t row) {
    const glm::dvec2 polar = unit_circle(band.first_ring + row, 2 * std::uint64_t{band.rings});
    const glm::dvec2 a = around[column];
    const DVec3 p(polar.y * a.x, polar.x, -polar.y * a.y);
    return Point{p, p};
  });
}

/// Sectors and rings of a sphere of 2 * sectors * (rings - 1) triangles.
GridSize sphere_size(const GeneratorOptions& options, std::uint32_t least_rings) {
  const double quads = wanted_quads(options);
  GridSize size(quads, 2, 3, least_rings);
  if (size.rows % 2 == 1 && least_rings % 2 == 0) ++size.rows;
  size.columns = std::max(3u, nearest(quads / (size.rows - 1)));
  return size;
}

}  // namespace

TriangleMesh sphere(const GeneratorOptions& options) {
  const GridSize size = sphere_size(options, 2);
  TriangleMesh mesh;
  add_sphere_band(mesh, {size.columns, size.rows, 0, size.rows});
  return mesh;
}

TriangleMesh seamed_sphere(const GeneratorOptions& options) {
  const GridSize size = sphere_size(options, 4);
  TriangleMesh mesh;
  add_sphere_band(mesh, {size.columns, size.rows, 0, size.rows / 2});
  const std::uint32_t north = mesh.triangle_count();
  add_sphere_band(mesh, {size.columns, size.rows, size.rows / 2, size.rows});
  mesh.ranges = {{0, 0, north}, {1, north, mesh.triangle_count() - north}};
  mesh.materials.resize(2);
  mesh.materials[0].name = "north";
  mesh.materials[0].base_color = Vec4(0.9f, 0.5f, 0.3f, 1);
  mesh.materials[1].name = "south";
  mesh.materials[1].base_color = Vec4(0.3f, 0.5f, 0.9f, 1);
  return mesh;
}

TriangleMesh torus(const GeneratorOptions& options) {
  constexpr double kRadius = 1;
  constexpr double kTube = 0.4;
  const GridSize size(wanted_quads(options), kRadius / kTube, 3, 3);
  const auto around = circle(size.columns), through = circle(size.rows);
  TriangleMesh mesh;
  add_grid(mesh, size, {}, [&](std::uint32_t column, std::uint32_t row) {
    const glm::dvec2 a = around[column], t = through[row];
    const DVec3 outward(a.x, 0, -a.y);
    const DVec3 normal = t.x * outward - DVec3(0, t.y, 0);
    return Point{kRadius * outward + kTube * normal, normal};
  });
  return mesh;
}

TriangleMesh knot(const KnotOptions& options) {
  constexpr double kRadius = 1, kThrough = 0.45, kTube = 0.2;
  const std::uint64_t p = std::clamp(options.p, 1u, 16u), q = std::clamp(options.q, 1u, 16u);
  const double aspect = (p * kRadius + q * kThrough) / kTube;
  const GridSize size(wanted_quads(options), aspect, 12 * static_cast<std::uint32_t>(p + q), 3);
  const auto tube = circle(size.rows);
  TriangleMesh mesh;
  add_grid(mesh, size, {}, [&](std::uint32_t column, std::uint32_t row) {
    const glm::dvec2 a = unit_circle(p * column, size.columns);
    const glm::dvec2 t = unit_circle(q * column, size.columns);
    // The frame of the torus along the knot: it closes without a twist.
    const double distance = kRadius + kThrough * t.x;
    const DVec3 outward(a.x, 0, -a.y), along(-a.y, 0, -a.x);
    const DVec3 normal = t.x * outward + DVec3(0, t.y, 0);
    DVec3 tangent =
        double(p) * distance * along + double(q) * kThrough * (-t.y * outward + DVec3(0, t.x, 0));
    tangent = tangent / std::sqrt(glm::dot(tangent, tangent));
    const DVec3 side = glm::cross(normal, tangent);
    const DVec3 direction = tube[row].x * normal - tube[row].y * side;
    const DVec3 center = distance * outward + DVec3(0, kThrough * t.y, 0);
    return Point{center + kTube * direction, direction};
  });
  return mesh;
}

TriangleMesh plane(const GeneratorOptions& options) {
  const GridSize size(wanted_quads(options), 1, 1, 1);
  TriangleMesh mesh;
  add_grid(mesh, size, {}, [&](std::uint32_t column, std::uint32_t row) {
    return Point{DVec3(centered(column, size.columns), 0, centered(row, size.rows)),
                 DVec3(0, 1, 0)};
  });
  return mesh;
}

TriangleMesh box(const GeneratorOptions& options) {
  const double wanted = std::min(options.triangles, kMaxGeneratedTriangles);
  const auto n = std::max(1u, nearest(std::sqrt(wanted / 12)));
  GridSize size(1, 1, n, n);
  TriangleMesh mesh;
  for (int axis = 0; axis < 3; ++axis)
    for (const double side : {1.0, -1.0}) {
      DVec3 normal(0), right(0);
      normal[axis] = side;
      right[(axis + 1) % 3] = 1;
      const DVec3 down = glm::cross(right, normal);
      add_grid(mesh, size, {}, [&](std::uint32_t column, std::uint32_t row) {
        const double u = centered(column, n), v = centered(row, n);
        return Point{normal + u * right + v * down, normal};
      });
    }
  return mesh;
}

}  // namespace varifold
