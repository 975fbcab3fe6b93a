#include <gtest/gtest.h>
#include <tests/support/meshes.h>
#include <varifold/mesh/generators.h>
#include <varifold/simplify/collapse_rounds.h>
#include <algorithm>

namespace varifold {
namespace {

struct Simplified {
  CollapseLog log;
  std::uint32_t faces = 0;
};

Simplified simplified_by(const RoundOptions& options, float distance_weight = 0) {
  InputFaults faults;
  PlanetOptions planet_options;
  planet_options.triangles = 20000;
  WorkingSurface surface = build_surface(planet(planet_options), {}, faults);
  CollapserOptions collapser_options;
  collapser_options.distance_weight = distance_weight;
  Collapser collapser(surface, nullptr, collapser_options);
  Simplified result;
  result.log = run_rounds(surface, collapser, options);
  result.faces = surface.face_count;
  return result;
}

std::uint16_t dearest(const std::vector<CollapseLogEntry>& entries) {
  std::uint16_t most = 0;
  for (const CollapseLogEntry& entry : entries) most = std::max(most, entry.bucket);
  return most;
}

TEST(CollapseRounds, ExactOnesStopAtTheCollapseThatReachesTheTarget) {
  for (const std::uint32_t target : {10001u, 5000u, 137u}) {
    RoundOptions options;
    options.target_faces = target;
    options.exact = true;
    const std::uint32_t faces = simplified_by(options).faces;
    EXPECT_LE(faces, target);
    EXPECT_GT(faces + 2, target);
  }
}

TEST(CollapseRounds, StopBeforeWhatIsTooDear) {
  RoundOptions options;
  options.target_faces = 40;
  options.exact = true;
  const Simplified all = simplified_by(options);
  options.most_cost = 4;
  const Simplified some = simplified_by(options);
  EXPECT_LE(all.faces, 40u);
  EXPECT_GT(some.faces, 40u);
  EXPECT_LT(some.faces, 10000u);  // it gets halfway in any case
  EXPECT_LT(dearest(some.log.entries), dearest(all.log.entries));
  EXPECT_LE(dearest(some.log.entries),
            dearest({some.log.entries.begin(),
                     some.log.entries.begin() +
                         static_cast<std::ptrdiff_t>(some.log.entries.size() * 3 / 4)}) +
                3 * BucketQueue::kBucketsPerOctave);
}

TEST(CollapseRounds, ADearDistanceComesLater) {
  RoundOptions options;
  options.target_faces = 2000;
  const Simplified plain = simplified_by(options), weighted = simplified_by(options, 1e-2f);
  EXPECT_LE(weighted.faces, 2000u);
  EXPECT_GT(dearest(weighted.log.entries), dearest(plain.log.entries));
}

}  // namespace
}  // namespace varifold
