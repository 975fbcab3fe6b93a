#include <varifold/simplify/pose_field.h>

#include <varifold/base/parallel.h>
#include <varifold/simplify/packed_normal.h>

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

}  // namespace

PoseField::PoseField(const WorkingSurface& surface, std::span<const std::span<const Vec3>> poses,
                     int threads)
    : places_(surface.point_count() * poses.size()),
      count_(static_cast<std::uint32_t>(poses.size())) {
  const auto for_each_point = [&](const auto& body) {
    parallel_for(threads, surface.point_count(), 4096, [&](std::size_t begin, std::size_t end) {
      for (auto point = static_cast<std::uint32_t>(begin); point < end; ++point)
        for (std::uint32_t i = 0; i < count_; ++i) body(point, i, places_[point * count_ + i]);
    });
  };
  for_each_point([&](std::uint32_t point, std::uint32_t number, PosePlace& place) {
    const Vec3& p = poses[number][surface.first_vertex_of_point[point]];
    place.position = Vec3((DVec3(p) - surface.center) * surface.scale);
  });
  for_each_point([&](std::uint32_t point, std::uint32_t number, PosePlace& place) {
    place.normal = normal_at(surface, point, pose(number));
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
  for (std::uint32_t number = 0; number < count_; ++number) {
    const PosePlaces places = pose(number);
    const ApexMove move{from, onto, places.position(onto), places.normal(onto)};
    if (const Refusal refusal = test_faces(surface, move, options, places);
        refusal != Refusal::kLegal)
      return refusal;
  }
  return Refusal::kLegal;
}

}  // namespace varifold
