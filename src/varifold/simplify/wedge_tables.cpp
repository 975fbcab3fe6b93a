#include <varifold/simplify/wedge_tables.h>

#include <varifold/mesh/vertex_arrays.h>
#include <varifold/simplify/working_surface.h>
#include <algorithm>

namespace varifold {

namespace {

// Thousands of vertices at one place are locked anyhow (classify.cpp).
constexpr std::size_t kMaxSearched = 1024;

class Maker {
 public:
  Maker(const TriangleMesh& mesh, const WorkingSurface& surface) : mesh_(mesh), surface_(surface) {}

  WedgeTables make() {
    sort_vertices_by_point();
    number_wedges();
    const bool one_each = out_.vertex_of.size() == surface_.point_count();
    if (one_each && mesh_.ranges.size() <= 1) {
      out_.first.clear();
      out_.point_of.clear();
      return std::move(out_);
    }
    fill_corners();
    group_wedges();
    out_.target.assign(out_.vertex_of.size(), kNone);
    if (mesh_.ranges.size() > 1) out_.material_of = triangle_materials(mesh_);
    return std::move(out_);
  }

 private:
  void sort_vertices_by_point() {
    std::vector<bool> used(mesh_.vertex_count(), false);
    for (std::uint32_t t = 0; t < mesh_.triangle_count(); ++t)
      for (std::size_t k = 0; k < 3; ++k)
        if (surface_.is_face[t]) used[mesh_.indices[3 * std::size_t{t} + k]] = true;
    first_vertex_.assign(surface_.point_count() + 1, 0);
    for (std::uint32_t v = 0; v < mesh_.vertex_count(); ++v)
      if (used[v]) ++first_vertex_[surface_.point_of_vertex[v] + 1];
    for (std::size_t p = 1; p < first_vertex_.size(); ++p) first_vertex_[p] += first_vertex_[p - 1];
    std::vector<std::uint32_t> cursor(first_vertex_.begin(), first_vertex_.end() - 1);
    vertices_.resize(first_vertex_.back());
    for (std::uint32_t v = 0; v < mesh_.vertex_count(); ++v)
      if (used[v]) vertices_[cursor[surface_.point_of_vertex[v]]++] = v;
  }

  void number_wedges() {
    out_.wedge_of_vertex.assign(mesh_.vertex_count(), kNone);
    out_.first.reserve(surface_.point_count() + 1);
    for (std::uint32_t p = 0; p < surface_.point_count(); ++p) {
      const auto first_wedge = static_cast<std::uint32_t>(out_.vertex_of.size());
      out_.first.push_back(first_wedge);
      for (std::uint32_t i = first_vertex_[p]; i < first_vertex_[p + 1]; ++i) {
        const std::uint32_t v = vertices_[i];
        out_.wedge_of_vertex[v] = find_equal(first_wedge, v);
      }
      // A point whose faces were all dropped still stands for its first vertex.
      if (out_.vertex_of.size() == first_wedge)
        out_.vertex_of.push_back(surface_.first_vertex_of_point[p]);
      out_.point_of.resize(out_.vertex_of.size(), p);
    }
    out_.first.push_back(static_cast<std::uint32_t>(out_.vertex_of.size()));
  }

  std::uint32_t find_equal(std::uint32_t first_wedge, std::uint32_t vertex) {
    const std::size_t end = std::min(out_.vertex_of.size(), first_wedge + kMaxSearched);
    for (std::size_t w = first_wedge; w < end; ++w)
      if (equal_attributes(mesh_, out_.vertex_of[w], vertex)) return static_cast<std::uint32_t>(w);
    out_.vertex_of.push_back(vertex);
    return static_cast<std::uint32_t>(out_.vertex_of.size() - 1);
  }

  void fill_corners() {
    out_.corners.resize(mesh_.indices.size());
    for (std::size_t i = 0; i < mesh_.indices.size(); ++i) {
      const std::uint32_t wedge = out_.wedge_of_vertex[mesh_.indices[i]];
      out_.corners[i] = wedge == kNone ? 0 : wedge;  // a triangle that is no face: never read
    }
  }

  // Wedges of a point with equal texture coordinates are on one side of the charts.
  void group_wedges() {
    out_.group_of.resize(out_.vertex_of.size());
    for (std::uint32_t p = 0; p < surface_.point_count(); ++p) {
      for (std::uint32_t w = out_.first[p]; w < out_.first[p + 1]; ++w) {
        out_.group_of[w] = w;
        const std::size_t end = std::min<std::size_t>(w, out_.first[p] + kMaxSearched);
        for (std::uint32_t other = out_.first[p]; other < end; ++other) {
          if (mesh_.has_texcoords() &&
              mesh_.texcoords[out_.vertex_of[w]] != mesh_.texcoords[out_.vertex_of[other]])
            continue;
          out_.group_of[w] = out_.group_of[other];
          break;
        }
      }
    }
  }

  const TriangleMesh& mesh_;
  const WorkingSurface& surface_;
  WedgeTables out_;
  std::vector<std::uint32_t> first_vertex_, vertices_;
};

}  // namespace

std::size_t WedgeTables::bytes() const {
  std::size_t words = 0;
  for (const auto* table : {&vertex_of, &wedge_of_vertex, &first, &point_of, &corners, &group_of,
                            &material_of, &target})
    words += table->capacity();
  return words * sizeof(std::uint32_t);
}

WedgeTables make_wedges(const TriangleMesh& mesh, const WorkingSurface& surface) {
  return Maker(mesh, surface).make();
}

}  // namespace varifold
