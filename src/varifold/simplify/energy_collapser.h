// Collapses in the order of the change of energy.
#pragma once

#include <varifold/base/progress.h>
#include <varifold/simplify/collapse_rounds.h>
#include <varifold/simplify/legality.h>
#include <varifold/simplify/placement_recorder.h>
#include <varifold/simplify/surface_energy.h>
#include <cstdint>
#include <vector>

namespace varifold {

struct EnergyCollapseOptions {
  EnergyOptions energy;
  LegalityOptions legality;
  std::uint32_t target_faces = 0;
  int threads = 0;  ///< 0 = all; of the first evaluation of all points
  Progress progress;
};

/// The log of collapses, and the change of energy of each.
struct EnergyLog {
  CollapseLog log;
  std::vector<float> costs;
};

/// Collapses until nothing legal is left or the target is reached. `placement` is null where
/// vertices are kept; else the vertices that stay go to where the energy is least, and positions of
/// the surface and values of the attributes change. The same for any number of threads. The errors
/// of the log are distances of samples, so far.
[[nodiscard]] EnergyLog collapse_by_energy(const EnergyInput& input,
                                           const EnergyCollapseOptions& options,
                                           PlacementLog* placement);

}  // namespace varifold
