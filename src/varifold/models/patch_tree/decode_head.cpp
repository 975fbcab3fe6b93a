#include <varifold/base/checksum.h>
#include <varifold/models/common/mesh_bytes.h>
#include <varifold/models/common/rig_bytes.h>
#include <varifold/models/common/varint.h>
#include <varifold/models/patch_tree/block_bytes.h>
#include <varifold/models/patch_tree/check_topology.h>
#include <varifold/models/patch_tree/encoding.h>
#include <varifold/models/patch_tree/required_nodes.h>
#include <algorithm>
#include <cmath>
#include <string>

namespace varifold {

namespace {

bool is_finite(const Vec3& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

class HeadReader {
 public:
  explicit HeadReader(SectionReader& section) : section_(section) {}

  // Null, or what is wrong.
  const char* take() {
    for (const auto part : {&HeadReader::take_materials_and_images, &HeadReader::take_levels,
                            &HeadReader::take_children, &HeadReader::take_neighbors,
                            &HeadReader::take_bounds, &HeadReader::take_counts}) {
      const char* const fault = (this->*part)();
      if (!section_.good()) return "the head ends too early, or a number is too large";
      if (fault) return fault;
    }
    if (!section_.at_end()) return "there are bytes behind the end of the head";
    if (const char* fault = check_neighbors(head_.topology)) return fault;
    return check_bounds(head_.topology, head_.bounds);
  }
  [[nodiscard]] PatchTreeHead& head() { return head_; }

 private:
  // A number that must be below `limit`.
  std::uint32_t take_number(std::uint64_t limit) {
    const std::uint64_t number = take_varint(section_);
    if (number >= limit) section_.fail_here();
    return section_.good() ? static_cast<std::uint32_t>(number) : 0;
  }
  // Whether so many elements of at least so many bytes may follow.
  [[nodiscard]] bool may_follow(std::uint64_t count, std::size_t least) const {
    return count <= section_.remaining() / least;
  }

  const char* take_materials_and_images();
  const char* take_levels();
  const char* take_children();
  const char* take_neighbors();
  const char* take_bounds();
  const char* take_counts();
  const char* take_counts_of(std::uint32_t node);
  [[nodiscard]] std::uint64_t least_block(std::uint32_t node) const;

  SectionReader& section_;
  PatchTreeHead head_;
};

const char* HeadReader::take_materials_and_images() {
  head_.materials = take_materials(section_);
  head_.images = take_images(section_);
  for (const Material& material : head_.materials)
    for (const std::uint32_t image : material.textures)
      if (image != kNone && image >= head_.images.size()) return "a material names an image beyond";
  const auto present = section_.take<std::uint32_t>();
  if (present > kStoredAll) return "unknown attributes";
  head_.has_normals = (present & kStoredNormals) != 0;
  head_.has_texcoords = (present & kStoredTexcoords) != 0;
  head_.has_colors = (present & kStoredColors) != 0;
  head_.has_skin = (present & kStoredSkin) != 0;
  if ((present & kStoredPoses) != 0) {
    PoseHead poses = take_pose_names(section_);
    head_.poses = std::move(poses.poses);
    head_.poses_have_normals = std::move(poses.has_normals);
  }
  if ((present & kStoredRig) != 0 && section_.good())
    head_.rig = take_rig(section_, head_.poses.size());
  return section_.good() ? nullptr : "the rig is damaged, or ends too early";
}

const char* HeadReader::take_levels() {
  constexpr std::size_t kLeastNode = 8 * sizeof(float) + 10;
  PatchTopology& t = head_.topology;
  const std::uint64_t levels = take_varint(section_);
  if (!may_follow(levels, kLeastNode)) return "more levels than there are bytes for";
  t.first_of_level.assign(1, 0);
  std::uint64_t nodes = 0;
  for (std::uint64_t level = 0; level < levels && section_.good(); ++level) {
    const std::uint64_t count = take_varint(section_);
    if (count == 0 || !may_follow(nodes + count, kLeastNode) || nodes + count >= kNone)
      return "a level without patches, or with more than there are bytes for";
    nodes += count;
    t.first_of_level.push_back(static_cast<std::uint32_t>(nodes));
  }
  t.parent.assign(nodes, kNone);
  return nullptr;
}

// The children of the nodes of a level are the nodes of the next, in order.
const char* HeadReader::take_children() {
  PatchTopology& t = head_.topology;
  const std::uint32_t nodes = t.node_count();
  t.first_child.reserve(nodes + std::size_t{1});
  for (std::uint32_t level = 0; level + 1 < t.level_count(); ++level) {
    std::uint64_t next = t.first_of_level[level + 1];
    for (std::uint32_t node = t.first_of_level[level]; node < t.first_of_level[level + 1]; ++node) {
      const std::uint64_t children = take_varint(section_);
      if (children == 0 || children > t.first_of_level[level + 2] - next)
        return "a patch has no children, or more than there are";
      t.first_child.push_back(static_cast<std::uint32_t>(next));
      for (std::uint64_t i = 0; i < children; ++i) t.parent[next + i] = node;
      next += children;
    }
    if (next != t.first_of_level[level + 2]) return "a patch has no parent";
  }
  t.first_child.resize(nodes + std::size_t{1}, nodes);
  return nullptr;
}

const char* HeadReader::take_neighbors() {
  PatchTopology& t = head_.topology;
  t.first_neighbor.reserve(t.node_count() + std::size_t{1});
  t.first_neighbor.push_back(0);
  for (std::uint32_t level = 0; level < t.level_count(); ++level) {
    const std::int64_t begin = t.first_of_level[level], end = t.first_of_level[level + 1];
    for (std::int64_t node = begin; node < end; ++node) {
      const std::uint32_t count = take_number(static_cast<std::uint64_t>(end - begin));
      std::int64_t last = node;
      for (std::uint32_t i = 0; i < count && section_.good(); ++i) {
        last += from_zigzag(take_varint(section_));
        if (last < begin || last >= end) return "a neighbour is of another level";
        t.neighbors.push_back(static_cast<std::uint32_t>(last));
      }
      if (t.neighbors.size() >= kNone) return "there are too many neighbours";
      t.first_neighbor.push_back(static_cast<std::uint32_t>(t.neighbors.size()));
    }
  }
  return nullptr;
}

const char* HeadReader::take_bounds() {
  if (!may_follow(head_.topology.node_count(), 8 * sizeof(float))) return "the head ends too early";
  head_.bounds.resize(head_.topology.node_count());
  for (PatchBounds& bounds : head_.bounds) {
    take_vector(section_, bounds.ball.center, 3);
    bounds.ball.radius = section_.take<float>();
    take_vector(section_, bounds.cone.axis, 3);
    const float cosine = section_.take<float>();
    if (!is_finite(bounds.ball.center) || !std::isfinite(bounds.ball.radius) ||
        bounds.ball.radius < 0)
      return "a ball is none";
    if (!is_finite(bounds.cone.axis) || !(cosine >= -1 && cosine <= 1)) return "a cone is none";
    bounds.cone.cosine = cosine;
    bounds.cone.sine = std::sqrt(std::max(0.0f, 1 - cosine * cosine));
  }
  for (std::uint32_t node = 0; node < inner_node_count(head_.topology); ++node) {
    PatchBounds& bounds = head_.bounds[node];
    bounds.error = section_.take<float>();
    bounds.mean_squared = section_.take<float>();
    const bool are_finite = std::isfinite(bounds.error) && std::isfinite(bounds.mean_squared);
    if (!are_finite || bounds.error < 0 || bounds.mean_squared < 0) return "an error is none";
  }
  return nullptr;
}

// What the block of a node takes at least.
std::uint64_t HeadReader::least_block(std::uint32_t node) const {
  const PatchOffsets& at = head_.offsets[node];
  const PatchOffsets& end = head_.offsets[node + 1];
  std::uint64_t bytes_a_vertex = sizeof(Vec3);
  if (head_.has_normals) bytes_a_vertex += sizeof(Vec3);
  if (head_.has_texcoords) bytes_a_vertex += sizeof(Vec2);
  if (head_.has_colors) bytes_a_vertex += sizeof(Color);
  if (head_.has_skin) bytes_a_vertex += kJointWeightsBytes;
  for (const bool has_normals : head_.poses_have_normals)
    bytes_a_vertex += (has_normals ? 2 : 1) * sizeof(Vec3);
  const std::uint32_t parent = head_.topology.parent[node];
  if (parent != kNone) bytes_a_vertex += bytes_of_number(head_.vertex_count_of(parent));
  return (end.vertex - at.vertex) * bytes_a_vertex + (end.controller - at.controller) +
         3 * std::uint64_t{end.triangle - at.triangle} *
             bytes_of_number(head_.vertex_count_of(node)) +
         3 * std::uint64_t{end.range - at.range};
}

const char* HeadReader::take_counts_of(std::uint32_t node) {
  constexpr std::uint64_t kMaxBlock = std::uint64_t{1} << 40;
  const PatchOffsets last = head_.offsets.back();
  const std::uint32_t vertices = take_number(kMaxPatchVertices + 1);
  const std::uint32_t moving = take_number(vertices + std::uint64_t{1});
  const std::uint32_t triangles = take_number(kNone);
  const std::uint32_t ranges = take_number(triangles + std::uint64_t{1});
  const std::uint64_t block = take_varint(section_);
  head_.checksums.push_back(section_.take<std::uint32_t>());
  if (!section_.good()) return "the counts of a patch do not fit, or end too early";
  if (moving > 0 && head_.topology.parent[node] == kNone) return "a root has vertices that move";
  if ((ranges == 0) != (triangles == 0)) return "a patch has no range";
  // Indices have numbers of 32 bits: three a triangle, and three more for those at borders.
  constexpr std::uint32_t kMaxTriangles = std::uint32_t{1} << 29;
  const bool fit = triangles < kMaxTriangles - last.triangle && ranges < kMaxTriangles &&
                   vertices < kNone - last.vertex && block < kMaxBlock;
  if (!fit) return "the patches are too large";
  head_.offsets.push_back({last.vertex + vertices, last.triangle + triangles,
                           last.controller + moving, last.range + ranges});
  head_.first_byte.push_back(head_.first_byte.back() + block);
  return block < least_block(node) ? "the block of a patch is too small for it" : nullptr;
}

const char* HeadReader::take_counts() {
  const PatchTopology& t = head_.topology;
  head_.offsets.reserve(t.node_count() + std::size_t{1});
  head_.offsets.emplace_back();
  head_.first_byte.reserve(t.node_count() + std::size_t{1});
  head_.first_byte.push_back(0);  // set to the size of the head by the caller
  head_.checksums.reserve(t.node_count());
  for (std::uint32_t node = 0; node < t.node_count(); ++node)
    if (const char* fault = take_counts_of(node)) return fault;
  for (std::uint32_t node = 0; node < inner_node_count(t); ++node) {
    const std::uint32_t below = head_.offsets[t.first_child[node + 1]].triangle -
                                head_.offsets[t.first_child[node]].triangle;
    if (head_.triangle_count_of(node) > below)
      return "a patch has more triangles than its children";
  }
  return nullptr;
}

}  // namespace

Result<std::uint64_t> patch_tree_head_bytes(std::span<const std::byte> bytes) {
  SectionReader section(bytes);
  if (as_text(section.take_bytes(4)) != kPatchTreeTag)
    return fail(ErrorKind::kInvalidInput, "byte 0: not a patch tree (no tag VPT1)");
  static_cast<void>(section.take<std::uint32_t>());
  const auto size = section.take<std::uint64_t>();
  if (!section.good() || size < kPatchTreePrefix) return section.fault("the head is too small");
  return size;
}

Result<PatchTreeHead> decode_patch_tree_head(std::span<const std::byte> bytes,
                                             Checksums checksums) {
  const auto size = patch_tree_head_bytes(bytes);
  if (!size) return tl::unexpected<Error>(size.error());
  if (*size > bytes.size())
    return fail(ErrorKind::kInvalidInput,
                "byte " + std::to_string(bytes.size()) + ": the head ends too early");
  const auto head = bytes.first(static_cast<std::size_t>(*size)).subspan(kPatchTreePrefix);
  if (checksums == Checksums::kVerify &&
      static_cast<std::uint32_t>(checksum(head)) != load<std::uint32_t>(bytes.data() + 4))
    return fail(ErrorKind::kInvalidInput, "byte 4: the checksum of the head does not fit");
  SectionReader section(head, kPatchTreePrefix);
  HeadReader reader(section);
  if (const char* fault = reader.take()) return section.fault(fault);
  for (std::uint64_t& first : reader.head().first_byte) first += *size;
  return std::move(reader.head());
}

}  // namespace varifold
