// Based on: [Hoppe1996] section 4.1 (points are projected onto the new neighbourhood only),
//   [Ericson2005] 5.1 (closest points).
// Differs: all faces share the apex, so edges are measured once and not per face; instead of
//   telling regions of a triangle apart, the least of plane and edges is taken, without branches.
#include <varifold/simplify/collapse_fan.h>

#include <algorithm>
#include <limits>

namespace varifold {

namespace {

constexpr float kFar = std::numeric_limits<float>::max();
// So many samples are measured before the sum is looked at.
constexpr std::size_t kChunk = 64;

template <class Visit>
void for_each_face(const WorkingSurface& surface, std::uint32_t point, const Visit& visit) {
  const RingEntry* ring = surface.ring(point);
  const std::uint32_t size = surface.points[point].ring_size;
  for (std::uint32_t i = 0; i < size; ++i)
    if (ring[i].face != kNone)
      visit(ring[i].face, ring[i].neighbor, ring[i + 1 == size ? 0 : i + 1].neighbor);
}

float inverse_or_zero(float x) { return x > 0 ? 1 / x : 0.0f; }

}  // namespace

void make_fan(const WorkingSurface& surface, const FanEdge& edge, std::vector<FanFace>& fan) {
  fan.clear();
  const auto [from, onto, moves] = edge;
  // Faces at the edge vanish; the ones of `onto` that share a corner with them are beside them.
  constexpr std::size_t kMaxApexes = 64;
  std::uint32_t apexes[kMaxApexes];
  std::size_t apex_count = 0;
  for_each_face(surface, from, [&](std::uint32_t face, std::uint32_t m, std::uint32_t n) {
    if (m != onto && n != onto)
      fan.push_back({face, m, n, true, true});
    else if (apex_count < kMaxApexes)
      apexes[apex_count++] = m == onto ? n : m;
  });
  const auto is_apex = [&](std::uint32_t point) {
    return std::find(apexes, apexes + apex_count, point) != apexes + apex_count;
  };
  for_each_face(surface, onto, [&](std::uint32_t face, std::uint32_t m, std::uint32_t n) {
    if (m == from || n == from) return;
    if (moves || is_apex(m) || is_apex(n)) fan.push_back({face, m, n, false, moves});
  });
}

void changed_faces(const WorkingSurface& surface, const FanEdge& edge,
                   std::vector<std::uint32_t>& faces) {
  for_each_face(surface, edge.from,
                [&](std::uint32_t face, std::uint32_t, std::uint32_t) { faces.push_back(face); });
  if (!edge.moves) return;
  for_each_face(surface, edge.onto, [&](std::uint32_t face, std::uint32_t m, std::uint32_t n) {
    if (m != edge.from && n != edge.from) faces.push_back(face);
  });
}

void FanDistances::add(const Vec3& position) {
  if (size_ == x_.size()) {
    const std::size_t room = std::max<std::size_t>(64, 2 * x_.size());
    for (auto* values : {&x_, &y_, &z_, &squared_}) values->resize(room);
    nearest_.resize(room);
  }
  x_[size_] = position.x, y_[size_] = position.y, z_[size_] = position.z;
  ++size_;
}

// The array has room for whole blocks; what lies behind the last sample only must be finite.
void FanDistances::pad() {
  for (std::size_t i = size_; i % kBlock != 0; ++i) x_[i] = y_[i] = z_[i] = 0;
}

void FanDistances::make_plans(const WorkingSurface& surface, std::span<const FanFace> fan,
                              const Vec3& apex) {
  plans_.clear();
  for (std::size_t i = 0; i < fan.size(); ++i) {
    Plan plan;
    plan.m = surface.points[fan[i].m].position - apex;
    plan.n = surface.points[fan[i].n].position - apex;
    plan.rim = plan.n - plan.m;
    const float mm = glm::dot(plan.m, plan.m), nn = glm::dot(plan.n, plan.n);
    const float mn = glm::dot(plan.m, plan.n);
    const Vec3 cross = glm::cross(plan.m, plan.n);
    const float square = glm::dot(cross, cross);
    // A face without area has no inside, only edges.
    const float inverse = inverse_or_zero(square);
    plan.to_m = inverse > 0 ? inverse * (nn * plan.m - mn * plan.n) : Vec3(0);
    plan.to_n = inverse > 0 ? inverse * (mm * plan.n - mn * plan.m) : Vec3(0);
    plan.normal = normalize_or_zero(cross);
    plan.m_scale = inverse_or_zero(mm);
    plan.n_scale = inverse_or_zero(nn);
    plan.rim_scale = inverse_or_zero(glm::dot(plan.rim, plan.rim));
    plan.needs_n = i + 1 == fan.size() || fan[i + 1].m != fan[i].n;
    plans_.push_back(plan);
  }
}

template <bool kWithFace>
void FanDistances::measure(std::size_t begin, std::size_t end, const Vec3& apex) {
  for (std::size_t block = begin; block < end; block += kBlock) {
    const float* x = &x_[block];
    const float* y = &y_[block];
    const float* z = &z_[block];
    float px[kBlock], py[kBlock], pz[kBlock], least[kBlock];
    std::int32_t nearest[kBlock];
    for (std::size_t i = 0; i < kBlock; ++i) {
      px[i] = x[i] - apex.x, py[i] = y[i] - apex.y, pz[i] = z[i] - apex.z;
      least[i] = kFar;
      nearest[i] = 0;
    }
    const auto take = [&](const float* squared, std::int32_t face) {
      for (std::size_t i = 0; i < kBlock; ++i) {
        if constexpr (kWithFace) nearest[i] = squared[i] < least[i] ? face : nearest[i];
        least[i] = squared[i] < least[i] ? squared[i] : least[i];
      }
    };
    // Distance to the segment from `start`, relative to the apex, along `edge`.
    const auto segment = [&](const Vec3& start, const Vec3& edge, float scale, float* squared) {
      for (std::size_t i = 0; i < kBlock; ++i) {
        const float qx = px[i] - start.x, qy = py[i] - start.y, qz = pz[i] - start.z;
        float t = (qx * edge.x + qy * edge.y + qz * edge.z) * scale;
        t = t > 0 ? t : 0;
        t = t < 1 ? t : 1;
        const float rx = qx - t * edge.x, ry = qy - t * edge.y, rz = qz - t * edge.z;
        squared[i] = rx * rx + ry * ry + rz * rz;
      }
    };
    for (std::size_t f = 0; f < plans_.size(); ++f) {
      const Plan& plan = plans_[f];
      const auto face = static_cast<std::int32_t>(f);
      float squared[kBlock];
      segment(Vec3(0), plan.m, plan.m_scale, squared);
      take(squared, face);
      segment(plan.m, plan.rim, plan.rim_scale, squared);
      take(squared, face);
      if (plan.needs_n) {
        segment(Vec3(0), plan.n, plan.n_scale, squared);
        take(squared, face);
      }
      for (std::size_t i = 0; i < kBlock; ++i) {
        const float at_m = px[i] * plan.to_m.x + py[i] * plan.to_m.y + pz[i] * plan.to_m.z;
        const float at_n = px[i] * plan.to_n.x + py[i] * plan.to_n.y + pz[i] * plan.to_n.z;
        const float height = px[i] * plan.normal.x + py[i] * plan.normal.y + pz[i] * plan.normal.z;
        // The least of the three weights tells whether the foot lies inside.
        const float at_apex = 1 - at_m - at_n;
        float inside = at_m < at_n ? at_m : at_n;
        inside = inside < at_apex ? inside : at_apex;
        squared[i] = inside > 0 ? height * height : kFar;
      }
      take(squared, face);
    }
    std::copy_n(least, kBlock, &squared_[block]);
    if constexpr (kWithFace) std::copy_n(nearest, kBlock, &nearest_[block]);
  }
}

double FanDistances::sum(const WorkingSurface& surface, std::span<const FanFace> fan,
                         const Vec3& apex, double limit) {
  make_plans(surface, fan, apex);
  pad();
  double total = 0;
  for (std::size_t begin = 0; begin < size_ && total <= limit; begin += kChunk) {
    const std::size_t end = std::min(begin + kChunk, size_);
    measure<false>(begin, end, apex);
    for (std::size_t i = begin; i < end; ++i) total += squared_[i];
  }
  return total;
}

void FanDistances::find_nearest(const WorkingSurface& surface, std::span<const FanFace> fan,
                                const Vec3& apex) {
  make_plans(surface, fan, apex);
  pad();
  measure<true>(0, size_, apex);
}

}  // namespace varifold
