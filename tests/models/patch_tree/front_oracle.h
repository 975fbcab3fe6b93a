// Fronts of patch trees by brute force: what is said of them, word by word.
#pragma once

#include <tests/models/patch_tree/synthetic_tree.h>

#include <varifold/base/random.h>
#include <varifold/models/patch_tree/front.h>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace varifold::test {

/// The split flags of all nodes.
using SplitFlags = std::vector<bool>;

/// Priorities of all nodes, from the roots on; leaves have none.
[[nodiscard]] std::vector<float> oracle_priorities(const PatchTree& tree,
                                                   const RefineCriteria& criteria,
                                                   PatchMeasure measure);

struct OracleStop {
  float tolerance = 0;
  std::uint64_t triangles = ~0ull;
  std::uint64_t splits = ~0ull;
  std::function<bool(std::uint32_t)> is_resident;  ///< null: all
};
struct OracleFront {
  SplitFlags split;
  std::uint32_t forced = 0;
  bool is_stopped = false;  ///< by triangles or splits
  float stopped_at = 0;     ///< the priority of the first node that was refused
};
/// Goes through all nodes in order of priority, with a fixpoint for each.
[[nodiscard]] OracleFront oracle_front(const PatchTree& tree, const std::vector<float>& priorities,
                                       const OracleStop& stop);
/// For a tolerance alone: one fixpoint of all nodes that are asked.
[[nodiscard]] SplitFlags oracle_threshold(const PatchTree& tree,
                                          const std::vector<float>& priorities, float tolerance);

/// The draws of a set of split nodes, by node.
[[nodiscard]] std::vector<PatchDraw> oracle_draws(const PatchTree& tree, const SplitFlags& split);
[[nodiscard]] std::uint64_t triangles_of(const PatchTree& tree,
                                         const std::vector<PatchDraw>& draws);

[[nodiscard]] SplitFlags flags_of(const PatchFront& front);
[[nodiscard]] std::vector<PatchDraw> sorted_draws(const PatchFront& front);
/// What is wrong with the state of a front: dependants, priorities, draws, slots, sums; "" if
/// nothing is.
[[nodiscard]] std::string faults_of(const PatchFront& front, const std::vector<float>& priorities);

/// A camera that sees some or none of the unit sphere, from afar, from nearby or from inside.
[[nodiscard]] Camera random_camera(Random& random);

}  // namespace varifold::test
