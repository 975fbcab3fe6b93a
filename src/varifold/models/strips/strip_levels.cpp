#include <varifold/models/strips/strip_levels.h>

#include <array>
#include <utility>

namespace varifold {

namespace {

// Vertices fall together from the finest level down; every set knows the corners in it. Of two
// sets that fall together only the corners of the smaller one are looked at.
class FallingTogether {
 public:
  FallingTogether(std::uint32_t vertices, const TriangleStrips& strips)
      : parent_(vertices), first_(vertices, kNone), last_(vertices, kNone), size_(vertices, 0) {
    for (std::uint32_t v = 0; v < vertices; ++v) parent_[v] = v;
    for (std::uint32_t s = 0; s < strips.count(); ++s) {
      const auto strip = strips.strip(s);
      for (std::size_t i = 0; i + 2 < strip.size(); ++i)
        if (const auto corners = strip_triangle(strip, i); !is_degenerate(corners))
          triangles_.push_back(corners);
    }
    next_.assign(3 * triangles_.size(), kNone);
    for (std::uint32_t corner = 0; corner < next_.size(); ++corner)
      append(triangles_[corner / 3][corner % 3], corner, corner, 1);
  }

  // How many triangles that makes degenerate.
  std::uint32_t join(std::uint32_t a, std::uint32_t b) {
    std::uint32_t large = find(a), small = find(b);
    if (large == small) return 0;
    if (size_[large] < size_[small]) std::swap(large, small);
    parent_[small] = large;
    std::uint32_t gone = 0;
    for (std::uint32_t corner = first_[small]; corner != kNone; corner = next_[corner]) {
      std::array<std::uint32_t, 3>& triangle = triangles_[corner / 3];
      if (triangle[0] == kNone) continue;
      for (std::uint32_t& vertex : triangle) vertex = find(vertex);
      if (!is_degenerate(triangle)) continue;
      triangle[0] = kNone;
      ++gone;
    }
    if (first_[small] != kNone) append(large, first_[small], last_[small], size_[small]);
    return gone;
  }
  [[nodiscard]] std::uint32_t left() const {
    std::uint32_t count = 0;
    for (const auto& triangle : triangles_) count += triangle[0] != kNone ? 1 : 0;
    return count;
  }

 private:
  std::uint32_t find(std::uint32_t v) {
    while (parent_[v] != v) v = parent_[v] = parent_[parent_[v]];
    return v;
  }
  void append(std::uint32_t set, std::uint32_t first, std::uint32_t last, std::uint32_t count) {
    (first_[set] == kNone ? first_[set] : next_[last_[set]]) = first;
    last_[set] = last;
    size_[set] += count;
  }

  std::vector<std::uint32_t> parent_;
  std::vector<std::uint32_t> first_, last_, size_;  // per set, its corners
  std::vector<std::uint32_t> next_;                 // per corner
  std::vector<std::array<std::uint32_t, 3>> triangles_;
};

}  // namespace

std::vector<std::uint32_t> triangles_added(const LevelTable& levels, const TriangleStrips& strips) {
  const std::uint32_t finest = levels.finest_level();
  std::vector<std::uint32_t> added(std::size_t{finest} + 1, 0);
  auto vertex = static_cast<std::uint32_t>(levels.targets().size());
  FallingTogether vertices(vertex, strips);
  for (std::uint32_t k = finest; k-- > 0;)
    for (std::uint32_t i = levels.step(k).vertices; i-- > 0;) {
      --vertex;
      added[k + 1] += vertices.join(vertex, levels.target(vertex));
    }
  added[0] = vertices.left();
  return added;
}

}  // namespace varifold
