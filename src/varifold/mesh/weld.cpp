#include <varifold/base/disjoint_sets.h>
#include <varifold/mesh/weld.h>
#include <algorithm>
#include <bit>
#include <cmath>

namespace varifold {

namespace {

std::uint64_t mix(std::uint64_t a, std::uint64_t b) {
  std::uint64_t h = a * 0x9e3779b97f4a7c15u;
  h = (h ^ (h >> 32)) + b;
  h *= 0xd6e8feb86659fd93u;
  h = (h ^ (h >> 32)) * 0xd6e8feb86659fd93u;
  return h ^ (h >> 32);
}

/// The bits of a position, with one pattern for both zeros.
struct PositionBits {
  std::uint64_t xy;
  std::uint32_t z;

  explicit PositionBits(const Vec3& p) {
    const auto bits = [](float x) { return std::bit_cast<std::uint32_t>(x == 0.0f ? 0.0f : x); };
    xy = bits(p.x) | (static_cast<std::uint64_t>(bits(p.y)) << 32);
    z = bits(p.z);
  }
  bool operator==(const PositionBits&) const = default;
  [[nodiscard]] std::uint64_t hash() const { return mix(xy, z); }
};

/// Open addressing wants at most half of its slots in use.
std::size_t table_size(std::size_t count) {
  return std::bit_ceil(std::max<std::size_t>(2 * count, 16));
}

/// A cell of the grid. Coordinates are kept as whole doubles: where they exceed 2^53 the spacing
/// of floats is far above the cell size, so that only equal positions can be near each other.
struct Cell {
  double x, y, z;
  bool operator==(const Cell&) const = default;
  [[nodiscard]] std::uint64_t hash() const {
    // Adding zero turns -0 into 0.
    return mix(mix(std::bit_cast<std::uint64_t>(x + 0.0), std::bit_cast<std::uint64_t>(y + 0.0)),
               std::bit_cast<std::uint64_t>(z + 0.0));
  }
};

/// A hash table from cells to the points in them, as linked lists.
class Grid {
 public:
  explicit Grid(std::uint32_t count)
      : heads_(table_size(count), kNone), cell_of_(count), next_(count, kNone) {}

  [[nodiscard]] std::uint32_t first(const Cell& cell) const { return heads_[slot(cell)]; }
  [[nodiscard]] std::uint32_t next(std::uint32_t point) const { return next_[point]; }

  void insert(std::uint32_t point, const Cell& cell) {
    std::uint32_t& head = heads_[slot(cell)];
    cell_of_[point] = cell;
    next_[point] = head;
    head = point;
  }

 private:
  [[nodiscard]] std::size_t slot(const Cell& cell) const {
    const std::size_t mask = heads_.size() - 1;
    std::size_t i = cell.hash() & mask;
    while (heads_[i] != kNone && !(cell_of_[heads_[i]] == cell)) i = (i + 1) & mask;
    return i;
  }

  std::vector<std::uint32_t> heads_;
  std::vector<Cell> cell_of_;
  std::vector<std::uint32_t> next_;
};

bool is_finite(const Vec3& p) {
  return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z);
}

/// Joins `point` with the points of the 27 cells around it that were inserted before it.
void unite_with_near(const std::vector<Vec3>& points, std::uint32_t point, double tolerance,
                     Grid& grid, DisjointSets& sets) {
  const DVec3 p(points[point]);
  const Cell home{std::floor(p.x / tolerance), std::floor(p.y / tolerance),
                  std::floor(p.z / tolerance)};
  for (int dz = -1; dz <= 1; ++dz)
    for (int dy = -1; dy <= 1; ++dy)
      for (int dx = -1; dx <= 1; ++dx) {
        const Cell cell{home.x + dx, home.y + dy, home.z + dz};
        for (std::uint32_t q = grid.first(cell); q != kNone; q = grid.next(q)) {
          const DVec3 d = DVec3(points[q]) - p;
          if (glm::dot(d, d) <= tolerance * tolerance) sets.unite(q, point);
        }
      }
  grid.insert(point, home);
}

}  // namespace

WeldMap weld_exact(std::span<const Vec3> positions) {
  const std::size_t count = positions.size();
  const std::size_t mask = table_size(count) - 1;
  std::vector<std::uint32_t> first_vertex(mask + 1, kNone);
  WeldMap weld;
  weld.class_of.resize(count);

  // Every look-up is a cache miss: hash a block ahead and prefetch its slots.
  constexpr std::size_t kBlock = 32;
  std::size_t slots[kBlock];
  for (std::size_t begin = 0; begin < count; begin += kBlock) {
    const std::size_t size = std::min(kBlock, count - begin);
    for (std::size_t i = 0; i < size; ++i) {
      slots[i] = PositionBits(positions[begin + i]).hash() & mask;
      __builtin_prefetch(&first_vertex[slots[i]], 1);
    }
    for (std::size_t i = 0; i < size; ++i) {
      const std::size_t v = begin + i;
      const PositionBits bits(positions[v]);
      std::size_t slot = slots[i];
      while (first_vertex[slot] != kNone && !(PositionBits(positions[first_vertex[slot]]) == bits))
        slot = (slot + 1) & mask;
      if (first_vertex[slot] == kNone) {
        first_vertex[slot] = static_cast<std::uint32_t>(v);
        weld.class_of[v] = weld.class_count++;
      } else {
        weld.class_of[v] = weld.class_of[first_vertex[slot]];
      }
    }
  }
  return weld;
}

WeldMap welded_by_both(const WeldMap& a, const WeldMap& b) {
  const std::size_t count = a.class_of.size();
  const std::size_t mask = table_size(count) - 1;
  std::vector<std::uint32_t> first_vertex(mask + 1, kNone);
  WeldMap weld;
  weld.class_of.resize(count);
  for (std::uint32_t v = 0; v < count; ++v) {
    std::size_t slot = mix(a.class_of[v], b.class_of[v]) & mask;
    const auto differs = [&](std::uint32_t other) {
      return a.class_of[other] != a.class_of[v] || b.class_of[other] != b.class_of[v];
    };
    while (first_vertex[slot] != kNone && differs(first_vertex[slot])) slot = (slot + 1) & mask;
    if (first_vertex[slot] == kNone) {
      first_vertex[slot] = v;
      weld.class_of[v] = weld.class_count++;
    } else {
      weld.class_of[v] = weld.class_of[first_vertex[slot]];
    }
  }
  return weld;
}

namespace {

// Joints and weights as places, so that those who follow the same joints are welded.
WeldMap weld_skin(const std::vector<JointWeights>& skin) {
  std::vector<Vec3> parts(skin.size());
  const auto part = [&](const auto& place_of) {
    for (std::size_t v = 0; v < skin.size(); ++v) parts[v] = place_of(skin[v]);
    return weld_exact(parts);
  };
  const auto joints = part([](const JointWeights& s) {
    return Vec3(s.joints[0] + 65536.0f * (s.joints[1] % 256),
                s.joints[1] / 256 + 256.0f * s.joints[2], s.joints[3]);
  });
  const auto first =
      part([](const JointWeights& s) { return Vec3(s.weights[0], s.weights[1], s.weights[2]); });
  const auto last = part([](const JointWeights& s) { return Vec3(s.weights[3], 0, 0); });
  return welded_by_both(welded_by_both(joints, first), last);
}

}  // namespace

WeldMap weld_points(const TriangleMesh& mesh) {
  WeldMap weld = weld_exact(mesh.positions);
  for (const Pose& pose : mesh.poses) weld = welded_by_both(weld, weld_exact(pose.positions));
  if (mesh.has_skin()) weld = welded_by_both(weld, weld_skin(mesh.skin));
  return weld;
}

WeldMap weld_within(std::span<const Vec3> positions, float tolerance) {
  WeldMap weld = weld_exact(positions);
  if (!(tolerance > 0)) return weld;

  // One point per exact class: many vertices at one place cost no more than one.
  std::vector<Vec3> points(weld.class_count);
  for (std::size_t v = positions.size(); v-- > 0;) points[weld.class_of[v]] = positions[v];

  DisjointSets sets(weld.class_count);
  Grid grid(weld.class_count);
  for (std::uint32_t point = 0; point < weld.class_count; ++point)
    if (is_finite(points[point])) unite_with_near(points, point, tolerance, grid, sets);

  // Number the sets by their first member; a root precedes its members.
  std::vector<std::uint32_t> number(weld.class_count);
  std::uint32_t count = 0;
  for (std::uint32_t c = 0; c < weld.class_count; ++c) {
    const std::uint32_t root = sets.find(c);
    number[c] = root == c ? count++ : number[root];
  }
  for (std::uint32_t& c : weld.class_of) c = number[c];
  weld.class_count = count;
  return weld;
}

}  // namespace varifold
