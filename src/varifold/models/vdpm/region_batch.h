// Many regions asked at once: eight lanes of the same arithmetic.
#pragma once

#include <varifold/models/vdpm/view_query.h>
#include <cstddef>
#include <cstdint>

namespace varifold {

/// Regions as they lie in a model, one per lane: codes of cone_code.h and error_code.h.
struct RegionBatch {
  static constexpr std::size_t kSize = 8;
  alignas(32) float x[kSize], y[kSize], z[kSize];  ///< centres
  alignas(32) std::uint32_t cone[kSize];
  alignas(32) float cosine[kSize];  ///< of the cone's angle; at most 0: tells nothing
  alignas(32) float radius[kSize], mu[kSize], delta[kSize], keep[kSize];
};

/// Their answers: as ViewQuery::test() of each, to the bit.
struct AnswerBatch {
  alignas(32) float slack[RegionBatch::kSize];
  alignas(32) std::int32_t asked[RegionBatch::kSize], mover[RegionBatch::kSize];

  [[nodiscard]] ViewAnswer at(std::size_t i) const {
    return {asked[i] != 0, static_cast<Mover>(mover[i]), slack[i]};
  }
};

/// With vector instructions where the processor has them.
void test_regions(const ViewQuery& query, const RegionBatch& regions, AnswerBatch& answers);
/// Without; the same results.
void test_regions_plain(const ViewQuery& query, const RegionBatch& regions, AnswerBatch& answers);

}  // namespace varifold
