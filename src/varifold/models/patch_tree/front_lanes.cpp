#include <varifold/models/patch_tree/front_lanes.h>
#include <varifold/view/criteria.h>

#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <utility>

#define VARIFOLD_INLINE __attribute__((always_inline)) inline

namespace varifold::front_lanes {

namespace {

constexpr std::uint32_t kLanes = 8;

VARIFOLD_INLINE float greater(float a, float b) { return a > b ? a : b; }
VARIFOLD_INLINE float smaller(float a, float b) { return a < b ? a : b; }

// The arrays without their owners, so that a loop over lanes sees that nothing moves.
struct Columns {
  explicit Columns(const FrontLanes& lanes)
      : x(lanes.x.data()),
        y(lanes.y.data()),
        z(lanes.z.data()),
        radius(lanes.radius.data()),
        error(lanes.error.data()),
        mean_squared(lanes.mean_squared.data()),
        axis_x(lanes.axis_x.data()),
        axis_y(lanes.axis_y.data()),
        axis_z(lanes.axis_z.data()),
        cosine(lanes.cosine.data()),
        sine(lanes.sine.data()) {}
  const float *x, *y, *z, *radius, *error, *mean_squared, *axis_x, *axis_y, *axis_z, *cosine, *sine;
};

// Above 0 where facing() of view/cone.h says that all is turned away, in its steps. The ray goes
// from the eye to the centre.
struct Ray {
  float x, y, z, length;
};
VARIFOLD_INLINE float turned_away(const Columns& at, std::size_t i, const Ray& ray) {
  const float radius = at.radius[i], cosine = at.cosine[i], sine = at.sine[i];
  const float sine_b = greater(radius, 0) / ray.length;
  const float cosine_b = std::sqrt(greater(1 - sine_b * sine_b, 0));
  const float cosine_sum = cosine * cosine_b - sine * sine_b;
  const float sine_sum = sine * cosine_b + cosine * sine_b;
  const float along =
      (at.axis_x[i] * ray.x + at.axis_y[i] * ray.y + at.axis_z[i] * ray.z) / ray.length;
  constexpr float kRounding = 1e-6f;
  return smaller(smaller(cosine, ray.length - radius),
                 smaller(cosine_sum, along - (sine_sum + kRounding)));
}

// What FrontPriorities::evaluate_singly() says, in its steps, without branches: differences have
// the sign of comparisons.
template <std::uint8_t kParts>
VARIFOLD_INLINE float priority(const Numbers& view, const Columns& at, std::size_t i) {
  constexpr bool kHasSquares = (kParts & kMeanSquares) != 0, kCullsNodes = (kParts & kCulls) != 0,
                 kTurnsNodes = (kParts & kTurns) != 0;
  const float x = at.x[i], y = at.y[i], z = at.z[i], radius = at.radius[i];
  const float dx = x - view.eye_x, dy = y - view.eye_y, dz = z - view.eye_z;
  const float length = std::sqrt(dx * dx + dy * dy + dz * dz);
  const float gap = greater(length - radius, 0);
  float own = 0;
  if constexpr (kHasSquares)
    own = at.mean_squared[i] / (gap * gap);
  else
    own = smaller(at.error[i] * view.focal / greater(gap, view.near_distance),
                  RefineCriteria::kFullDetail);
  own = own > 0 ? own : 0;
  if constexpr (kCullsNodes) {
    float inside = radius;  // of empty balls nothing is
    for (const auto& plane : view.planes)
      inside = smaller(inside, plane[0] * x + plane[1] * y + plane[2] * z + plane[3] + radius);
    own = inside < 0 ? 0 : own;
  }
  if constexpr (kTurnsNodes) own = turned_away(at, i, {dx, dy, dz, length}) > 0 ? 0 : own;
  return own;
}

// The next kCount nodes from `first` on.
template <std::uint8_t kParts, std::uint32_t kCount>
VARIFOLD_INLINE void evaluate_lanes(const Numbers& view, const Columns& at, std::uint32_t first,
                                    float* __restrict own) {
  for (std::uint32_t i = 0; i < kCount; ++i) own[i] = priority<kParts>(view, at, first + i);
}

template <std::uint8_t kParts>
VARIFOLD_INLINE void evaluate_block(const Numbers& view, const Columns& at,
                                    const std::uint32_t* parent, std::uint32_t first,
                                    float* priorities) {
  float own[kLanes], limit[kLanes];
  evaluate_lanes<kParts, kLanes>(view, at, first, own);
  for (std::uint32_t i = 0; i < kLanes; ++i) limit[i] = priorities[parent[first + i]];
  for (std::uint32_t i = 0; i < kLanes; ++i) priorities[first + i] = smaller(limit[i], own[i]);
}

// The same where a parent may be among the eight.
template <std::uint8_t kParts>
VARIFOLD_INLINE void evaluate_in_turn(const Numbers& view, const Columns& at,
                                      const std::uint32_t* parent, std::uint32_t first,
                                      float* priorities) {
  for (std::uint32_t node = first; node < first + kLanes; ++node)
    priorities[node] = smaller(priorities[parent[node]], priority<kParts>(view, at, node));
}

// No lambdas in here: they would not know of the vectors.
template <std::uint8_t kParts>
VARIFOLD_INLINE void evaluate_all(const Numbers& numbers, const Nodes& nodes) {
  const Numbers view = numbers;  // nothing that is written is part of it
  const Columns at(nodes.tables.lanes());
  const std::uint32_t* const parent = nodes.tables.lanes().parent.data();
  float* const priorities = nodes.priorities.data();
  const std::uint32_t first_apart = nodes.tables.first_apart();
  for (std::uint32_t part = 0; part < nodes.words.size(); ++part) {
    for (std::uint64_t words = nodes.words[part]; words != 0; words &= words - 1) {
      const std::uint32_t word = 64 * part + static_cast<std::uint32_t>(std::countr_zero(words));
      for (std::uint64_t rest = nodes.exists[word]; rest != 0;) {
        const std::uint32_t shift = static_cast<std::uint32_t>(std::countr_zero(rest)) & ~7u;
        rest &= ~(0xffull << shift);
        const std::uint32_t first = 64 * word + shift;
        if (first >= first_apart)
          evaluate_block<kParts>(view, at, parent, first, priorities);
        else
          evaluate_in_turn<kParts>(view, at, parent, first, priorities);
      }
    }
  }
}

// Children mostly are two to four.
template <std::uint8_t kParts>
VARIFOLD_INLINE void evaluate_run_of(const Numbers& view, const FrontTables& tables,
                                     const Run& run) {
  constexpr std::uint32_t kFew = 4;
  const Columns at(tables.lanes());
  for (std::uint32_t done = 0; done < run.count; done += kFew) {
    float own[kFew];
    // What is beyond the last child is padding at worst.
    const std::uint32_t first = run.first + done;
    evaluate_lanes<kParts, kFew>(view, at, first, own);
    for (std::uint32_t i = 0; i < kFew && done + i < run.count; ++i)
      run.priorities[first + i] = smaller(run.limit, own[i]);
  }
}

template <std::uint8_t kParts>
void evaluate_plain(const Numbers& numbers, const Nodes& nodes) {
  evaluate_all<kParts>(numbers, nodes);
}
template <std::uint8_t kParts>
void evaluate_run_plain(const Numbers& numbers, const FrontTables& tables, const Run& run) {
  evaluate_run_of<kParts>(numbers, tables, run);
}

template <std::size_t... kParts>
constexpr std::array<Functions, sizeof...(kParts)> plain_functions(
    std::index_sequence<kParts...> /*parts*/) {
  return {Functions{evaluate_plain<kParts>, evaluate_run_plain<kParts>}...};
}
constexpr auto kPlain = plain_functions(std::make_index_sequence<kPartSets>());

#if defined(__x86_64__)

template <std::uint8_t kParts>
__attribute__((target("avx2"))) void evaluate_avx2(const Numbers& numbers, const Nodes& nodes) {
  evaluate_all<kParts>(numbers, nodes);
}
template <std::uint8_t kParts>
__attribute__((target("avx2"))) void evaluate_run_avx2(const Numbers& numbers,
                                                       const FrontTables& tables, const Run& run) {
  evaluate_run_of<kParts>(numbers, tables, run);
}

template <std::size_t... kParts>
constexpr std::array<Functions, sizeof...(kParts)> avx2_functions(
    std::index_sequence<kParts...> /*parts*/) {
  return {Functions{evaluate_avx2<kParts>, evaluate_run_avx2<kParts>}...};
}
constexpr auto kAvx2 = avx2_functions(std::make_index_sequence<kPartSets>());

const bool kHasAvx2 = __builtin_cpu_supports("avx2") != 0;

#endif

}  // namespace

const Functions& plain_functions_of(std::uint8_t parts) { return kPlain[parts]; }

const Functions& functions_of(std::uint8_t parts) {
#if defined(__x86_64__)
  if (kHasAvx2) return kAvx2[parts];
#endif
  return kPlain[parts];
}

}  // namespace varifold::front_lanes
