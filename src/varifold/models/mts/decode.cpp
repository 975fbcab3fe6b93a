#include <varifold/models/common/level_table_bytes.h>
#include <varifold/models/common/mesh_bytes.h>
#include <varifold/models/mts/encoding.h>
#include <varifold/view/draw_list.h>
#include <algorithm>

namespace varifold {

namespace {

using Data = MultiresolutionStripsData;

const char* check_mesh(const TriangleMesh& mesh, std::size_t vertices) {
  if (mesh.vertex_count() != vertices) return "the levels have another number of vertices";
  for (const Material& material : mesh.materials)
    for (const std::uint32_t image : material.textures)
      if (image != kNone && image >= mesh.images.size()) return "a material names an image beyond";
  return nullptr;
}

const char* take_ranges(SectionReader& section, std::uint32_t triangles, TriangleMesh& mesh) {
  std::vector<bool> seen(mesh.materials.size(), false);
  std::uint64_t covered = 0;
  const std::uint32_t count = section.take_count(8);
  for (std::uint32_t r = 0; r < count; ++r) {
    MaterialRange range;
    range.material = section.take<std::uint32_t>();
    range.first_triangle = static_cast<std::uint32_t>(covered);
    range.triangle_count = section.take<std::uint32_t>();
    if (range.material >= seen.size() || seen[range.material])
      return "a range has no material of its own";
    seen[range.material] = true;
    covered += range.triangle_count;
    if (covered > triangles) return "the ranges do not add up";
    mesh.ranges.push_back(range);
  }
  return count == 0 || covered == triangles ? nullptr : "the ranges do not add up";
}

class StripsReader {
 public:
  StripsReader(SectionReader& section, Data& data) : section_(section), data_(data) {}

  const char* take() {
    if (const char* fault = take_counts()) return fault;
    const Data::Strip& all = data_.strips.back();
    data_.node_vertex = section_.take_array<std::uint32_t>(all.first_node);
    data_.node_arc = section_.take_array<std::uint16_t>(all.first_node);
    const auto to = section_.take_array<std::uint16_t>(all.first_arc);
    const auto last = section_.take_array<std::uint16_t>(all.first_arc);
    data_.changes = section_.take_array<std::uint32_t>(all.first_change);
    if (!section_.good()) return "the strips end too early";
    data_.arcs.resize(to.size());
    for (std::size_t a = 0; a < to.size(); ++a) data_.arcs[a] = {to[a], last[a]};

    const std::uint32_t finest = data_.levels.finest_level();
    vertices_.reserve(finest + std::size_t{1});
    vertices_.push_back(data_.levels.vertex_count(0));
    for (std::uint32_t k = 0; k < finest; ++k)
      vertices_.push_back(vertices_.back() + data_.levels.step(k).vertices);
    for (std::uint32_t s = 0; s + 1 < data_.strips.size(); ++s)
      if (const char* fault = check_strip(s)) return fault;
    return nullptr;
  }

 private:
  const char* take_counts() {
    const std::uint32_t strips = section_.take_count(8);
    data_.strips.assign(strips + std::size_t{1}, {});
    for (std::uint32_t Data::Strip::*first :
         {&Data::Strip::first_node, &Data::Strip::first_arc, &Data::Strip::first_change,
          &Data::Strip::first_index}) {
      for (std::uint32_t s = 0; s < strips; ++s) {
        const std::uint32_t count = section_.take<std::uint16_t>();
        if (count >= Data::kStripLimit) return "a strip is too large";
        const std::uint32_t before = data_.strips[s].*first;
        if (before > kNone - 1 - count) return "the strips are too large";
        data_.strips[s + 1].*first = before + count;
      }
    }
    const std::size_t ranges = std::max<std::size_t>(1, data_.mesh.ranges.size());
    std::uint64_t first = 0;
    data_.first_strip.assign(1, 0);
    for (std::size_t r = 0; r < ranges; ++r) {
      first += section_.take<std::uint32_t>();
      if (first > strips) return "the ranges have more strips than there are";
      data_.first_strip.push_back(static_cast<std::uint32_t>(first));
    }
    return first == strips ? nullptr : "the ranges have fewer strips than there are";
  }

  const char* check_strip(std::uint32_t s) {
    const Data::Strip& here = data_.strips[s];
    const Data::Strip& next = data_.strips[s + 1];
    const std::uint32_t nodes = next.first_node - here.first_node;
    const std::uint32_t arcs = next.first_arc - here.first_arc;
    const std::uint32_t changes = next.first_change - here.first_change;
    const std::uint32_t slot = next.first_index - here.first_index;
    if (slot == 0 || slot > nodes) return "a strip's slot is larger than the strip, or empty";
    std::uint32_t level = data_.levels.finest_level();
    for (std::uint32_t c = here.first_change; c < next.first_change; ++c) {
      if (data_.changes[c] >= level) return "a strip's changes do not fall";
      level = data_.changes[c];
    }

    // From the end, so that the last state of the node that an arc leads to is known.
    last_of_.assign(nodes + std::size_t{1}, 0xffff);
    std::uint32_t end = arcs;
    for (std::uint32_t node = nodes; node-- > 0;) {
      const std::uint32_t begin = data_.node_arc[here.first_node + node];
      if (begin >= end) return "a node has no arc";
      for (std::uint32_t a = begin; a < end; ++a)
        if (const char* fault = check_arc(s, node, a, a == begin)) return fault;
      last_of_[node] = data_.arcs[here.first_arc + end - 1].last;
      end = begin;
    }
    if (end != 0 || last_of_[0] != changes) return "a strip lacks states";
    return nullptr;
  }

  // An arc leads forward, to a node that lives as long and is a vertex of all levels of the arc.
  const char* check_arc(std::uint32_t s, std::uint32_t node, std::uint32_t a, bool first) {
    const Data::Strip& here = data_.strips[s];
    const std::uint32_t nodes = data_.strips[s + 1].first_node - here.first_node;
    const std::uint32_t changes = data_.strips[s + 1].first_change - here.first_change;
    Data::Arc& arc = data_.arcs[here.first_arc + a];
    const std::uint32_t to = node + arc.to;
    if (arc.to == 0 || to > nodes) return "an arc leads out of its strip";
    arc.to = static_cast<std::uint16_t>(to);
    if (arc.last > changes || (!first && arc.last <= data_.arcs[here.first_arc + a - 1].last))
      return "the intervals of a node's arcs do not follow each other";
    if (to == nodes) return nullptr;
    if (arc.last > last_of_[to]) return "an arc leads to a node that is gone";
    const std::uint32_t vertex = data_.node_vertex[here.first_node + to];
    const std::uint32_t lowest =
        arc.last == changes ? 0 : data_.changes[here.first_change + arc.last] + 1;
    if (vertex != kStripRestart && vertex >= vertices_[lowest])
      return "a node's vertex is not there at its level";
    return nullptr;
  }

  SectionReader& section_;
  Data& data_;
  std::vector<std::uint32_t> vertices_;  // per level
  std::vector<std::uint16_t> last_of_;   // per node of a strip, its last state
};

}  // namespace

Result<MultiresolutionStrips> decode_mts(std::span<const std::byte> bytes) {
  SectionReader section(bytes);
  if (as_text(section.take_bytes(4)) != "VMT1")
    return fail(ErrorKind::kInvalidInput,
                "byte 0: not multiresolution triangle strips (no tag VMT1)");
  Data data;
  data.mesh.materials = take_materials(section);
  data.mesh.images = take_images(section);
  take_attributes(section, data.mesh);
  if (!section.good()) return section.fault("the vertices end too early, or are not finite");
  auto levels = LevelTableCoder::take(section, data.mesh.vertex_count());
  if (!levels) return tl::unexpected<Error>(levels.error());
  data.levels = std::move(*levels);
  if (const char* fault = check_mesh(data.mesh, data.levels.targets().size()))
    return section.fault(fault);
  const std::uint32_t triangles = data.levels.triangle_count(data.levels.finest_level());
  if (const char* fault = take_ranges(section, triangles, data.mesh)) return section.fault(fault);
  if (const char* fault = StripsReader(section, data).take()) return section.fault(fault);
  if (!section.at_end()) return section.fault("there are bytes behind the end");
  return MultiresolutionStrips(std::move(data));
}

}  // namespace varifold
