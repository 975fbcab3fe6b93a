// Strips of fronts against the triangles that they are made of, and against the rule word by word.
#include <gtest/gtest.h>
#include <tests/models/vdpm/vdpm_support.h>

#include <varifold/models/vdpm/front_strips.h>
#include <varifold/strip/triangle_strips.h>
#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <utility>

namespace varifold::test {
namespace {

using Corners = std::array<std::uint32_t, 3>;

struct ListedTriangle {
  Corners corners{};
  std::uint32_t material = 0;
  auto operator<=>(const ListedTriangle&) const = default;
};

std::vector<ListedTriangle> listed(const DrawList& list) {
  std::vector<ListedTriangle> all;
  for (const DrawRange& range : list.ranges)
    for (std::uint32_t i = range.first_index; i < range.first_index + range.index_count; i += 3)
      all.push_back({{list.indices[i], list.indices[i + 1], list.indices[i + 2]}, range.material});
  return all;
}

bool has_area(const Corners& c) { return c[0] != c[1] && c[1] != c[2] && c[2] != c[0]; }

std::vector<ListedTriangle> sorted(std::vector<ListedTriangle> triangles) {
  std::erase_if(triangles, [](const ListedTriangle& t) { return !has_area(t.corners); });
  for (ListedTriangle& t : triangles)
    std::rotate(t.corners.begin(), std::min_element(t.corners.begin(), t.corners.end()),
                t.corners.end());
  std::sort(triangles.begin(), triangles.end());
  return triangles;
}

// As a device reads strips: orientation flips from triangle to triangle, and begins anew after a
// restart.
std::vector<ListedTriangle> drawn(const DrawList& list) {
  std::vector<ListedTriangle> all;
  for (const DrawRange& range : list.ranges) {
    EXPECT_EQ(range.primitive, Primitive::kStrips);
    std::vector<std::uint32_t> strip;
    for (const std::uint32_t v : list.indices.subspan(range.first_index, range.index_count)) {
      if (v == kStripRestart) {
        strip.clear();
        continue;
      }
      strip.push_back(v);
      const std::size_t n = strip.size();
      if (n < 3) continue;
      Corners corners{strip[n - 3], strip[n - 2], strip[n - 1]};
      if (n % 2 == 0) std::swap(corners[0], corners[1]);
      all.push_back({corners, range.material});
    }
  }
  return all;
}

// The rule in terms of maps and paths: which triangles follow each other in a strip.
class SimpleSpirals {
 public:
  using Path = std::vector<ListedTriangle>;

  explicit SimpleSpirals(std::vector<ListedTriangle> triangles) : triangles_(std::move(triangles)) {
    for (std::size_t t = 0; t < triangles_.size(); ++t) {
      if (!has_area(triangles_[t].corners)) continue;
      free_.insert(t);
      for (std::size_t e = 0; e < 3; ++e)
        on_edge_.insert({{corner(t, e), corner(t, e + 1)}, t});  // unless there is one before it
    }
    while (!free_.empty()) paths_.push_back(path_from(*free_.begin()));
  }
  [[nodiscard]] const std::vector<Path>& paths() const { return paths_; }

 private:
  [[nodiscard]] std::uint32_t corner(std::size_t t, std::size_t i) const {
    return triangles_[t].corners[i % 3];
  }
  // The free neighbour across edge e of triangle t.
  [[nodiscard]] std::optional<std::size_t> across(std::size_t t, std::size_t e) const {
    const auto found = on_edge_.find({corner(t, e + 1), corner(t, e)});
    const bool is_free = found != on_edge_.end() && free_.contains(found->second) &&
                         triangles_[found->second].material == triangles_[t].material;
    return is_free ? std::optional(found->second) : std::nullopt;
  }
  Path path_from(std::size_t first) {
    Path path{triangles_[first]};
    free_.erase(first);
    std::size_t here = first;
    std::array<std::size_t, 3> exits{1, 2, 0};
    std::size_t exit_count = 3;
    for (;;) {
      std::optional<std::size_t> next;
      std::size_t left_by = 0;
      for (std::size_t i = 0; i < exit_count && !next; ++i) next = across(here, left_by = exits[i]);
      if (!next) return path;
      // Seen from its front, with the way in from below, the edge on the right is the one after
      // that: clockwise.
      std::size_t entry = 0;
      while (corner(*next, entry) != corner(here, left_by + 1) ||
             corner(*next, entry + 1) != corner(here, left_by))
        ++entry;
      here = *next;
      exits = {(entry + 1) % 3, (entry + 2) % 3, 0};
      exit_count = 2;
      path.push_back(triangles_[here]);
      free_.erase(here);
    }
  }

  std::vector<ListedTriangle> triangles_;
  std::set<std::size_t> free_;
  std::map<std::array<std::uint32_t, 2>, std::size_t> on_edge_;
  std::vector<Path> paths_;
};

Corners turned(Corners c) {
  std::rotate(c.begin(), std::min_element(c.begin(), c.end()), c.end());
  return c;
}

std::vector<std::vector<Corners>> paths_of(const DrawList& list) {
  std::vector<std::vector<Corners>> paths;
  for (const DrawRange& range : list.ranges) {
    const TriangleStrips strips = strips_of(list.indices, {&range, 1});
    for (std::uint32_t s = 0; s < strips.count(); ++s) {
      std::vector<Corners>& path = paths.emplace_back();
      for (std::size_t i = 0; i + 2 < strips.strip(s).size(); ++i) {
        const Corners corners = strip_triangle(strips.strip(s), i);
        if (has_area(corners)) path.push_back(turned(corners));
      }
    }
  }
  return paths;
}

std::vector<std::vector<Corners>> paths_of(const SimpleSpirals& spirals) {
  std::vector<std::vector<Corners>> paths;
  for (const SimpleSpirals::Path& from : spirals.paths()) {
    std::vector<Corners>& path = paths.emplace_back();
    for (const ListedTriangle& t : from) path.push_back(turned(t.corners));
  }
  return paths;
}

// Repeats turn a strip inside, and once is enough.
void expect_no_waste(const DrawList& list, const std::string& where) {
  const TriangleStrips strips = strips_of(list.indices, list.ranges);
  for (std::uint32_t s = 0; s < strips.count(); ++s) {
    const auto strip = strips.strip(s);
    bool before = false;
    for (std::size_t i = 0; i + 2 < strip.size(); ++i) {
      const bool now = has_area(strip_triangle(strip, i));
      ASSERT_TRUE(before || now) << where;
      before = now;
    }
    ASSERT_TRUE(before) << where;
  }
}

template <class Visit>
void for_each_front(const Visit& visit) {
  for (const NamedVdpm& named : all_vdpms()) {
    ActiveSurface surface(*named.model);
    RandomWalk walk(*named.model, 31);
    int stage = 0;
    visit(surface.draw_list(), named.name + ", base");
    for (const double upwards : {0.9, 0.5, 1.0, 0.1}) {
      walk.walk(surface, 2 * named.model->step_count() + 1, upwards);
      visit(surface.draw_list(), named.name + ", stage " + std::to_string(stage++));
    }
  }
}

TEST(FrontStrips, DrawTheTrianglesOfTheFront) {
  FrontStrips strips;
  for_each_front([&](const DrawList& triangles, const std::string& where) {
    const auto expected = sorted(listed(triangles));
    for (const StripJoin join : {StripJoin::kRestart, StripJoin::kDegenerate}) {
      const DrawList list = strips.build(triangles, join);
      ASSERT_TRUE(sorted(drawn(list)) == expected) << where;
      const auto restarts = std::count(list.indices.begin(), list.indices.end(), kStripRestart);
      if (join == StripJoin::kDegenerate) {
        ASSERT_EQ(restarts, 0) << where;
      }
      ASSERT_EQ(list.positions.data(), triangles.positions.data()) << where;
      ASSERT_EQ(list.normals.data(), triangles.normals.data()) << where;
      std::size_t end = 0;
      for (const DrawRange& range : list.ranges) {
        ASSERT_EQ(range.first_index, end) << where;
        ASSERT_GE(range.index_count, 3u) << where;
        end += range.index_count;
      }
      ASSERT_EQ(list.indices.size(), end) << where;
    }
  });
}

TEST(FrontStrips, FollowTheRule) {
  FrontStrips strips;
  std::size_t several = 0;
  for_each_front([&](const DrawList& triangles, const std::string& where) {
    const DrawList list = strips.build(triangles);
    const SimpleSpirals simple(listed(triangles));
    ASSERT_TRUE(paths_of(list) == paths_of(simple)) << where;
    expect_no_waste(list, where);
    for (const auto& path : simple.paths()) several += path.size() > 3 ? 1 : 0;
  });
  EXPECT_GT(several, 1000u);
}

TEST(FrontStrips, MadeAgainAreTheSame) {
  FrontStrips strips;
  for_each_front([&](const DrawList& triangles, const std::string& where) {
    for (const StripJoin join : {StripJoin::kRestart, StripJoin::kDegenerate}) {
      const auto first = strips.build(triangles, join).indices;
      const std::vector<std::uint32_t> kept(first.begin(), first.end());
      FrontStrips fresh;
      const DrawList list = strips.build(triangles, join);
      ASSERT_TRUE(std::ranges::equal(list.indices, kept)) << where;
      ASSERT_TRUE(std::ranges::equal(fresh.build(triangles, join).indices, kept)) << where;
    }
  });
}

DrawList one_range(std::span<const std::uint32_t> indices, std::span<const Vec3> positions,
                   DrawRange& range) {
  range = {0, static_cast<std::uint32_t>(indices.size()), Primitive::kTriangles, 0, 1};
  DrawList list;
  list.positions = positions;
  list.indices = indices;
  list.ranges = {&range, 1};
  return list;
}

//  5---3---4    From the lowest triangle up into the middle one; there clockwise is to the right,
//   \ / \ /     which takes a repeated 1. What is on the left is a strip of its own.
//    2---1
//     \ /
//      0
TEST(FrontStrips, TurnClockwiseFirst) {
  const std::vector<std::uint32_t> triangles{0, 1, 2, 2, 1, 3, 2, 3, 5, 3, 1, 4};
  const std::vector<Vec3> positions(6, Vec3(0));
  DrawRange range;
  FrontStrips strips;
  const DrawList list = strips.build(one_range(triangles, positions, range));
  const std::vector<std::uint32_t> expected{0, 1, 2, 1, 3, 4, kStripRestart, 2, 3, 5};
  EXPECT_TRUE(std::ranges::equal(list.indices, expected));
  const DrawList joined =
      strips.build(one_range(triangles, positions, range), StripJoin::kDegenerate);
  EXPECT_TRUE(std::ranges::equal(joined.indices,
                                 std::vector<std::uint32_t>{0, 1, 2, 1, 3, 4, 4, 2, 2, 3, 5}));
}

//    3---2      A hexagon about 0. The first triangle, (0, 1, 2), has no neighbour across 1 2;
//    across
//   / \ / \     2 0 clockwise would be about 2, where the border is: so round 0 the other way.
//  4---0---1
//   \ / \ /
//    5---6
TEST(FrontStrips, GoRoundAVertexWhereNothingElseIsLeft) {
  const std::vector<std::uint32_t> fan{0, 1, 2, 0, 2, 3, 0, 3, 4, 0, 4, 5, 0, 5, 6, 0, 6, 1};
  const std::vector<Vec3> positions(7, Vec3(0));
  DrawRange range;
  FrontStrips strips;
  const DrawList list = strips.build(one_range(fan, positions, range));
  EXPECT_TRUE(std::ranges::equal(list.indices,
                                 std::vector<std::uint32_t>{1, 2, 0, 3, 0, 4, 0, 5, 0, 6, 1}));
}

// 6---7---8    Material 2 has the squares on the left, in two ranges, and 1 those on the right.
// | \ | \ |
// 3---4---5
// | \ | \ |
// 0---1---2
TEST(FrontStrips, StayWithinTheirMaterial) {
  const std::vector<std::uint32_t> squares{4, 3, 1, 0, 1, 3, 1, 2, 4, 2, 5, 4,
                                           3, 4, 6, 4, 7, 6, 4, 5, 7, 5, 8, 7};
  const std::vector<Vec3> positions(9, Vec3(0));
  const DrawRange ranges[] = {{0, 6, Primitive::kTriangles, 2, 1},
                              {12, 6, Primitive::kTriangles, 2, 1},
                              {6, 6, Primitive::kTriangles, 1, 1},
                              {18, 6, Primitive::kTriangles, 1, 1}};
  DrawRange all;
  DrawList triangles = one_range(squares, positions, all);
  triangles.ranges = ranges;
  FrontStrips strips;
  const DrawList list = strips.build(triangles);
  ASSERT_EQ(list.ranges.size(), 2u);
  EXPECT_EQ(list.ranges[0].material, 2u);
  EXPECT_EQ(list.ranges[1].material, 1u);
  EXPECT_TRUE(sorted(drawn(list)) == sorted(listed(triangles)));
}

TEST(FrontStrips, OfAnInstanceAreThoseOfItsTriangles) {
  for (const NamedMesh& mesh : {NamedMesh{"sphere", icosphere(5000)}, group_seams().back()}) {
    const NamedVdpm named = make_vdpm(mesh, Placement::kKept);
    ViewDependentInstance shown(named.model), other(named.model);
    DeviceCopy device;
    for (int frame = 0; frame < 60; ++frame) {
      // Now and then the camera rests, and now and then someone else asks for the triangles.
      const auto angle = 0.05f * static_cast<float>(frame - frame % 4);
      const auto criteria = orbit_view(named.model->bounding_ball(), angle);
      (void)shown.adapt(criteria, {0.5f, kNone});
      (void)other.adapt(criteria, {0.5f, kNone});
      if (frame % 7 == 0) (void)shown.draw_list();
      const StripJoin join = frame % 11 < 9 ? StripJoin::kRestart : StripJoin::kDegenerate;
      const DrawList list = shown.draw_strips(join), triangles = other.draw_list();
      const std::string where = named.name + ", frame " + std::to_string(frame);
      ASSERT_TRUE(sorted(drawn(list)) == sorted(listed(triangles))) << where;
      if (frame % 7 != 0) device.take(list);
      if (frame % 7 == 0) device = {}, device.take(list);
      device.expect_same(list, where);
      if (frame % 4 != 0 && frame % 7 != 0 && frame % 11 != 9 && frame % 11 != 0) {
        ASSERT_TRUE(list.changed_indices.empty()) << where;
      }
    }
  }
}

}  // namespace
}  // namespace varifold::test
