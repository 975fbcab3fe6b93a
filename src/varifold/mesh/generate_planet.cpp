#include <varifold/base/parallel.h>
#include <varifold/mesh/generators.h>
#include <varifold/mesh/noise.h>
#include <varifold/mesh/normals.h>
#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

namespace varifold {

namespace {

/// The icosahedron: its corners, its faces counter-clockwise, its edges and their numbers.
struct Icosahedron {
  std::array<DVec3, 12> corners;
  std::array<std::array<std::uint32_t, 3>, 20> faces;
  std::array<std::array<std::uint32_t, 2>, 30> edges;
  std::array<std::array<std::uint32_t, 12>, 12> edge_of;

  Icosahedron() {
    const double golden = (1 + std::sqrt(5.0)) / 2;
    std::uint32_t count = 0;
    for (const double a : {-1.0, 1.0})
      for (const double b : {-golden, golden}) {
        corners[count++] = DVec3(0, a, b);
        corners[count++] = DVec3(a, b, 0);
        corners[count++] = DVec3(b, 0, a);
      }
    find_edges();
    find_faces();
  }

 private:
  [[nodiscard]] bool adjacent(std::uint32_t a, std::uint32_t b) const {
    const DVec3 d = corners[a] - corners[b];
    return glm::dot(d, d) < 4.1;  // edges have length 2, the next distance is 3.2
  }
  void find_edges() {
    std::uint32_t count = 0;
    for (std::uint32_t a = 0; a < 12; ++a)
      for (std::uint32_t b = a + 1; b < 12; ++b)
        if (adjacent(a, b)) {
          edge_of[a][b] = edge_of[b][a] = count;
          edges[count++] = {a, b};
        }
  }
  void find_faces() {
    std::uint32_t count = 0;
    for (std::uint32_t a = 0; a < 12; ++a)
      for (std::uint32_t b = a + 1; b < 12; ++b)
        for (std::uint32_t c = b + 1; c < 12; ++c) {
          if (!adjacent(a, b) || !adjacent(b, c) || !adjacent(a, c)) continue;
          const DVec3 normal = glm::cross(corners[b] - corners[a], corners[c] - corners[a]);
          if (glm::dot(normal, corners[a]) > 0)
            faces[count++] = {a, b, c};
          else
            faces[count++] = {a, c, b};
        }
  }
};

/// The icosahedron with its edges cut into f parts. Vertices: the corners, then the insides of the
/// edges, then the insides of the faces; so every place has one vertex.
class Icosphere {
 public:
  explicit Icosphere(std::uint32_t f) : f_(f) {}

  [[nodiscard]] std::size_t vertex_count() const { return std::size_t{10} * f_ * f_ + 2; }
  [[nodiscard]] std::size_t triangle_count() const { return std::size_t{20} * f_ * f_; }

  /// Vertex at row i (0..f) and place j (0..i) of a face: row 0 is its first corner.
  [[nodiscard]] std::uint32_t vertex(std::uint32_t face, std::uint32_t i, std::uint32_t j) const {
    const auto& [a, b, c] = solid_.faces[face];
    if (i == 0) return a;
    if (i == f_ && j == 0) return b;
    if (i == f_ && j == f_) return c;
    if (j == 0) return on_edge(a, b, i);
    if (j == i) return on_edge(a, c, i);
    if (i == f_) return on_edge(b, c, j);
    return first_inside(face) + (i - 1) * (i - 2) / 2 + (j - 1);
  }

  /// Calls visit(vertex, direction) for the corners.
  template <class Visit>
  void visit_corners(const Visit& visit) const {
    for (std::uint32_t c = 0; c < 12; ++c) visit(c, normalize(solid_.corners[c]));
  }
  /// The same for the inside of one of the 30 edges.
  template <class Visit>
  void visit_edge(std::uint32_t edge, const Visit& visit) const {
    const auto& [a, b] = solid_.edges[edge];
    for (std::uint32_t k = 1; k < f_; ++k)
      visit(on_edge(a, b, k),
            normalize(double(f_ - k) * solid_.corners[a] + double(k) * solid_.corners[b]));
  }
  /// The same for the inside of row i (1..f-1) of a face.
  template <class Visit>
  void visit_row(std::uint32_t face, std::uint32_t i, const Visit& visit) const {
    const auto& [a, b, c] = solid_.faces[face];
    for (std::uint32_t j = 1; j < i; ++j)
      visit(vertex(face, i, j),
            normalize(double(f_ - i) * solid_.corners[a] + double(i - j) * solid_.corners[b] +
                      double(j) * solid_.corners[c]));
  }

  /// Writes the triangles between rows i and i + 1 of a face.
  void write_row(std::uint32_t face, std::uint32_t i, std::uint32_t* out) const {
    for (std::uint32_t j = 0; j <= i; ++j) {
      *out++ = vertex(face, i, j);
      *out++ = vertex(face, i + 1, j);
      *out++ = vertex(face, i + 1, j + 1);
      if (j == i) break;
      *out++ = vertex(face, i, j);
      *out++ = vertex(face, i + 1, j + 1);
      *out++ = vertex(face, i, j + 1);
    }
  }

 private:
  static DVec3 normalize(const DVec3& v) { return v / std::sqrt(glm::dot(v, v)); }
  [[nodiscard]] std::uint32_t on_edge(std::uint32_t a, std::uint32_t b, std::uint32_t step) const {
    const std::uint32_t from_lower = a < b ? step : f_ - step;
    return 12 + solid_.edge_of[a][b] * (f_ - 1) + from_lower - 1;
  }
  [[nodiscard]] std::uint32_t first_inside(std::uint32_t face) const {
    return 12 + 30 * (f_ - 1) + face * ((f_ - 1) * (f_ - 2) / 2);
  }

  std::uint32_t f_;
  Icosahedron solid_;
};

/// The relief of the planet, in [-1, 1].
class Relief {
 public:
  /// `edges` is the number of triangle edges per edge of the icosahedron.
  Relief(std::uint64_t seed, std::uint32_t edges) : noise_(seed) {
    // The finest octave still has about three triangle edges to a lattice cell.
    fractal_.frequency = 1.4;
    fractal_.octaves = 2;
    double frequency = fractal_.frequency * 4;
    for (; frequency * 2.75 <= edges; frequency *= 2) ++fractal_.octaves;
  }

  [[nodiscard]] double operator()(const DVec3& direction) const {
    const FractalNoise sum = fractal_noise(noise_, direction, fractal_);
    const double base = sum.smooth + 0.05;
    // Under the sea the ground is flatter; inland there are ranges of mountains.
    if (base < 0) return std::max(-1.0, 0.3 * base);
    const double inland = std::min(1.0, 3 * base);
    return std::min(1.0, 0.8 * base + 0.5 * inland * std::max(0.0, sum.ridged));
  }

 private:
  GradientNoise noise_;
  FractalOptions fractal_;
};

/// Deep sea, shallows, beach, meadow, rock and snow.
Color height_color(double height) {
  struct Stop {
    double height;
    DVec3 color;
  };
  static constexpr Stop kStops[] = {
      {-1.0, {6, 16, 60}},    {-0.12, {14, 54, 124}},  {-0.005, {60, 150, 190}},
      {0.0, {214, 200, 150}}, {0.03, {96, 140, 60}},   {0.25, {60, 100, 48}},
      {0.45, {120, 106, 90}}, {0.62, {236, 240, 245}}, {1.01, {255, 255, 255}}};
  std::size_t i = 1;
  while (kStops[i].height < height && i + 1 < std::size(kStops)) ++i;
  const Stop &a = kStops[i - 1], &b = kStops[i];
  const double t = (height - a.height) / (b.height - a.height);
  const DVec3 mixed = a.color + t * (b.color - a.color);
  return Color(glm::u8vec3(mixed + 0.5), 255);
}

std::uint32_t icosphere_frequency(std::uint32_t triangles) {
  const double wanted = std::min(triangles, kMaxGeneratedTriangles);
  const auto below = static_cast<std::uint32_t>(std::max(1.0, std::sqrt(wanted / 20)));
  const auto error = [&](double f) { return std::abs(20 * f * f - wanted); };
  return error(below) <= error(below + 1.0) ? below : below + 1;
}

}  // namespace

TriangleMesh planet(const PlanetOptions& options) {
  const std::uint32_t f = icosphere_frequency(options.triangles);
  const Icosphere icosphere(f);
  const Relief relief(options.seed, f);
  TriangleMesh mesh;
  mesh.positions.resize(icosphere.vertex_count());
  mesh.indices.resize(3 * icosphere.triangle_count());
  if (options.colors_by_height) mesh.colors.resize(mesh.positions.size());

  const auto place = [&](std::uint32_t v, const DVec3& direction) {
    const double height = relief(direction);
    mesh.positions[v] = Vec3((1 + options.relief * height) * direction);
    if (options.colors_by_height) mesh.colors[v] = height_color(height);
  };
  icosphere.visit_corners(place);
  parallel_for(options.threads, 30, 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t edge = begin; edge < end; ++edge)
      icosphere.visit_edge(static_cast<std::uint32_t>(edge), place);
  });
  const std::size_t rows_per_piece = std::max(1u, 2048 / f);
  parallel_for(options.threads, std::size_t{20} * f, rows_per_piece,
               [&](std::size_t begin, std::size_t end) {
                 for (std::size_t row = begin; row < end; ++row) {
                   const auto face = static_cast<std::uint32_t>(row / f);
                   const auto i = static_cast<std::uint32_t>(row % f);
                   if (i > 0) icosphere.visit_row(face, i, place);
                   const std::size_t first = (std::size_t{face} * f * f + std::size_t{i} * i) * 3;
                   icosphere.write_row(face, i, &mesh.indices[first]);
                 }
               });

  // Every vertex is a position class of its own: no need to weld.
  WeldMap weld;
  weld.class_count = mesh.vertex_count();
  weld.class_of.resize(weld.class_count);
  std::iota(weld.class_of.begin(), weld.class_of.end(), 0u);
  NormalOptions normals;
  normals.weight = NormalWeight::kArea;
  normals.threads = options.threads;
  compute_normals(mesh, weld, normals);
  return mesh;
}

}  // namespace varifold
