#include <varifold/simplify/surface_builder.h>

#include <varifold/base/parallel.h>
#include <varifold/mesh/weld.h>
#include <varifold/simplify/borrowed_normals.h>
#include <varifold/simplify/classify.h>
#include <varifold/simplify/morton.h>
#include <varifold/simplify/packed_normal.h>
#include <algorithm>
#include <tuple>
#include <utility>

namespace varifold {

namespace {

// Points wider than this would overflow the ring size; the fan around them is left alone.
constexpr std::uint32_t kMaxRing = 60000;
constexpr std::uint32_t kMaxCells = 512;

// Drop link edges that repeat another one: their faces have the same corners in the same order.
// Every corner of such a face drops the same one, the later.
void drop_duplicates(std::vector<LinkEdge>& edges) {
  std::sort(edges.begin(), edges.end(), [](const LinkEdge& a, const LinkEdge& b) {
    return std::tie(a.from, a.to, a.face) < std::tie(b.from, b.to, b.face);
  });
  const auto same = [](const LinkEdge& a, const LinkEdge& b) {
    return a.from == b.from && a.to == b.to;
  };
  edges.erase(std::unique(edges.begin(), edges.end(), same), edges.end());
}

}  // namespace

// Number the position classes along a Morton curve and scale them to a unit box.
void SurfaceBuilder::make_points() {
  WeldMap weld = weld_points(mesh_);
  std::vector<std::uint32_t> first_vertex(weld.class_count, kNone);
  std::vector<Vec3> class_position(weld.class_count);
  Box box;
  std::vector<bool> used(weld.class_count, false);
  for (const std::uint32_t v : mesh_.indices) {
    used[weld.class_of[v]] = true;
    box.add(mesh_.positions[v]);
  }
  for (std::uint32_t v = mesh_.vertex_count(); v-- > 0;) {
    first_vertex[weld.class_of[v]] = v;
    class_position[weld.class_of[v]] = mesh_.positions[v];
  }
  surface_.center = box.empty() ? DVec3(0) : 0.5 * (DVec3(box.lower) + DVec3(box.upper));
  const double diagonal = box.empty() ? 0 : glm::length(DVec3(box.upper) - DVec3(box.lower));
  surface_.scale = diagonal > 0 ? 1 / diagonal : 1;

  std::vector<std::uint32_t> used_classes;
  used_classes.reserve(weld.class_count);
  for (std::uint32_t c = 0; c < weld.class_count; ++c)
    if (used[c]) used_classes.push_back(c);
  const std::vector<std::uint32_t> order = morton_order(class_position, used_classes, box);

  const auto count = static_cast<std::uint32_t>(order.size());
  surface_.points.resize(count);
  surface_.first_vertex_of_point.resize(count);
  std::vector<std::uint32_t>& point_of_class = used_classes;
  point_of_class.assign(weld.class_count, kNone);
  for (std::uint32_t p = 0; p < count; ++p) {
    point_of_class[order[p]] = p;
    surface_.first_vertex_of_point[p] = first_vertex[order[p]];
    surface_.points[p].position =
        Vec3((DVec3(class_position[order[p]]) - surface_.center) * surface_.scale);
  }
  surface_.point_of_vertex = std::move(weld.class_of);
  for (std::uint32_t& p : surface_.point_of_vertex) p = point_of_class[p];
}

void SurfaceBuilder::make_faces() {
  face_points_.resize(mesh_.indices.size());
  degree_.assign(surface_.point_count(), 0);
  for (std::size_t i = 0; i < mesh_.indices.size(); ++i)
    face_points_[i] = surface_.point_of_vertex[mesh_.indices[i]];
  surface_.is_face.assign(mesh_.triangle_count(), false);
  for (std::uint32_t face = 0; face < mesh_.triangle_count(); ++face) {
    if (is_degenerate(face)) {
      ++faults_.degenerate_triangles;
      continue;
    }
    ++surface_.face_count;
    surface_.is_face[face] = true;
    for (int k = 0; k < 3; ++k) ++degree_[face_points_[3 * std::size_t{face} + k]];
  }
}

// Put every face into the rings of its corners, as {next corner, face}, in no order yet.
void SurfaceBuilder::fill_rings() {
  const std::uint32_t count = surface_.point_count();
  surface_.lines.resize(count);
  surface_.pools.resize(std::clamp(count / std::max(1u, options_.points_per_cell), 1u, kMaxCells));
  make_room();
  for (std::uint32_t face = 0; face < mesh_.triangle_count(); ++face)
    if (!is_degenerate(face)) add_to_rings(face);
}

void SurfaceBuilder::make_room() {
  for (std::uint32_t p = 0; p < surface_.point_count(); ++p) {
    if (degree_[p] > kMaxRing) degree_[p] = 0;  // no ring: nothing around it can be changed
    if (degree_[p] <= RingLine::kCapacity) continue;
    const std::uint32_t pool = surface_.pool_of(p);
    surface_.lines[p].entries[0] = {surface_.pools[pool].allocate(degree_[p]), pool};
  }
}

void SurfaceBuilder::add_to_rings(std::uint32_t face) {
  const std::uint32_t* p = &face_points_[3 * std::size_t{face}];
  for (int k = 0; k < 3; ++k) {
    const std::uint32_t point = p[k];
    if (degree_[point] == 0) continue;
    RingEntry* entries = surface_.lines[point].entries;
    if (degree_[point] > RingLine::kCapacity)
      entries = surface_.pools[entries[0].face].at(entries[0].neighbor);
    entries[surface_.points[point].ring_size++] = {p[k == 2 ? 0 : k + 1], face};
  }
}

// A face that no ring mentions any more was a repetition.
void SurfaceBuilder::count_faces() {
  std::vector<bool> mentioned(mesh_.triangle_count(), false);
  for (std::uint32_t p = 0; p < surface_.point_count(); ++p)
    for (const RingEntry& entry : surface_.ring_span(p))
      if (entry.face != kNone) mentioned[entry.face] = true;
  for (std::uint32_t face = 0; face < mesh_.triangle_count(); ++face) {
    if (!surface_.is_face[face] || mentioned[face]) continue;
    surface_.is_face[face] = false;
    ++faults_.duplicate_triangles;
    --surface_.face_count;
  }
}

void SurfaceBuilder::order_one(std::uint32_t point, std::vector<LinkEdge>& edges,
                               std::vector<RingEntry>& ring) {
  RingEntry* entries = surface_.lines[point].entries;
  if (degree_[point] > RingLine::kCapacity)
    entries = surface_.pools[entries[0].face].at(entries[0].neighbor);
  const std::uint32_t size = surface_.points[point].ring_size;
  edges.clear();
  for (std::uint32_t i = 0; i < size; ++i) {
    const std::uint32_t* p = &face_points_[3 * std::size_t{entries[i].face}];
    const int at = p[0] == point ? 0 : p[1] == point ? 1 : 2;
    edges.push_back({entries[i].neighbor, p[at == 0 ? 2 : at - 1], entries[i].face});
  }

  // The common case, one closed ring, in place: swap each successor into its seat.
  bool closed = size >= 3 && size <= 32;
  for (std::uint32_t i = 0; closed && i + 1 < size; ++i) {
    std::uint32_t j = i + 1;
    while (j < size && edges[j].from != edges[i].to) ++j;
    closed = j < size;
    if (closed) std::swap(edges[i + 1], edges[j]);
  }
  closed = closed && edges[size - 1].to == edges[0].from;
  for (std::uint32_t i = 0; closed && i + 1 < size; ++i)
    for (std::uint32_t j = i + 1; j < size; ++j) closed = closed && edges[i].from != edges[j].from;
  if (closed) {
    for (std::uint32_t i = 0; i < size; ++i) entries[i] = {edges[i].from, edges[i].face};
    return;
  }

  drop_duplicates(edges);
  if (edges.size() != size) any_dropped_ = true;
  order_ring(edges, ring);
  // set_ring frees by the present size, which is that of the unordered ring.
  surface_.set_ring(point, ring);
}

void SurfaceBuilder::order_rings(std::uint32_t begin, std::uint32_t end, bool with_normals) {
  std::vector<LinkEdge> edges;
  std::vector<RingEntry> ring;
  for (std::uint32_t p = begin; p < end; ++p) {
    order_one(p, edges, ring);
    if (with_normals) set_normal(p);
  }
}

// The mean of the normals of the faces around, by area.
void SurfaceBuilder::set_normal(std::uint32_t point) {
  PointState& state = surface_.points[point];
  const auto ring = surface_.ring_span(point);
  Vec3 sum(0);
  for (std::size_t i = 0; i < ring.size(); ++i) {
    if (ring[i].face == kNone) continue;
    const std::uint32_t next = ring[i + 1 == ring.size() ? 0 : i + 1].neighbor;
    sum += glm::cross(surface_.points[ring[i].neighbor].position - state.position,
                      surface_.points[next].position - state.position);
  }
  state.normal = pack_normal(sum);
}

SurfaceBuilder::SurfaceBuilder(const TriangleMesh& mesh, const SurfaceOptions& options)
    : SurfaceBuilder(mesh, options, {}) {
  make_points();
  make_faces();
}

void SurfaceBuilder::make_rings() {
  fill_rings();
  parallel_for(options_.threads, surface_.point_count(), surface_.points_per_pool(),
               [&](std::size_t begin, std::size_t end) {
                 order_rings(static_cast<std::uint32_t>(begin), static_cast<std::uint32_t>(end),
                             true);
               });
  borrow_normals(surface_,
                 [&](std::uint32_t p) -> std::uint32_t& { return surface_.points[p].normal; });
  face_points_ = {};
  degree_ = {};
}

WorkingSurface SurfaceBuilder::finish(InputFaults& faults) {
  if (any_dropped_) count_faces();
  if (options_.with_wedges) surface_.wedge = make_wedges(mesh_, surface_);
  classify_points(surface_, options_.threads);
  faults = faults_;
  return std::move(surface_);
}

WorkingSurface build_surface(const TriangleMesh& mesh, const SurfaceOptions& options,
                             InputFaults& faults) {
  SurfaceBuilder builder(mesh, options);
  builder.make_rings();
  return builder.finish(faults);
}

void rebuild_rings(WorkingSurface& surface, std::span<const std::uint32_t> faces,
                   std::span<const std::uint32_t> corners) {
  const TriangleMesh no_mesh;
  SurfaceBuilder builder(no_mesh, {}, std::move(surface));
  WorkingSurface& rebuilt = builder.surface_;
  builder.face_points_.assign(3 * rebuilt.is_face.size(), 0);
  builder.degree_.assign(rebuilt.point_count(), 0);
  for (RingPool& pool : rebuilt.pools) pool = RingPool();
  for (PointState& point : rebuilt.points) point.ring_size = 0;
  for (PointState& point : rebuilt.points) point.flags |= PointState::kDead;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    rebuilt.points[corners[i]].flags = 0;
    builder.face_points_[3 * std::size_t{faces[i / 3]} + i % 3] = corners[i];
    ++builder.degree_[corners[i]];
  }
  builder.make_room();
  for (const std::uint32_t face : faces) builder.add_to_rings(face);
  builder.order_rings(0, rebuilt.point_count(), false);
  rebuilt.face_count = static_cast<std::uint32_t>(faces.size());
  surface = std::move(rebuilt);
}

}  // namespace varifold
