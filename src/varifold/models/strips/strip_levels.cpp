#include <varifold/models/strips/strip_levels.h>

#include <varifold/mesh/vertex_arrays.h>
#include <varifold/mesh/weld.h>
#include <algorithm>
#include <array>
#include <numeric>
#include <utility>

namespace varifold {

namespace {

// Per vertex, the first one at its place; empty where that is itself, always.
std::vector<std::uint32_t> first_at_place(const TriangleMesh& mesh) {
  if (!may_have_seams(mesh)) return {};  // there is one vertex at a place
  const WeldMap weld = weld_points(mesh);
  std::vector<std::uint32_t> first_of_class(weld.class_count, kNone), first(mesh.vertex_count());
  for (std::uint32_t v = 0; v < first.size(); ++v) {
    std::uint32_t& of_class = first_of_class[weld.class_of[v]];
    if (of_class == kNone) of_class = v;
    first[v] = of_class;
  }
  return first;
}

bool stays_whole(const LevelTable& levels, const std::vector<std::uint32_t>& place) {
  // Vertices of one step follow one another, and `place` is the first of them.
  std::uint32_t vertex = levels.vertex_count(0);
  for (std::uint32_t v = 0; v < vertex; ++v)
    if (place[v] >= vertex) return false;
  for (std::uint32_t k = 0; k < levels.finest_level(); ++k) {
    const std::uint32_t first = vertex;
    vertex += levels.step(k).vertices;
    for (std::uint32_t v = first; v < vertex; ++v)
      if (place[v] < first || place[levels.target(v)] != place[levels.target(place[v])])
        return false;
  }
  return true;
}

// Names fall together from the finest level down; every set of them knows the corners in it. Of two
// sets that fall together only the corners of the smaller one are looked at.
class FallingTogether {
 public:
  explicit FallingTogether(std::size_t names, const TriangleStrips& strips)
      : parent_(names), first_(names, kNone), last_(names, kNone), size_(names, 0) {
    std::iota(parent_.begin(), parent_.end(), 0u);
    triangles_.assign(strips.indices.size(), kGone);
    next_.assign(3 * triangles_.size(), kNone);
  }
  void add(std::uint32_t slot, const std::array<std::uint32_t, 3>& triangle) {
    if (is_degenerate(triangle)) return;
    triangles_[slot] = triangle;
    for (std::uint32_t c = 0; c < 3; ++c) append(triangle[c], 3 * slot + c, 3 * slot + c, 1);
  }
  // Calls gone(slot) for every triangle that this makes degenerate.
  template <class Gone>
  void join(std::uint32_t a, std::uint32_t b, const Gone& gone) {
    std::uint32_t large = find(a), small = find(b);
    if (large == small) return;
    if (size_[large] < size_[small]) std::swap(large, small);
    parent_[small] = large;
    for (std::uint32_t corner = first_[small]; corner != kNone; corner = next_[corner]) {
      std::array<std::uint32_t, 3>& triangle = triangles_[corner / 3];
      if (triangle == kGone) continue;
      for (std::uint32_t& name : triangle) name = find(name);
      if (!is_degenerate(triangle)) continue;
      triangle = kGone;
      gone(corner / 3);
    }
    if (first_[small] != kNone) append(large, first_[small], last_[small], size_[small]);
  }
  [[nodiscard]] bool is_gone(std::uint32_t slot) const { return triangles_[slot] == kGone; }

 private:
  static constexpr std::array<std::uint32_t, 3> kGone{kNone, kNone, kNone};
  std::uint32_t find(std::uint32_t name) {
    while (parent_[name] != name) name = parent_[name] = parent_[parent_[name]];
    return name;
  }
  void append(std::uint32_t set, std::uint32_t first, std::uint32_t last, std::uint32_t count) {
    (first_[set] == kNone ? first_[set] : next_[last_[set]]) = first;
    last_[set] = last;
    size_[set] += count;
  }

  std::vector<std::uint32_t> parent_;
  std::vector<std::uint32_t> first_, last_, size_;       // per set, its corners
  std::vector<std::uint32_t> next_;                      // per corner
  std::vector<std::array<std::uint32_t, 3>> triangles_;  // by their first slots
};

// Per slot, the coarsest level that has the triangle that begins there, kNone where there is none.
// With `name_of`, vertices of one name are one.
std::vector<std::uint32_t> triangle_levels(const LevelTable& levels, const TriangleStrips& strips,
                                           const std::vector<std::uint32_t>& name_of) {
  const auto name = [&](std::uint32_t v) { return name_of.empty() ? v : name_of[v]; };
  auto vertex = static_cast<std::uint32_t>(levels.targets().size());
  FallingTogether names(vertex, strips);
  for (std::uint32_t s = 0; s < strips.count(); ++s) {
    const auto strip = strips.strip(s);
    for (std::uint32_t i = 0; i + 2 < strip.size(); ++i)
      names.add(strips.first[s] + i, {name(strip[i]), name(strip[i + 1]), name(strip[i + 2])});
  }
  std::vector<std::uint32_t> level_of(strips.indices.size(), kNone);
  for (std::uint32_t slot = 0; slot < level_of.size(); ++slot)
    if (!names.is_gone(slot)) level_of[slot] = 0;
  for (std::uint32_t k = levels.finest_level(); k-- > 0;)
    for (std::uint32_t i = levels.step(k).vertices; i-- > 0;) {
      --vertex;
      names.join(name(vertex), name(levels.target(vertex)),
                 [&](std::uint32_t slot) { level_of[slot] = k + 1; });
    }
  return level_of;
}

}  // namespace

StripLevels strip_levels(const TriangleMesh& mesh, const LevelTable& levels,
                         const TriangleStrips& strips) {
  const std::vector<std::uint32_t> place = first_at_place(mesh);
  StripLevels result;
  if (!place.empty() && !stays_whole(levels, place)) {
    result.places_stay_whole = false;
    return result;
  }
  result.level_of = triangle_levels(levels, strips, place);
  const std::vector<std::uint32_t>& level_of = result.level_of;
  result.added.assign(std::size_t{levels.finest_level()} + 1, 0);
  for (const std::uint32_t level : level_of)
    if (level != kNone) ++result.added[level];
  if (place.empty()) return result;
  const std::vector<std::uint32_t> by_vertices = triangle_levels(levels, strips, {});
  for (std::uint32_t slot = 0; slot < level_of.size(); ++slot)
    if (level_of[slot] != by_vertices[slot]) result.slivers.push_back(slot);
  return result;
}

}  // namespace varifold
