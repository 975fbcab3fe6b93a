#include <varifold/simplify/sequence_builder.h>

#include <varifold/mesh/vertex_arrays.h>
#include <algorithm>

namespace varifold {

namespace {

// A vertex of the output stands for one wedge; without wedge tables a point is its own wedge.
class SequenceBuilder {
 public:
  SequenceBuilder(const TriangleMesh& mesh, const WorkingSurface& surface, const CollapseLog& log,
                  std::size_t step_count)
      : mesh_(mesh), surface_(surface), log_(log), steps_(step_count) {}

  DetailedMesh build() {
    number_vertices();
    number_triangles();
    gather_attributes();
    set_errors();
    return std::move(out_);
  }

 private:
  [[nodiscard]] std::uint32_t wedge_count(std::uint32_t point) const {
    return surface_.wedge.count_of(point);
  }

  // Gives ids from `next` on to the wedges of a point.
  void number_point(std::uint32_t point, std::uint32_t next) {
    const WedgeTables& wedge = surface_.wedge;
    const std::uint32_t first = wedge.first_of(point);
    for (std::uint32_t w = first; w < first + wedge.count_of(point); ++w) {
      out_.original_vertex[next] =
          wedge.vertex_of.empty() ? surface_.first_vertex_of_point[point] : wedge.vertex_of[w];
      id_of_wedge_[w] = next++;
    }
  }

  // The last to vanish come first: the base in Morton order, then the log read backwards.
  void number_vertices() {
    CollapseSequence& sequence = out_.sequence;
    const std::uint32_t points = surface_.point_count();
    std::vector<bool> collapsed(points, false);
    std::uint32_t total = 0;
    for (std::size_t i = 0; i < steps_; ++i) collapsed[log_.entries[i].from] = true;
    for (std::uint32_t p = 0; p < points; ++p) total += wedge_count(p);

    out_.original_vertex.resize(total);
    id_of_wedge_.assign(total, kNone);
    std::uint32_t next = 0;
    for (std::uint32_t p = 0; p < points; ++p) {
      if (collapsed[p]) continue;
      number_point(p, next);
      next += wedge_count(p);
    }
    sequence.vertices.reserve(steps_ + 1);
    sequence.vertices.push_back(next);
    for (std::size_t i = steps_; i-- > 0;) {
      number_point(log_.entries[i].from, next);
      next += wedge_count(log_.entries[i].from);
      sequence.vertices.push_back(next);
    }
    set_targets();
  }

  void set_targets() {
    CollapseSequence& sequence = out_.sequence;
    sequence.target.assign(out_.original_vertex.size(), kNone);
    for (std::size_t i = 0; i < steps_; ++i) {
      const CollapseLogEntry& entry = log_.entries[i];
      const WedgeTables& wedge = surface_.wedge;
      const std::uint32_t first = wedge.first_of(entry.from);
      for (std::uint32_t w = first; w < first + wedge.count_of(entry.from); ++w)
        sequence.target[id_of_wedge_[w]] =
            id_of_wedge_[wedge.has_seams() ? wedge.target[w] : entry.onto];
    }
  }

  // Within each range, triangles in the order in which the levels gain them.
  void number_triangles() {
    CollapseSequence& sequence = out_.sequence;
    std::vector<MaterialRange> ranges = mesh_.ranges;
    if (ranges.empty()) ranges.push_back({0, 0, mesh_.triangle_count()});
    std::vector<std::uint32_t> level_of(mesh_.triangle_count(), kNone);
    mark_faces(level_of);
    const std::vector<std::uint32_t> by_level = sort_by_level(level_of);

    std::vector<std::uint32_t> range_of(mesh_.triangle_count());
    for (std::uint32_t r = 0; r < ranges.size(); ++r)
      std::fill_n(range_of.begin() + ranges[r].first_triangle, ranges[r].triangle_count, r);
    std::vector<std::uint32_t> cursor(ranges.size() + 1, 0);
    for (const std::uint32_t t : by_level) ++cursor[range_of[t] + 1];
    for (std::size_t r = 1; r < cursor.size(); ++r) cursor[r] += cursor[r - 1];
    for (std::size_t r = 0; r < ranges.size(); ++r)
      if (!mesh_.ranges.empty() && cursor[r + 1] > cursor[r])
        out_.mesh.ranges.push_back({ranges[r].material, cursor[r], cursor[r + 1] - cursor[r]});

    const std::size_t count = by_level.size();
    out_.original_triangle.resize(count);
    sequence.triangle_level.resize(count);
    out_.mesh.indices.resize(3 * count);
    for (const std::uint32_t t : by_level) {
      const std::uint32_t id = cursor[range_of[t]]++;
      out_.original_triangle[id] = t;
      sequence.triangle_level[id] = level_of[t];
      for (std::size_t k = 0; k < 3; ++k)
        out_.mesh.indices[3 * std::size_t{id} + k] = new_id(mesh_.indices[3 * std::size_t{t} + k]);
    }
  }

  [[nodiscard]] std::uint32_t new_id(std::uint32_t vertex) const {
    const WedgeTables& wedge = surface_.wedge;
    return id_of_wedge_[wedge.has_seams() ? wedge.wedge_of_vertex[vertex]
                                          : surface_.point_of_vertex[vertex]];
  }

  // The level of each live face; kNone for triangles that never were faces. Counts per level too.
  void mark_faces(std::vector<std::uint32_t>& level_of) {
    CollapseSequence& sequence = out_.sequence;
    const auto steps = static_cast<std::uint32_t>(steps_);
    for (std::uint32_t t = 0; t < mesh_.triangle_count(); ++t)
      if (surface_.is_face[t]) level_of[t] = 0;
    std::uint32_t base = static_cast<std::uint32_t>(
        std::count(surface_.is_face.begin(), surface_.is_face.end(), true));
    std::size_t face = 0;
    for (std::uint32_t i = 0; i < steps; ++i) {
      for (std::uint32_t k = 0; k < log_.entries[i].removed_faces; ++k)
        level_of[log_.removed_faces[face++]] = steps - i;
      base -= log_.entries[i].removed_faces;
    }
    sequence.triangles.resize(steps + 1);
    sequence.triangles[0] = base;
    for (std::uint32_t k = 1; k <= steps; ++k)
      sequence.triangles[k] = sequence.triangles[k - 1] + log_.entries[steps - k].removed_faces;
  }

  [[nodiscard]] std::vector<std::uint32_t> sort_by_level(
      const std::vector<std::uint32_t>& level_of) const {
    const CollapseSequence& sequence = out_.sequence;
    std::vector<std::uint32_t> cursor(steps_ + 1, 0);
    for (std::size_t k = 1; k <= steps_; ++k) cursor[k] = sequence.triangles[k - 1];
    std::vector<std::uint32_t> sorted(sequence.triangles.back());
    for (std::uint32_t t = 0; t < level_of.size(); ++t)
      if (level_of[t] != kNone) sorted[cursor[level_of[t]]++] = t;
    return sorted;
  }

  void gather_attributes() {
    TriangleMesh mesh = gather_vertices(mesh_, out_.original_vertex);
    mesh.indices = std::move(out_.mesh.indices);
    mesh.ranges = std::move(out_.mesh.ranges);
    mesh.materials = mesh_.materials;
    mesh.images = mesh_.images;
    out_.mesh = std::move(mesh);
  }

  void set_errors() {
    CollapseSequence& sequence = out_.sequence;
    sequence.error.assign(steps_ + 1, 0);
    float greatest = 0;
    for (std::size_t i = 0; i < steps_; ++i) {
      greatest = std::max(greatest, log_.entries[i].error);
      sequence.error[steps_ - 1 - i] = static_cast<float>(greatest / surface_.scale);
    }
  }

  const TriangleMesh& mesh_;
  const WorkingSurface& surface_;
  const CollapseLog& log_;
  std::size_t steps_;
  DetailedMesh out_;
  std::vector<std::uint32_t> id_of_wedge_;
};

}  // namespace

DetailedMesh build_sequence(const TriangleMesh& mesh, const WorkingSurface& surface,
                            const CollapseLog& log, std::size_t step_count) {
  return SequenceBuilder(mesh, surface, log, step_count).build();
}

void add_placement(DetailedMesh& detailed, const WorkingSurface& surface,
                   const PlacementLog& placement, std::size_t step_count) {
  // The log names wedges; the sequence has vertices of its own.
  const WedgeTables& wedge = surface.wedge;
  std::vector<std::uint32_t> id_of(detailed.original_vertex.size(), kNone);
  for (std::uint32_t v = 0; v < detailed.original_vertex.size(); ++v) {
    const std::uint32_t original = detailed.original_vertex[v];
    id_of[wedge.has_seams() ? wedge.wedge_of_vertex[original] : surface.point_of_vertex[original]] =
        v;
  }
  CollapseSequence& sequence = detailed.sequence;
  const auto copy = [](const auto& from, std::uint32_t j, auto& to) {
    if (!from.empty()) to.push_back(from[j]);
  };
  sequence.first_placed.assign(1, 0);
  for (std::size_t step = step_count; step-- > 0;) {
    for (std::uint32_t j = placement.first[step]; j < placement.first[step + 1]; ++j) {
      sequence.placed_vertex.push_back(id_of[placement.wedge[j]]);
      copy(placement.attributes.positions, j, sequence.placed.positions);
      copy(placement.attributes.normals, j, sequence.placed.normals);
      copy(placement.attributes.texcoords, j, sequence.placed.texcoords);
      copy(placement.attributes.colors, j, sequence.placed.colors);
    }
    sequence.first_placed.push_back(static_cast<std::uint32_t>(sequence.placed_vertex.size()));
  }
}

}  // namespace varifold
