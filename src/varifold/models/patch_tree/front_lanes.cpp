#include <varifold/models/patch_tree/front_lanes.h>

#include <bit>
#include <cmath>
#if defined(__x86_64__)
#include <immintrin.h>
#endif

#define VARIFOLD_INLINE __attribute__((always_inline)) inline

namespace varifold::front_lanes {

namespace {

using Numbers = FrontPriorities::Numbers;
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
  constexpr bool kMeanSquares = (kParts & 1u) != 0, kCulls = (kParts & 2u) != 0,
                 kTurns = (kParts & 4u) != 0;
  const float x = at.x[i], y = at.y[i], z = at.z[i], radius = at.radius[i];
  const float dx = x - view.eye_x, dy = y - view.eye_y, dz = z - view.eye_z;
  const float length = std::sqrt(dx * dx + dy * dy + dz * dz);
  const float gap = greater(length - radius, 0);
  float own = 0;
  if constexpr (kMeanSquares)
    own = at.mean_squared[i] / (gap * gap);
  else
    own = smaller(at.error[i] * view.focal / greater(gap, view.near_distance),
                  RefineCriteria::kFullDetail);
  own = own > 0 ? own : 0;
  if constexpr (kCulls) {
    float inside = radius;  // of empty balls nothing is
    for (const auto& plane : view.planes)
      inside = smaller(inside, plane[0] * x + plane[1] * y + plane[2] * z + plane[3] + radius);
    own = inside < 0 ? 0 : own;
  }
  if constexpr (kTurns) own = turned_away(at, i, {dx, dy, dz, length}) > 0 ? 0 : own;
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

template <std::uint8_t kParts>
VARIFOLD_INLINE void evaluate_all(const Numbers& numbers, const Nodes& nodes) {
  const Numbers view = numbers;  // nothing that is written is part of it
  const Columns at(nodes.tables.lanes());
  const std::uint32_t* const parent = nodes.tables.lanes().parent.data();
  float* const priorities = nodes.priorities.data();
  const std::uint32_t first_apart = nodes.tables.first_apart();
  for (std::uint32_t word = 0; word < nodes.exists.size(); ++word) {
    std::uint64_t rest = nodes.exists[word];
    while (rest != 0) {
      const std::uint32_t byte = static_cast<std::uint32_t>(std::countr_zero(rest)) / 8;
      rest &= ~(0xffull << 8 * byte);
      const std::uint32_t first = 64 * word + 8 * byte;
      if (first >= first_apart) {
        evaluate_block<kParts>(view, at, parent, first, priorities);
        continue;
      }
      // A parent may be among the eight.
      for (std::uint32_t node = first; node < first + kLanes; ++node)
        priorities[node] = smaller(priorities[parent[node]], priority<kParts>(view, at, node));
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

using Evaluate = void (*)(const Numbers&, const Nodes&);
using EvaluateRun = void (*)(const Numbers&, const FrontTables&, const Run&);

constexpr Evaluate kPlain[] = {evaluate_plain<0>, evaluate_plain<1>, evaluate_plain<2>,
                               evaluate_plain<3>, evaluate_plain<4>, evaluate_plain<5>,
                               evaluate_plain<6>, evaluate_plain<7>};
constexpr EvaluateRun kRuns[] = {
    evaluate_run_plain<0>, evaluate_run_plain<1>, evaluate_run_plain<2>, evaluate_run_plain<3>,
    evaluate_run_plain<4>, evaluate_run_plain<5>, evaluate_run_plain<6>, evaluate_run_plain<7>};

VARIFOLD_INLINE std::uint32_t bits_within(const float* priorities, const Window& window) {
  std::uint32_t bits = 0;
  for (std::uint32_t i = 0; i < kLanes; ++i)
    bits |=
        static_cast<std::uint32_t>((priorities[i] > window.above) & (priorities[i] <= window.up_to))
        << i;
  return bits;
}

#if defined(__x86_64__)

template <std::uint8_t kParts>
__attribute__((target("avx2"))) void evaluate_avx2(const Numbers& numbers, const Nodes& nodes) {
  evaluate_all<kParts>(numbers, nodes);
}
constexpr Evaluate kAvx2[] = {evaluate_avx2<0>, evaluate_avx2<1>, evaluate_avx2<2>,
                              evaluate_avx2<3>, evaluate_avx2<4>, evaluate_avx2<5>,
                              evaluate_avx2<6>, evaluate_avx2<7>};

__attribute__((target("avx2"))) inline std::uint32_t bits_within_avx2(const float* priorities,
                                                                      const Window& window) {
  const __m256 values = _mm256_loadu_ps(priorities);
  const __m256 above = _mm256_cmp_ps(values, _mm256_set1_ps(window.above), _CMP_GT_OQ);
  const __m256 below = _mm256_cmp_ps(values, _mm256_set1_ps(window.up_to), _CMP_LE_OQ);
  return static_cast<std::uint32_t>(_mm256_movemask_ps(_mm256_and_ps(above, below)));
}

const bool kHasAvx2 = __builtin_cpu_supports("avx2") != 0;

#endif

// The nodes of a word of a set that are within the window.
template <class Bits>
VARIFOLD_INLINE std::uint64_t word_within(std::uint64_t among, const float* priorities,
                                          const Window& window, const Bits& bits_of) {
  std::uint64_t bits = 0;
  for (std::uint64_t rest = among; rest != 0;) {
    const std::uint32_t shift = static_cast<std::uint32_t>(std::countr_zero(rest)) & ~7u;
    rest &= ~(0xffull << shift);
    bits |= static_cast<std::uint64_t>(bits_of(priorities + shift, window)) << shift;
  }
  return bits & among;
}

std::uint64_t word_within_plain(std::uint64_t among, const float* priorities,
                                const Window& window) {
  return word_within(among, priorities, window,
                     [](const float* p, const Window& w) { return bits_within(p, w); });
}

#if defined(__x86_64__)
__attribute__((target("avx2"))) std::uint64_t word_within_avx2(std::uint64_t among,
                                                               const float* priorities,
                                                               const Window& window) {
  std::uint64_t bits = 0;
  for (std::uint64_t rest = among; rest != 0;) {
    const std::uint32_t shift = static_cast<std::uint32_t>(std::countr_zero(rest)) & ~7u;
    rest &= ~(0xffull << shift);
    bits |= static_cast<std::uint64_t>(bits_within_avx2(priorities + shift, window)) << shift;
  }
  return bits & among;
}
#endif

std::uint64_t find_within(std::uint64_t among, const float* priorities, const Window& window) {
  if (among == 0) return 0;
#if defined(__x86_64__)
  if (kHasAvx2) return word_within_avx2(among, priorities, window);
#endif
  return word_within_plain(among, priorities, window);
}

}  // namespace

void evaluate_narrow(std::uint8_t parts, const Numbers& numbers, const Nodes& nodes) {
  kPlain[parts](numbers, nodes);
}

void evaluate(std::uint8_t parts, const Numbers& numbers, const Nodes& nodes) {
#if defined(__x86_64__)
  if (kHasAvx2) {
    kAvx2[parts](numbers, nodes);
    return;
  }
#endif
  kPlain[parts](numbers, nodes);
}

void evaluate_run(std::uint8_t parts, const Numbers& numbers, const FrontTables& tables,
                  const Run& run) {
  kRuns[parts](numbers, tables, run);
}

void find_above(std::span<const std::uint64_t> among, std::span<const float> priorities,
                float tolerance, std::span<std::uint64_t> above) {
  const Window window{tolerance, HUGE_VALF};
  for (std::size_t word = 0; word < among.size(); ++word)
    above[word] = find_within(among[word], priorities.data() + 64 * word, window);
}

void collect(std::span<const std::uint64_t> among, std::span<const std::uint64_t> except,
             std::span<const float> priorities, const Window& window,
             std::vector<std::uint32_t>& nodes) {
  for (std::size_t word = 0; word < among.size(); ++word) {
    std::uint64_t found =
        find_within(among[word] & ~except[word], priorities.data() + 64 * word, window);
    for (; found != 0; found &= found - 1)
      nodes.push_back(static_cast<std::uint32_t>(
          64 * word + static_cast<std::size_t>(std::countr_zero(found))));
  }
}

}  // namespace varifold::front_lanes
