#include <varifold/models/common/level_table_bytes.h>
#include <varifold/models/common/mesh_bytes.h>
#include <varifold/models/common/section_reader.h>
#include <varifold/models/lodstrips/frame_strips.h>
#include <varifold/models/lodstrips/strip_bytes.h>
#include <cmath>
#include <string_view>
#include <utility>

namespace varifold {

namespace {

constexpr std::string_view kTag = "VFS1";

// The numbers of a sequence: every vertex once.
bool take_vertices(SectionReader& section, std::uint32_t count, std::vector<std::uint32_t>& to) {
  to = section.take_array<std::uint32_t>(count);
  if (!section.good()) return false;
  std::vector<bool> seen(count, false);
  for (const std::uint32_t v : to) {
    if (v >= count || seen[v]) return false;
    seen[v] = true;
  }
  return true;
}

Result<void> take_sequences(SectionReader& section, FrameStripsData& data) {
  const std::uint32_t vertices = data.mesh.vertex_count();
  const std::uint32_t count = section.take_count(sizeof(std::uint32_t));
  for (std::uint32_t i = 0; i < count; ++i) {
    FrameSequence& sequence = data.sequences.emplace_back();
    auto levels = LevelTableCoder::take(section, vertices);
    if (!levels) return tl::unexpected(std::move(levels.error()));
    sequence.levels = std::move(*levels);
    if (sequence.levels.targets().size() != vertices)
      return section.fault("the levels have another number of vertices");
    if (sequence.levels.finest_level() != data.sequences[0].levels.finest_level())
      return section.fault("sequences have different numbers of levels");
    if (!take_vertices(section, vertices, sequence.vertex))
      return section.fault("a sequence does not have every vertex once");
  }
  if (!section.good() || count == 0) return section.fault("there are no sequences");
  return {};
}

Result<void> take_frames(SectionReader& section, FrameStripsData& data) {
  const std::uint32_t count = section.take_count(2 * sizeof(std::uint32_t));
  for (std::uint32_t i = 0; i < count; ++i) {
    StripFrame& frame = data.frames.emplace_back();
    frame.sequence = section.take<std::uint32_t>();
    const std::uint32_t weights = section.take_count(sizeof(float));
    for (std::uint32_t w = 0; w < weights; ++w) frame.weights.push_back(section.take<float>());
    if (!section.good() || frame.sequence >= data.sequences.size() ||
        weights > data.mesh.poses.size())
      return section.fault("a frame names a sequence or a pose that there is not");
    for (const float weight : frame.weights)
      if (!std::isfinite(weight)) return section.fault("a weight is not finite");
  }
  if (!section.good() || count == 0) return section.fault("there are no frames");
  return {};
}

}  // namespace

std::vector<std::byte> encode_frame_strips(const FrameStrips& model) {
  const FrameStripsData& data = model.data();
  std::vector<std::byte> bytes;
  append_text(bytes, kTag);
  append_materials(data.mesh.materials, bytes);
  append_range_materials(data.mesh, bytes);
  append_images(data.mesh.images, bytes);
  append_attributes(data.mesh, bytes);
  append_little(bytes, static_cast<std::uint32_t>(data.sequences.size()));
  for (const FrameSequence& sequence : data.sequences) {
    LevelTableCoder::append(sequence.levels, bytes);
    append_array<std::uint32_t>(bytes, sequence.vertex);
  }
  append_little(bytes, static_cast<std::uint32_t>(data.frames.size()));
  for (const StripFrame& frame : data.frames) {
    append_little(bytes, frame.sequence);
    append_little(bytes, static_cast<std::uint32_t>(frame.weights.size()));
    for (const float weight : frame.weights) append_little(bytes, weight);
  }
  append_strips(data.strips, bytes);
  return bytes;
}

Result<FrameStrips> decode_frame_strips(std::span<const std::byte> bytes) {
  SectionReader section(bytes);
  if (as_text(section.take_bytes(kTag.size())) != kTag)
    return fail(ErrorKind::kInvalidInput, "byte 0: not FrameStrips (no tag VFS1)");
  FrameStripsData data;
  data.mesh.materials = take_materials(section);
  if (!take_range_materials(section, data.mesh))
    return section.fault("a range has no material of its own");
  data.mesh.images = take_images(section);
  take_attributes(section, data.mesh);
  if (!section.good()) return section.fault("the vertices end too early");
  if (auto taken = take_sequences(section, data); !taken) return tl::unexpected(taken.error());
  if (auto taken = take_frames(section, data); !taken) return tl::unexpected(taken.error());
  auto strips = take_strips(section, data.mesh.vertex_count(),
                            static_cast<std::uint32_t>(data.mesh.ranges.size()));
  if (!strips) return tl::unexpected(std::move(strips.error()));
  data.strips = std::move(*strips);
  if (!std::is_sorted(data.strips.range.begin(), data.strips.range.end()))
    return section.fault("strips do not stand by material ranges");
  if (!section.at_end()) return section.fault("more bytes than the model has");
  return FrameStrips(std::move(data));
}

}  // namespace varifold
