#include <varifold/simplify/stop_report.h>

#include <algorithm>

namespace varifold {

const char* stop_reason_name(StopReason reason) {
  switch (reason) {
    case StopReason::kTargetReached:
      return "target_reached";
    case StopReason::kErrorReached:
      return "error_reached";
    case StopReason::kExhausted:
      return "exhausted";
    case StopReason::kStuck:
      return "stuck";
  }
  return "unknown";
}

namespace {

// A base of this many triangles, or of this part of the input, is as small as one could wish.
constexpr std::uint32_t kSmallBase = 200;
constexpr double kSmallPart = 0.02;

std::string advise(const WorkingSurface& surface, const StopReport& report) {
  const auto left = [&](VertexKind kind) { return report.left_by_kind[static_cast<int>(kind)]; };
  const std::uint32_t all = std::max(1u, surface.live_points());
  if (2 * (left(VertexKind::kSeam) + left(VertexKind::kCorner)) > all)
    return "most vertices that are left lie on seams of texture coordinates or materials: unwrap "
           "with fewer charts, or drop the texture coordinates (--ignore texcoords)";
  if (2 * left(VertexKind::kBorder) > all)
    return "most vertices that are left lie on open borders: if the mesh should be closed, weld it "
           "first (--weld TOLERANCE)";
  if (2 * (left(VertexKind::kLocked) + left(VertexKind::kNonManifold)) > all)
    return "most vertices that are left are non-manifold: repair the mesh, or weld it with a "
           "smaller "
           "tolerance";
  return "the parts that are left are as small as their topology allows (many components or "
         "handles)";
}

}  // namespace

StopReport report_stop(WorkingSurface& surface, Collapser& collapser,
                       const SimplifyOptions& options, bool all_done) {
  StopReport report;
  report.triangles = surface.face_count;
  const bool reached =
      options.target_triangles > 0 && surface.face_count <= options.target_triangles;
  if (reached || !all_done) {
    report.reason = StopReason::kTargetReached;
    return report;
  }
  Cell scratch;
  for (std::uint32_t p = 0; p < surface.point_count(); ++p) {
    const PointState& state = surface.points[p];
    if (state.flags & PointState::kDead) continue;
    ++report.left_by_kind[static_cast<int>(state.kind)];
    ++report.refusals[static_cast<int>(collapser.refusal_of(scratch, p))];
  }
  const auto faces =
      static_cast<std::uint32_t>(std::count(surface.is_face.begin(), surface.is_face.end(), true));
  const bool small = surface.face_count <= kSmallBase || surface.face_count <= kSmallPart * faces;
  const bool wanted = options.target_triangles == 0 && small;
  report.reason = wanted ? StopReason::kExhausted : StopReason::kStuck;
  if (!wanted) report.advice = advise(surface, report);
  return report;
}

}  // namespace varifold
