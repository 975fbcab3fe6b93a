#include <gtest/gtest.h>
#include <tests/models/patch_tree/built_trees.h>

#include <varifold/base/bytes.h>
#include <varifold/base/checksum.h>
#include <varifold/base/random.h>
#include <varifold/mesh/validation.h>
#include <varifold/models/patch_tree/encoding.h>
#include <varifold/models/patch_tree/extract.h>
#include <varifold/models/patch_tree/instance.h>
#include <algorithm>
#include <limits>

namespace varifold::test {
namespace {

using Bytes = std::vector<std::byte>;

void expect_same_topology(const PatchTopology& a, const PatchTopology& b) {
  EXPECT_EQ(a.first_of_level, b.first_of_level);
  EXPECT_EQ(a.parent, b.parent);
  EXPECT_EQ(a.first_child, b.first_child);
  EXPECT_EQ(a.first_neighbor, b.first_neighbor);
  EXPECT_EQ(a.neighbors, b.neighbors);
}

void expect_same_patches(const PatchTreeData& a, const PatchTreeData& b) {
  ASSERT_EQ(a.offsets.size(), b.offsets.size());
  for (std::size_t n = 0; n < a.offsets.size(); ++n) {
    EXPECT_EQ(a.offsets[n].vertex, b.offsets[n].vertex);
    EXPECT_EQ(a.offsets[n].triangle, b.offsets[n].triangle);
    EXPECT_EQ(a.offsets[n].controller, b.offsets[n].controller);
    EXPECT_EQ(a.offsets[n].range, b.offsets[n].range);
  }
  EXPECT_EQ(a.survivors, b.survivors);
  EXPECT_EQ(a.controllers, b.controllers);
  EXPECT_EQ(a.corners, b.corners);
  ASSERT_EQ(a.ranges.size(), b.ranges.size());
  for (std::size_t r = 0; r < a.ranges.size(); ++r) {
    EXPECT_EQ(a.ranges[r].material, b.ranges[r].material);
    EXPECT_EQ(a.ranges[r].constant_triangles, b.ranges[r].constant_triangles);
    EXPECT_EQ(a.ranges[r].triangle_count, b.ranges[r].triangle_count);
  }
}

void expect_same_bounds(const PatchTreeData& a, const PatchTreeData& b) {
  ASSERT_EQ(a.bounds.size(), b.bounds.size());
  for (std::size_t n = 0; n < a.bounds.size(); ++n) {
    const PatchBounds &x = a.bounds[n], &y = b.bounds[n];
    EXPECT_TRUE(x.ball.center == y.ball.center && x.ball.radius == y.ball.radius);
    EXPECT_TRUE(x.error == y.error && x.mean_squared == y.mean_squared);
    EXPECT_TRUE(x.cone.axis == y.cone.axis && x.cone.cosine == y.cone.cosine &&
                x.cone.sine == y.cone.sine);
  }
}

TEST(PatchTreeEncoding, IsTheIdentity) {
  for (const BuiltTree& built : built_trees()) {
    SCOPED_TRACE(built.name);
    const Bytes bytes = encode_patch_tree(*built.tree);
    const auto decoded = decode_patch_tree(bytes);
    ASSERT_TRUE(decoded) << decoded.error().message;
    EXPECT_EQ(encode_patch_tree(*decoded), bytes);
    const PatchTreeData &a = decoded->data(), &b = built.tree->data();
    expect_same_topology(a.topology, b.topology);
    expect_same_patches(a, b);
    expect_same_bounds(a, b);
    EXPECT_TRUE(a.vertices.positions == b.vertices.positions);
    EXPECT_TRUE(a.vertices.normals == b.vertices.normals);
    EXPECT_TRUE(a.vertices.texcoords == b.vertices.texcoords);
    EXPECT_TRUE(a.vertices.colors == b.vertices.colors);
    EXPECT_EQ(a.vertices.materials.size(), b.vertices.materials.size());
    EXPECT_EQ(a.vertices.images.size(), b.vertices.images.size());
    EXPECT_EQ(decoded->bytes(), built.tree->bytes());
  }
}

TEST(PatchTreeEncoding, EmptyTree) {
  const auto decoded = decode_patch_tree(encode_patch_tree(PatchTree{}));
  ASSERT_TRUE(decoded) << decoded.error().message;
  EXPECT_EQ(decoded->node_count(), 0u);
}

// Patches can be read one by one, in any order, from the bytes of the head and their own.
TEST(PatchTreeEncoding, BlocksStandAlone) {
  const BuiltTree& built = built_tree("blob of patches of 40");
  const Bytes bytes = encode_patch_tree(*built.tree);
  const auto size = patch_tree_head_bytes(std::span(bytes).first(kPatchTreePrefix));
  ASSERT_TRUE(size);
  const auto head = decode_patch_tree_head(std::span(bytes).first(*size));
  ASSERT_TRUE(head) << head.error().message;
  EXPECT_EQ(head->first_byte.front(), *size);
  EXPECT_EQ(head->first_byte.back(), bytes.size());
  EXPECT_TRUE(std::is_sorted(head->first_byte.begin(), head->first_byte.end()));
  const PatchTreeData& data = built.tree->data();
  for (std::uint32_t node = built.tree->node_count(); node-- > 0;) {
    const PatchOffsets &at = data.offsets[node], &end = data.offsets[node + 1];
    std::vector<Vec3> positions(end.vertex - at.vertex);
    std::vector<std::uint16_t> survivors(positions.size());
    std::vector<std::uint16_t> corners(3 * std::size_t{end.triangle - at.triangle});
    std::vector<std::uint8_t> controllers(end.controller - at.controller);
    std::vector<PatchRange> ranges(end.range - at.range);
    PatchArrays to;
    to.positions = positions;
    to.survivors = survivors;
    to.corners = corners;
    to.controllers = controllers;
    to.ranges = ranges;
    const auto first = static_cast<std::ptrdiff_t>(head->first_byte[node]);
    const auto last = static_cast<std::ptrdiff_t>(head->first_byte[node + 1]);
    const Bytes block(bytes.begin() + first, bytes.begin() + last);
    const auto read = decode_patch(*head, node, block, to);
    ASSERT_TRUE(read) << read.error().message;
    EXPECT_TRUE(std::equal(positions.begin(), positions.end(),
                           data.vertices.positions.begin() + at.vertex));
    EXPECT_TRUE(std::equal(survivors.begin(), survivors.end(), data.survivors.begin() + at.vertex));
    EXPECT_TRUE(std::equal(corners.begin(), corners.end(),
                           data.corners.begin() + 3 * std::ptrdiff_t{at.triangle}));
    Bytes damaged = block;
    damaged[block.size() / 2] ^= std::byte{16};
    const auto refused = decode_patch(*head, node, damaged, to);
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().message.rfind("byte " + std::to_string(first) + ":", 0), 0u)
        << refused.error().message;
  }
}

// An error of one line with an offset, or a tree of which any front can be chosen and drawn.
// Returns whether it was a tree.
bool expect_fault_or_tree(const std::string& name, std::span<const std::byte> bytes,
                          Checksums checksums, std::uint64_t seed) {
  auto decoded = decode_patch_tree(bytes, checksums);
  if (!decoded) {
    EXPECT_EQ(decoded.error().kind, ErrorKind::kInvalidInput);
    EXPECT_EQ(decoded.error().message.rfind("byte ", 0), 0u) << decoded.error().message;
    EXPECT_EQ(decoded.error().message.find('\n'), std::string::npos);
    return false;
  }
  const auto tree = std::make_shared<const PatchTree>(std::move(*decoded));
  PatchTreeInstance instance(tree);
  const auto look = [&] {
    const DrawList list = instance.draw_list();
    for (const DrawRange& range : list.ranges) {
      const std::size_t end = range.first_index + std::size_t{range.index_count};
      ASSERT_LE(end, list.indices.size()) << name;
      for (std::size_t i = range.first_index; i < end; ++i)
        ASSERT_LT(list.indices[i], list.positions.size()) << name;
    }
    for (const Fault& fault : validate(instance.extract(), 1))
      EXPECT_NE(fault.severity, Severity::kBroken) << name << ": " << fault.kind;
    EXPECT_TRUE(is_legal(tree->topology(), instance.split_flags())) << name;
  };
  for (const std::uint32_t level : {tree->finest_level(), tree->finest_level() / 2, 0u}) {
    instance.go_to_level(level);
    EXPECT_EQ(instance.triangle_count(), tree->triangle_count(level)) << name;
    look();
  }
  Random random(seed);
  for (int i = 0; i < 4; ++i) {
    RefineCriteria criteria;
    criteria.sphere = Sphere{Vec3(static_cast<float>(random.uniform()), 0.5f, 0.5f), 0.3f};
    AdaptOptions options;
    if (i % 2 == 1) options.max_triangles = random.below(400);
    const FrontStatistics front = instance.adapt(criteria, options);
    EXPECT_TRUE(front.triangles <= options.max_triangles ||
                front.triangles == tree->triangle_count(0))
        << name;
    look();
  }
  return true;
}

std::vector<const BuiltTree*> small_trees_of(std::uint32_t triangles) {
  std::vector<const BuiltTree*> small;
  for (const BuiltTree& built : built_trees())
    if (built.tree->triangle_count(built.tree->finest_level()) <= triangles)
      small.push_back(&built);
  return small;
}

TEST(PatchTreeEncoding, EveryTruncationIsRefused) {
  for (const BuiltTree* built : small_trees_of(40)) {
    const Bytes bytes = encode_patch_tree(*built->tree);
    for (const Checksums checksums : {Checksums::kVerify, Checksums::kTrust}) {
      for (std::size_t size = 0; size < bytes.size(); ++size)
        ASSERT_FALSE(
            expect_fault_or_tree(built->name, std::span(bytes).first(size), checksums, size))
            << built->name << " " << size;
      Bytes longer = bytes;
      longer.push_back(std::byte{0});
      EXPECT_FALSE(expect_fault_or_tree(built->name, longer, checksums, 0));
    }
  }
}

// Every bit counts, but for the size of the head that the checksum of the head does not cover, and
// that is found by what stands there.
TEST(PatchTreeEncoding, EveryBitIsGuarded) {
  for (const BuiltTree* built : small_trees_of(30)) {
    Bytes bytes = encode_patch_tree(*built->tree);
    for (std::size_t bit = 0; bit < 8 * bytes.size(); ++bit) {
      const std::byte mask{static_cast<unsigned char>(1u << (bit % 8))};
      bytes[bit / 8] ^= mask;
      ASSERT_FALSE(expect_fault_or_tree(built->name, bytes, Checksums::kVerify, bit))
          << built->name << ", bit " << bit;
      bytes[bit / 8] ^= mask;
    }
  }
}

TEST(PatchTreeEncoding, DamagedBytesAreRefusedOrHarmless) {
  Random random(5);
  std::uint32_t refused = 0, accepted = 0;
  for (const BuiltTree* built : small_trees_of(700)) {
    const Bytes bytes = encode_patch_tree(*built->tree);
    const auto head = static_cast<std::uint32_t>(load<std::uint64_t>(bytes.data() + 8));
    for (int i = 0; i < 60; ++i) {
      Bytes damaged = bytes;
      const std::uint32_t faults = 1 + random.below(2);
      for (std::uint32_t j = 0; j < faults; ++j) {
        // Half of them in the head, where counts and links are.
        const std::uint32_t size =
            random.below(2) == 0 ? head : static_cast<std::uint32_t>(bytes.size());
        const std::uint32_t at = random.below(size);
        damaged[at] = random.below(2) == 0
                          ? static_cast<std::byte>(random.next())
                          : static_cast<std::byte>(static_cast<std::uint8_t>(bytes[at]) + 1 -
                                                   2 * random.below(2));
      }
      const bool is_tree =
          expect_fault_or_tree(built->name, damaged, Checksums::kTrust, random.next());
      ++(is_tree ? accepted : refused);
    }
  }
  EXPECT_GT(refused, 200u);
  EXPECT_GT(accepted, 200u);
}

// What a reader must refuse, one fault at a time, with checksums that fit.
class BrokenTree : public ::testing::Test {
 protected:
  PatchTreeData data_ = built_tree("blob of patches of 40").tree->data();
  [[nodiscard]] std::string message() const {
    const auto decoded = decode_patch_tree(encode_patch_tree(PatchTree(data_)));
    return decoded ? "" : decoded.error().message.substr(decoded.error().message.find(": ") + 2);
  }
  [[nodiscard]] std::uint32_t last_inner() const {
    return data_.topology.first_of_level[data_.topology.level_count() - 1] - 1;
  }
};

TEST_F(BrokenTree, IsNoneYet) { EXPECT_EQ(message(), ""); }
TEST_F(BrokenTree, Neighbors) {
  PatchTopology& t = data_.topology;
  const std::vector<std::uint32_t> good = t.neighbors;
  const std::uint32_t node = last_inner(), at = t.first_neighbor[node];
  t.neighbors[at] = node;
  EXPECT_EQ(message(), "a patch is its own neighbour");
  t.neighbors = good;
  t.neighbors[at] = 0;
  EXPECT_EQ(message(), "a neighbour is of another level");
  t.neighbors = good;
  t.neighbors[at] = t.neighbors[at + 1];
  EXPECT_EQ(message(), "a neighbour does not know of it");
  // One that is no neighbour of its.
  t.neighbors = good;
  for (std::uint32_t n = t.first_of_level[t.level_count() - 2]; n < node; ++n) {
    const auto known = t.neighbors_of(node);
    if (std::find(known.begin(), known.end(), n) != known.end()) continue;
    t.neighbors[at] = n;
    EXPECT_EQ(message(), "a neighbour does not know of it");
    return;
  }
  FAIL();
}
TEST_F(BrokenTree, NeighborsTwice) {
  PatchTopology& t = data_.topology;
  const std::vector<std::uint32_t> good = t.neighbors, first = t.first_neighbor;
  const std::uint32_t a = last_inner(), b = good[first[a]];
  t.neighbors.clear();
  t.first_neighbor.assign(1, 0);
  for (std::uint32_t node = 0; node < t.node_count(); ++node) {
    t.neighbors.insert(t.neighbors.end(), good.begin() + first[node],
                       good.begin() + first[node + 1]);
    if (node == a || node == b) t.neighbors.push_back(node == a ? b : a);
    t.first_neighbor.push_back(static_cast<std::uint32_t>(t.neighbors.size()));
  }
  EXPECT_EQ(message(), "a patch has a neighbour twice");
}
TEST_F(BrokenTree, Bounds) {
  const PatchBounds good = data_.bounds[1];
  data_.bounds[1].ball.radius = 100;
  EXPECT_EQ(message(), "a ball does not hold those of the children");
  data_.bounds[1] = good;
  data_.bounds[1].error = 100;
  EXPECT_EQ(message(), "an error is less than those of the children");
  data_.bounds[1].error = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(message(), "an error is none");
  data_.bounds[1] = good;
  data_.bounds[1].cone.cosine = 2;
  EXPECT_EQ(message(), "a cone is none");
}
TEST_F(BrokenTree, Vertices) {
  data_.vertices.positions[77].y = std::numeric_limits<float>::infinity();
  EXPECT_EQ(message(), "a vertex is not finite, or is not there");
}
TEST_F(BrokenTree, Survivors) {
  const std::uint32_t leaf = last_inner() + 1;
  const PatchTree tree(data_);
  data_.survivors[data_.offsets[leaf].vertex] =
      static_cast<std::uint16_t>(tree.vertex_count_of(data_.topology.parent[leaf]));
  EXPECT_EQ(message(), "a survivor is no vertex of the parent");
}
TEST_F(BrokenTree, Controllers) {
  data_.controllers.back() = 31;
  EXPECT_EQ(message(), "no neighbour moves a vertex that moves");
}
TEST_F(BrokenTree, Corners) {
  const PatchTree tree(data_);
  data_.corners.back() = static_cast<std::uint16_t>(tree.vertex_count_of(tree.node_count() - 1));
  EXPECT_EQ(message(), "a corner is no vertex of the patch");
}
TEST_F(BrokenTree, Ranges) {
  const PatchRange good = data_.ranges.back();
  data_.ranges.back().material = 1;
  EXPECT_EQ(message(), "a range has no material");
  data_.ranges.back() = good;
  --data_.ranges.back().triangle_count;
  EXPECT_EQ(message(), "the ranges of a patch do not fit");
  data_.ranges.back() = good;
  data_.ranges.back().constant_triangles = good.triangle_count;
  EXPECT_EQ(message(), "a vertex of a constant triangle moves");
}

}  // namespace
}  // namespace varifold::test
