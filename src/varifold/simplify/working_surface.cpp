#include <varifold/base/parallel.h>
#include <varifold/simplify/working_surface.h>

#include <varifold/mesh/weld.h>
#include <varifold/simplify/classify.h>
#include <varifold/simplify/morton.h>
#include <varifold/simplify/packed_normal.h>
#include <algorithm>
#include <atomic>
#include <cstring>
#include <tuple>

namespace varifold {

void WorkingSurface::release_ring(std::uint32_t point) {
  PointState& state = points[point];
  if (state.ring_size > RingLine::kCapacity) {
    const RingEntry address = lines[point].entries[0];
    pools[address.face].release(address.neighbor, state.ring_size);
  }
  state.ring_size = 0;
}

void WorkingSurface::set_ring(std::uint32_t point, std::span<const RingEntry> entries) {
  release_ring(point);
  RingEntry* destination = lines[point].entries;
  const auto size = static_cast<std::uint32_t>(entries.size());
  if (size > RingLine::kCapacity) {
    const std::uint32_t pool = pool_of(point);
    const std::uint32_t offset = pools[pool].allocate(size);
    lines[point].entries[0] = {offset, pool};
    destination = pools[pool].at(offset);
  }
  if (size > 0) std::memcpy(destination, entries.data(), size * sizeof(RingEntry));
  points[point].ring_size = static_cast<std::uint16_t>(size);
}

std::uint32_t WorkingSurface::live_points() const {
  return static_cast<std::uint32_t>(std::count_if(
      points.begin(), points.end(), [](const auto& p) { return !(p.flags & PointState::kDead); }));
}

std::size_t WorkingSurface::bytes() const {
  std::size_t sum =
      points.capacity() * sizeof(PointState) + lines.capacity() * sizeof(RingLine) +
      (point_of_vertex.capacity() + first_vertex_of_point.capacity()) * sizeof(std::uint32_t) +
      is_face.capacity() / 8;
  for (const RingPool& pool : pools) sum += pool.bytes();
  sum += wedge.bytes();
  return sum;
}

namespace {

// Points wider than this would overflow the ring size; the fan around them is left alone.
constexpr std::uint32_t kMaxRing = 60000;
constexpr std::uint32_t kMaxCells = 512;

struct Builder {
  const TriangleMesh& mesh;
  const SurfaceOptions& options;
  WorkingSurface surface;
  InputFaults faults;
  std::vector<std::uint32_t> face_points;  // three per input triangle
  std::vector<std::uint32_t> degree;
  std::atomic<bool> any_dropped{false};

  [[nodiscard]] bool is_degenerate(std::uint32_t face) const {
    const std::uint32_t* p = &face_points[3 * std::size_t{face}];
    return p[0] == p[1] || p[1] == p[2] || p[2] == p[0];
  }

  void make_points();
  void make_faces();
  void fill_rings();
  void make_room();
  void add_to_rings(std::uint32_t face);
  void order_rings(std::uint32_t begin, std::uint32_t end, bool with_normals);
  void set_normal(std::uint32_t point);
  void order_one(std::uint32_t point, std::vector<LinkEdge>& edges, std::vector<RingEntry>& ring);
  static void drop_duplicates(std::vector<LinkEdge>& edges);
  void count_faces();
};

// Number the position classes along a Morton curve and scale them to a unit box.
void Builder::make_points() {
  WeldMap weld = weld_exact(mesh.positions);
  std::vector<std::uint32_t> first_vertex(weld.class_count, kNone);
  std::vector<Vec3> class_position(weld.class_count);
  Box box;
  std::vector<bool> used(weld.class_count, false);
  for (const std::uint32_t v : mesh.indices) {
    used[weld.class_of[v]] = true;
    box.add(mesh.positions[v]);
  }
  for (std::uint32_t v = mesh.vertex_count(); v-- > 0;) {
    first_vertex[weld.class_of[v]] = v;
    class_position[weld.class_of[v]] = mesh.positions[v];
  }
  surface.center = box.empty() ? DVec3(0) : 0.5 * (DVec3(box.lower) + DVec3(box.upper));
  const double diagonal = box.empty() ? 0 : glm::length(DVec3(box.upper) - DVec3(box.lower));
  surface.scale = diagonal > 0 ? 1 / diagonal : 1;

  std::vector<std::uint32_t> used_classes;
  used_classes.reserve(weld.class_count);
  for (std::uint32_t c = 0; c < weld.class_count; ++c)
    if (used[c]) used_classes.push_back(c);
  const std::vector<std::uint32_t> order = morton_order(class_position, used_classes, box);

  const auto count = static_cast<std::uint32_t>(order.size());
  surface.points.resize(count);
  surface.first_vertex_of_point.resize(count);
  std::vector<std::uint32_t>& point_of_class = used_classes;
  point_of_class.assign(weld.class_count, kNone);
  for (std::uint32_t p = 0; p < count; ++p) {
    point_of_class[order[p]] = p;
    surface.first_vertex_of_point[p] = first_vertex[order[p]];
    surface.points[p].position =
        Vec3((DVec3(class_position[order[p]]) - surface.center) * surface.scale);
  }
  surface.point_of_vertex = std::move(weld.class_of);
  for (std::uint32_t& p : surface.point_of_vertex) p = point_of_class[p];
}

void Builder::make_faces() {
  face_points.resize(mesh.indices.size());
  degree.assign(surface.point_count(), 0);
  for (std::size_t i = 0; i < mesh.indices.size(); ++i)
    face_points[i] = surface.point_of_vertex[mesh.indices[i]];
  surface.is_face.assign(mesh.triangle_count(), false);
  for (std::uint32_t face = 0; face < mesh.triangle_count(); ++face) {
    if (is_degenerate(face)) {
      ++faults.degenerate_triangles;
      continue;
    }
    ++surface.face_count;
    surface.is_face[face] = true;
    for (int k = 0; k < 3; ++k) ++degree[face_points[3 * std::size_t{face} + k]];
  }
}

// Put every face into the rings of its corners, as {next corner, face}, in no order yet.
void Builder::fill_rings() {
  const std::uint32_t count = surface.point_count();
  surface.lines.resize(count);
  surface.pools.resize(std::clamp(count / std::max(1u, options.points_per_cell), 1u, kMaxCells));
  make_room();
  for (std::uint32_t face = 0; face < mesh.triangle_count(); ++face)
    if (!is_degenerate(face)) add_to_rings(face);
}

void Builder::make_room() {
  for (std::uint32_t p = 0; p < surface.point_count(); ++p) {
    if (degree[p] > kMaxRing) degree[p] = 0;  // no ring: nothing around it can be changed
    if (degree[p] <= RingLine::kCapacity) continue;
    const std::uint32_t pool = surface.pool_of(p);
    surface.lines[p].entries[0] = {surface.pools[pool].allocate(degree[p]), pool};
  }
}

void Builder::add_to_rings(std::uint32_t face) {
  const std::uint32_t* p = &face_points[3 * std::size_t{face}];
  for (int k = 0; k < 3; ++k) {
    const std::uint32_t point = p[k];
    if (degree[point] == 0) continue;
    RingEntry* entries = surface.lines[point].entries;
    if (degree[point] > RingLine::kCapacity)
      entries = surface.pools[entries[0].face].at(entries[0].neighbor);
    entries[surface.points[point].ring_size++] = {p[k == 2 ? 0 : k + 1], face};
  }
}

// Drop link edges that repeat another one: their faces have the same corners in the same order.
// Every corner of such a face drops the same one, the later.
void Builder::drop_duplicates(std::vector<LinkEdge>& edges) {
  std::sort(edges.begin(), edges.end(), [](const LinkEdge& a, const LinkEdge& b) {
    return std::tie(a.from, a.to, a.face) < std::tie(b.from, b.to, b.face);
  });
  const auto same = [](const LinkEdge& a, const LinkEdge& b) {
    return a.from == b.from && a.to == b.to;
  };
  edges.erase(std::unique(edges.begin(), edges.end(), same), edges.end());
}

// A face that no ring mentions any more was a repetition.
void Builder::count_faces() {
  std::vector<bool> mentioned(mesh.triangle_count(), false);
  for (std::uint32_t p = 0; p < surface.point_count(); ++p)
    for (const RingEntry& entry : surface.ring_span(p))
      if (entry.face != kNone) mentioned[entry.face] = true;
  for (std::uint32_t face = 0; face < mesh.triangle_count(); ++face) {
    if (!surface.is_face[face] || mentioned[face]) continue;
    surface.is_face[face] = false;
    ++faults.duplicate_triangles;
    --surface.face_count;
  }
}

void Builder::order_one(std::uint32_t point, std::vector<LinkEdge>& edges,
                        std::vector<RingEntry>& ring) {
  RingEntry* entries = surface.lines[point].entries;
  if (degree[point] > RingLine::kCapacity)
    entries = surface.pools[entries[0].face].at(entries[0].neighbor);
  const std::uint32_t size = surface.points[point].ring_size;
  edges.clear();
  for (std::uint32_t i = 0; i < size; ++i) {
    const std::uint32_t* p = &face_points[3 * std::size_t{entries[i].face}];
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
  if (edges.size() != size) any_dropped = true;
  order_ring(edges, ring);
  // set_ring frees by the present size, which is that of the unordered ring.
  surface.set_ring(point, ring);
}

void Builder::order_rings(std::uint32_t begin, std::uint32_t end, bool with_normals) {
  std::vector<LinkEdge> edges;
  std::vector<RingEntry> ring;
  for (std::uint32_t p = begin; p < end; ++p) {
    order_one(p, edges, ring);
    if (with_normals) set_normal(p);
  }
}

// The mean of the normals of the faces around, by area.
void Builder::set_normal(std::uint32_t point) {
  PointState& state = surface.points[point];
  const auto ring = surface.ring_span(point);
  Vec3 sum(0);
  for (std::size_t i = 0; i < ring.size(); ++i) {
    if (ring[i].face == kNone) continue;
    const std::uint32_t next = ring[i + 1 == ring.size() ? 0 : i + 1].neighbor;
    sum += glm::cross(surface.points[ring[i].neighbor].position - state.position,
                      surface.points[next].position - state.position);
  }
  state.normal = pack_normal(sum);
}

}  // namespace

void rebuild_rings(WorkingSurface& surface, std::span<const std::uint32_t> faces,
                   std::span<const std::uint32_t> corners) {
  const TriangleMesh no_mesh;
  const SurfaceOptions options;
  Builder builder{no_mesh, options, {}, {}, {}, {}};
  builder.surface = std::move(surface);
  builder.face_points.assign(3 * builder.surface.is_face.size(), 0);
  builder.degree.assign(builder.surface.point_count(), 0);
  for (RingPool& pool : builder.surface.pools) pool = RingPool();
  for (PointState& point : builder.surface.points) point.ring_size = 0;
  for (PointState& point : builder.surface.points) point.flags |= PointState::kDead;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    builder.surface.points[corners[i]].flags = 0;
    builder.face_points[3 * std::size_t{faces[i / 3]} + i % 3] = corners[i];
    ++builder.degree[corners[i]];
  }
  builder.make_room();
  for (const std::uint32_t face : faces) builder.add_to_rings(face);
  builder.order_rings(0, builder.surface.point_count(), false);
  builder.surface.face_count = static_cast<std::uint32_t>(faces.size());
  surface = std::move(builder.surface);
}

WorkingSurface build_surface(const TriangleMesh& mesh, const SurfaceOptions& options,
                             InputFaults& faults) {
  Builder builder{mesh, options, {}, {}, {}, {}};
  builder.make_points();
  builder.make_faces();
  builder.fill_rings();
  const std::uint32_t count = builder.surface.point_count();
  parallel_for(options.threads, count, builder.surface.points_per_pool(),
               [&](std::size_t begin, std::size_t end) {
                 builder.order_rings(static_cast<std::uint32_t>(begin),
                                     static_cast<std::uint32_t>(end), true);
               });
  if (builder.any_dropped) builder.count_faces();
  if (options.with_wedges) builder.surface.wedge = make_wedges(mesh, builder.surface);
  classify_points(builder.surface, options.threads);
  faults = builder.faults;
  return std::move(builder.surface);
}

}  // namespace varifold
