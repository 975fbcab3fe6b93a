#include <varifold/measure/check_parts.h>

#include <algorithm>
#include <cmath>

namespace varifold::check {

WeldMap ModelPoints::at_level(std::uint32_t level, std::uint32_t vertices) const {
  WeldMap weld;
  weld.class_of.assign(point_of.begin(), point_of.begin() + vertices);
  weld.class_count = base_points + level;
  return weld;
}

WeldMap ModelPoints::all() const {
  const std::uint32_t count =
      point_of.empty() ? 0 : *std::max_element(point_of.begin(), point_of.end()) + 1;
  return {point_of, std::max(count, base_points)};
}

std::vector<std::uint32_t> levels_to_visit(std::uint32_t finest, const ModelCheckOptions& options) {
  std::vector<std::uint32_t> levels;
  const bool all = finest <= options.all_levels_up_to;
  const std::uint32_t half = std::max(1u, options.spread_levels / 2);
  for (std::uint32_t k = 0; all && k <= finest; ++k) levels.push_back(k);
  for (std::uint32_t i = 0; !all && i <= half; ++i) {
    const double part = static_cast<double>(i) / half;
    levels.push_back(static_cast<std::uint32_t>(part * finest));
    levels.push_back(static_cast<std::uint32_t>(std::pow(static_cast<double>(finest), part)));
  }
  levels.push_back(0);
  levels.push_back(finest);
  std::sort(levels.begin(), levels.end());
  levels.erase(std::unique(levels.begin(), levels.end()), levels.end());
  return levels;
}

CanonicalTriangle canonical(CanonicalTriangle triangle) {
  std::rotate(triangle.begin(), std::min_element(triangle.begin(), triangle.begin() + 3),
              triangle.begin() + 3);
  return triangle;
}

std::vector<CanonicalTriangle> canonical_triangles(const TriangleMesh& mesh) {
  const std::vector<std::uint32_t> materials = triangle_materials(mesh);
  std::vector<CanonicalTriangle> triangles(mesh.triangle_count());
  for (std::size_t t = 0; t < triangles.size(); ++t)
    triangles[t] = canonical(
        {mesh.indices[3 * t], mesh.indices[3 * t + 1], mesh.indices[3 * t + 2], materials[t]});
  std::sort(triangles.begin(), triangles.end());
  return triangles;
}

TriangleDifferences compare_triangles(const std::vector<CanonicalTriangle>& expected,
                                      const std::vector<CanonicalTriangle>& found) {
  TriangleDifferences differences;
  std::size_t e = 0, f = 0;
  while (e < expected.size() || f < found.size()) {
    if (f == found.size() || (e < expected.size() && expected[e] < found[f])) {
      differences.lost = true;
      ++e;
    } else if (e == expected.size() || found[f] < expected[e]) {
      const bool again = e > 0 && expected[e - 1] == found[f];
      (again ? differences.doubled : differences.wrong) = true;
      ++f;
    } else {
      ++e;
      ++f;
    }
  }
  return differences;
}

bool indices_exist(const DrawList& list, std::uint32_t vertices) {
  for (const DrawRange& range : list.ranges) {
    if (std::uint64_t{range.first_index} + range.index_count > list.indices.size()) return false;
    const bool is_strip = range.primitive == Primitive::kStrips;
    for (const std::uint32_t v : list.indices.subspan(range.first_index, range.index_count))
      if (v >= vertices && !(is_strip && v == kStripRestart)) return false;
  }
  return true;
}

std::uint64_t fingerprint_of(const DrawList& list, const TriangleMesh& attributes) {
  ChecksumStream sum;
  sum.add(std::as_bytes(list.indices));
  if (list.positions.data() != attributes.positions.data()) {
    sum.add(std::as_bytes(list.positions));
    sum.add(std::as_bytes(list.normals));
    sum.add(std::as_bytes(list.texcoords));
    sum.add(std::as_bytes(list.colors));
  }
  for (const DrawRange& range : list.ranges) {
    const std::array<std::uint32_t, 4> words{range.first_index, range.index_count,
                                             static_cast<std::uint32_t>(range.primitive),
                                             range.material};
    sum.add(std::as_bytes(std::span(words)));
  }
  return sum.value();
}

std::uint64_t set_fingerprint_of(const DrawList& list) {
  // A checksum for each corner; of a triangle, the least corner comes first.
  const auto corner = [&](std::uint32_t v) {
    ChecksumStream sum;
    sum.add(std::as_bytes(list.positions.subspan(v, 1)));
    if (!list.normals.empty()) sum.add(std::as_bytes(list.normals.subspan(v, 1)));
    if (!list.texcoords.empty()) sum.add(std::as_bytes(list.texcoords.subspan(v, 1)));
    if (!list.colors.empty()) sum.add(std::as_bytes(list.colors.subspan(v, 1)));
    return sum.value();
  };
  std::vector<std::uint64_t> corners(list.positions.size());
  for (std::uint32_t v = 0; v < corners.size(); ++v) corners[v] = corner(v);
  std::vector<std::array<std::uint64_t, 4>> triangles;
  for (const DrawRange& range : list.ranges) {
    for (std::uint32_t i = 0; i + 2 < range.index_count; i += 3) {
      const auto indices = list.indices.subspan(range.first_index + i, 3);
      std::array<std::uint64_t, 4> triangle{corners[indices[0]], corners[indices[1]],
                                            corners[indices[2]], range.material};
      std::rotate(triangle.begin(), std::min_element(triangle.begin(), triangle.begin() + 3),
                  triangle.begin() + 3);
      triangles.push_back(triangle);
    }
  }
  std::sort(triangles.begin(), triangles.end());
  ChecksumStream sum;
  sum.add(std::as_bytes(std::span(triangles)));
  return sum.value();
}

}  // namespace varifold::check
