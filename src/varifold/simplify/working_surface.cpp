#include <varifold/simplify/working_surface.h>

#include <algorithm>
#include <cstring>

namespace varifold {

void WorkingSurface::release_ring(std::uint32_t point) {
  PointState& state = points[point];
  if (state.ring_size > RingLine::kCapacity) {
    const RingEntry address = lines[point].entries[0];
    pools[address.face].release(address.neighbor, state.ring_size);
  }
  state.ring_size = 0;
}

void WorkingSurface::set_ring(std::uint32_t point, std::span<const RingEntry> entries) {
  release_ring(point);
  RingEntry* destination = lines[point].entries;
  const auto size = static_cast<std::uint32_t>(entries.size());
  if (size > RingLine::kCapacity) {
    const std::uint32_t pool = pool_of(point);
    const std::uint32_t offset = pools[pool].allocate(size);
    lines[point].entries[0] = {offset, pool};
    destination = pools[pool].at(offset);
  }
  if (size > 0) std::memcpy(destination, entries.data(), size * sizeof(RingEntry));
  points[point].ring_size = static_cast<std::uint16_t>(size);
}

std::uint32_t WorkingSurface::live_points() const {
  return static_cast<std::uint32_t>(std::count_if(
      points.begin(), points.end(), [](const auto& p) { return !(p.flags & PointState::kDead); }));
}

std::size_t WorkingSurface::bytes() const {
  std::size_t sum =
      points.capacity() * sizeof(PointState) + lines.capacity() * sizeof(RingLine) +
      (point_of_vertex.capacity() + first_vertex_of_point.capacity()) * sizeof(std::uint32_t) +
      is_face.capacity() / 8;
  for (const RingPool& pool : pools) sum += pool.bytes();
  sum += wedge.bytes();
  return sum;
}

}  // namespace varifold
