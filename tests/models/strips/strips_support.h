// Strips frameworks of all test meshes, and oracles that share no code with them.
#pragma once

#include <tests/support/greedy_strips.h>
#include <tests/support/meshes.h>

#include <varifold/models/strips/build.h>
#include <varifold/models/strips/instance.h>
#include <varifold/simplify/collapse_sequence.h>
#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace varifold::test {

/// The strips that all models here are built from.
[[nodiscard]] inline TriangleStrips some_strips(const TriangleMesh& mesh) {
  return greedy_strips(mesh, Joins::kSome);
}

struct NamedFramework {
  std::string name;
  DetailedMesh detailed;
  std::shared_ptr<const StripFramework> model;
};

/// A sphere with short creases of its normals all over, which end inside the surface.
[[nodiscard]] NamedMesh torn_sphere(std::uint64_t seed);
/// A sheet with a triangle more on each edge of its border.
[[nodiscard]] NamedMesh fringed_sheet(std::uint64_t seed);
[[nodiscard]] NamedFramework make_framework(const NamedMesh& named);
/// Every test mesh, three torn spheres and three fringed sheets, made once; and those with at most
/// so many levels.
[[nodiscard]] const std::vector<NamedFramework>& all_frameworks();
[[nodiscard]] std::vector<const NamedFramework*> small_frameworks(std::uint32_t levels);

/// All levels of a small model, some 40 of a large one, the ends among them.
[[nodiscard]] std::vector<std::uint32_t> spread_levels(std::uint32_t finest);

/// Corners and material, turned so that the least corner comes first.
using Triangle = std::array<std::uint32_t, 4>;
[[nodiscard]] Triangle turned(std::uint32_t a, std::uint32_t b, std::uint32_t c,
                              std::uint32_t material);
/// Sorted; without those that have two equal corners.
[[nodiscard]] std::vector<Triangle> triangle_set(const TriangleMesh& mesh);
/// Of what a draw list draws: by its ranges, restarts and all.
[[nodiscard]] std::vector<Triangle> triangle_set(const DrawList& list);
/// The mesh where the given steps are split: every corner its first ancestor that is there.
[[nodiscard]] TriangleMesh mesh_of_front(const DetailedMesh& detailed,
                                         const std::vector<bool>& split);
[[nodiscard]] std::vector<bool> splits_of(const StripFrameworkInstance& instance);

/// The dependencies of every step, read from the model's packed form.
[[nodiscard]] std::vector<std::vector<std::uint32_t>> dependencies_of(const StripFramework& model);

/// Empty where both have the same state and the same buffers, byte for byte.
[[nodiscard]] std::string difference(StripFrameworkInstance& a, StripFrameworkInstance& b);

}  // namespace varifold::test
