#include <varifold/models/vdpm/connectivity_code.h>

#include <algorithm>

namespace varifold::vdpm {

namespace {

// Which corner is the new vertex (0), its target (1), another one (2).
constexpr std::array<std::array<std::uint8_t, 3>, 6> kOrders{
    {{0, 1, 2}, {2, 0, 1}, {1, 2, 0}, {0, 2, 1}, {1, 0, 2}, {2, 1, 0}}};

// The order of a triangle with corners c and t, or kNone.
std::uint32_t order_of(const std::array<std::uint32_t, 3>& corners, std::uint32_t c,
                       std::uint32_t t) {
  for (std::uint32_t code = 0; code < kOrders.size(); ++code) {
    bool fits = true;
    for (std::size_t i = 0; i < 3; ++i)
      fits = fits && (kOrders[code][i] == 2 || corners[i] == (kOrders[code][i] == 0 ? c : t));
    if (fits) return code;
  }
  return kNone;
}

std::uint32_t third_corner(const std::array<std::uint32_t, 3>& corners, std::uint32_t order) {
  for (std::size_t i = 0; i < 3; ++i)
    if (kOrders[order][i] == 2) return corners[i];
  return kNone;
}

bool is_triangle(const SplitFrame& frame, const std::array<std::uint32_t, 3>& corners) {
  const auto [a, b, c] = corners;
  const std::uint32_t newest = std::max({a, b, c});
  return a != b && b != c && c != a && newest >= frame.first_vertex && newest < frame.end_vertex;
}

}  // namespace

GrowingSurface::GrowingSurface(std::uint32_t vertices, std::uint32_t triangles)
    : slots_(std::size_t{3} * triangles), rows_(vertices) {}

void GrowingSurface::append(std::uint32_t vertex, std::uint32_t slot) {
  slots_[slot].next = kNone;
  Row& row = rows_[vertex];
  if (row.first == kNone)
    row.first = slot;
  else
    slots_[row.last].next = slot;
  row.last = slot;
  ++row.count;
}

std::vector<std::uint32_t> GrowingSurface::corners() const {
  std::vector<std::uint32_t> corners(slots_.size());
  for (std::size_t i = 0; i < corners.size(); ++i) corners[i] = slots_[i].corner;
  return corners;
}

void GrowingSurface::add(std::uint32_t triangle, const std::array<std::uint32_t, 3>& corners) {
  for (std::uint32_t c = 0; c < 3; ++c) {
    slots_[3 * triangle + c].corner = corners[c];
    append(corners[c], 3 * triangle + c);
  }
}

std::uint32_t GrowingSurface::other(std::uint32_t slot, std::uint32_t which) const {
  const std::uint32_t corner = slot % 3, first = slot - corner;
  return slots_[first + (corner + 1 + which) % 3].corner;
}

std::uint32_t GrowingSurface::neighbour(std::uint32_t a, std::uint32_t b,
                                        std::uint32_t place) const {
  std::uint32_t vertex = a, index = place / 2;
  if (index >= rows_[a].count) {
    index -= rows_[a].count;
    vertex = b;
  }
  std::uint32_t slot = rows_[vertex].first;
  for (; index > 0; --index) slot = slots_[slot].next;
  return other(slot, place % 2);
}

std::uint32_t GrowingSurface::place_of(std::uint32_t vertex, std::uint32_t a,
                                       std::uint32_t b) const {
  std::uint32_t place = 0;
  for (const std::uint32_t center : {a, b})
    for (std::uint32_t slot = rows_[center].first; slot != kNone; slot = slots_[slot].next)
      for (std::uint32_t which = 0; which < 2; ++which, ++place)
        if (other(slot, which) == vertex) return place;
  return kNone;
}

void write_division(const SplitFrame& frame, GrowingSurface& surface, BitWriter& bits) {
  for (std::uint32_t v = frame.first_vertex; v < frame.end_vertex; ++v)
    surface.divide(frame.target[v], v, [&](std::uint32_t slot) {
      const bool goes = surface.corner(slot) == v;
      bits.bits(goes ? 1 : 0, 1);
      return goes;
    });
}

bool read_division(const SplitFrame& frame, GrowingSurface& surface, BitReader& bits,
                   std::vector<std::uint32_t>& taken, std::vector<std::uint32_t>& taken_end) {
  for (std::uint32_t v = frame.first_vertex; v < frame.end_vertex; ++v) {
    surface.divide(frame.target[v], v, [&](std::uint32_t slot) {
      const bool goes = bits.bits(1) != 0;
      if (goes) taken.push_back(slot);
      return goes;
    });
    if (bits.exhausted()) return false;
    taken_end.push_back(static_cast<std::uint32_t>(taken.size()));
  }
  return true;
}

void write_triangle(const SplitFrame& frame, const NewTriangle& triangle,
                    const GrowingSurface& surface, BitWriter& bits) {
  if (frame.ranges > 1) bits.uniform(triangle.range, frame.ranges);
  for (std::uint32_t c = frame.first_vertex; c < frame.end_vertex; ++c) {
    const std::uint32_t target = frame.target[c];
    const std::uint32_t order = order_of(triangle.corners, c, target);
    if (order == kNone) continue;
    const std::uint32_t place = surface.place_of(third_corner(triangle.corners, order), c, target);
    if (place == kNone) continue;
    bits.bits(1, 1);
    bits.uniform(c - frame.first_vertex, frame.end_vertex - frame.first_vertex);
    bits.uniform(order, static_cast<std::uint32_t>(kOrders.size()));
    bits.uniform(place, surface.neighbours(c, target));
    return;
  }
  bits.bits(0, 1);
  for (const std::uint32_t corner : triangle.corners) bits.uniform(corner, frame.end_vertex);
}

bool read_triangle(const SplitFrame& frame, const GrowingSurface& surface, BitReader& bits,
                   NewTriangle& triangle) {
  triangle.range = frame.ranges > 1 ? bits.uniform(frame.ranges) : 0;
  if (bits.bits(1) == 0) {
    for (std::uint32_t& corner : triangle.corners) corner = bits.uniform(frame.end_vertex);
    return is_triangle(frame, triangle.corners);
  }
  const std::uint32_t c = frame.first_vertex + bits.uniform(frame.end_vertex - frame.first_vertex);
  const std::uint32_t target = frame.target[c];
  const auto& order = kOrders[bits.uniform(static_cast<std::uint32_t>(kOrders.size()))];
  const std::uint32_t places = surface.neighbours(c, target);
  if (places == 0) return false;
  const std::array<std::uint32_t, 3> choice{c, target,
                                            surface.neighbour(c, target, bits.uniform(places))};
  for (std::size_t i = 0; i < 3; ++i) triangle.corners[i] = choice[order[i]];
  return is_triangle(frame, triangle.corners);
}

void write_moved(const SplitFrame& frame, std::span<const std::uint32_t> moved, BitWriter& bits) {
  const auto targets =
      frame.target.subspan(frame.first_vertex, frame.end_vertex - frame.first_vertex);
  const bool usual = std::equal(moved.begin(), moved.end(), targets.begin(), targets.end());
  bits.bits(usual ? 1 : 0, 1);
  if (usual) return;
  bits.bits(static_cast<std::uint32_t>(moved.size()), 32);
  for (const std::uint32_t v : moved) bits.uniform(v, frame.first_vertex);
}

bool read_moved(const SplitFrame& frame, BitReader& bits, std::vector<std::uint32_t>& moved) {
  if (bits.bits(1) != 0) {
    for (std::uint32_t v = frame.first_vertex; v < frame.end_vertex; ++v)
      moved.push_back(frame.target[v]);
    return !bits.exhausted();
  }
  const std::uint32_t count = bits.bits(32);
  if (count > frame.first_vertex) return false;
  for (std::uint32_t i = 0; i < count; ++i) {
    moved.push_back(bits.uniform(frame.first_vertex));
    if (bits.exhausted()) return false;
  }
  return true;
}

}  // namespace varifold::vdpm
