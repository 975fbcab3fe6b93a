// Fronts of a patch tree as draw lists whose indices never change.
//
// Based on: [Birkholz2007] section 5 (a constant partition in graphics memory, a changeable one).
// Differs: the changeable part is a mask of bits per patch, which the vertex shader applies, so
//   that no triangle is written anew; geomorphs.
#pragma once

#include <varifold/models/patch_tree/extract.h>
#include <varifold/models/patch_tree/front_draws.h>
#include <varifold/models/patch_tree/front_priorities.h>
#include <varifold/models/patch_tree/patch_tree.h>
#include <varifold/view/patch_draws.h>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace varifold {

/// What all instances of a tree share: a word per vertex that says how borders are switched, and,
/// where geomorphs are wanted, two that say how vertices blend. Immutable.
class PatchDrawTables {
 public:
  /// With `morphs`, vertices blend by that measure of their patches: PatchBounds::error, or the
  /// root of PatchBounds::mean_squared. O(vertices).
  explicit PatchDrawTables(std::shared_ptr<const PatchTree> tree,
                           std::optional<PatchMeasure> morphs = std::nullopt);

  [[nodiscard]] const PatchTree& tree() const { return *tree_; }
  [[nodiscard]] std::span<const PatchRemap> remap() const { return remap_; }
  [[nodiscard]] std::span<const PatchMorph> morphs() const { return morphs_; }
  /// The most materials that a patch has: so many draws stand for each, empty ones at the end.
  [[nodiscard]] std::uint32_t draws_per_patch() const { return draws_per_patch_; }
  [[nodiscard]] std::size_t bytes() const;

 private:
  void find_remap();
  void find_morphs(PatchMeasure measure);
  void find_morphs_of_level(std::uint32_t level, PatchMeasure measure);

  std::shared_ptr<const PatchTree> tree_;
  std::vector<PatchRemap> remap_;
  std::vector<PatchMorph> morphs_;
  std::uint32_t draws_per_patch_ = 1;
};

/// The draws of a front. Allocates only where a front has more patches than any before.
class PatchDraws {
 public:
  explicit PatchDraws(std::shared_ptr<const PatchDrawTables> tables) : tables_(std::move(tables)) {}

  /// Takes over what the last follow() of `draws` changed; to be called after each of these, always
  /// with the same `draws`, or after any number of them with `rewrite`. O(changed slots).
  void follow(const FrontDraws& draws, bool rewrite = false);
  /// Any legal front, written as a whole. O(nodes).
  void show(SplitFlags is_split);

  /// Valid until the next call of another function.
  [[nodiscard]] PatchDrawList list() const;
  [[nodiscard]] const PatchDrawTables& tables() const { return *tables_; }
  [[nodiscard]] std::size_t bytes() const;

 private:
  void write(std::uint32_t slot, const PatchDraw& draw);
  void write_all(std::span<const PatchDraw> draws);

  std::shared_ptr<const PatchDrawTables> tables_;
  std::vector<PatchDrawCommand> commands_;  // draws_per_patch() for each slot
  std::vector<std::uint32_t> changed_;
  bool is_begun_ = false;  // follow() has been called, and show() not after it
};

}  // namespace varifold
