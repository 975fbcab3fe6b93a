#include <varifold/models/strips/encoding.h>

#include <varifold/base/bytes.h>
#include <varifold/models/common/error_code.h>
#include <varifold/models/common/level_table_bytes.h>
#include <varifold/models/common/mesh_bytes.h>
#include <varifold/models/common/section_reader.h>
#include <varifold/models/strips/dependencies.h>
#include <varifold/models/strips/strip_levels.h>
#include <cmath>
#include <string_view>
#include <utility>

namespace varifold {

namespace {

constexpr std::string_view kTag = "VST1";
constexpr std::uint32_t kMostSlots = 0x7fffffff;

bool all_finite(const std::vector<Vec3>& positions) {
  for (const Vec3& p : positions)
    if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z)) return false;
  return true;
}

Result<void> take_ranges(SectionReader& section, StripFrameworkData& data) {
  const std::uint32_t count = section.take_count(8);
  std::uint64_t triangles = 0;
  std::vector<bool> has_range(data.mesh.materials.size(), false);
  for (std::uint32_t r = 0; r < count; ++r) {
    const MaterialRange range{section.take<std::uint32_t>(), static_cast<std::uint32_t>(triangles),
                              section.take<std::uint32_t>()};
    triangles += range.triangle_count;
    if (range.material >= data.mesh.materials.size() || range.triangle_count == 0)
      return section.fault("a range without triangles or material");
    if (has_range[range.material]) return section.fault("a material has two ranges");
    has_range[range.material] = true;
    data.mesh.ranges.push_back(range);
  }
  if (!section.good()) return section.fault("the ranges end too early");
  if (count > 0 && triangles != data.levels.triangle_count(data.levels.finest_level()))
    return section.fault("the ranges do not have all triangles");
  return {};
}

Result<TriangleStrips> take_strips(SectionReader& section, const StripFrameworkData& data) {
  TriangleStrips strips;
  const std::uint32_t count = section.take_count(8);
  const std::size_t ranges = data.mesh.ranges.empty() ? 1 : data.mesh.ranges.size();
  std::uint64_t slots = 0;
  for (std::uint32_t s = 0; s < count; ++s) {
    slots += section.take<std::uint32_t>();
    if (slots > kMostSlots) return section.fault("the strips are too long");
    strips.first.push_back(static_cast<std::uint32_t>(slots));
    const auto range = section.take<std::uint32_t>();
    if (range >= ranges || (s > 0 && range < strips.range.back()))
      return section.fault("a strip of no range, or out of order");
    strips.range.push_back(range);
  }
  strips.indices = section.take_array<std::uint32_t>(slots);
  if (!section.good()) return section.fault("the strips end too early");
  for (const std::uint32_t v : strips.indices)
    if (v >= data.mesh.vertex_count()) return section.fault("a strip names no vertex");
  return strips;
}

// Every level must have as many triangles as the level table says, every range as many as it says.
bool triangles_match(const StripFrameworkData& data, const TriangleStrips& strips,
                     const std::vector<std::uint32_t>& added) {
  const LevelTable& levels = data.levels;
  if (added[0] != levels.triangle_count(0)) return false;
  for (std::uint32_t k = 0; k < levels.finest_level(); ++k)
    if (added[k + 1] != levels.step(k).triangles) return false;
  std::vector<std::uint32_t> of_range(data.mesh.ranges.size(), 0);
  for (std::uint32_t s = 0; s < strips.count() && !of_range.empty(); ++s) {
    const auto strip = strips.strip(s);
    for (std::size_t i = 0; i + 2 < strip.size(); ++i)
      if (!is_degenerate(strip_triangle(strip, i))) ++of_range[strips.range[s]];
  }
  for (std::size_t r = 0; r < of_range.size(); ++r)
    if (of_range[r] != data.mesh.ranges[r].triangle_count) return false;
  return true;
}

Result<void> take_dependencies(SectionReader& section, StripFrameworkData& data) {
  const std::uint32_t words = section.take_count(4);
  data.dependencies = section.take_array<std::uint32_t>(words);
  if (!section.good()) return section.fault("the dependencies end too early");
  if (const char* fault = dependency_fault(data.dependencies, data.levels))
    return section.fault(fault);
  return {};
}

Result<void> take_regions(SectionReader& section, StripFrameworkData& data) {
  const std::uint32_t steps = data.levels.finest_level();
  data.radius = section.take_array<float>(steps);
  data.cone = section.take_array<std::uint32_t>(steps);
  data.error_codes = section.take_array<std::uint16_t>(steps);
  if (!section.good()) return section.fault("the regions end too early");
  for (const float radius : data.radius)
    if (!(radius >= 0 && std::isfinite(radius))) return section.fault("a ball without a radius");
  for (const std::uint16_t code : data.error_codes)
    if (code >= kErrorCodes) return section.fault("an error that is no number");
  return {};
}

Result<void> take_mesh(SectionReader& section, StripFrameworkData& data) {
  take_attributes(section, data.mesh);
  if (!section.good()) return section.fault("the attributes end too early, or are unknown");
  if (!all_finite(data.mesh.positions)) return section.fault("a position is not finite");
  data.mesh.materials = take_materials(section);
  data.mesh.images = take_images(section);
  if (!section.good()) return section.fault("the materials end too early");
  for (const Material& material : data.mesh.materials)
    for (const std::uint32_t image : material.textures)
      if (image != kNone && image >= data.mesh.images.size())
        return section.fault("a material names no image");
  return {};
}

}  // namespace

std::vector<std::byte> encode_strip_framework(const StripFramework& model) {
  const StripFrameworkData& data = model.data();
  std::vector<std::byte> bytes;
  append_text(bytes, kTag);
  append_attributes(data.mesh, bytes);
  append_materials(data.mesh.materials, bytes);
  append_images(data.mesh.images, bytes);
  LevelTableCoder::append(data.levels, bytes);
  append_little(bytes, static_cast<std::uint32_t>(data.mesh.ranges.size()));
  for (const MaterialRange& range : data.mesh.ranges) {
    append_little(bytes, range.material);
    append_little(bytes, range.triangle_count);
  }
  const TriangleStrips strips = model.full_strips();
  append_little(bytes, strips.count());
  for (std::uint32_t s = 0; s < strips.count(); ++s) {
    append_little(bytes, strips.first[s + 1] - strips.first[s]);
    append_little(bytes, strips.range[s]);
  }
  append_array<std::uint32_t>(bytes, strips.indices);
  append_little(bytes, static_cast<std::uint32_t>(data.dependencies.size()));
  append_array<std::uint32_t>(bytes, data.dependencies);
  append_array<float>(bytes, data.radius);
  append_array<std::uint32_t>(bytes, data.cone);
  append_array<std::uint16_t>(bytes, data.error_codes);
  return bytes;
}

Result<StripFramework> decode_strip_framework(std::span<const std::byte> bytes) {
  SectionReader section(bytes);
  if (as_text(section.take_bytes(kTag.size())) != kTag)
    return section.fault("this is no strips framework of version 1");
  StripFrameworkData data;
  if (auto taken = take_mesh(section, data); !taken)
    return tl::unexpected<Error>(std::move(taken.error()));
  auto levels = LevelTableCoder::take(section, data.mesh.vertex_count());
  if (!levels) return tl::unexpected<Error>(std::move(levels.error()));
  data.levels = std::move(*levels);
  if (data.levels.targets().size() != data.mesh.vertex_count())
    return section.fault("the levels do not have all vertices");
  if (auto taken = take_ranges(section, data); !taken)
    return tl::unexpected<Error>(std::move(taken.error()));
  auto strips = take_strips(section, data);
  if (!strips) return tl::unexpected<Error>(std::move(strips.error()));
  StripLevels found = strip_levels(data.mesh, data.levels, *strips);
  if (!found.places_stay_whole)
    return section.fault("vertices at one place do not go to one place");
  if (!triangles_match(data, *strips, found.added))
    return section.fault("the strips do not have the triangles of the levels");
  if (auto taken = take_dependencies(section, data); !taken)
    return tl::unexpected<Error>(std::move(taken.error()));
  if (auto taken = take_regions(section, data); !taken)
    return tl::unexpected<Error>(std::move(taken.error()));
  data.slivers = std::move(found.slivers);
  if (!section.at_end()) return section.fault("there are bytes behind the end");
  return StripFramework(std::move(data), std::move(*strips));
}

}  // namespace varifold
