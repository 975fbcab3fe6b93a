#include <varifold/base/disjoint_sets.h>
#include <varifold/base/parallel.h>
#include <varifold/mesh/topology_scan.h>
#include <algorithm>

namespace varifold::detail {

namespace {

/// Looks at the star of one position class after the other.
class StarScanner {
 public:
  StarScanner(const TriangleMesh& mesh, const WeldMap& weld, const VertexFaces& faces,
              TopologyScan& scan)
      : mesh_(mesh), weld_(weld), faces_(faces), scan_(scan) {}

  void scan_class(std::uint32_t c) {
    gather(c);
    count_duplicates();
    if (spokes_.empty()) return;
    ++scan_.used_classes;
    bool is_manifold = walk_edges(c);
    const std::uint32_t root = fans_.find(spoke_triangle(spokes_[0]));
    for (const std::uint64_t spoke : spokes_)
      is_manifold = is_manifold && fans_.find(spoke_triangle(spoke)) == root;
    if (!is_manifold) scan_.nonmanifold_vertices.add(c);
    join_boundary();
  }

 private:
  // A spoke is one end of a triangle's edge at the class: the class at the far end in the upper
  // half, then the place of the triangle in the star, then whether the edge leaves the class.
  static std::uint64_t make_spoke(std::uint32_t far, std::uint32_t i, bool leaves) {
    return (std::uint64_t{far} << 32) | (std::uint64_t{i} << 1) | (leaves ? 1 : 0);
  }
  static std::uint32_t spoke_far(std::uint64_t spoke) {
    return static_cast<std::uint32_t>(spoke >> 32);
  }
  static std::uint32_t spoke_triangle(std::uint64_t spoke) {
    return static_cast<std::uint32_t>(spoke) >> 1;
  }
  static bool spoke_leaves(std::uint64_t spoke) { return (spoke & 1) != 0; }

  struct Opposite {
    std::uint64_t edge;
    std::uint32_t triangle;
    bool operator<(const Opposite& other) const {
      return edge != other.edge ? edge < other.edge : triangle < other.triangle;
    }
  };

  /// Lists the spokes and, of triangles that count here, the opposite edges.
  void gather(std::uint32_t c) {
    spokes_.clear();
    opposites_.clear();
    first_corner_.clear();
    for (const std::uint32_t t : faces_.triangles_of(c)) {
      const std::uint32_t* index = &mesh_.indices[3 * std::size_t{t}];
      const std::uint32_t of[3] = {weld_.class_of[index[0]], weld_.class_of[index[1]],
                                   weld_.class_of[index[2]]};
      const std::uint32_t k = of[0] == c ? 0 : of[1] == c ? 1 : 2;
      const std::uint32_t next = of[(k + 1) % 3], previous = of[(k + 2) % 3];
      if (next == previous || next == c || previous == c) {
        if (c <= next && c <= previous) scan_.degenerate_triangles.add(t);
        continue;
      }
      const auto i = static_cast<std::uint32_t>(first_corner_.size());
      spokes_.push_back(make_spoke(next, i, true));
      spokes_.push_back(make_spoke(previous, i, false));
      first_corner_.push_back(3 * t + k);
      if (c < next && c < previous) opposites_.push_back({edge_place(next, previous), t});
    }
    std::sort(spokes_.begin(), spokes_.end());
    fans_.reset(first_corner_.size());
  }

  void count_duplicates() {
    if (opposites_.size() < 2) return;
    std::sort(opposites_.begin(), opposites_.end());
    for (std::size_t i = 1; i < opposites_.size(); ++i)
      if (opposites_[i].edge == opposites_[i - 1].edge)
        scan_.duplicate_triangles.add(opposites_[i].triangle);
  }

  /// Counts the edges that belong here and joins triangles across those with two; returns whether
  /// no edge has more. Boundary spokes are kept in boundary_.
  bool walk_edges(std::uint32_t c) {
    bool is_manifold = true;
    boundary_.clear();
    for (std::size_t begin = 0, end = 0; begin < spokes_.size(); begin = end) {
      const std::uint32_t far = spoke_far(spokes_[begin]);
      while (end < spokes_.size() && spoke_far(spokes_[end]) == far) ++end;
      const std::size_t count = end - begin;
      if (count == 1) boundary_.push_back(spokes_[begin]);
      if (count == 2)
        fans_.unite(spoke_triangle(spokes_[begin]), spoke_triangle(spokes_[begin + 1]));
      if (count > 2) is_manifold = false;
      if (far > c) count_edge(edge_place(c, far), begin, count);
    }
    return is_manifold;
  }

  void count_edge(std::uint64_t place, std::size_t begin, std::size_t count) {
    ++scan_.edges;
    scan_.odd_edges += count % 2;
    if (count == 1) {
      scan_.boundary_edges.add(place);
      scan_.boundary_ids.push_back(boundary_id(spokes_[begin]));
    } else if (count > 2) {
      scan_.nonmanifold_edges.add(place);
    } else if (spoke_leaves(spokes_[begin]) == spoke_leaves(spokes_[begin + 1])) {
      scan_.misoriented_edges.add(place);
    }
  }

  /// Joins the boundary spokes at both ends of each fan of triangles.
  void join_boundary() {
    if (boundary_.size() < 2) return;
    const auto fan = [&](std::uint64_t spoke) { return fans_.find(spoke_triangle(spoke)); };
    std::sort(boundary_.begin(), boundary_.end(), [&](std::uint64_t a, std::uint64_t b) {
      return std::pair(fan(a), a) < std::pair(fan(b), b);
    });
    for (std::size_t i = 1; i < boundary_.size(); ++i)
      if (fan(boundary_[i]) == fan(boundary_[i - 1]))
        scan_.boundary_joints.push_back({boundary_id(boundary_[i - 1]), boundary_id(boundary_[i])});
  }

  /// The corner of the triangle at which the edge of a spoke starts.
  [[nodiscard]] std::uint32_t boundary_id(std::uint64_t spoke) const {
    const std::uint32_t corner = first_corner_[spoke_triangle(spoke)];
    if (spoke_leaves(spoke)) return corner;
    return corner % 3 == 0 ? corner + 2 : corner - 1;
  }

  const TriangleMesh& mesh_;
  const WeldMap& weld_;
  const VertexFaces& faces_;
  TopologyScan& scan_;
  std::vector<std::uint64_t> spokes_;
  std::vector<std::uint64_t> boundary_;
  std::vector<Opposite> opposites_;
  std::vector<std::uint32_t> first_corner_;  // of each triangle: 3 * triangle + corner at the class
  DisjointSets fans_;                        // over the triangles of the star
};

}  // namespace

void TopologyScan::append(const TopologyScan& later) {
  degenerate_triangles.append(later.degenerate_triangles);
  duplicate_triangles.append(later.duplicate_triangles);
  boundary_edges.append(later.boundary_edges);
  nonmanifold_edges.append(later.nonmanifold_edges);
  misoriented_edges.append(later.misoriented_edges);
  nonmanifold_vertices.append(later.nonmanifold_vertices);
  edges += later.edges;
  odd_edges += later.odd_edges;
  used_classes += later.used_classes;
  boundary_ids.insert(boundary_ids.end(), later.boundary_ids.begin(), later.boundary_ids.end());
  boundary_joints.insert(boundary_joints.end(), later.boundary_joints.begin(),
                         later.boundary_joints.end());
}

TopologyScan scan_topology(const TriangleMesh& mesh, const WeldMap& weld, int threads) {
  constexpr std::size_t kGrain = 1 << 14;
  const VertexFaces faces(mesh.indices, weld);
  std::vector<TopologyScan> pieces((weld.class_count + kGrain - 1) / kGrain);
  parallel_for(threads, weld.class_count, kGrain, [&](std::size_t begin, std::size_t end) {
    StarScanner scanner(mesh, weld, faces, pieces[begin / kGrain]);
    for (std::size_t c = begin; c < end; ++c) scanner.scan_class(static_cast<std::uint32_t>(c));
  });
  TopologyScan scan;
  for (const TopologyScan& piece : pieces) scan.append(piece);
  return scan;
}

}  // namespace varifold::detail
