#include <varifold/models/lodstrips/lod_strips.h>

#include <varifold/mesh/vertex_arrays.h>
#include <varifold/models/common/extract_level.h>
#include <varifold/models/common/level_table_bytes.h>
#include <varifold/models/common/mesh_bytes.h>
#include <varifold/models/common/uniform_model.h>
#include <varifold/models/lodstrips/strip_bytes.h>
#include <varifold/view/draw_vertices.h>
#include <array>
#include <string>
#include <utility>

namespace varifold {

static_assert(UniformInstance<LodStripsInstance, LodStrips>);

namespace {

constexpr std::string_view kTag = "VLS1";

template <std::size_t kIndex = 0>
Result<LodStrips::Form> take_form(std::uint32_t kind, SectionReader& section,
                                  const LevelTable& levels, std::uint32_t ranges) {
  if constexpr (kIndex == std::variant_size_v<LodStrips::Form>) {
    return section.fault("an unknown form of strips");
  } else {
    if (kind != kIndex) return take_form<kIndex + 1>(kind, section, levels, ranges);
    auto form = std::variant_alternative_t<kIndex, LodStrips::Form>::take(section, levels, ranges);
    if (!form) return tl::unexpected(std::move(form.error()));
    return LodStrips::Form(std::in_place_index<kIndex>, std::move(*form));
  }
}

}  // namespace

std::string_view form_name(LodStripsForm form) {
  constexpr std::array<std::string_view, 3> kNames = {"blocks", "grouped", "thesis"};
  return kNames[static_cast<std::size_t>(form)];
}

LodStrips::LodStrips(LevelTable levels, TriangleMesh attributes, Form form)
    : levels_(std::move(levels)), attributes_(std::move(attributes)), form_(std::move(form)) {
  attributes_.indices = {};
  for (MaterialRange& range : attributes_.ranges) range = {range.material, 0, 0};
}

std::size_t LodStrips::bytes() const {
  return vertex_bytes(attributes_) + levels_.bytes() +
         std::visit([](const auto& form) { return form.bytes(); }, form_);
}

std::vector<std::byte> encode_lod_strips(const LodStrips& model) {
  std::vector<std::byte> bytes;
  append_text(bytes, kTag);
  append_little(bytes, static_cast<std::uint32_t>(model.form_kind()));
  append_materials(model.attributes().materials, bytes);
  append_range_materials(model.attributes(), bytes);
  append_images(model.attributes().images, bytes);
  append_attributes(model.attributes(), bytes);
  LevelTableCoder::append(model.levels(), bytes);
  std::visit([&](const auto& form) { form.append_bytes(bytes); }, model.form());
  return bytes;
}

Result<LodStrips> decode_lod_strips(std::span<const std::byte> bytes) {
  SectionReader section(bytes);
  if (as_text(section.take_bytes(kTag.size())) != kTag)
    return fail(ErrorKind::kInvalidInput, "byte 0: not LodStrips (no tag VLS1)");
  const auto kind = section.take<std::uint32_t>();
  TriangleMesh mesh;
  mesh.materials = take_materials(section);
  if (!take_range_materials(section, mesh))
    return section.fault("a range has no material of its own");
  mesh.images = take_images(section);
  take_attributes(section, mesh);
  if (!section.good()) return section.fault("the vertices end too early");
  auto levels = LevelTableCoder::take(section, mesh.positions.size());
  if (!levels) return tl::unexpected(std::move(levels.error()));
  if (levels->targets().size() != mesh.positions.size())
    return section.fault("the levels have another number of vertices");
  const auto ranges = static_cast<std::uint32_t>(mesh.ranges.size());
  auto form = take_form(kind, section, *levels, ranges);
  if (!form) return tl::unexpected(std::move(form.error()));
  if (!section.at_end()) return section.fault("more bytes than the model has");
  return LodStrips(std::move(*levels), std::move(mesh), std::move(*form));
}

LodStripsInstance::Cursor LodStripsInstance::make_cursor(const LodStrips& model,
                                                         StripBuffer buffer) {
  const auto make = [&]<class Made, class Form>(std::in_place_type_t<Made> made, const Form& form) {
    Cursor cursor(made, form, model.levels(), model.attributes());
    std::get<Made>(cursor).go_to_level(0);
    return cursor;
  };
  if (const auto* const form = std::get_if<GroupedForm>(&model.form()))
    return make(std::in_place_type<GroupedCursor>, *form);
  if (const auto* const form = std::get_if<ThesisForm>(&model.form()))
    return make(std::in_place_type<ThesisCursor>, *form);
  return Cursor(std::in_place_type<BlockCursor>, std::get<BlockForm>(model.form()), model.levels(),
                model.attributes(), buffer);
}

LodStripsInstance::LodStripsInstance(std::shared_ptr<const LodStrips> model, StripBuffer buffer)
    : model_(std::move(model)), cursor_(make_cursor(*model_, buffer)) {}

std::uint32_t LodStripsInstance::level() const {
  return std::visit([](const auto& cursor) { return cursor.level(); }, cursor_);
}

void LodStripsInstance::go_to_level(std::uint32_t level) {
  std::visit([&](auto& cursor) { cursor.go_to_level(level); }, cursor_);
}

DrawList LodStripsInstance::draw_list() {
  DrawList list = draw_vertices(model_->attributes());
  std::visit([&](auto& cursor) { cursor.fill(list); }, cursor_);
  const std::uint32_t finest = model_->finest_level();
  list.level = finest > 0 ? static_cast<float>(level()) / static_cast<float>(finest) : 1;
  return list;
}

TriangleMesh LodStripsInstance::extract() const {
  // A copy, so that looking does not count as drawing.
  LodStripsInstance copy(*this);
  return extract_level(model_->attributes(), model_->vertex_count(level()), copy.draw_list());
}

std::size_t LodStripsInstance::bytes() const {
  return std::visit([](const auto& cursor) { return cursor.bytes(); }, cursor_);
}

}  // namespace varifold
