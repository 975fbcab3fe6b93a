#include <varifold/mesh/topology.h>
#include <array>

namespace varifold {

namespace {

/// Calls visit(position class, triangle) once for every class of every triangle.
template <class Visit>
void for_each_incidence(std::span<const std::uint32_t> indices, const WeldMap& weld,
                        const Visit& visit) {
  for (std::size_t corner = 0; corner + 2 < indices.size(); corner += 3) {
    const std::uint32_t a = weld.class_of[indices[corner]];
    const std::uint32_t b = weld.class_of[indices[corner + 1]];
    const std::uint32_t c = weld.class_of[indices[corner + 2]];
    const auto triangle = static_cast<std::uint32_t>(corner / 3);
    visit(a, triangle);
    if (b != a) visit(b, triangle);
    if (c != a && c != b) visit(c, triangle);
  }
}

}  // namespace

VertexFaces::VertexFaces(std::span<const std::uint32_t> indices, const WeldMap& weld)
    : offsets_(std::size_t{weld.class_count} + 1, 0) {
  // Count one place ahead, so that filling moves each offset to where it belongs.
  for_each_incidence(indices, weld, [&](std::uint32_t c, std::uint32_t) { ++offsets_[c]; });
  std::uint32_t total = 0;
  for (std::uint32_t& offset : offsets_) {
    total += offset;
    offset = total;
  }
  triangles_.resize(total);

  // Fill from the back: each row ends up ascending, each offset at the start of its row.
  for (std::size_t corner = indices.size() / 3 * 3; corner > 0; corner -= 3) {
    const std::uint32_t a = weld.class_of[indices[corner - 3]];
    const std::uint32_t b = weld.class_of[indices[corner - 2]];
    const std::uint32_t c = weld.class_of[indices[corner - 1]];
    const auto triangle = static_cast<std::uint32_t>(corner / 3 - 1);
    triangles_[--offsets_[a]] = triangle;
    if (b != a) triangles_[--offsets_[b]] = triangle;
    if (c != a && c != b) triangles_[--offsets_[c]] = triangle;
  }
}

}  // namespace varifold
