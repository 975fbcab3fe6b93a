#include <varifold/models/vdpm/region_batch.h>

#include <varifold/view/cone_code.h>
#include <cmath>

namespace varifold {

namespace {

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

__attribute__((always_inline)) inline void test_lanes(const ViewQuery& query,
                                                      const RegionBatch& __restrict regions,
                                                      AnswerBatch& __restrict answers) {
  const view_query::Numbers view = query.numbers();  // nothing that is written is part of it
  for (std::size_t i = 0; i < RegionBatch::kSize; ++i) {
    const Axis axis = unpack_axis(regions.cone[i]);
    const float cosine = regions.cosine[i];
    const float sine = std::sqrt(view_query::greater(1 - cosine * cosine, 0));
    const view_query::LaneAnswer answer = view_query::test_lane(
        view, {regions.x[i], regions.y[i], regions.z[i], regions.radius[i], axis.x, axis.y, axis.z,
               cosine, sine, regions.mu[i], regions.delta[i], regions.keep[i]});
    answers.asked[i] = answer.asked;
    answers.mover[i] = answer.mover;
    answers.slack[i] = answer.slack;
  }
}

}  // namespace

void test_regions_plain(const ViewQuery& query, const RegionBatch& regions, AnswerBatch& answers) {
  test_lanes(query, regions, answers);
}

#if defined(__x86_64__)

namespace {

__attribute__((target("avx2"))) void test_regions_avx2(const ViewQuery& query,
                                                       const RegionBatch& regions,
                                                       AnswerBatch& answers) {
  test_lanes(query, regions, answers);
}
const bool kHasAvx2 = __builtin_cpu_supports("avx2") != 0;

}  // namespace

void test_regions(const ViewQuery& query, const RegionBatch& regions, AnswerBatch& answers) {
  kHasAvx2 ? test_regions_avx2(query, regions, answers) : test_lanes(query, regions, answers);
}

#else

void test_regions(const ViewQuery& query, const RegionBatch& regions, AnswerBatch& answers) {
  test_lanes(query, regions, answers);
}

#endif

}  // namespace varifold
