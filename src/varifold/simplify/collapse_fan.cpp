// Based on: [Hoppe1996] section 4.1 (points are projected onto the new neighbourhood only),
//   [Ericson2005] 5.1 (closest points).
// Differs: all faces share the apex, so edges are measured once and not per face; instead of
//   telling regions of a triangle apart, the least of plane and edges is taken, without branches.
#include <varifold/simplify/collapse_fan.h>

#include <algorithm>
#include <cstring>
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
  const std::uint32_t from = edge.from, onto = edge.onto;
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
    if (edge.moves || is_apex(m) || is_apex(n)) fan.push_back({face, m, n, false, edge.moves});
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
    const Vec3 cross = glm::cross(plan.m, plan.n);
    // A face without area has no inside, only edges.
    const float inverse = inverse_or_zero(glm::length(cross));
    plan.normal = inverse * cross;
    plan.to_m = inverse * glm::cross(plan.n, plan.normal);
    plan.to_n = inverse * glm::cross(plan.normal, plan.m);
    plan.m_scale = inverse_or_zero(glm::dot(plan.m, plan.m));
    plan.n_scale = inverse_or_zero(glm::dot(plan.n, plan.n));
    plan.rim_scale = inverse_or_zero(glm::dot(plan.rim, plan.rim));
    plan.needs_n = i + 1 == fan.size() || fan[i + 1].m != fan[i].n;
    plans_.push_back(plan);
  }
}

namespace {

// A vector register in every processor that matters; GCC and Clang both know this notation.
using Lanes = float __attribute__((vector_size(16)));
using IntLanes = std::int32_t __attribute__((vector_size(16)));
static_assert(FanDistances::kBlock * sizeof(float) == sizeof(Lanes));

Lanes load(const float* from) {
  Lanes lanes;
  std::memcpy(&lanes, from, sizeof lanes);
  return lanes;
}

struct LaneVec {
  Lanes x, y, z;
  LaneVec operator-(const Vec3& v) const { return {x - v.x, y - v.y, z - v.z}; }
  [[nodiscard]] Lanes dot(const Vec3& v) const { return x * v.x + y * v.y + z * v.z; }
};

// Squared distance to the segment from the origin along `edge`.
Lanes squared_to_segment(const LaneVec& p, const Vec3& edge, float scale) {
  Lanes t = p.dot(edge) * scale;
  t = t > 0.0f ? t : Lanes{};
  t = t < 1.0f ? t : Lanes{} + 1.0f;
  const Lanes x = p.x - t * edge.x, y = p.y - t * edge.y, z = p.z - t * edge.z;
  return x * x + y * y + z * z;
}

}  // namespace

template <bool kWithFace>
void FanDistances::measure(std::size_t begin, std::size_t end, const Vec3& apex) {
  for (std::size_t block = begin; block < end; block += kBlock) {
    const LaneVec p = LaneVec{load(&x_[block]), load(&y_[block]), load(&z_[block])} - apex;
    Lanes least = Lanes{} + kFar;
    IntLanes nearest{};
    IntLanes face{};
    const auto take = [&](const Lanes& squared) {
      if constexpr (kWithFace) nearest = squared < least ? face : nearest;
      least = squared < least ? squared : least;
    };
    for (const Plan& plan : plans_) {
      take(squared_to_segment(p, plan.m, plan.m_scale));
      take(squared_to_segment(p - plan.m, plan.rim, plan.rim_scale));
      if (plan.needs_n) take(squared_to_segment(p, plan.n, plan.n_scale));
      // The least of the three weights tells whether the foot lies inside.
      const Lanes at_m = p.dot(plan.to_m), at_n = p.dot(plan.to_n);
      const Lanes at_apex = 1.0f - at_m - at_n;
      Lanes inside = at_m < at_n ? at_m : at_n;
      inside = inside < at_apex ? inside : at_apex;
      const Lanes height = p.dot(plan.normal);
      take(inside > 0.0f ? height * height : Lanes{} + kFar);
      face += 1;
    }
    std::memcpy(&squared_[block], &least, sizeof least);
    if constexpr (kWithFace) std::memcpy(&nearest_[block], &nearest, sizeof nearest);
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
