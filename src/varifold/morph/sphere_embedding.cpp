// Based on: [PraunHoppe2003] section 3: undo collapses one by one, each new vertex within the
//   kernel of its ring, and relax as the mesh grows.
// Differs: whole-numbered directions and exact signs; a vertex goes to the middle of its kernel;
//   half of the sphere for discs, whose boundary stays.
#include <varifold/morph/disc_pair.h>
#include <varifold/morph/ring_decimation.h>
#include <varifold/morph/sphere_embedding.h>
#include <varifold/morph/star_relaxation.h>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace varifold {
namespace {

// All vertices are relaxed whenever there are so many times more of them.
constexpr double kGrowth = 1.25;
constexpr int kSweepsAtGrowth = 2;
constexpr int kAttempts = 4;
constexpr int kSweepsForRoom = 10;
constexpr double kAlike = 1e3;  // a floor of lengths that makes all triangles alike
// The part of the mean area of a triangle that each gets at least, roughly.
constexpr double kAreaFloor = 0.02;

// Around the middle of its box, one unit large: costs and floors are in proportion then.
std::vector<Vec3> normalized(std::span<const Vec3> positions) {
  Box box;
  for (const Vec3& p : positions) box.add(p);
  const DVec3 lower(box.lower), extent = DVec3(box.upper) - lower;
  const double scale = 1 / std::max({extent.x, extent.y, extent.z, 1e-300});
  std::vector<Vec3> result;
  result.reserve(positions.size());
  for (const Vec3& p : positions) result.emplace_back(Vec3(scale * (DVec3(p) - lower)) - Vec3(0.5));
  return result;
}

class SphereEmbedding {
 public:
  SphereEmbedding(std::span<const std::uint32_t> indices, std::span<const Vec3> positions,
                  const SphereEmbeddingOptions& options)
      : SphereEmbedding(indices, positions, std::vector<SpherePoint>(positions.size()), {},
                        options) {}

  // Points that are fixed have places, and are all but one of those that a decimation leaves.
  SphereEmbedding(std::span<const std::uint32_t> indices, std::span<const Vec3> positions,
                  std::vector<SpherePoint> points, std::vector<bool> is_fixed,
                  const SphereEmbeddingOptions& options)
      : options_(options),
        positions_(normalized(positions)),
        mesh_(indices, static_cast<std::uint32_t>(positions.size())),
        is_fixed_(std::move(is_fixed)),
        fixed_(static_cast<std::uint32_t>(std::count(is_fixed_.begin(), is_fixed_.end(), true))),
        points_(std::move(points)),
        relaxation_(mesh_, positions_, points_) {
    for (std::size_t t = 0; t + 2 < indices.size(); t += 3) {
      // The fan that closes a disc is no part of it.
      if (!is_free(indices[t]) && !is_free(indices[t + 1]) && !is_free(indices[t + 2])) continue;
      const Vec3 &a = positions_[indices[t]], &b = positions_[indices[t + 1]],
                 &c = positions_[indices[t + 2]];
      area_ += 0.5 * static_cast<double>(glm::length(glm::cross(b - a, c - a)));
    }
  }

  Result<std::vector<SpherePoint>> run() {
    const CollapseRecord record =
        fixed_ > 0 ? decimate_to_cone() : decimate_to_tetrahedron(mesh_, positions_);
    if (mesh_.vertex_count() != (fixed_ > 0 ? fixed_ + 1 : 4))
      return fail(ErrorKind::kFailed, "the surface does not collapse to a tetrahedron or a cone");
    fixed_ > 0 ? place_tip() : place_base();
    const std::size_t steps = record.steps.size();
    double next_sweep = fixed_ > 0 ? 2 : 6;
    for (std::size_t i = 0; i < steps; ++i) {
      const RecordedCollapse& step = record.steps[steps - 1 - i];
      if (!split(record, step) && !split_with_more_room(record, step))
        return out_of_resolution(step.vertex);
      if (free_count() < next_sweep) continue;
      if (!proceed(0.5f * static_cast<float>(i) / static_cast<float>(steps))) return cancelled();
      for (int sweep = 0; sweep < kSweepsAtGrowth; ++sweep) relax_all();
      next_sweep = kGrowth * free_count();
    }
    for (int sweep = 0; sweep < options_.final_sweeps; ++sweep) {
      const auto done = static_cast<float>(sweep) / static_cast<float>(options_.final_sweeps);
      if (!proceed(0.5f + 0.5f * done)) return cancelled();
      relax_all();
    }
    return std::move(points_);
  }

 private:
  CollapseRecord decimate_to_cone() {
    std::vector<Hold> holds(is_fixed_.size(), Hold::kFree);
    for (std::size_t v = 0; v < holds.size(); ++v)
      if (is_fixed_[v]) holds[v] = Hold::kAlways;
    DecimationOptions options;
    options.least = fixed_ + 1;
    options.holds = holds;
    options.bars_targets = true;
    return decimate(mesh_, positions_, options);
  }
  [[nodiscard]] bool proceed(float done) const {
    return !options_.progress || options_.progress(done);
  }
  static tl::unexpected<Error> cancelled() {
    return fail(ErrorKind::kCancelled, "cancelled while a surface was laid onto the sphere");
  }
  static tl::unexpected<Error> out_of_resolution(std::uint32_t vertex) {
    return fail(ErrorKind::kFailed, "vertex " + std::to_string(vertex) +
                                        " finds no place on the sphere: triangles are too small");
  }

  [[nodiscard]] std::uint32_t free_count() const { return mesh_.vertex_count() - fixed_; }
  [[nodiscard]] bool is_free(std::uint32_t vertex) const {
    return fixed_ == 0 || !is_fixed_[vertex];
  }

  // Edges are at least as long as those of a small part of a mean triangle.
  void set_floor() {
    relaxation_.set_scale(area_ / sphere_area());
    relaxation_.set_length_floor(std::sqrt(kAreaFloor * 2.3 * area_ / triangle_count() + 1e-30));
  }
  [[nodiscard]] double sphere_area() const { return (fixed_ > 0 ? 2 : 4) * std::numbers::pi; }
  [[nodiscard]] double triangle_count() const {
    // Those of the fan that closes a disc are as many as points of its boundary.
    const double fan = fixed_ > 0 ? fixed_ - 1.0 : 0;
    return 2.0 * mesh_.vertex_count() - 4 - fan;
  }

  void place_base() {
    std::uint32_t top = 0;
    while (!mesh_.is_live(top)) ++top;
    points_[top] = to_sphere_point({0, 0, 1});
    const double r = std::sqrt(8.0) / 3, x = -0.5 * r, y = std::sqrt(0.75) * r;
    const auto ring = mesh_.ring(top);
    points_[ring[0]] = to_sphere_point({r, 0, -1.0 / 3});
    points_[ring[1]] = to_sphere_point({x, y, -1.0 / 3});
    points_[ring[2]] = to_sphere_point({x, -y, -1.0 / 3});
    set_floor();
  }

  // The one that is left of a disc sees all of the boundary from anywhere above.
  void place_tip() {
    for (std::uint32_t v = 0; v < points_.size(); ++v)
      if (mesh_.is_live(v) && is_free(v)) points_[v] = to_sphere_point({0, 0, 1});
    set_floor();
  }

  bool split(const CollapseRecord& record, const RecordedCollapse& step) {
    mesh_.undo(record, step);
    if (!relaxation_.place(step.vertex)) return false;
    for (const std::uint32_t neighbour : mesh_.ring(step.vertex))
      if (is_free(neighbour)) relaxation_.relax(neighbour, 2);
    relaxation_.relax(step.vertex, 2);
    return true;
  }

  // Where there is no place for a vertex, all others are moved as if all triangles were alike,
  // which leaves room everywhere; the shape of the surface gets its due later.
  bool split_with_more_room(const CollapseRecord& record, const RecordedCollapse& step) {
    CollapseRecord again;
    for (int attempt = 0; attempt < kAttempts; ++attempt) {
      mesh_.collapse(step.vertex, record.ring(step)[0], again);
      relaxation_.set_length_floor(kAlike);
      relaxation_.set_scale(0.25 * std::sqrt(3.0) * kAlike * kAlike * triangle_count() /
                            sphere_area());
      for (int sweep = 0; sweep < (1 << attempt) * kSweepsForRoom; ++sweep) relax_each();
      set_floor();
      if (split(record, step)) return true;
    }
    return false;
  }

  void relax_all() {
    set_floor();
    relax_each();
  }

  void relax_each() {
    for (std::uint32_t v = 0; v < points_.size(); ++v)
      if (mesh_.is_live(v) && is_free(v)) relaxation_.relax(v, 2);
  }

  const SphereEmbeddingOptions& options_;
  std::vector<Vec3> positions_;
  RingMesh mesh_;
  std::vector<bool> is_fixed_;  // empty for a closed surface
  std::uint32_t fixed_ = 0;     // how many; one of them closes the disc
  std::vector<SpherePoint> points_;
  StarRelaxation relaxation_;
  double area_ = 0;
};

}  // namespace

Result<std::vector<SpherePoint>> embed_on_sphere(std::span<const std::uint32_t> indices,
                                                 std::span<const Vec3> positions,
                                                 const SphereEmbeddingOptions& options) {
  return SphereEmbedding(indices, positions, options).run();
}

Result<std::vector<SpherePoint>> embed_on_half_sphere(const SphereSurface& disc,
                                                      std::vector<SpherePoint> points,
                                                      const SphereEmbeddingOptions& options) {
  CappedDisc closed = capped({{{}, disc}, std::move(points)});
  auto found = SphereEmbedding(closed.surface.indices, closed.surface.positions,
                               std::move(closed.points), std::move(closed.is_fixed), options)
                   .run();
  if (found) found->pop_back();
  return found;
}

std::uint32_t count_flipped_on_sphere(std::span<const std::uint32_t> indices,
                                      std::span<const SpherePoint> points) {
  std::uint32_t flipped = 0;
  for (std::size_t t = 0; t + 2 < indices.size(); t += 3)
    flipped += orientation(points[indices[t]], points[indices[t + 1]], points[indices[t + 2]]) <= 0;
  return flipped;
}

}  // namespace varifold
