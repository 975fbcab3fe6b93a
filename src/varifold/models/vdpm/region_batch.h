// Many regions asked at once: eight lanes of the same arithmetic.
#pragma once

#include <varifold/models/vdpm/odometers.h>
#include <varifold/models/vdpm/step_bounds.h>
#include <varifold/models/vdpm/view_query.h>
#include <array>
#include <cstddef>
#include <cstdint>

namespace varifold {

/// Regions as they lie in a model, one per lane; every lane must be set.
struct RegionBatch {
  static constexpr std::size_t kSize = 8;
  std::array<const PackedBounds*, kSize> bounds{};
  std::array<const Vec3*, kSize> centers{};
  bool keeps = false;
  std::array<float, kSize> keep{};  ///< of own regions; zeros unless `keeps`
};

/// Their answers: asked, and the keys, as ViewQuery::test() and Odometers::key() give them, to the
/// bit.
struct AnswerBatch {
  alignas(32) std::array<float, RegionBatch::kSize> keys;
  std::uint32_t asked;  ///< a bit for every lane
};

/// Asks for what steps change themselves.
void test_own_regions(const ViewQuery& query, const Odometers& odometers,
                      const RegionBatch& regions, AnswerBatch& answers);
/// For what they and all below them in the watch tree change.
void test_nested_regions(const ViewQuery& query, const Odometers& odometers,
                         const RegionBatch& regions, AnswerBatch& answers);

/// Without vector instructions; the same results.
void test_own_regions_plain(const ViewQuery& query, const Odometers& odometers,
                            const RegionBatch& regions, AnswerBatch& answers);
void test_nested_regions_plain(const ViewQuery& query, const Odometers& odometers,
                               const RegionBatch& regions, AnswerBatch& answers);

}  // namespace varifold
