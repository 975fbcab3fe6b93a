// Triangles over measured error: one point for each tolerance asked for.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <vector>

namespace varifold::bench {

struct CurvePoint {
  double error = 0, triangles = 0;
};

/// By ascending error, with triangles that fall as it rises; straight between points where both
/// axes are logarithmic.
class ErrorCurve {
 public:
  ErrorCurve() = default;
  /// Points with an error of 0 are left out, and so are those where more triangles are not better.
  explicit ErrorCurve(std::vector<CurvePoint> points) {
    std::sort(points.begin(), points.end(), [](const CurvePoint& a, const CurvePoint& b) {
      return a.error < b.error || (a.error == b.error && a.triangles < b.triangles);
    });
    for (const CurvePoint& p : points)
      if (p.error > 0 && p.triangles > 0 &&
          (points_.empty() || p.triangles < points_.back().triangles))
        points_.push_back(p);
  }

  /// Nothing where the error is outside what was measured.
  [[nodiscard]] std::optional<double> triangles_at(double error) const {
    if (points_.empty() || error < points_.front().error || error > points_.back().error) return {};
    const auto above = std::lower_bound(points_.begin(), points_.end(), error,
                                        [](const CurvePoint& p, double e) { return p.error < e; });
    if (above == points_.begin()) return above->triangles;
    const CurvePoint &a = *(above - 1), &b = *above;
    const double part = std::log(error / a.error) / std::log(b.error / a.error);
    return a.triangles * std::pow(b.triangles / a.triangles, part);
  }

  [[nodiscard]] const std::vector<CurvePoint>& points() const { return points_; }

 private:
  std::vector<CurvePoint> points_;
};

/// The geometric mean of how many triangles `a` needs for each that `b` does, over the logarithms
/// of the errors from `low` to `high` that both were measured at. Nothing where there are none.
[[nodiscard]] inline std::optional<double> mean_ratio(const ErrorCurve& a, const ErrorCurve& b,
                                                      double low, double high) {
  constexpr int kSteps = 64;
  double sum = 0;
  int count = 0;
  for (int i = 0; i <= kSteps; ++i) {
    const double error = low * std::pow(high / low, static_cast<double>(i) / kSteps);
    const auto of_a = a.triangles_at(error), of_b = b.triangles_at(error);
    if (of_a && of_b) sum += std::log(*of_a / *of_b), ++count;
  }
  if (count == 0) return {};
  return std::exp(sum / count);
}

}  // namespace varifold::bench
