// LodStrips: any level of one mesh, exactly, as triangle strips that are changed in place.
//
// Based on: [Ramos2008] chapters 4 and 5.
// Differs: three forms of the same model; see docs/algorithms/lodstrips.md.
#pragma once

#include <varifold/base/result.h>
#include <varifold/mesh/triangle_mesh.h>
#include <varifold/models/common/level_queries.h>
#include <varifold/models/common/level_table.h>
#include <varifold/models/lodstrips/block_cursor.h>
#include <varifold/models/lodstrips/block_form.h>
#include <varifold/models/lodstrips/grouped_cursor.h>
#include <varifold/models/lodstrips/grouped_form.h>
#include <varifold/models/lodstrips/thesis_cursor.h>
#include <varifold/models/lodstrips/thesis_form.h>
#include <varifold/view/draw_list.h>
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string_view>
#include <variant>
#include <vector>

namespace varifold {

enum class LodStripsForm : std::uint8_t {
  kBlocks,   ///< strips built from coarse to fine, in blocks: block_form.h
  kGrouped,  ///< strips of the full mesh, changes in groups: chapter 5, grouped_form.h
  kThesis,   ///< the same, three words a change: chapter 4, thesis_form.h
};

inline constexpr std::array<LodStripsForm, 3> kLodStripsForms = {
    LodStripsForm::kBlocks, LodStripsForm::kGrouped, LodStripsForm::kThesis};

/// "blocks", "grouped", "thesis".
[[nodiscard]] std::string_view form_name(LodStripsForm form);

/// Immutable, shared by any number of instances and threads.
class LodStrips : public LevelQueries<LodStrips> {
 public:
  using Form = std::variant<BlockForm, GroupedForm, ThesisForm>;  // as LodStripsForm

  LodStrips() = default;
  /// The parts must be consistent, as from build_lod_strips() (build.h) or decode_lod_strips(). Of
  /// `attributes`, indices and the triangles of ranges are not kept.
  LodStrips(LevelTable levels, TriangleMesh attributes, Form form);

  [[nodiscard]] const LevelTable& levels() const { return levels_; }
  [[nodiscard]] const Form& form() const { return form_; }
  [[nodiscard]] LodStripsForm form_kind() const {
    return static_cast<LodStripsForm>(form_.index());
  }
  /// The vertex attributes at full detail, the materials of the ranges and images.
  [[nodiscard]] const TriangleMesh& attributes() const { return attributes_; }

  /// Memory of all arrays but images; vertices included.
  [[nodiscard]] std::size_t bytes() const;

 private:
  LevelTable levels_;
  TriangleMesh attributes_;
  Form form_;
};

/// All of the model as bytes; docs/formats/lodstrips.md. O(n).
[[nodiscard]] std::vector<std::byte> encode_lod_strips(const LodStrips& model);

/// The same model again. Accepts any bytes; O(bytes) time and memory.
/// Errors: kInvalidInput with the offset of the fault.
[[nodiscard]] Result<LodStrips> decode_lod_strips(std::span<const std::byte> bytes);

/// One place in a scene where a model stands, at a level of its own.
class LodStripsInstance {
 public:
  /// Begins at level 0. O(size of the model). `buffer` is for the form of blocks; the others draw
  /// from a buffer of their own.
  explicit LodStripsInstance(std::shared_ptr<const LodStrips> model,
                             StripBuffer buffer = StripBuffer::kInPlace);

  [[nodiscard]] const LodStrips& model() const { return *model_; }
  [[nodiscard]] std::uint32_t level() const;

  /// Splits or collapses until `level` (at most the model's finest). Allocates nothing. The buffers
  /// depend on the level alone, not on the way to it.
  void go_to_level(std::uint32_t level);

  /// Strips of the present level, ready to be drawn, and what changed since the last call of this
  /// function. Valid until the next go_to_level().
  [[nodiscard]] DrawList draw_list();

  /// A copy of the level as a mesh of its own, with materials. O(size of the instance).
  [[nodiscard]] TriangleMesh extract() const;

  /// Memory of the instance alone.
  [[nodiscard]] std::size_t bytes() const;

 private:
  using Cursor = std::variant<BlockCursor, GroupedCursor, ThesisCursor>;
  [[nodiscard]] static Cursor make_cursor(const LodStrips& model, StripBuffer buffer);

  std::shared_ptr<const LodStrips> model_;
  Cursor cursor_;
};

}  // namespace varifold
