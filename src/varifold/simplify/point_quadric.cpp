#include <varifold/base/parallel.h>
#include <varifold/simplify/point_quadric.h>

#include <varifold/simplify/classify.h>
#include <algorithm>
#include <cmath>

namespace varifold {

namespace {

// Keeps the division by the area of a face without any finite; far below all others.
constexpr float kTiny = 1e-30f;

// Planes through the feature edges, at right angles to the faces there. Borders between regions
// are no part of the shape: they may wander over the surface (held, rough ones cost a patch tree up
// to 80 % in error).
template <class Places>
void add_constraints(WorkingSurface& surface, std::uint32_t point, const Places& places,
                     const QuadricOptions& options, Quadric& quadric) {
  const auto ring = surface.ring_span(point);
  const bool is_open = std::any_of(ring.begin(), ring.end(),
                                   [](const RingEntry& entry) { return entry.face == kNone; });
  if (!is_open && !surface.wedge.has_seams()) return;
  const Vec3 origin = places.position(point);
  for (std::size_t i = 0; i < ring.size(); ++i) {
    if (ring[i].face == kNone) continue;
    const std::size_t ends[2] = {i, i + 1 == ring.size() ? 0 : i + 1};
    const Vec3 edges[2] = {places.position(ring[ends[0]].neighbor) - origin,
                           places.position(ring[ends[1]].neighbor) - origin};
    const Vec3 normal = normalize_or_zero(glm::cross(edges[0], edges[1]));
    for (int k = 0; k < 2; ++k) {
      const EdgeUse use = edge_use_at(surface, point, ends[k]);
      if (!use.is_feature() || (use.region && !use.seam)) continue;
      const float weight = use.seam ? options.seam_weight : options.border_weight;
      quadric.add_plane(normalize_or_zero(glm::cross(edges[k], normal)),
                        0.5f * weight * glm::dot(edges[k], edges[k]));
    }
  }
}

}  // namespace

template <class Places>
void RingOffsets::gather_places(const WorkingSurface& surface, std::uint32_t point,
                                const Places& places) {
  const RingEntry* ring = surface.ring(point);
  size_ = surface.points[point].ring_size;
  const std::size_t stride = padded(size_);
  float* memory = inline_;
  if (size_ > kInline) {
    long_.resize(5 * stride);
    memory = long_.data();
  }
  x_ = memory;
  y_ = x_ + stride;
  z_ = y_ + stride;
  is_face_ = z_ + stride;
  errors_ = is_face_ + stride;

  const Vec3 origin = places.position(point);
  for (std::size_t i = 0; i < size_; ++i) {
    const Vec3 offset = places.position(ring[i].neighbor) - origin;
    x_[i] = offset.x;
    y_[i] = offset.y;
    z_[i] = offset.z;
    is_face_[i] = ring[i].face == kNone ? 0.0f : 1.0f;
  }
  // The first closes the ring; beyond it nothing counts.
  x_[size_] = x_[0];
  y_[size_] = y_[0];
  z_[size_] = z_[0];
  for (std::size_t i = size_; i < stride; ++i) is_face_[i] = 0;
  for (std::size_t i = size_ + 1; i < stride; ++i) x_[i] = y_[i] = z_[i] = 0;
}

void RingOffsets::gather(const WorkingSurface& surface, std::uint32_t point) {
  gather_places(surface, point, RestPlaces(surface));
}

void RingOffsets::gather(const WorkingSurface& surface, std::uint32_t point,
                         const PosePlaces& pose) {
  gather_places(surface, point, pose);
}

namespace {

// Always in the same order, whatever the compiler makes of it.
float sum_of_block(const float* v) {
  return ((v[0] + v[4]) + (v[2] + v[6])) + ((v[1] + v[5]) + (v[3] + v[7]));
}

}  // namespace

PointQuadric RingOffsets::face_quadric() const {
  PointQuadric result;
  Quadric& q = result.quadric;
  for (std::size_t first = 0; first < size_; first += kBlock) {
    const float* x = x_ + first;
    const float* y = y_ + first;
    const float* z = z_ + first;
    const float* is_face = is_face_ + first;
    float xx[kBlock], yy[kBlock], zz[kBlock], xy[kBlock], xz[kBlock], yz[kBlock], weight[kBlock];
    for (std::size_t i = 0; i < kBlock; ++i) {
      // The cross product c of two edges has twice the area as its length, so that the plane
      // weighted with a third of the area is c c' / (6 |c|).
      const float cx = y[i] * z[i + 1] - z[i] * y[i + 1];
      const float cy = z[i] * x[i + 1] - x[i] * z[i + 1];
      const float cz = x[i] * y[i + 1] - y[i] * x[i + 1];
      const float length = std::sqrt(cx * cx + cy * cy + cz * cz) * is_face[i];
      const float scale = is_face[i] / (6 * length + kTiny);
      weight[i] = length * (1.0f / 6);
      xx[i] = cx * cx * scale;
      yy[i] = cy * cy * scale;
      zz[i] = cz * cz * scale;
      xy[i] = cx * cy * scale;
      xz[i] = cx * cz * scale;
      yz[i] = cy * cz * scale;
    }
    q.xx += sum_of_block(xx), q.yy += sum_of_block(yy), q.zz += sum_of_block(zz);
    q.xy += sum_of_block(xy), q.xz += sum_of_block(xz), q.yz += sum_of_block(yz);
    result.weight += sum_of_block(weight);
  }
  return result;
}

const float* RingOffsets::errors(const Quadric& q) {
  for (std::size_t first = 0; first < size_; first += kBlock) {
    const float* x = x_ + first;
    const float* y = y_ + first;
    const float* z = z_ + first;
    float* error = errors_ + first;
    for (std::size_t i = 0; i < kBlock; ++i) {
      const float rx = q.xx * x[i] + q.xy * y[i] + q.xz * z[i];
      const float ry = q.xy * x[i] + q.yy * y[i] + q.yz * z[i];
      const float rz = q.xz * x[i] + q.yz * y[i] + q.zz * z[i];
      const float sum = rx * x[i] + ry * y[i] + rz * z[i];
      error[i] = sum > 0 ? sum : 0;
    }
  }
  return errors_;
}

namespace {

template <class Places>
PointQuadric quadric_at(WorkingSurface& surface, std::uint32_t point, const QuadricOptions& options,
                        const RingOffsets& offsets, const Places& places) {
  PointQuadric result = offsets.face_quadric();
  if (surface.points[point].kind != VertexKind::kManifold)
    add_constraints(surface, point, places, options, result.quadric);
  result.quadric.add_point(options.tangential_weight * result.weight);
  return result;
}

}  // namespace

PointQuadric point_quadric(WorkingSurface& surface, std::uint32_t point,
                           const QuadricOptions& options, const RingOffsets& offsets) {
  return quadric_at(surface, point, options, offsets, RestPlaces(surface));
}

PointQuadric point_quadric(WorkingSurface& surface, std::uint32_t point,
                           const QuadricOptions& options, const RingOffsets& offsets,
                           const PosePlaces& pose) {
  return quadric_at(surface, point, options, offsets, pose);
}

PointQuadric point_quadric(WorkingSurface& surface, std::uint32_t point,
                           const QuadricOptions& options) {
  RingOffsets offsets;
  offsets.gather(surface, point);
  return point_quadric(surface, point, options, offsets);
}

void add_faces_to_attributes(WorkingSurface& surface, AttributeField& attributes, int threads) {
  parallel_for(threads, surface.point_count(), 4096, [&](std::size_t begin, std::size_t end) {
    for (auto point = static_cast<std::uint32_t>(begin); point < end; ++point) {
      const auto ring = surface.ring_span(point);
      const Vec3 origin = surface.points[point].position;
      for (std::size_t i = 0; i < ring.size(); ++i) {
        if (ring[i].face == kNone) continue;
        const std::uint32_t neighbor = ring[i].neighbor;
        const std::uint32_t next = ring[i + 1 == ring.size() ? 0 : i + 1].neighbor;
        const auto wedge_at = [&](std::uint32_t p) {
          return surface.wedge.has_seams() ? surface.wedge.at_corner(ring[i].face, p) : p;
        };
        attributes.add_face({wedge_at(point), wedge_at(neighbor), wedge_at(next)},
                            surface.points[neighbor].position - origin,
                            surface.points[next].position - origin);
      }
    }
  });
}

}  // namespace varifold
