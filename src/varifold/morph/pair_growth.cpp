#include <varifold/morph/pair_growth.h>
#include <varifold/morph/sphere_embedding.h>
#include <varifold/morph/surface_lift.h>
#include <algorithm>
#include <cmath>
#include <utility>

namespace varifold {
namespace {

using Reach = StarRelaxation::Reach;

// All vertices are relaxed whenever there are so many times more of them.
constexpr double kGrowth = 1.25;
constexpr int kBaseRounds = 8;
constexpr int kRoundsAtGrowth = 2;
constexpr int kFinalRounds = 4;
constexpr int kSweeps = 2;  // of one side before it is the other's turn
// Vertices are tried all over their stars while there are fewer.
constexpr double kCoarse = 2000;
// Features are dragged from this size on, and up to the other one.
constexpr double kLeastDragged = 200, kMostDragged = 2000;
constexpr int kDragRounds = 60;
// The part of the mean area of a triangle that each gets at least, roughly.
constexpr double kAreaFloor = 0.02;

}  // namespace

// One of the two, as far as it has grown.
struct PairGrowth::Side {
  explicit Side(const SurfaceView& surface)
      : positions(surface.positions),
        mesh(surface.indices, static_cast<std::uint32_t>(positions.size())),
        points(positions.size()),
        is_held(positions.size(), false),
        relaxation(mesh, positions, points),
        area(area_of(surface.indices, positions)) {}

  std::span<const Vec3> positions;
  RingMesh mesh;
  std::vector<SpherePoint> points;
  std::vector<bool> is_held;
  StarRelaxation relaxation;
  double area = 0;
  CollapseRecord record;
  std::size_t left = 0;  // steps of the record that are not undone
  // What the other side is lifted onto.
  std::unique_ptr<SphereTriangulation> sphere;
  std::unique_ptr<SurfaceLift> lift;
};

PairGrowth::PairGrowth(const std::array<SurfaceView, 2>& surfaces)
    : sides_{std::make_unique<Side>(surfaces[0]), std::make_unique<Side>(surfaces[1])} {}

PairGrowth::~PairGrowth() = default;

void PairGrowth::coarsen(int s, const DecimationOptions& options) {
  Side& side = *sides_[s];
  side.record = decimate(side.mesh, side.positions, options);
  side.left = side.record.steps.size();
}

CoarseSurface PairGrowth::coarse(int s) const {
  const Side& side = *sides_[s];
  CoarseSurface result;
  std::vector<std::uint32_t> number(side.positions.size(), kNone);
  for (std::uint32_t v = 0; v < side.positions.size(); ++v) {
    if (!side.mesh.is_live(v)) continue;
    number[v] = static_cast<std::uint32_t>(result.vertices.size());
    result.vertices.push_back(v);
    result.positions.push_back(side.positions[v]);
  }
  result.indices = side.mesh.triangles();
  for (std::uint32_t& corner : result.indices) corner = number[corner];
  return result;
}

void PairGrowth::hold(int s, std::uint32_t vertex) { sides_[s]->is_held[vertex] = true; }

void PairGrowth::put(int s, std::uint32_t vertex, const SpherePoint& point) {
  sides_[s]->points[vertex] = point;
}

bool PairGrowth::is_positive() const {
  return std::all_of(sides_.begin(), sides_.end(), [](const auto& side) {
    return count_flipped_on_sphere(side->mesh.triangles(), side->points) == 0;
  });
}

bool PairGrowth::grow(std::span<const FeaturePoint> features, std::uint32_t most,
                      const std::function<bool(float done)>& progress) {
  const double full = std::max(sides_[0]->positions.size(), sides_[1]->positions.size());
  double size = std::max(sides_[0]->mesh.vertex_count(), sides_[1]->mesh.vertex_count());
  if (size < kCoarse) exchange(kBaseRounds, Reach::kStar);
  if (size >= kLeastDragged) bring_features(features);
  while (sides_[0]->left + sides_[1]->left > 0 && size < most) {
    size *= kGrowth;
    for (int s = 0; s < 2; ++s) {
      see_other(s);
      if (!add_vertices(s, static_cast<std::uint32_t>(size))) return false;
    }
    exchange(kRoundsAtGrowth, size < kCoarse ? Reach::kStar : Reach::kNear);
    if (size >= kLeastDragged && size <= kMostDragged) bring_features(features);
    if (progress && !progress(static_cast<float>(0.8 * std::min(1.0, size / full)))) return false;
  }
  exchange(kFinalRounds, Reach::kNear);
  return !progress || progress(1);
}

// Has side s look at the other one as it is now.
void PairGrowth::see_other(int s) {
  Side &side = *sides_[s], &other = *sides_[1 - s];
  auto sphere = std::make_unique<SphereTriangulation>(other.mesh.triangles(), other.points);
  auto lift = std::make_unique<SurfaceLift>(*sphere, other.positions);
  side.relaxation.set_scale(side.area / other.area);
  const double triangles = 2.0 * side.mesh.vertex_count() - 4;
  side.relaxation.set_length_floor(std::sqrt(kAreaFloor * 2.3 * side.area / triangles + 1e-30));
  side.relaxation.set_lift(lift.get());
  other.sphere = std::move(sphere);
  other.lift = std::move(lift);
}

bool PairGrowth::add_vertices(int s, std::uint32_t size) {
  Side& side = *sides_[s];
  while (side.left > 0 && side.mesh.vertex_count() < size) {
    const RecordedCollapse& step = side.record.steps[--side.left];
    side.mesh.undo(side.record, step);
    if (!side.relaxation.place(step.vertex)) return false;
    for (const std::uint32_t neighbour : side.mesh.ring(step.vertex))
      relax(side, neighbour, Reach::kNear);
    relax(side, step.vertex, Reach::kNear);
  }
  return true;
}

void PairGrowth::relax(Side& side, std::uint32_t vertex, Reach reach) {
  if (!side.is_held[vertex]) side.relaxation.relax(vertex, 2, reach);
}

// The sides take turns.
void PairGrowth::exchange(int rounds, Reach reach) {
  for (int round = 0; round < rounds; ++round)
    for (int s = 0; s < 2; ++s) {
      see_other(s);
      Side& side = *sides_[s];
      for (int sweep = 0; sweep < kSweeps; ++sweep)
        for (std::uint32_t v = 0; v < side.points.size(); ++v)
          if (side.mesh.is_live(v)) relax(side, v, reach);
    }
}

void PairGrowth::bring_features(std::span<const FeaturePoint> features) {
  Side &a = *sides_[0], &b = *sides_[1];
  double least = 1e300;
  for (int round = 0; round < kDragRounds; ++round) {
    double left = 0;
    for (const auto& [in_a, in_b] : features) {
      if (!a.mesh.is_live(in_a) || !b.mesh.is_live(in_b)) continue;
      a.is_held[in_a] = b.is_held[in_b] = true;
      if (a.points[in_a] == b.points[in_b]) continue;
      const DVec3 half = direction(a.points[in_a]) + direction(b.points[in_b]);
      const SpherePoint goal = glm::dot(half, half) > 1e-6 ? to_sphere_point(half) : a.points[in_a];
      a.relaxation.drag(in_a, goal);
      b.relaxation.drag(in_b, goal);
      left += glm::distance(direction(a.points[in_a]), direction(b.points[in_b]));
    }
    if (left == 0 || left > 0.999 * least) return;
    least = left;
    exchange(1, Reach::kNear);
  }
}

double PairGrowth::distortion() {
  double sum = 0;
  for (int s = 0; s < 2; ++s) {
    see_other(s);
    sum += sides_[s]->relaxation.mean_distortion();
  }
  return 0.5 * sum;
}

std::vector<Meeting> PairGrowth::meetings() {
  std::vector<Meeting> result;
  for (int s = 0; s < 2; ++s) {
    see_other(s);
    const Side& side = *sides_[s];
    std::vector<double> area(side.positions.size(), 0);
    const std::vector<std::uint32_t> triangles = side.mesh.triangles();
    for (std::size_t t = 0; t < triangles.size(); t += 3) {
      const double part =
          area_of(std::span(triangles).subspan(t, 3), side.positions) / (3 * side.area);
      for (std::size_t k = t; k < t + 3; ++k) area[triangles[k]] += part;
    }
    for (std::uint32_t v = 0; v < side.positions.size(); ++v) {
      if (!side.mesh.is_live(v)) continue;
      const DVec3 here(side.positions[v]), there = side.relaxation.lifted()[v];
      result.push_back({s == 0 ? here : there, s == 0 ? there : here, area[v]});
    }
  }
  return result;
}

std::span<const SpherePoint> PairGrowth::points(int s) const { return sides_[s]->points; }

}  // namespace varifold
