#include <varifold/simplify/target_tree.h>

namespace varifold {

std::vector<std::uint32_t> places_in_tree(const CollapseSequence& sequence) {
  const auto vertices = static_cast<std::uint32_t>(sequence.target.size());
  // A target has the smaller number, so that a subtree is counted when its own vertex is reached.
  std::vector<std::uint32_t> size(vertices, 1), place(vertices, 0);
  for (std::uint32_t v = vertices; v-- > 0;)
    if (sequence.target[v] != kNone) size[sequence.target[v]] += size[v];
  // From here on `size` is where the places of the subtree end that are not given yet.
  std::uint32_t roots = 0;
  for (std::uint32_t v = 0; v < vertices; ++v) {
    if (sequence.target[v] != kNone) continue;
    place[v] = roots;
    size[v] = roots += size[v];
  }
  // Who comes last stands last: coarse steps first.
  for (std::uint32_t k = 0; k < sequence.step_count(); ++k)
    for (std::uint32_t v = sequence.vertices[k + 1]; v-- > sequence.vertices[k];) {
      std::uint32_t& end = size[sequence.target[v]];
      const std::uint32_t own_end = end;
      place[v] = end -= size[v];
      size[v] = own_end;
    }
  return place;
}

}  // namespace varifold
