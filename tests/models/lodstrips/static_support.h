// Static forms of all test meshes.
#pragma once

#include <tests/support/meshes.h>
#include <varifold/models/common/extract_level.h>
#include <varifold/models/lodstrips/grouped_cursor.h>
#include <varifold/models/lodstrips/static_build.h>
#include <varifold/models/lodstrips/thesis_cursor.h>
#include <varifold/simplify/simplify.h>
#include <varifold/strip/stripify.h>
#include <varifold/view/draw_vertices.h>
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

/// A seam that ends at a vertex: 0 and 1 are wedges of one point, and 4 goes to 0. The triangle on
/// 1 and 4 vanishes then, although its corners 1, 0 and 3 are three vertices.
///
///     3-----2
///     |  \  |     in the strip 1 4 3 / 4 2 3 / 4 0 2
///     4     |
///     |\ \  |
///     1 0 --+
inline NamedSequence torn_seam() {
  NamedSequence result;
  result.name = "torn seam";
  TriangleMesh& mesh = result.detailed.mesh;
  mesh.positions = {{0, 0, 0}, {0, 0, 0}, {2, 1, 0}, {0, 2, 0}, {0, 1, 0}};
  mesh.indices = {4, 2, 3, 4, 0, 2, 1, 4, 3};
  CollapseSequence& sequence = result.detailed.sequence;
  sequence.target = {kNone, kNone, kNone, kNone, 0};
  sequence.triangle_level = {0, 1, 1};
  sequence.vertices = {4, 5};
  sequence.triangles = {1, 3};
  sequence.error = {1, 0};
  result.table = LevelTable(sequence);
  return result;
}

/// Every test mesh; made once.
inline const std::vector<NamedSequence>& all_sequences() {
  static const std::vector<NamedSequence> sequences = [] {
    std::vector<NamedSequence> made;
    for (const NamedMesh& named : all_groups())
      made.push_back(make_sequence(named.name, named.mesh));
    made.push_back(torn_seam());
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
  DrawList list = draw_vertices(attributes);
  cursor.fill(list);
  return list;
}

}  // namespace varifold::test
