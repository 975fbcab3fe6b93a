#include <varifold/base/checksum.h>
#include <varifold/mesh/rig.h>
#include <varifold/models/common/rig_bytes.h>
#include <varifold/models/common/varint.h>
#include <varifold/models/patch_tree/block_bytes.h>
#include <varifold/models/patch_tree/encoding.h>
#include <algorithm>
#include <numeric>
#include <string>
#include <utility>

namespace varifold {

namespace {

template <class T>
std::span<T> part(std::vector<T>& values, std::size_t first, std::size_t end) {
  return values.empty() ? std::span<T>() : std::span(values).subspan(first, end - first);
}

class BlockReader {
 public:
  BlockReader(const PatchTreeHead& head, std::uint32_t node, SectionReader& section,
              const PatchArrays& to)
      : head_(head), node_(node), section_(section), to_(to) {}

  // Null, or what is wrong.
  const char* take() {
    take_vectors(to_.positions);
    take_vectors(to_.normals);
    take_vectors(to_.texcoords);
    take_colors();
    take_skin();
    take_poses();
    if (!section_.good()) return "a vertex is not finite, or is not there";
    if (const char* fault = take_survivors()) return fault;
    if (const char* fault = take_controllers()) return fault;
    take_numbers(head_.vertex_count_of(node_), to_.corners);
    if (!section_.good()) return "a corner is no vertex of the patch";
    if (const char* fault = take_ranges()) return fault;
    return section_.at_end() ? nullptr : "there are bytes behind the end of a block";
  }

 private:
  template <class V>
  void take_vectors(std::span<V> to) {
    const auto bytes = section_.take_bytes(to.size_bytes());
    if (!section_.good()) return;
    const std::byte* from = bytes.data();
    for (V& value : to) {
      for (int i = 0; i < V::length(); ++i, from += sizeof(float)) {
        value[i] = load<float>(from);
        if (!(value[i] - value[i] == 0)) section_.fail_here();
      }
    }
  }
  void take_colors() {
    const auto bytes = section_.take_bytes(to_.colors.size_bytes());
    if (!section_.good()) return;
    for (std::size_t v = 0; v < to_.colors.size(); ++v)
      for (int i = 0; i < 4; ++i)
        to_.colors[v][i] = static_cast<std::uint8_t>(bytes[4 * v + static_cast<std::size_t>(i)]);
  }
  void take_skin() {
    const std::size_t joints = head_.rig ? head_.rig->joints.size() : 0;
    for (JointWeights& followed : to_.skin) {
      followed = take_joints(section_);
      if (!is_sound(followed, joints)) section_.fail_here();
    }
  }
  void take_poses() {
    const std::size_t count = head_.vertex_count_of(node_);
    for (Pose& pose : to_.poses) {
      take_vectors(std::span(pose.positions).subspan(to_.first_in_poses, count));
      if (!pose.normals.empty())
        take_vectors(std::span(pose.normals).subspan(to_.first_in_poses, count));
    }
  }
  // Numbers below `count`.
  void take_numbers(std::uint32_t count, std::span<std::uint16_t> to) {
    const std::size_t size = bytes_of_number(count);
    const auto bytes = section_.take_bytes(size * to.size());
    if (!section_.good()) return;
    std::uint32_t greatest = 0;
    for (std::size_t i = 0; i < to.size(); ++i) {
      to[i] = size == 1 ? static_cast<std::uint16_t>(bytes[i])
                        : load<std::uint16_t>(bytes.data() + 2 * i);
      greatest = std::max<std::uint32_t>(greatest, to[i]);
    }
    if (!to.empty() && greatest >= count) section_.fail_here();
  }

  const char* take_survivors() {
    const std::uint32_t parent = head_.topology.parent[node_];
    if (parent == kNone) {
      std::iota(to_.survivors.begin(), to_.survivors.end(), std::uint16_t{0});
      return nullptr;
    }
    take_numbers(head_.vertex_count_of(parent), to_.survivors);
    return section_.good() ? nullptr : "a survivor is no vertex of the parent";
  }

  const char* take_controllers() {
    if (to_.controllers.empty()) return nullptr;
    const std::size_t neighbors = head_.topology.neighbors_of(head_.topology.parent[node_]).size();
    const std::size_t limit = std::min<std::size_t>(neighbors, kMaxControllers);
    const auto bytes = section_.take_bytes(to_.controllers.size());
    for (std::size_t i = 0; i < bytes.size(); ++i) {
      to_.controllers[i] = static_cast<std::uint8_t>(bytes[i]);
      if (to_.controllers[i] >= limit) return "no neighbour moves a vertex that moves";
    }
    return section_.good() ? nullptr : "a block ends too early";
  }

  const char* take_ranges() {
    const std::size_t materials = std::max<std::size_t>(1, head_.materials.size());
    std::size_t first = 0, all = to_.corners.size() / 3;
    std::uint64_t next_material = 0;
    for (PatchRange& range : to_.ranges) {
      const std::uint64_t material = take_varint(section_);
      const std::uint64_t constant = take_varint(section_);
      const std::uint64_t triangles = take_varint(section_);
      if (!section_.good()) return "a block ends too early";
      if (material < next_material || material >= materials) return "a range has no material";
      if (triangles == 0 || triangles > all - first || constant > triangles)
        return "the ranges of a patch do not fit";
      range = {static_cast<std::uint32_t>(material), static_cast<std::uint32_t>(constant),
               static_cast<std::uint32_t>(triangles)};
      for (const std::uint16_t corner : to_.corners.subspan(3 * first, 3 * constant))
        if (corner < to_.controllers.size()) return "a vertex of a constant triangle moves";
      first += triangles;
      next_material = material + 1;
    }
    return first == all ? nullptr : "the ranges of a patch do not fit";
  }

  const PatchTreeHead& head_;
  std::uint32_t node_;
  SectionReader& section_;
  const PatchArrays& to_;
};

// The place of a patch in the arrays of the whole.
PatchArrays arrays_of(const PatchTreeHead& head, std::uint32_t node, PatchTreeData& data) {
  const PatchOffsets& at = head.offsets[node];
  const PatchOffsets& end = head.offsets[node + 1];
  PatchArrays to;
  to.positions = part(data.vertices.positions, at.vertex, end.vertex);
  to.normals = part(data.vertices.normals, at.vertex, end.vertex);
  to.texcoords = part(data.vertices.texcoords, at.vertex, end.vertex);
  to.colors = part(data.vertices.colors, at.vertex, end.vertex);
  to.skin = part(data.vertices.skin, at.vertex, end.vertex);
  to.poses = data.vertices.poses;
  to.first_in_poses = at.vertex;
  to.survivors = part(data.survivors, at.vertex, end.vertex);
  to.corners = part(data.corners, 3 * std::size_t{at.triangle}, 3 * std::size_t{end.triangle});
  to.controllers = part(data.controllers, at.controller, end.controller);
  to.ranges = part(data.ranges, at.range, end.range);
  return to;
}

void make_room(const PatchTreeHead& head, PatchTreeData& data) {
  const PatchOffsets& all = head.offsets.back();
  data.vertices.positions.resize(all.vertex);
  if (head.has_normals) data.vertices.normals.resize(all.vertex);
  if (head.has_texcoords) data.vertices.texcoords.resize(all.vertex);
  if (head.has_colors) data.vertices.colors.resize(all.vertex);
  if (head.has_skin) data.vertices.skin.resize(all.vertex);
  data.vertices.poses = head.poses;
  for (std::size_t k = 0; k < head.poses.size(); ++k) {
    data.vertices.poses[k].positions.resize(all.vertex);
    if (head.poses_have_normals[k]) data.vertices.poses[k].normals.resize(all.vertex);
  }
  data.vertices.rig = head.rig;
  data.survivors.resize(all.vertex);
  data.corners.resize(3 * std::size_t{all.triangle});
  data.controllers.resize(all.controller);
  data.ranges.resize(all.range);
}

}  // namespace

Result<void> decode_patch(const PatchTreeHead& head, std::uint32_t node,
                          std::span<const std::byte> block, const PatchArrays& to,
                          Checksums checksums) {
  SectionReader section(block, static_cast<std::size_t>(head.first_byte[node]));
  if (block.size() != head.first_byte[node + 1] - head.first_byte[node])
    return section.fault("a block has another size than the head says");
  if (checksums == Checksums::kVerify &&
      static_cast<std::uint32_t>(checksum(block)) != head.checksums[node])
    return section.fault("the checksum of a block does not fit");
  if (const char* fault = BlockReader(head, node, section, to).take()) return section.fault(fault);
  return {};
}

Result<PatchTree> decode_patch_tree(std::span<const std::byte> bytes, Checksums checksums) {
  auto head = decode_patch_tree_head(bytes, checksums);
  if (!head) return tl::unexpected<Error>(head.error());
  // So many bytes justify what the counts of the head ask for.
  if (head->first_byte.back() != bytes.size())
    return fail(ErrorKind::kInvalidInput, "byte " + std::to_string(bytes.size()) +
                                              ": the blocks end elsewhere than the head says");
  PatchTreeData data;
  make_room(*head, data);
  for (std::uint32_t node = 0; node < head->topology.node_count(); ++node) {
    const std::uint64_t first = head->first_byte[node], end = head->first_byte[node + 1];
    const auto block =
        bytes.subspan(static_cast<std::size_t>(first), static_cast<std::size_t>(end - first));
    if (auto read = decode_patch(*head, node, block, arrays_of(*head, node, data), checksums);
        !read)
      return tl::unexpected<Error>(read.error());
  }
  data.topology = std::move(head->topology);
  data.bounds = std::move(head->bounds);
  data.offsets = std::move(head->offsets);
  data.vertices.materials = std::move(head->materials);
  data.vertices.images = std::move(head->images);
  return PatchTree(std::move(data));
}

}  // namespace varifold
