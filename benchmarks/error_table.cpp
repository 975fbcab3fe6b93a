// Prints the table of errors of docs/performance.md: the two-sided sampled distance between the
// original and its simplification, as a fraction of the bounding box's diagonal.
#include <benchmarks/bench_meshes.h>
#include <benchmarks/peers.h>
#include <varifold/measure/surface_distance.h>
#include <varifold/simplify/simplify.h>
#include <array>
#include <cstdint>
#include <cstdio>
#include <string>
#include <vector>

namespace varifold::bench {

namespace {

constexpr std::array<double, 3> kParts = {0.5, 0.1, 0.01};

struct Row {
  std::string title;
  std::array<std::string, kParts.size()> cells;
};

// RMS and maximum, each the greater one of both directions.
std::string distance_cell(const TriangleMesh& original, const TriangleMesh& simplified) {
  const SurfaceDistanceReport report = surface_distance(simplified, original);
  std::array<char, 64> text{};
  std::snprintf(text.data(), text.size(), "%.2e / %.1e", report.rms / report.diagonal,
                report.hausdorff / report.diagonal);
  return text.data();
}

std::uint32_t triangles_at(const TriangleMesh& mesh, double part) {
  return static_cast<std::uint32_t>(part * mesh.triangle_count());
}

Row varifold_row(const TriangleMesh& original, Placement placement, Metric metric) {
  SimplifyOptions options;
  options.placement = placement;
  options.metric = metric;
  options.measure_error = false;
  Row row{std::string(metric == Metric::kEnergy ? "Varifold by energy" : "Varifold") +
              (placement == Placement::kKept ? ", vertices kept" : ", vertices moved"),
          {}};
  const auto result = simplify(original, options);
  if (!result) return row;
  for (std::size_t i = 0; i < kParts.size(); ++i) {
    const std::uint32_t level =
        result->detailed.sequence.level_for_triangles(triangles_at(original, kParts[i]));
    row.cells[i] = distance_cell(original, mesh_at_level(result->detailed, level));
  }
  return row;
}

Row meshoptimizer_row(const TriangleMesh& original) {
  Row row{"meshoptimizer 0.18, vertices kept", {}};
  for (std::size_t i = 0; i < kParts.size(); ++i)
    row.cells[i] = distance_cell(
        original, meshoptimizer_simplify(original, triangles_at(original, kParts[i])));
  return row;
}

// Not measured by this program: taken once with the tools that accompany [Hoppe1999], memoryless
// quadrics, vertices moved; two-sided, 200,000 samples, measured as here.
std::vector<Row> quoted_rows(const std::string& name) {
  const std::string title = "memoryless quadrics [Hoppe1999], vertices moved (quoted)";
  if (name == "bunny.ply")
    return {{title, {"4.34e-05 / 3.3e-04", "1.91e-04 / 1.3e-03", "1.34e-03 / 1.2e-02"}}};
  if (name == "igea.ply")
    return {{title, {"1.13e-05 / 9.2e-05", "5.98e-05 / 4.8e-04", "4.16e-04 / 3.6e-03"}}};
  return {};
}

void print_rows(const std::string& name) {
  const TriangleMesh original = without_attributes(mesh(name));
  std::vector<Row> rows = {varifold_row(original, Placement::kKept, Metric::kQuadric),
                           varifold_row(original, Placement::kKept, Metric::kEnergy),
                           meshoptimizer_row(original),
                           varifold_row(original, Placement::kOptimal, Metric::kQuadric),
                           varifold_row(original, Placement::kOptimal, Metric::kEnergy)};
  for (Row& row : quoted_rows(name)) rows.push_back(std::move(row));
  const std::string stem = name.substr(0, name.find('.'));
  for (const Row& row : rows) {
    std::printf("| %s | %s |", stem.c_str(), row.title.c_str());
    for (const std::string& cell : row.cells) std::printf(" %s |", cell.c_str());
    std::printf("\n");
    std::fflush(stdout);
  }
}

}  // namespace

}  // namespace varifold::bench

int main() {
  const std::vector<std::string> names =
      varifold::bench::present({"bunny.ply", "armadillo.ply", "igea.ply"});
  if (names.empty()) {
    std::fprintf(stderr, "no meshes: set VARIFOLD_MESHES to the folder of bunny.ply, ...\n");
    return 1;
  }
  std::printf("| mesh | simplified by | 50 %%: RMS / max | 10 %% | 1 %% |\n");
  std::printf("| --- | --- | --- | --- | --- |\n");
  for (const std::string& name : names) varifold::bench::print_rows(name);
  return 0;
}
