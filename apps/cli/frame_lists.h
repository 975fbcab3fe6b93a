// What the frames of an instance draw: the lists of any model, or the patches of a tree.
#pragma once

#include <varifold/io/any_model.h>
#include <varifold/models/patch_tree/patch_draws.h>
#include <varifold/render/renderer.h>
#include <varifold/view/draw_list.h>
#include <varifold/view/patch_draws.h>
#include <varifold/view/patch_morph.h>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>

namespace varifold::cli {

/// Models of patches, whose fronts can be drawn by commands over constant buffers.
template <class Model>
concept DrawsPatches = requires(const InstanceOf<Model>& instance) {
  instance.front().draws();
};

/// Instances of triangles that can be drawn as strips, too.
template <class Model>
concept MakesStrips = requires(InstanceOf<Model>& instance) {
  { instance.draw_strips() } -> std::same_as<DrawList>;
};

/// Valid as long as the lists in it.
struct FrameList {
  DrawList list;
  std::optional<PatchDrawList> patches;  ///< where they are drawn, in place of `list`
  PatchStyle patch_style;
};

/// O(indices) of a list, O(draws) of patches.
[[nodiscard]] inline SubmittedIndices submitted_indices(const FrameList& frame) {
  if (!frame.patches) return submitted_indices(frame.list);
  const std::uint64_t indices = 3 * submitted_triangles(*frame.patches);
  return {indices, indices, 0};
}

struct ListOptions {
  bool strips = false;  ///< made anew for each frame, by models that do
  bool arrays = false;  ///< patches as index arrays, whose borders are written anew
  /// Vertices of patches can blend, by that measure of their errors.
  std::optional<PatchMeasure> morphs;
};

/// How the vertices of a front blend that was chosen by a measure and stopped at a tolerance;
/// nothing where no tolerance can be told.
[[nodiscard]] inline std::optional<PatchMorphRange> morph_range(const Camera& camera,
                                                                PatchMeasure measure,
                                                                float tolerance, float band) {
  if (!(tolerance > 0) || tolerance >= RefineCriteria::kFullDetail) return std::nullopt;
  PatchMorphRange range = measure == PatchMeasure::kMeanSquared
                              ? mean_squared_morph_range(camera.eye, tolerance)
                              : pixel_morph_range(PixelScale(camera), tolerance);
  range.band = band;
  return range;
}

/// Makes the lists of one instance; to be asked once after each change of that.
template <class Model>
class FrameLists {
 public:
  FrameLists(const std::shared_ptr<const Model>& model, const ListOptions& options)
      : strips_(options.strips) {
    if constexpr (DrawsPatches<Model>)
      if (!options.arrays)
        draws_.emplace(std::make_shared<const PatchDrawTables>(model, options.morphs));
  }

  [[nodiscard]] FrameList of(InstanceOf<Model>& instance) {
    if constexpr (DrawsPatches<Model>)
      if (draws_) {
        draws_->follow(instance.front().draws());
        return {{}, draws_->list(), {}};
      }
    if constexpr (MakesStrips<Model>)
      if (strips_) return {instance.draw_strips(), {}, {}};
    return {instance.draw_list(), {}, {}};
  }

 private:
  std::optional<PatchDraws> draws_;
  bool strips_ = false;
};

}  // namespace varifold::cli
