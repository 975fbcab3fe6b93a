#include <varifold/base/checksum.h>
#include <varifold/models/common/mesh_bytes.h>
#include <varifold/models/common/rig_bytes.h>
#include <varifold/models/common/varint.h>
#include <varifold/models/patch_tree/block_bytes.h>
#include <varifold/models/patch_tree/encoding.h>
#include <varifold/models/patch_tree/required_nodes.h>
#include <cassert>

namespace varifold {

namespace {

using Bytes = std::vector<std::byte>;

template <class V>
void append_vectors(const std::vector<V>& values, std::uint32_t first, std::uint32_t end,
                    Bytes& bytes) {
  if (values.empty()) return;
  for (std::uint32_t v = first; v < end; ++v) append_vector(bytes, values[v], V::length());
}

void append_numbers(std::span<const std::uint16_t> numbers, std::size_t size, Bytes& bytes) {
  if (size == 2) {
    for (const std::uint16_t number : numbers) append_little(bytes, number);
    return;
  }
  for (const std::uint16_t number : numbers) {
    assert(number < 256);
    bytes.push_back(static_cast<std::byte>(number));
  }
}

void append_block(const PatchTree& tree, std::uint32_t node, Bytes& bytes) {
  const PatchTreeData& data = tree.data();
  const PatchOffsets& at = data.offsets[node];
  const PatchOffsets& end = data.offsets[node + 1];
  append_vectors(data.vertices.positions, at.vertex, end.vertex, bytes);
  append_vectors(data.vertices.normals, at.vertex, end.vertex, bytes);
  append_vectors(data.vertices.texcoords, at.vertex, end.vertex, bytes);
  append_vectors(data.vertices.colors, at.vertex, end.vertex, bytes);
  if (data.vertices.has_skin())
    for (std::uint32_t v = at.vertex; v < end.vertex; ++v)
      append_joints(data.vertices.skin[v], bytes);
  for (const Pose& pose : data.vertices.poses) {
    append_vectors(pose.positions, at.vertex, end.vertex, bytes);
    append_vectors(pose.normals, at.vertex, end.vertex, bytes);
  }
  const std::uint32_t parent = data.topology.parent[node];
  if (parent != kNone)
    append_numbers(std::span(data.survivors).subspan(at.vertex, end.vertex - at.vertex),
                   bytes_of_number(tree.vertex_count_of(parent)), bytes);
  append_array<std::uint8_t>(
      bytes, std::span(data.controllers).subspan(at.controller, end.controller - at.controller));
  append_numbers(
      std::span(data.corners)
          .subspan(3 * std::size_t{at.triangle}, 3 * std::size_t{end.triangle - at.triangle}),
      bytes_of_number(tree.vertex_count_of(node)), bytes);
  for (std::uint32_t r = at.range; r < end.range; ++r) {
    append_varint(bytes, data.ranges[r].material);
    append_varint(bytes, data.ranges[r].constant_triangles);
    append_varint(bytes, data.ranges[r].triangle_count);
  }
}

void append_topology(const PatchTopology& t, Bytes& bytes) {
  append_varint(bytes, t.level_count());
  for (std::uint32_t level = 0; level < t.level_count(); ++level)
    append_varint(bytes, t.first_of_level[level + 1] - t.first_of_level[level]);
  for (std::uint32_t node = 0; node < inner_node_count(t); ++node)
    append_varint(bytes, t.first_child[node + 1] - t.first_child[node]);
  for (std::uint32_t node = 0; node < t.node_count(); ++node) {
    append_varint(bytes, t.neighbors_of(node).size());
    std::uint32_t last = node;
    for (const std::uint32_t neighbor : t.neighbors_of(node)) {
      append_varint(bytes, to_zigzag(std::int64_t{neighbor} - last));
      last = neighbor;
    }
  }
}

void append_bounds(const PatchTreeData& data, Bytes& bytes) {
  for (const PatchBounds& bounds : data.bounds) {
    append_vector(bytes, bounds.ball.center, 3);
    append_little(bytes, bounds.ball.radius);
    append_vector(bytes, bounds.cone.axis, 3);
    append_little(bytes, bounds.cone.cosine);
  }
  for (std::uint32_t node = 0; node < inner_node_count(data.topology); ++node) {
    append_little(bytes, data.bounds[node].error);
    append_little(bytes, data.bounds[node].mean_squared);
  }
}

void append_attribute_head(const TriangleMesh& mesh, Bytes& bytes) {
  append_little(bytes, stored_attributes(mesh));
  if (!mesh.poses.empty()) append_pose_names(mesh.poses, bytes);
  if (mesh.rig) append_rig(*mesh.rig, bytes);
}

// The sizes of the blocks are known once they have been written; they are written twice, so that
// memory holds them once. Returns the bytes of all.
std::size_t append_counts(const PatchTree& tree, Bytes& bytes) {
  std::size_t all = 0;
  Bytes block;
  for (std::uint32_t node = 0; node < tree.node_count(); ++node) {
    const PatchOffsets& at = tree.data().offsets[node];
    const PatchOffsets& end = tree.data().offsets[node + 1];
    block.clear();
    append_block(tree, node, block);
    append_varint(bytes, end.vertex - at.vertex);
    append_varint(bytes, end.controller - at.controller);
    append_varint(bytes, end.triangle - at.triangle);
    append_varint(bytes, end.range - at.range);
    append_varint(bytes, block.size());
    append_little(bytes, static_cast<std::uint32_t>(checksum(block)));
    all += block.size();
  }
  return all;
}

}  // namespace

std::vector<std::byte> encode_patch_tree(const PatchTree& tree) {
  const PatchTreeData& data = tree.data();
  Bytes bytes;
  append_text(bytes, kPatchTreeTag);
  bytes.resize(kPatchTreePrefix);
  append_materials(data.vertices.materials, bytes);
  append_images(data.vertices.images, bytes);
  append_attribute_head(data.vertices, bytes);
  append_topology(data.topology, bytes);
  append_bounds(data, bytes);
  const std::size_t blocks = append_counts(tree, bytes);
  store_little(bytes.data() + 8, static_cast<std::uint64_t>(bytes.size()));
  store_little(bytes.data() + 4,
               static_cast<std::uint32_t>(checksum(std::span(bytes).subspan(kPatchTreePrefix))));
  bytes.reserve(bytes.size() + blocks);
  for (std::uint32_t node = 0; node < tree.node_count(); ++node) append_block(tree, node, bytes);
  return bytes;
}

}  // namespace varifold
