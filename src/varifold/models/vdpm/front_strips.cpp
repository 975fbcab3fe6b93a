#include <varifold/models/vdpm/front_strips.h>

#include <varifold/models/vdpm/dirty_pages.h>
#include <algorithm>

namespace varifold {
namespace {

// Indices of a triangle at most, with what joins strips: a lone one has 3 and a restart, or 3 and 3
// repeats; each further one of a strip has 2.
constexpr std::size_t kMostWithRestarts = 4, kMostWithRepeats = 6;

// visit(place, its three slots)
template <class F>
void for_each_triangle(const DrawList& list, const DrawRange& range, const F& visit) {
  const std::uint32_t end = (range.first_index + range.index_count) / 3;
  for (std::uint32_t place = range.first_index / 3; place < end; ++place)
    visit(place, list.indices.data() + 3 * std::size_t{place});
}

// Never shrinks; all of the capacity is in use.
template <class T>
void grow_to(std::vector<T>& buffer, std::size_t size) {
  if (size <= buffer.size()) return;
  reserve_for(buffer, size);
  buffer.resize(buffer.capacity());
}

}  // namespace

// Grows strips, one after the other. Plain pointers, so that writing an index does not make the
// compiler read them again.
struct FrontStrips::Spiral {
  const std::uint32_t* slots;   // of the triangles
  const std::uint32_t* across;  // per half-edge
  std::uint32_t* free;
  std::uint32_t* out;

  // Where a half-edge leads to, if that is free.
  [[nodiscard]] std::uint32_t find(std::uint32_t half_edge, std::uint32_t material) const {
    const std::uint32_t other = across[half_edge];
    return other != kNone && free[other >> 2] == material ? other : kNone;
  }

  // Writes the triangle that the strip begins with, and returns where it goes on.
  std::uint32_t start(std::uint32_t place, std::uint32_t material) {
    const std::uint32_t* const corners = slots + 3 * std::size_t{place};
    free[place] = kNone;
    std::uint32_t next = kNone, apex = 0;
    for (; apex < 3 && next == kNone; ++apex) next = find(4 * place + (apex + 1) % 3, material);
    apex = next == kNone ? 0 : apex - 1;
    *out++ = corners[apex];
    *out++ = corners[(apex + 1) % 3];
    *out++ = corners[(apex + 2) % 3];
    return next;
  }

  void grow(std::uint32_t place, std::uint32_t material) {
    std::uint32_t entry = start(place, material);
    // The last two indices are the ends of the half-edge that the strip has come in by.
    while (entry != kNone) {
      const std::uint32_t corner = entry & 3u, here = entry >> 2;
      const std::uint32_t right = corner == 2 ? 0 : corner + 1, left = corner == 0 ? 2 : corner - 1;
      const std::uint32_t* const corners = slots + 3 * std::size_t{here};
      free[here] = kNone;
      // Clockwise is about the end of that half-edge.
      std::uint32_t pivot = corners[right];
      const std::uint32_t apex = corners[left];
      entry = find(4 * here + right, material);
      if (entry == kNone) {
        pivot = corners[corner];
        entry = find(4 * here + left, material);
        if (entry == kNone) pivot = out[-1];
      }
      if (out[-1] != pivot) *out++ = pivot;
      *out++ = apex;
    }
  }

  // Between a strip and the one after it; `length`: what the range has so far.
  void divide(StripJoin join, std::size_t length) {
    if (join == StripJoin::kRestart) {
      *out++ = kStripRestart;
      return;
    }
    // Every strip begins at an even place, so that the first triangle keeps its orientation.
    const std::uint32_t last = out[-1];
    *out++ = last;
    if (length % 2 == 1) *out++ = last;
    ++out;  // the first index of the next strip, which is not known yet
  }
};

// Also counts the corners at vertex v in begin_[v + 2]. Returns how many triangles are free.
std::size_t FrontStrips::mark_free(const DrawList& triangles) {
  const std::size_t vertices = triangles.positions.size();
  grow_to(free_, triangles.indices.size() / 3);
  grow_to(begin_, vertices + 2);
  std::fill_n(free_.begin(), triangles.indices.size() / 3, kNone);
  std::fill_n(begin_.begin(), vertices + 2, 0u);
  std::size_t count = 0;
  std::uint32_t* const free = free_.data();
  std::uint32_t* const valence = begin_.data() + 2;
  for (const DrawRange& range : triangles.ranges) {
    if (range.primitive != Primitive::kTriangles) continue;
    for_each_triangle(triangles, range, [&](std::uint32_t place, const std::uint32_t* slots) {
      if (is_degenerate({slots[0], slots[1], slots[2]})) return;
      free[place] = range.material;
      for (int i = 0; i < 3; ++i) ++valence[slots[i]];
      ++count;
    });
  }
  return count;
}

// By counting, so that each row is in the order of the list.
void FrontStrips::sort_spokes(const DrawList& triangles, std::size_t count) {
  const std::size_t vertices = triangles.positions.size();
  for (std::size_t v = 2; v < vertices + 2; ++v) begin_[v] += begin_[v - 1];
  grow_to(spokes_, count);
  const std::uint32_t* const free = free_.data();
  std::uint32_t* const next = begin_.data() + 1;
  Spoke* const spokes = spokes_.data();
  for (const DrawRange& range : triangles.ranges) {
    if (range.primitive != Primitive::kTriangles) continue;
    for_each_triangle(triangles, range, [&](std::uint32_t place, const std::uint32_t* slots) {
      if (free[place] == kNone) return;
      spokes[next[slots[0]]++] = {4 * place, slots[1], slots[2]};
      spokes[next[slots[1]]++] = {4 * place + 1, slots[2], slots[0]};
      spokes[next[slots[2]]++] = {4 * place + 2, slots[0], slots[1]};
    });
  }
}

// Each half-edge into a vertex finds what runs the other way among those out of it, without a
// search: these leave marks where they end.
void FrontStrips::pair_half_edges(std::size_t vertices, std::size_t places) {
  grow_to(marks_, vertices);
  grow_to(across_, 4 * places);
  std::fill_n(marks_.begin(), vertices, Mark{kNone, kNone});
  Mark* const marks = marks_.data();
  std::uint32_t* const across = across_.data();
  for (std::uint32_t v = 0; v < vertices; ++v) {
    const Spoke* const begin = spokes_.data() + begin_[v];
    const Spoke* const end = spokes_.data() + begin_[v + std::size_t{1}];
    // Backwards, so that of several the first stays.
    for (const Spoke* spoke = end; spoke != begin;) {
      --spoke;
      marks[spoke->end] = {v, spoke->half_edge};
    }
    for (const Spoke* spoke = begin; spoke != end; ++spoke) {
      const Mark mark = marks[spoke->before];
      const bool is_first = (spoke->half_edge & 3u) == 0;
      across[is_first ? spoke->half_edge + 2 : spoke->half_edge - 1] =
          mark.from == v ? mark.half_edge : kNone;
    }
  }
}

DrawList FrontStrips::build(const DrawList& triangles, StripJoin join) {
  join_ = join;
  const std::size_t count = mark_free(triangles);
  sort_spokes(triangles, 3 * count);
  pair_half_edges(triangles.positions.size(), triangles.indices.size() / 3);
  grow_to(indices_, count * (join == StripJoin::kRestart ? kMostWithRestarts : kMostWithRepeats));
  Spiral spiral{triangles.indices.data(), across_.data(), free_.data(), indices_.data()};
  ranges_.clear();
  reserve_for(ranges_, triangles.ranges.size());
  std::uint32_t* begin = indices_.data();  // of the range
  for (const DrawRange& range : triangles.ranges) {
    if (range.primitive != Primitive::kTriangles) continue;
    const bool goes_on = !ranges_.empty() && ranges_.back().material == range.material;
    if (!goes_on) begin = spiral.out;
    for_each_triangle(triangles, range, [&](std::uint32_t place, const std::uint32_t*) {
      if (spiral.free[place] == kNone) return;
      const bool is_first = spiral.out == begin;
      if (!is_first) spiral.divide(join, static_cast<std::size_t>(spiral.out - begin));
      std::uint32_t* const strip = spiral.out;
      spiral.grow(place, range.material);
      if (!is_first && join == StripJoin::kDegenerate) strip[-1] = strip[0];
    });
    if (spiral.out == begin) continue;
    if (!goes_on)
      ranges_.push_back({static_cast<std::uint32_t>(begin - indices_.data()), 0, Primitive::kStrips,
                         range.material, range.level});
    ranges_.back().index_count = static_cast<std::uint32_t>(spiral.out - begin);
  }
  index_count_ = static_cast<std::size_t>(spiral.out - indices_.data());
  all_ = {0, static_cast<std::uint32_t>(index_count_)};
  DrawList list = again(triangles);
  if (index_count_ > 0) list.changed_indices = {&all_, 1};
  return list;
}

DrawList FrontStrips::again(const DrawList& triangles) const {
  DrawList list = triangles;
  list.indices = std::span(indices_).first(index_count_);
  list.ranges = ranges_;
  list.changed_indices = {};
  return list;
}

std::size_t FrontStrips::bytes() const {
  return (free_.capacity() + begin_.capacity() + across_.capacity() + indices_.capacity()) *
             sizeof(std::uint32_t) +
         spokes_.capacity() * sizeof(Spoke) + marks_.capacity() * sizeof(Mark) +
         ranges_.capacity() * sizeof(DrawRange);
}

}  // namespace varifold
