// A small stripifier for tests of what is made of strips.
#pragma once

#include <varifold/strip/triangle_strips.h>

namespace varifold::test {

/// Whether strips that end are joined to the next one by degenerate triangles: never, or about half
/// of them, as generalised strips are.
enum class Joins { kNone, kSome };

/// Strips that go straight on as long as they can, within ranges and across equal vertices only.
/// O(n log n).
[[nodiscard]] TriangleStrips greedy_strips(const TriangleMesh& mesh, Joins joins = Joins::kNone);

}  // namespace varifold::test
