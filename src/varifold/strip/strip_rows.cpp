// Based on: [EvansSkienaVarshney1996] section 4 (the global algorithm: large patches first, walked
//   row by row).
// Differs: their patches are made of quadrangles, which triangle meshes do not tell; a row of
//   alternating turns is what a row of quadrangles is as triangles. Rows are taken by length over
//   the whole mesh, not patch by patch.
#include <varifold/strip/strip_rows.h>
#include <algorithm>
#include <array>

namespace varifold {

namespace {

constexpr std::uint32_t kLongest = 255;  // rows are cut there

// A triangle on a row: left by this half-edge after a turn of that kind.
struct Place {
  std::uint32_t exit;
  std::uint32_t turn;
  friend bool operator==(const Place&, const Place&) = default;
};

// The edge by which the row came.
std::uint32_t entry_of(const Place& place) {
  return place.turn == 0 ? previous_half_edge(place.exit) : next_half_edge(place.exit);
}
// The edge that the row does not cross; it names the row at this triangle.
std::uint32_t axis_of(const Place& place) {
  return place.turn == 0 ? next_half_edge(place.exit) : previous_half_edge(place.exit);
}
Place turned_round(const Place& place) { return {entry_of(place), place.turn ^ 1u}; }

struct Row {
  Place begin;
  std::uint8_t length;  // triangles
};

class RowTaker {
 public:
  RowTaker(StripPaths& paths, std::vector<std::uint8_t>& taken, std::uint32_t least)
      : paths_(paths), taken_(taken), least_(least), seen_(paths.triangle_count(), 0) {}

  void run() {
    for (std::uint32_t t = 0; t < paths_.triangle_count(); ++t)
      for (std::uint32_t axis = 0; axis < 3 && !taken_[t]; ++axis)
        if ((seen_[t] >> axis & 1u) == 0) find(3 * t + axis);
    for (std::uint32_t length = kLongest; length >= least_; --length) {
      while (!rows_[length].empty()) {
        const Row row = rows_[length].back();
        rows_[length].pop_back();
        take(row);
      }
    }
  }

 private:
  void push(const Row& row) {
    if (row.length >= least_) rows_[row.length].push_back(row);
  }

  // Goes one triangle on, where there is one.
  bool step(Place& place) const {
    const std::uint32_t entry = paths_.across(place.exit);
    if (entry == kNone) return false;
    place.turn ^= 1u;
    place.exit = exit_of(entry, place.turn);
    return true;
  }
  [[nodiscard]] bool seen(const Place& place) const {
    const std::uint32_t axis = axis_of(place);
    return (seen_[axis / 3] >> (axis % 3) & 1u) != 0;
  }
  void see(const Place& place) {
    const std::uint32_t axis = axis_of(place);
    seen_[axis / 3] |= static_cast<std::uint8_t>(1u << (axis % 3));
  }

  // The row through a triangle that does not cross its edge `axis`.
  void find(std::uint32_t axis) {
    const Place start{previous_half_edge(axis), 0};
    Place last = start, first = turned_round(start);
    std::uint32_t length = see_from(last);
    Place before = first;
    if (step(before) && !seen(before)) {
      first = before;
      length += see_from(first);
    }
    Place place = turned_round(first);
    while (length > 0) {
      const std::uint32_t piece = std::min(length, kLongest);
      push({place, static_cast<std::uint8_t>(piece)});
      length -= piece;
      for (std::uint32_t i = 0; i < piece && length > 0; ++i) step(place);
    }
  }
  // Walks on over triangles that were not seen; `place` becomes the last one. Returns how many.
  std::uint32_t see_from(Place& place) {
    std::uint32_t length = 1;
    see(place);
    for (Place next = place; step(next) && !seen(next); ++length) {
      place = next;
      see(place);
    }
    return length;
  }

  // Links a row where all of it is free; else puts back its pieces that are.
  void take(const Row& row) {
    if (!is_free(row)) return split(row);
    Place place = row.begin;
    taken_[place.exit / 3] = 1;
    for (std::uint32_t left = row.length - 1; left > 0; --left) {
      const std::uint32_t crossed = place.exit;
      step(place);
      // A row may cross itself.
      if (taken_[place.exit / 3]) return split({place, static_cast<std::uint8_t>(left)});
      paths_.link(crossed);
      taken_[place.exit / 3] = 1;
    }
  }
  [[nodiscard]] bool is_free(const Row& row) const {
    Place place = row.begin;
    for (std::uint32_t i = 0; i < row.length; ++i, step(place))
      if (taken_[place.exit / 3]) return false;
    return true;
  }
  void split(const Row& row) {
    Place place = row.begin;
    Row piece{place, 0};
    for (std::uint32_t i = 0; i < row.length; ++i, step(place)) {
      if (taken_[place.exit / 3]) {
        push(piece);
        piece.length = 0;
      } else {
        if (piece.length == 0) piece.begin = place;
        ++piece.length;
      }
    }
    push(piece);
  }

  StripPaths& paths_;
  std::vector<std::uint8_t>& taken_;
  std::uint32_t least_;
  std::vector<std::uint8_t> seen_;  // per triangle, a bit per axis
  std::array<std::vector<Row>, kLongest + 1> rows_;
};

}  // namespace

void link_rows(StripPaths& paths, std::vector<std::uint8_t>& taken, std::uint32_t least) {
  RowTaker(paths, taken, least).run();
}

}  // namespace varifold
