// Static forms of all test meshes.
#pragma once

#include <tests/support/meshes.h>
#include <varifold/models/common/extract_level.h>
#include <varifold/models/lodstrips/grouped_cursor.h>
#include <varifold/models/lodstrips/static_build.h>
#include <varifold/models/lodstrips/thesis_cursor.h>
#include <varifold/simplify/simplify.h>
#include <varifold/strip/stripify.h>
#include <algorithm>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace varifold::test {

struct Thesis {
  using Form = ThesisForm;
  using Cursor = ThesisCursor;
  static Form build(const DetailedMesh& detailed, const TriangleStrips& strips) {
    return build_thesis_form(detailed, strips);
  }
};
struct Grouped {
  using Form = GroupedForm;
  using Cursor = GroupedCursor;
  static Form build(const DetailedMesh& detailed, const TriangleStrips& strips) {
    return build_grouped_form(detailed, strips);
  }
};

struct NamedSequence {
  std::string name;
  DetailedMesh detailed;
  LevelTable table;
};

inline NamedSequence make_sequence(const std::string& name, const TriangleMesh& mesh) {
  SimplifyOptions options;
  options.threads = 1;
  options.measure_error = false;
  NamedSequence result{name, std::move(simplify(mesh, options)->detailed), {}};
  result.table = LevelTable(result.detailed.sequence);
  return result;
}

/// A double pyramid whose waist is a seam: vertices of the waist have two wedges, and so has the
/// upper tip, one for either half of its faces. Collapses along the seam make triangles vanish
/// whose corners differ.
inline TriangleMesh seamed_pyramid() {
  TriangleMesh mesh;
  constexpr std::uint32_t kSides = 12;
  const auto add = [&](Vec3 position, float u) {
    mesh.positions.push_back(position);
    mesh.texcoords.push_back({u, 0});
    return mesh.vertex_count() - 1;
  };
  std::vector<std::uint32_t> upper, lower;
  for (std::uint32_t i = 0; i < kSides; ++i) {
    const float x = i < kSides / 2 ? static_cast<float>(i) : static_cast<float>(kSides - i);
    const float y = static_cast<float>((i * 5) % kSides) / 3 + (i < kSides / 2 ? 0.f : 6.f);
    upper.push_back(add({x, y, 0}, 0));
    lower.push_back(add({x, y, 0}, 1));
  }
  const std::uint32_t tips[3] = {add({3, 3, 4}, 0.2f), add({3, 3, 4}, 0.4f), add({3, 3, -4}, 1)};
  for (std::uint32_t i = 0; i < kSides; ++i) {
    const std::uint32_t j = (i + 1) % kSides;
    for (const std::uint32_t v : {upper[i], upper[j], tips[i < kSides / 2 ? 0 : 1]})
      mesh.indices.push_back(v);
    for (const std::uint32_t v : {lower[j], lower[i], tips[2]}) mesh.indices.push_back(v);
  }
  return mesh;
}

/// Every test mesh; made once.
inline const std::vector<NamedSequence>& all_sequences() {
  static const std::vector<NamedSequence> sequences = [] {
    std::vector<NamedSequence> made;
    for (const NamedMesh& named : all_groups())
      made.push_back(make_sequence(named.name, named.mesh));
    made.push_back(make_sequence("seamed_pyramid", seamed_pyramid()));
    return made;
  }();
  return sequences;
}

/// Stripifiers that differ in what they make: long strips, strips cut short, strips for a cache.
inline std::vector<StripifyOptions> some_options() {
  return {{},
          {.max_indices = 8},
          {.heuristic = StripHeuristic::kRandom, .join_ends = false},
          {.method = StripMethod::kCacheAware}};
}

/// All levels of a small mesh, some 40 of a large one, the ends among them.
inline std::vector<std::uint32_t> spread_levels(std::uint32_t finest) {
  std::vector<std::uint32_t> levels;
  const std::uint32_t count = std::min(finest, finest <= 300 ? finest : 40u);
  for (std::uint32_t i = 0; i <= count; ++i)
    levels.push_back(count == 0 ? 0
                                : static_cast<std::uint32_t>(std::uint64_t{finest} * i / count));
  return levels;
}

template <class Cursor>
DrawList draw(Cursor& cursor, const TriangleMesh& attributes) {
  DrawList list;
  list.positions = attributes.positions;
  list.normals = attributes.normals;
  list.texcoords = attributes.texcoords;
  list.colors = attributes.colors;
  cursor.fill(list);
  return list;
}

}  // namespace varifold::test
