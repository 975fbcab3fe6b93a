#include <varifold/models/common/level_table_bytes.h>
#include <varifold/models/common/mesh_bytes.h>
#include <varifold/models/mts/encoding.h>

namespace varifold {

namespace {

using Data = MultiresolutionStripsData;

void append_strips(const Data& data, std::vector<std::byte>& bytes) {
  append_little(bytes, static_cast<std::uint32_t>(data.strips.size() - 1));
  const auto column = [&](std::uint32_t Data::Strip::*first) {
    for (std::size_t s = 0; s + 1 < data.strips.size(); ++s)
      append_little(bytes,
                    static_cast<std::uint16_t>(data.strips[s + 1].*first - data.strips[s].*first));
  };
  column(&Data::Strip::first_node);
  column(&Data::Strip::first_arc);
  column(&Data::Strip::first_change);
  column(&Data::Strip::first_index);
}

}  // namespace

std::vector<std::byte> encode_mts(const MultiresolutionStrips& model) {
  const Data& data = model.data();
  std::vector<std::byte> bytes;
  append_text(bytes, "VMT1");
  append_materials(data.mesh.materials, bytes);
  append_images(data.mesh.images, bytes);
  append_attributes(data.mesh, bytes);
  LevelTableCoder::append(data.levels, bytes);

  append_little(bytes, static_cast<std::uint32_t>(data.mesh.ranges.size()));
  for (const MaterialRange& range : data.mesh.ranges) {
    append_little(bytes, range.material);
    append_little(bytes, range.triangle_count);
  }
  append_strips(data, bytes);
  for (std::size_t r = 0; r + 1 < data.first_strip.size(); ++r)
    append_little(bytes, data.first_strip[r + 1] - data.first_strip[r]);
  append_array<std::uint32_t>(bytes, data.node_vertex);
  append_array<std::uint16_t>(bytes, data.node_arc);
  for (std::size_t s = 0; s + 1 < data.strips.size(); ++s) {
    // Where arcs lead, as seen from the node before them.
    const std::uint32_t nodes = data.strips[s + 1].first_node - data.strips[s].first_node;
    std::uint32_t node = 0;
    for (std::uint32_t a = data.strips[s].first_arc; a < data.strips[s + 1].first_arc; ++a) {
      while (node + 1 < nodes &&
             data.strips[s].first_arc + data.node_arc[data.strips[s].first_node + node + 1] <= a)
        ++node;
      append_little(bytes, static_cast<std::uint16_t>(data.arcs[a].to - node));
    }
  }
  for (const Data::Arc& arc : data.arcs) append_little(bytes, arc.last);
  append_array<std::uint32_t>(bytes, data.changes);
  return bytes;
}

}  // namespace varifold
