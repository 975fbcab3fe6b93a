#include <varifold/partition/edge_links.h>

#include <algorithm>
#include <cassert>

namespace varifold {

namespace {

constexpr std::uint32_t kIsSecond = 0x80000000u;
constexpr std::uint32_t kHasSecond = 0x40000000u;
constexpr std::uint32_t kHalfEdge = 0x3fffffffu;  // the bits of a half-edge; all set: none

}  // namespace

EdgeLinks::EdgeLinks(const SurfaceView& surface) : across_(surface.corners.size()) {
  assert(surface.corners.size() < kHalfEdge);
  match(surface);
  resolve();
  if (surface.materials.empty()) return;
  for (std::uint32_t h = 0; h < across_.size(); ++h)
    if (across_[h] != kNone && surface.materials[h / 3] != surface.materials[across(h) / 3])
      across_[h] |= kForeign;
}

// Hangs the first half-edge of every edge into a list at its lower point, where the others find it.
void EdgeLinks::match(const SurfaceView& surface) {
  const std::uint32_t* corners = surface.corners.data();
  LargeVector<std::uint32_t> first_at(surface.positions.size(), kHalfEdge);
  std::vector<std::uint32_t> firsts_of_thirds;
  for (std::uint32_t h = 0; h < across_.size(); ++h) {
    const std::uint32_t a = corners[h], b = corners[next_in_triangle(h)];
    const std::uint32_t lower = std::min(a, b);
    std::uint32_t g = first_at[lower];
    while (g != kHalfEdge && corners[g] + corners[next_in_triangle(g)] != a + b)
      g = across_[g] & kHalfEdge;
    if (g == kHalfEdge) {
      across_[h] = first_at[lower];
      first_at[lower] = h;
    } else if (!(across_[g] & kHasSecond)) {
      across_[g] |= kHasSecond;
      across_[h] = kIsSecond | g;
    } else {
      across_[h] = kNone;
      nonmanifold_.push_back(h);
      firsts_of_thirds.push_back(g);
    }
  }
  nonmanifold_.insert(nonmanifold_.end(), firsts_of_thirds.begin(), firsts_of_thirds.end());
}

void EdgeLinks::resolve() {
  for (std::uint32_t h = 0; h < across_.size(); ++h) {
    if (across_[h] == kNone) continue;
    if (across_[h] & kIsSecond)
      across_[across_[h] &= kHalfEdge] = h;
    else
      across_[h] = kNone;  // until its second comes
  }
  // Unlink the first two of the edges that have more.
  for (std::size_t i = 0, count = nonmanifold_.size(); i < count; ++i) {
    const std::uint32_t first = nonmanifold_[i];
    if (across_[first] == kNone) continue;
    nonmanifold_.push_back(across_[first]);
    across_[across_[first]] = kNone;
    across_[first] = kNone;
  }
  std::sort(nonmanifold_.begin(), nonmanifold_.end());
  nonmanifold_.erase(std::unique(nonmanifold_.begin(), nonmanifold_.end()), nonmanifold_.end());
}

}  // namespace varifold
