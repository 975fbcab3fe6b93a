#include <varifold/simplify/pose_field.h>

#include <varifold/base/parallel.h>
#include <varifold/simplify/borrowed_normals.h>
#include <varifold/simplify/packed_normal.h>
#include <cmath>

namespace varifold {

namespace {

// The mean of the normals of the faces around, by area.
std::uint32_t normal_at(const WorkingSurface& surface, std::uint32_t point,
                        const PosePlaces& pose) {
  const RingEntry* ring = surface.ring(point);
  const std::size_t size = surface.points[point].ring_size;
  const Vec3 origin = pose.position(point);
  Vec3 sum(0);
  for (std::size_t i = 0; i < size; ++i) {
    if (ring[i].face == kNone) continue;
    const std::uint32_t next = ring[i + 1 == size ? 0 : i + 1].neighbor;
    sum += glm::cross(pose.position(ring[i].neighbor) - origin, pose.position(next) - origin);
  }
  return pack_normal(sum);
}

// About the middle of the box, such that taking it off positions rounds nothing: an axis that 0 is
// near to stays as it is, on others all numbers are large, and few bits are taken off.
DVec3 exact_center(const Box& box) {
  DVec3 center(0);
  for (int axis = 0; axis < 3 && !box.empty(); ++axis) {
    const double low = box.lower[axis], high = box.upper[axis], middle = 0.5 * (low + high);
    if (std::abs(middle) <= high - low) continue;
    const double step = std::exp2(std::floor(std::log2(std::abs(middle))) - 16);
    center[axis] = std::round(middle / step) * step;
  }
  return center;
}

}  // namespace

PoseField::PoseField(const WorkingSurface& surface, std::span<const Vec3> rest,
                     std::span<const std::span<const Vec3>> poses, int threads)
    : places_(surface.point_count() * poses.size()),
      exact_(poses.empty() ? 0 : surface.point_count() * (poses.size() + 1)),
      count_(static_cast<std::uint32_t>(poses.size())) {
  for (std::uint32_t i = 0; i < count_; ++i)
    fill(surface, poses[i], {surface.center, surface.scale}, {places_.data() + i, count_}, threads);
  for (std::uint32_t i = 0; i <= count_ && count_ > 0; ++i) {
    const std::span<const Vec3> shape = i == 0 ? rest : poses[i - 1];
    Box box;
    for (const std::uint32_t vertex : surface.first_vertex_of_point) box.add(shape[vertex]);
    const double diagonal = box.empty() ? 0 : glm::length(DVec3(box.upper) - DVec3(box.lower));
    const double scale = diagonal > 0 ? std::exp2(-std::round(std::log2(diagonal))) : 1;
    fill(surface, shape, {exact_center(box), scale}, {exact_.data() + i, count_ + 1}, threads);
  }
}

void PoseField::fill(const WorkingSurface& surface, std::span<const Vec3> shape,
                     const Placement& placement, const Column& column, int threads) {
  const auto for_each_point = [&](const auto& body) {
    parallel_for(threads, surface.point_count(), 4096, [&](std::size_t begin, std::size_t end) {
      for (auto point = static_cast<std::uint32_t>(begin); point < end; ++point)
        body(point, column.first[point * column.stride]);
    });
  };
  for_each_point([&](std::uint32_t point, PosePlace& place) {
    const DVec3 p(shape[surface.first_vertex_of_point[point]]);
    place.position = Vec3((p - placement.center) * placement.scale);
  });
  const PosePlaces places{column.first, column.stride};
  for_each_point([&](std::uint32_t point, PosePlace& place) {
    place.normal = normal_at(surface, point, places);
  });
  borrow_normals(surface, [&](std::uint32_t point) -> std::uint32_t& {
    return column.first[point * column.stride].normal;
  });
}

RingErrors PoseField::mean_errors(WorkingSurface& surface, std::uint32_t point,
                                  const QuadricOptions& options, const RingErrors& at_rest,
                                  PoseScratch& scratch) const {
  const std::size_t size = surface.points[point].ring_size;
  scratch.errors.assign(at_rest.errors, at_rest.errors + size);
  float weight = at_rest.weight;
  for (std::uint32_t number = 0; number < count_; ++number) {
    const PosePlaces places = pose(number);
    scratch.offsets.gather(surface, point, places);
    const PointQuadric from = point_quadric(surface, point, options, scratch.offsets, places);
    const float* errors = scratch.offsets.errors(from.quadric);
    for (std::size_t i = 0; i < size; ++i) scratch.errors[i] += errors[i];
    weight += from.weight;
  }
  const float part = 1 / static_cast<float>(count_ + 1);
  for (float& error : scratch.errors) error *= part;
  return {scratch.errors.data(), weight * part};
}

Refusal PoseField::test(WorkingSurface& surface, std::uint32_t from, std::uint32_t onto,
                        const LegalityOptions& options) const {
  for (std::uint32_t shape = 0; shape <= count_ && count_ > 0; ++shape) {
    const PosePlaces places{exact_.data() + shape, count_ + 1};
    const ApexMove move{from, onto, places.position(onto), places.normal(onto)};
    if (const Refusal refusal = test_faces(surface, move, options, places);
        refusal != Refusal::kLegal)
      return refusal;
  }
  return Refusal::kLegal;
}

}  // namespace varifold
