// The surface while it is simplified: one record and one ring per position class ("point").
//
// Points are position classes in Morton order, scaled to a unit box about the mesh's centre, so
// that neighbours share pages and costs share a range. Wedges (the vertices of the input) exist
// beside them where the mesh has seams or attributes: corners name wedges, rings name points.
#pragma once

#include <varifold/base/large_vector.h>
#include <varifold/base/math.h>
#include <varifold/mesh/triangle_mesh.h>
#include <varifold/simplify/rings.h>
#include <varifold/simplify/vertex_kind.h>
#include <varifold/simplify/wedge_tables.h>
#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

namespace varifold {

/// State of a point; half a cache line.
struct alignas(32) PointState {
  Vec3 position{0};
  float error = 0;               ///< estimate of how far the surface around has moved
  std::uint32_t target = kNone;  ///< the best collapse found last
  float step = 0;                ///< estimate of the distance that it would move the surface
  std::uint32_t normal = 0;      ///< of the input around the point (packed_normal.h)
  std::uint16_t ring_size = 0;
  VertexKind kind = VertexKind::kManifold;
  std::uint8_t flags = 0;

  static constexpr std::uint8_t kDead = 1;       ///< collapsed
  static constexpr std::uint8_t kDirty = 2;      ///< `target` must be found anew
  static constexpr std::uint8_t kBlocked = 4;    ///< no legal collapse; waits for a change nearby
  static constexpr std::uint8_t kIrregular = 8;  ///< several fans: its ring is edited the slow way
};
static_assert(sizeof(PointState) == 32);

/// Room for the ring of most points; longer ones leave {offset, pool} in the first entry.
struct alignas(64) RingLine {
  static constexpr std::uint32_t kCapacity = 8;
  RingEntry entries[kCapacity];
};

struct SurfaceOptions {
  bool with_wedges = false;  ///< attributes and materials matter: make the wedge tables
  int threads = 0;           ///< 0 = all
  /// Points in a cell (collapse_rounds.h), and so in a ring pool.
  std::uint32_t points_per_cell = 16384;
};

class WorkingSurface {
 public:
  LargeVector<PointState> points;
  LargeVector<RingLine> lines;
  std::vector<RingPool> pools;
  WedgeTables wedge;
  std::vector<std::uint32_t> point_of_vertex;        ///< kNone for unused vertices
  std::vector<std::uint32_t> first_vertex_of_point;  ///< the first vertex of the input there
  std::vector<bool> is_face;                         ///< per triangle of the input
  /// Per triangle of the input; empty where the surface is not divided. Edges between faces of
  /// different regions are features.
  std::vector<std::uint32_t> region_of;
  /// Per triangle of the input, packed; empty where nothing is asked. Faces must not turn away from
  /// them by more than LegalityOptions allow.
  std::vector<std::uint32_t> reference_normal;
  std::uint32_t face_count = 0;  ///< live faces
  DVec3 center{0};
  double scale = 1;  ///< points are (position - center) * scale

  [[nodiscard]] std::uint32_t point_count() const {
    return static_cast<std::uint32_t>(points.size());
  }
  [[nodiscard]] RingEntry* ring(std::uint32_t point) {
    RingLine& line = lines[point];
    if (points[point].ring_size <= RingLine::kCapacity) return line.entries;
    return pools[line.entries[0].face].at(line.entries[0].neighbor);
  }
  [[nodiscard]] const RingEntry* ring(std::uint32_t point) const {
    return const_cast<WorkingSurface*>(this)->ring(point);
  }
  [[nodiscard]] std::span<RingEntry> ring_span(std::uint32_t point) {
    return {ring(point), points[point].ring_size};
  }
  [[nodiscard]] std::uint32_t points_per_pool() const {
    const auto count = static_cast<std::uint32_t>(std::max<std::size_t>(1, pools.size()));
    return std::max(1u, (point_count() + count - 1) / count);
  }
  [[nodiscard]] std::uint32_t pool_of(std::uint32_t point) const {
    return point / points_per_pool();
  }
  /// Replaces a ring; `entries` must not lie in the storage of rings. Long ones go to the pool
  /// of the point's cell.
  void set_ring(std::uint32_t point, std::span<const RingEntry> entries);
  void release_ring(std::uint32_t point);

  [[nodiscard]] std::size_t bytes() const;
  /// Points that have not collapsed. O(n).
  [[nodiscard]] std::uint32_t live_points() const;
};

/// What the simplifier had to leave out of the input.
struct InputFaults {
  std::uint32_t degenerate_triangles = 0;  ///< two corners at one position
  std::uint32_t duplicate_triangles = 0;   ///< the same corners in the same order again
};

/// Builds points, rings and kinds. Triangles that are degenerate on position
/// classes, and exact repetitions, get no face. O(n log n) for the Morton sort, else linear.
[[nodiscard]] WorkingSurface build_surface(const TriangleMesh& mesh, const SurfaceOptions& options,
                                           InputFaults& faults);

/// Puts the surface back to other faces: `faces` are numbers of triangles, `corners` three points
/// for each. Points that they use live again; wedges are left as they are. O(points + faces).
void rebuild_rings(WorkingSurface& surface, std::span<const std::uint32_t> faces,
                   std::span<const std::uint32_t> corners);

}  // namespace varifold
