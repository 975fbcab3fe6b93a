#include <benchmarks/pixel_error_tables.h>

#include <benchmarks/error_curve.h>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <iterator>
#include <map>
#include <optional>
#include <utility>

namespace varifold::bench {
namespace {

using Field = TriangleField;

// What is measured, the error where triangles are told, and the range of the mean.
struct Measure {
  Field field;
  const char* title;
  double told, low, high;  // pixels
};
constexpr Measure kMeasures[] = {{&CutErrors::max, "max", 1, 0.5, 4},
                                 {&CutErrors::most_of_1000, "99.9 %", 1, 0.5, 4},
                                 {&CutErrors::rms, "RMS", 0.25, 0.125, 1}};

ErrorCurve curve_of(const std::vector<CutErrors>& results, const CutErrors& like, Field error,
                    Field triangles) {
  std::vector<CurvePoint> points;
  for (const CutErrors& r : results)
    if (r.mesh == like.mesh && r.kind == like.kind && r.model == like.model && r.mode == like.mode)
      points.push_back({r.*error, r.*triangles});
  return ErrorCurve(std::move(points));
}

void print_number(const char* form, const std::optional<double>& number) {
  number ? std::printf(form, *number) : std::printf("-");
}

}  // namespace

void print_asked(const std::vector<CutErrors>& results) {
  std::printf(
      "\n| mesh | views | model | asked, px | max | 99.9 %% | RMS | drawn | inside | all |\n"
      "| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |\n");
  for (const CutErrors& r : results)
    if (r.mode == Mode::kFrustum &&
        (r.asked == 0.5 || r.asked == 1 || r.asked == 2 || r.asked == 4))
      std::printf("| %s | %s | %s | %g | %.2f | %.2f | %.3f | %.0f | %.0f | %.0f |\n",
                  r.mesh.c_str(), r.kind.c_str(), r.model.c_str(), r.asked, r.max, r.most_of_1000,
                  r.rms, r.drawn, r.inside, r.all);
}

void print_equal(const std::vector<CutErrors>& results, Mode mode, Field triangles) {
  std::printf("\n%s, %s\n\n| mesh | views | measured | %s",
              mode == Mode::kSeen ? "what is seen" : "what the frustum holds",
              triangles == &CutErrors::drawn ? "triangles of pieces that are not culled"
                                             : "triangles inside the frustum",
              kPeer);
  for (const std::uint32_t size : kPatchSizes) std::printf(" | patches of %u, mean", size);
  std::printf(" |\n| --- | --- | --- | --- | --- | --- | --- |\n");
  std::map<std::pair<std::string, std::size_t>, std::vector<double>> means;  // logarithms
  for (const Measure& measure : kMeasures) {
    for (const CutErrors& r : results) {
      if (r.mode != mode || r.asked != 1 || r.model != kPeer) continue;
      const ErrorCurve peer = curve_of(results, r, measure.field, triangles);
      const auto of_peer = peer.triangles_at(measure.told);
      std::printf("| %s | %s | %s %g px | ", r.mesh.c_str(), r.kind.c_str(), measure.title,
                  measure.told);
      print_number("%.0f", of_peer);
      for (std::size_t i = 0; i < std::size(kPatchSizes); ++i) {
        CutErrors like = r;
        like.model = "patches of " + std::to_string(kPatchSizes[i]);
        const ErrorCurve own = curve_of(results, like, measure.field, triangles);
        const auto of_own = own.triangles_at(measure.told);
        const auto mean = mean_ratio(own, peer, measure.low, measure.high);
        std::printf(" | ");
        print_number("%.2f", of_own && of_peer ? std::optional(*of_own / *of_peer) : std::nullopt);
        std::printf(", ");
        print_number("%.2f", mean);
        if (mean) means[{measure.title, i}].push_back(std::log(*mean));
      }
      std::printf(" |\n");
    }
  }
  for (const Measure& measure : kMeasures) {
    std::printf("| all | all | %s | ", measure.title);
    for (std::size_t i = 0; i < std::size(kPatchSizes); ++i) {
      double sum = 0;
      const std::vector<double>& logarithms = means[{measure.title, i}];
      for (const double x : logarithms) sum += x / static_cast<double>(logarithms.size());
      std::printf(" | %.2f", std::exp(sum));
    }
    std::printf(" |\n");
  }
}

void write_curves(const std::vector<CutErrors>& results, const char* path) {
  std::FILE* const file = std::fopen(path, "w");
  if (file == nullptr) return std::perror(path);
  std::fprintf(file, "mesh,views,seen,model,asked,max,most_of_1000,rms,drawn,inside,all\n");
  for (const CutErrors& r : results)
    std::fprintf(file, "%s,%s,%d,%s,%g,%.4f,%.4f,%.5f,%.1f,%.1f,%.1f\n", r.mesh.c_str(),
                 r.kind.c_str(), r.mode == Mode::kSeen ? 1 : 0, r.model.c_str(), r.asked, r.max,
                 r.most_of_1000, r.rms, r.drawn, r.inside, r.all);
  std::fclose(file);
}

}  // namespace varifold::bench
