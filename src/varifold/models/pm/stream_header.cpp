#include <varifold/models/pm/stream_header.h>

#include <varifold/base/bytes.h>
#include <varifold/models/common/error_code.h>
#include <varifold/models/common/mesh_bytes.h>
#include <varifold/models/common/section_reader.h>
#include <cmath>
#include <string>

namespace varifold::pm {

namespace {

constexpr std::string_view kTag = "VPM1";

enum Flags : std::uint32_t {
  kNormals = 1,
  kTexcoords = 2,
  kColors = 4,
  kMeasured = 8,
  kMovesVertices = 16,
  kRanges = 32,
  kAllFlags = 63,
};

void append_format(const AttributeFormat& format, std::vector<std::byte>& bytes) {
  append_little(bytes, static_cast<std::uint8_t>(format.position_bits));
  append_little(bytes, static_cast<std::uint8_t>(format.normal_bits));
  append_little(bytes, static_cast<std::uint8_t>(format.texcoord_bits));
  append_little(bytes, std::uint8_t{0});
  if (format.position_bits > 0) {
    append_vector(bytes, format.position_origin, 3);
    append_little(bytes, format.position_step);
  }
  if (format.texcoord_bits > 0) {
    append_vector(bytes, format.texcoord_origin, 2);
    for (const double step : format.texcoord_step) append_little(bytes, step);
  }
}

bool is_step(double step) { return step >= 0 && std::isfinite(step); }

const char* take_format(SectionReader& section, AttributeFormat& format) {
  format.position_bits = section.take<std::uint8_t>();
  format.normal_bits = section.take<std::uint8_t>();
  format.texcoord_bits = section.take<std::uint8_t>();
  if (section.take<std::uint8_t>() != 0) return "a reserved byte is not zero";
  if (format.position_bits > kMaxPositionBits || format.normal_bits > kMaxNormalBits ||
      format.normal_bits == 1 || format.texcoord_bits > kMaxTexcoordBits)
    return "a grid has more bits than there can be";
  if (format.position_bits > 0) {
    take_vector(section, format.position_origin, 3);
    format.position_step = section.take<double>();
    if (!is_step(format.position_step)) return "the step of the positions is no distance";
  }
  if (format.texcoord_bits > 0) {
    take_vector(section, format.texcoord_origin, 2);
    for (double& step : format.texcoord_step) {
      step = section.take<double>();
      if (!is_step(step)) return "the step of the texture coordinates is no distance";
    }
  }
  return nullptr;
}

// Ranges name each material at most once.
const char* check_ranges(const StreamHeader& header) {
  if (!header.has_ranges) return header.ranges.size() == 1 ? nullptr : "there is not one range";
  std::vector<bool> seen(header.materials.size(), false);
  for (const StreamRange& range : header.ranges) {
    if (range.material >= seen.size() || seen[range.material])
      return "a range has no material of its own";
    seen[range.material] = true;
  }
  return header.ranges.empty() ? "there is no range" : nullptr;
}

const char* check_counts(const StreamHeader& header) {
  std::uint64_t base_triangles = 0;
  for (const StreamRange& range : header.ranges) base_triangles += range.base_triangles;
  if (base_triangles != header.base_triangles) return "the ranges do not add up";
  // Several ranges grow in blocks that may be half empty, and slots have 31 bits.
  if (header.ranges.size() > 1u << 20) return "too many ranges";
  if (header.triangles > 0x7fffffffu / (header.ranges.size() > 1 ? 12 : 3))
    return "too many triangles";
  if (header.base_vertices > header.vertices || header.base_triangles > header.triangles)
    return "the base is larger than the whole";
  if (header.levels > header.vertices - header.base_vertices)
    return "there are more levels than vertices";
  if (header.levels > 0 && header.base_vertices == 0) return "there is no vertex to split";
  if (header.error >= kErrorCodes) return "the error is no number";
  return nullptr;
}

}  // namespace

void append_preamble(const StreamPreamble& preamble, std::vector<std::byte>& bytes) {
  append_text(bytes, kTag);
  append_little(bytes, preamble.header_size);
  append_little(bytes, preamble.images_size);
  append_little(bytes, preamble.base_size);
}

void append_header(const StreamHeader& header, std::vector<std::byte>& bytes) {
  const std::uint32_t flags =
      (header.format.normals ? kNormals : 0u) | (header.format.texcoords ? kTexcoords : 0u) |
      (header.format.colors ? kColors : 0u) | (header.error_is_measured ? kMeasured : 0u) |
      (header.moves_vertices ? kMovesVertices : 0u) | (header.has_ranges ? kRanges : 0u);
  append_little(bytes, flags);
  for (const std::uint32_t count : {header.levels, header.vertices, header.triangles,
                                    header.base_vertices, header.base_triangles, header.error})
    append_little(bytes, count);
  append_format(header.format, bytes);
  append_little(bytes, static_cast<std::uint32_t>(header.ranges.size()));
  for (const StreamRange& range : header.ranges) {
    append_little(bytes, range.material);
    append_little(bytes, range.base_triangles);
  }
  append_materials(header.materials, bytes);
}

Result<StreamPreamble> read_preamble(std::span<const std::byte> bytes) {
  SectionReader section(bytes, 0);
  if (as_text(section.take_bytes(kTag.size())) != kTag)
    return fail(ErrorKind::kInvalidInput, "byte 0: not a progressive mesh (no tag VPM1)");
  StreamPreamble preamble;
  preamble.header_size = section.take<std::uint32_t>();
  preamble.images_size = section.take<std::uint64_t>();
  preamble.base_size = section.take<std::uint64_t>();
  constexpr std::uint64_t kLargest = std::uint64_t{1} << 48;
  if (preamble.images_size > kLargest || preamble.base_size > kLargest)
    return section.fault("a section is too large");
  return preamble;
}

Result<StreamHeader> read_header(std::span<const std::byte> bytes, std::size_t offset) {
  SectionReader section(bytes, offset);
  StreamHeader header;
  const auto flags = section.take<std::uint32_t>();
  if ((flags & ~std::uint32_t{kAllFlags}) != 0) return section.fault("unknown flags");
  header.format.normals = (flags & kNormals) != 0;
  header.format.texcoords = (flags & kTexcoords) != 0;
  header.format.colors = (flags & kColors) != 0;
  header.error_is_measured = (flags & kMeasured) != 0;
  header.moves_vertices = (flags & kMovesVertices) != 0;
  header.has_ranges = (flags & kRanges) != 0;
  for (std::uint32_t* count : {&header.levels, &header.vertices, &header.triangles,
                               &header.base_vertices, &header.base_triangles, &header.error})
    *count = section.take<std::uint32_t>();
  if (const char* fault = take_format(section, header.format)) return section.fault(fault);

  header.ranges.resize(section.take_count(8));
  for (StreamRange& range : header.ranges) {
    range.material = section.take<std::uint32_t>();
    range.base_triangles = section.take<std::uint32_t>();
  }
  header.materials = take_materials(section);
  if (!section.good()) return section.fault("the header ends too early");
  if (!section.at_end()) return section.fault("the header is too long");
  if (const char* fault = check_ranges(header)) return section.fault(fault);
  if (const char* fault = check_counts(header)) return section.fault(fault);
  return header;
}

}  // namespace varifold::pm
