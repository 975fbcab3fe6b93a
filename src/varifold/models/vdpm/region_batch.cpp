#include <varifold/models/vdpm/region_batch.h>

#include <varifold/models/vdpm/step_regions.h>
#include <varifold/view/cone_code.h>
#include <cmath>
#if defined(__x86_64__)
#include <immintrin.h>
#endif

namespace varifold {

namespace {

constexpr std::size_t kSize = RegionBatch::kSize;

// The same numbers of all lanes side by side; of the bounds the words as they lie in memory.
struct Lanes {
  alignas(32) float x[kSize], y[kSize], z[kSize];
  alignas(32) std::uint32_t cone[kSize], radii[kSize], errors[kSize], below[kSize];
};
struct LaneAnswers {
  alignas(32) float slack[kSize];
  alignas(32) std::int32_t asked[kSize], mover[kSize];
};

// The axis of a cone code, in the steps of unpack_cone().
struct Axis {
  float x, y, z;
};
inline Axis unpack_axis(std::uint32_t code) {
  constexpr auto kLast = static_cast<std::int32_t>(cone_code::kAxisSteps - 1);
  constexpr std::int32_t kMiddle = kLast / 2;
  const auto column = static_cast<std::int32_t>(code >> 21u);
  const auto row = static_cast<std::int32_t>(code >> 10u & 2047u);
  const std::int32_t x = (column < kLast ? column : kLast) - kMiddle;
  const std::int32_t y = (row < kLast ? row : kLast) - kMiddle;
  const std::int32_t width = x < 0 ? -x : x, height = y < 0 ? -y : y;
  const std::int32_t z = kMiddle - width - height;
  // The lower half, folded outwards.
  const std::int32_t folded_x = x < 0 ? height - kMiddle : kMiddle - height;
  const std::int32_t folded_y = y < 0 ? width - kMiddle : kMiddle - width;
  const auto nx = static_cast<float>(z < 0 ? folded_x : x);
  const auto ny = static_cast<float>(z < 0 ? folded_y : y);
  const auto nz = static_cast<float>(z);
  const float scale = 1 / std::sqrt(nx * nx + ny * ny + nz * nz);
  return {nx * scale, ny * scale, nz * scale};
}

inline float sine_of(float cosine) {
  return std::sqrt(view_query::greater(1 - cosine * cosine, 0));
}

// Two codes lie in a word of memory, the first one in its lower half.
inline float first_length(std::uint32_t word) { return error_of_code(word & 0xffffu); }
inline float second_length(std::uint32_t word) { return error_of_code(word >> 16u); }

template <bool kKeeps>
struct Own {
  static view_query::Lane lane(const Lanes& lanes, const float* keep, std::size_t i) {
    const Axis axis = unpack_axis(lanes.cone[i]);
    const float cosine = own_cosine(lanes.cone[i]);
    return {lanes.x[i],
            lanes.y[i],
            lanes.z[i],
            first_length(lanes.radii[i]),
            axis.x,
            axis.y,
            axis.z,
            cosine,
            sine_of(cosine),
            first_length(lanes.errors[i]),
            second_length(lanes.errors[i]),
            kKeeps ? keep[i] : 0};
  }
};

struct Nested {
  static view_query::Lane lane(const Lanes& lanes, const float* /*keep*/, std::size_t i) {
    const Axis axis = unpack_axis(lanes.cone[i]);
    const float cosine = nested_cosine(lanes.below[i] >> 16u);
    return {lanes.x[i], lanes.y[i], lanes.z[i],      second_length(lanes.radii[i]), axis.x, axis.y,
            axis.z,     cosine,     sine_of(cosine), first_length(lanes.below[i]),  0,      0};
  }
};

template <class Kind>
__attribute__((always_inline)) inline void test_lanes(const ViewQuery& query,
                                                      const Lanes& __restrict lanes,
                                                      const float* __restrict keep,
                                                      LaneAnswers& __restrict answers) {
  const view_query::Numbers view = query.numbers();  // nothing that is written is part of it
  for (std::size_t i = 0; i < kSize; ++i) {
    const view_query::LaneAnswer answer = view_query::test_lane(view, Kind::lane(lanes, keep, i));
    answers.asked[i] = answer.asked;
    answers.mover[i] = answer.mover;
    answers.slack[i] = answer.slack;
  }
}

inline std::uint32_t word_of(std::uint16_t first, std::uint16_t second) {
  return first | static_cast<std::uint32_t>(second) << 16u;
}

template <class Kind>
void test_plain(const ViewQuery& query, const Odometers& odometers, const RegionBatch& regions,
                AnswerBatch& answers) {
  Lanes lanes;
  for (std::size_t i = 0; i < kSize; ++i) {
    const PackedBounds& bounds = *regions.bounds[i];
    const Vec3& center = *regions.centers[i];
    lanes.x[i] = center.x;
    lanes.y[i] = center.y;
    lanes.z[i] = center.z;
    lanes.cone[i] = bounds.cone;
    lanes.radii[i] = word_of(bounds.radius, bounds.nested_radius);
    lanes.errors[i] = word_of(bounds.mu, bounds.delta);
    lanes.below[i] = word_of(bounds.nested_error, bounds.nested_angle);
  }
  LaneAnswers lane_answers;
  test_lanes<Kind>(query, lanes, regions.keep.data(), lane_answers);
  answers.asked = 0;
  for (std::size_t i = 0; i < kSize; ++i) {
    answers.asked |= lane_answers.asked[i] != 0 ? 1u << i : 0u;
    answers.keys[i] =
        odometers.key(static_cast<Mover>(lane_answers.mover[i]), lane_answers.slack[i]);
  }
}

#if defined(__x86_64__)

#define VARIFOLD_AVX2 __attribute__((target("avx2"))) inline

VARIFOLD_AVX2 __m256 low_pairs(__m256 a, __m256 b) {
  return _mm256_castpd_ps(_mm256_unpacklo_pd(_mm256_castps_pd(a), _mm256_castps_pd(b)));
}
VARIFOLD_AVX2 __m256 high_pairs(__m256 a, __m256 b) {
  return _mm256_castpd_ps(_mm256_unpackhi_pd(_mm256_castps_pd(a), _mm256_castps_pd(b)));
}
// Four rows of four words become columns; of two such blocks at once.
VARIFOLD_AVX2 void transpose(__m256 (&rows)[4]) {
  const __m256 low_ab = _mm256_unpacklo_ps(rows[0], rows[1]);
  const __m256 high_ab = _mm256_unpackhi_ps(rows[0], rows[1]);
  const __m256 low_cd = _mm256_unpacklo_ps(rows[2], rows[3]);
  const __m256 high_cd = _mm256_unpackhi_ps(rows[2], rows[3]);
  rows[0] = low_pairs(low_ab, low_cd);
  rows[1] = high_pairs(low_ab, low_cd);
  rows[2] = low_pairs(high_ab, high_cd);
  rows[3] = high_pairs(high_ab, high_cd);
}

VARIFOLD_AVX2 __m128 load_bounds(const PackedBounds* bounds) {
  return _mm_castsi128_ps(_mm_loadu_si128(reinterpret_cast<const __m128i*>(bounds)));
}
VARIFOLD_AVX2 __m128 load_center(const Vec3* center) {
  return _mm_movelh_ps(_mm_castsi128_ps(_mm_loadu_si64(center)), _mm_load_ss(&center->z));
}

VARIFOLD_AVX2 void load_lanes(const RegionBatch& regions, Lanes& lanes) {
  __m256 center[4], words[4];
  for (std::size_t i = 0; i < 4; ++i) {
    center[i] =
        _mm256_set_m128(load_center(regions.centers[i + 4]), load_center(regions.centers[i]));
    words[i] = _mm256_set_m128(load_bounds(regions.bounds[i + 4]), load_bounds(regions.bounds[i]));
  }
  transpose(center);
  _mm256_store_ps(lanes.x, center[0]);
  _mm256_store_ps(lanes.y, center[1]);
  _mm256_store_ps(lanes.z, center[2]);
  transpose(words);
  std::uint32_t* const to[] = {lanes.cone, lanes.radii, lanes.errors, lanes.below};
  for (std::size_t i = 0; i < 4; ++i)
    _mm256_store_si256(reinterpret_cast<__m256i*>(to[i]), _mm256_castps_si256(words[i]));
}

// Odometers::key() of all lanes.
VARIFOLD_AVX2 void make_keys(const Odometers& odometers, const LaneAnswers& lanes,
                             AnswerBatch& answers) {
  const __m256i mover = _mm256_load_si256(reinterpret_cast<const __m256i*>(lanes.mover));
  const __m256 base = _mm256_permutevar8x32_ps(_mm256_loadu_ps(odometers.base().data()), mover);
  const __m256 sum = _mm256_add_ps(base, _mm256_load_ps(lanes.slack));
  const __m256i bits = _mm256_castps_si256(_mm256_max_ps(sum, _mm256_set1_ps(1e-30f)));
  const __m256i less =
      _mm256_andnot_si256(_mm256_set1_epi32(7), _mm256_sub_epi32(bits, _mm256_set1_epi32(8)));
  _mm256_store_ps(answers.keys.data(), _mm256_castsi256_ps(_mm256_or_si256(less, mover)));
  const __m256i no = _mm256_cmpeq_epi32(
      _mm256_load_si256(reinterpret_cast<const __m256i*>(lanes.asked)), _mm256_setzero_si256());
  answers.asked = ~static_cast<std::uint32_t>(_mm256_movemask_ps(_mm256_castsi256_ps(no))) & 0xffu;
}

template <class Kind>
__attribute__((target("avx2"))) void test_avx2(const ViewQuery& query, const Odometers& odometers,
                                               const RegionBatch& regions, AnswerBatch& answers) {
  Lanes lanes;
  load_lanes(regions, lanes);
  LaneAnswers lane_answers;
  test_lanes<Kind>(query, lanes, regions.keep.data(), lane_answers);
  make_keys(odometers, lane_answers, answers);
}

#undef VARIFOLD_AVX2

const bool kHasAvx2 = __builtin_cpu_supports("avx2") != 0;

template <class Kind>
void test_regions(const ViewQuery& query, const Odometers& odometers, const RegionBatch& regions,
                  AnswerBatch& answers) {
  kHasAvx2 ? test_avx2<Kind>(query, odometers, regions, answers)
           : test_plain<Kind>(query, odometers, regions, answers);
}

#else

template <class Kind>
void test_regions(const ViewQuery& query, const Odometers& odometers, const RegionBatch& regions,
                  AnswerBatch& answers) {
  test_plain<Kind>(query, odometers, regions, answers);
}

#endif

}  // namespace

void test_own_regions(const ViewQuery& query, const Odometers& odometers,
                      const RegionBatch& regions, AnswerBatch& answers) {
  regions.keeps ? test_regions<Own<true>>(query, odometers, regions, answers)
                : test_regions<Own<false>>(query, odometers, regions, answers);
}

void test_nested_regions(const ViewQuery& query, const Odometers& odometers,
                         const RegionBatch& regions, AnswerBatch& answers) {
  test_regions<Nested>(query, odometers, regions, answers);
}

void test_own_regions_plain(const ViewQuery& query, const Odometers& odometers,
                            const RegionBatch& regions, AnswerBatch& answers) {
  test_plain<Own<true>>(query, odometers, regions, answers);
}

void test_nested_regions_plain(const ViewQuery& query, const Odometers& odometers,
                               const RegionBatch& regions, AnswerBatch& answers) {
  test_plain<Nested>(query, odometers, regions, answers);
}

}  // namespace varifold
