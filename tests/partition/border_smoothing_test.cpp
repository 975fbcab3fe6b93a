// Borders get shorter by smoothing until no path beside them is.
#include <gtest/gtest.h>
#include <tests/partition/patch_checks.h>
#include <varifold/mesh/generators.h>
#include <varifold/partition/patches.h>
#include <algorithm>
#include <limits>
#include <map>
#include <set>

namespace varifold::test {
namespace {

struct RoughAndSmooth {
  Partition rough, smooth;
};

RoughAndSmooth both(const TestSurface& surface, std::uint32_t size) {
  return {make_patches(surface.view(), {.triangles_per_patch = size, .smooth = false}),
          make_patches(surface.view(), {.triangles_per_patch = size})};
}

double edge_length(const TestSurface& surface, const Edge& edge) {
  return glm::distance(DVec3(surface.positions[edge.first]), DVec3(surface.positions[edge.second]));
}

// The length of the border between every two patches.
std::map<Edge, double> border_lengths(const TestSurface& surface,
                                      const std::vector<std::uint32_t>& patch_of) {
  std::map<Edge, double> lengths;
  for (const auto& [edge, triangles] : triangles_of_edges(surface))
    if (triangles.size() == 2 && patch_of[triangles[0]] != patch_of[triangles[1]])
      lengths[std::minmax(patch_of[triangles[0]], patch_of[triangles[1]])] +=
          edge_length(surface, edge);
  return lengths;
}

TEST(BorderSmoothing, LengthensNoBorder) {
  for (const TestSurface& surface : partition_surfaces())
    for (const std::uint32_t size : {16u, 100u, 400u}) {
      SCOPED_TRACE(surface.name + " " + std::to_string(size));
      const auto [rough, smooth] = both(surface, size);
      ASSERT_EQ(rough.patch_count, smooth.patch_count);
      const auto before = border_lengths(surface, rough.patch_of);
      const auto after = border_lengths(surface, smooth.patch_of);
      EXPECT_EQ(before.size(), after.size()) << "the same patches are neighbours";
      double total = 0, rough_total = 0;
      for (const auto& [pair, length] : after) {
        ASSERT_TRUE(before.count(pair));
        EXPECT_LE(length, before.at(pair) * (1 + 1e-6));
        total += length;
      }
      for (const auto& [pair, length] : before) rough_total += length;
      EXPECT_NEAR(smooth.border_length, total, 1e-5 * total);
      EXPECT_NEAR(smooth.rough_border_length, rough_total, 1e-5 * rough_total);
    }
}

TEST(BorderSmoothing, KeepsThePatchesWhatTheyAre) {
  for (const TestSurface& surface : partition_surfaces())
    for (const std::uint32_t size : {4u, 16u, 100u}) {
      SCOPED_TRACE(surface.name + " " + std::to_string(size));
      const auto [rough, smooth] = both(surface, size);
      const auto before = triangles_by_label(rough.patch_of, rough.patch_count);
      const auto after = triangles_by_label(smooth.patch_of, smooth.patch_count);
      const auto parts_before = connected_parts(surface, rough.patch_of, false);
      const auto parts_after = connected_parts(surface, smooth.patch_of, false);
      for (std::uint32_t p = 0; p < rough.patch_count; ++p) {
        ASSERT_FALSE(after[p].empty());
        EXPECT_EQ(euler_of(surface, after[p]), euler_of(surface, before[p]));
        std::set<std::uint32_t> parts[2];
        for (const std::uint32_t t : before[p]) parts[0].insert(parts_before[t]);
        for (const std::uint32_t t : after[p]) parts[1].insert(parts_after[t]);
        EXPECT_EQ(parts[0].size(), parts[1].size());
      }
    }
}

// What the definition of a corridor says, written down once more with sets.
class Oracle {
 public:
  Oracle(const TestSurface& surface, const std::vector<std::uint32_t>& patch_of)
      : surface_(surface), patch_of_(patch_of), edges_(triangles_of_edges(surface)) {
    for (std::uint32_t h = 0; h < surface.corners.size(); ++h)
      patches_at_[surface.corners[h]].insert(patch_of[h / 3]);
    for (const auto& [edge, triangles] : edges_) {
      neighbors_[edge.first].insert(edge.second);
      neighbors_[edge.second].insert(edge.first);
      if (triangles.size() != 2) {
        fixed_.insert({edge.first, edge.second});
      } else if (patch_of[triangles[0]] != patch_of[triangles[1]]) {
        border_[edge.first].push_back(edge.second);
        border_[edge.second].push_back(edge.first);
      }
    }
  }

  // The worst ratio of a shortest path through its corridor and a stretch.
  double worst_ratio() {
    double worst = 1;
    for (const auto& [point, next] : border_)
      if (is_corner(point))
        for (const std::uint32_t second : next)
          worst = std::min(worst, ratio(follow(point, second)));
    return worst;
  }
  std::size_t stretch_count() const { return stretches_; }

 private:
  bool is_corner(std::uint32_t point) { return fixed_.count(point) || border_[point].size() != 2; }
  std::vector<std::uint32_t> follow(std::uint32_t first, std::uint32_t second) {
    std::vector<std::uint32_t> path{first, second};
    while (!is_corner(path.back())) {
      const std::vector<std::uint32_t>& ends = border_[path.back()];
      path.push_back(ends[0] == path[path.size() - 2] ? ends[1] : ends[0]);
    }
    return path;
  }
  double ratio(const std::vector<std::uint32_t>& path) {
    if (path.front() == path.back()) return 1;
    ++stretches_;
    std::set<std::uint32_t> patches;
    for (const std::uint32_t t : edges_.at(std::minmax(path[0], path[1])))
      patches.insert(patch_of_[t]);
    const auto is_inner_edge = [&](std::uint32_t p, std::uint32_t q) {
      const std::vector<std::uint32_t>& triangles = edges_.at(std::minmax(p, q));
      return triangles.size() == 2 && patches.count(patch_of_[triangles[0]]) &&
             patches.count(patch_of_[triangles[1]]);
    };
    std::set<std::uint32_t> corridor(path.begin(), path.end());
    for (const std::uint32_t p : path)
      for (const std::uint32_t q : neighbors_[p])
        if (is_inner_edge(p, q) && !fixed_.count(q) && patches_at_[q].size() == 1)
          corridor.insert(q);

    // The plainest form of the shortest path: relax all edges until nothing changes.
    std::map<std::uint32_t, double> distance;
    for (const std::uint32_t p : corridor) distance[p] = std::numeric_limits<double>::infinity();
    distance[path.front()] = 0;
    for (bool again = true; again;) {
      again = false;
      for (const std::uint32_t p : corridor)
        for (const std::uint32_t q : neighbors_[p])
          if (corridor.count(q) && is_inner_edge(p, q)) {
            const double reached = distance[p] + edge_length(surface_, {p, q});
            if (reached < distance[q]) {
              distance[q] = reached;
              again = true;
            }
          }
    }
    double length = 0;
    for (std::size_t i = 1; i < path.size(); ++i)
      length += edge_length(surface_, {path[i - 1], path[i]});
    return distance[path.back()] / length;
  }

  const TestSurface& surface_;
  const std::vector<std::uint32_t>& patch_of_;
  std::map<Edge, std::vector<std::uint32_t>> edges_;
  std::map<std::uint32_t, std::set<std::uint32_t>> patches_at_, neighbors_;
  std::map<std::uint32_t, std::vector<std::uint32_t>> border_;
  std::set<std::uint32_t> fixed_;
  std::size_t stretches_ = 0;
};

TEST(BorderSmoothing, LeavesNothingToShorten) {
  std::vector<TestSurface> surfaces;
  for (const std::uint64_t seed : {1u, 2u, 3u}) {
    PlanetOptions rough;
    rough.triangles = 9'000;
    rough.seed = seed;
    surfaces.push_back(make_surface("planet " + std::to_string(seed), planet(rough)));
    TerrainOptions hills;
    hills.triangles = 6'000;
    hills.seed = seed;
    surfaces.push_back(make_surface("terrain " + std::to_string(seed), terrain(hills)));
  }
  surfaces.push_back(make_surface("torus", torus({.triangles = 8'000})));
  for (const TestSurface& surface : surfaces)
    for (const std::uint32_t size : {64u, 250u}) {
      SCOPED_TRACE(surface.name + " " + std::to_string(size));
      const auto [rough, smooth] = both(surface, size);
      Oracle before(surface, rough.patch_of), after(surface, smooth.patch_of);
      EXPECT_LT(before.worst_ratio(), 0.9) << "there was something to do";
      EXPECT_GT(after.worst_ratio(), 1 - 2e-5);
      EXPECT_GT(after.stretch_count(), smooth.patch_count);
      EXPECT_LT(smooth.border_length, 0.95 * smooth.rough_border_length);
    }
}

}  // namespace
}  // namespace varifold::test
