#include <tests/morph/disc_shapes.h>
#include <varifold/base/angle.h>
#include <varifold/base/random.h>
#include <varifold/mesh/generators.h>
#include <varifold/mesh/topology.h>
#include <varifold/mesh/weld.h>
#include <varifold/morph/repair_sphere.h>
#include <map>
#include <utility>

namespace varifold::test {

TriangleMesh cut_disc(const TriangleMesh& mesh,
                      const std::function<bool(const Vec3& middle)>& is_kept) {
  TriangleMesh cut = mesh;
  cut.indices.clear();
  for (std::size_t t = 0; t < mesh.indices.size(); t += 3) {
    Vec3 middle(0);
    for (std::size_t k = 0; k < 3; ++k) middle += mesh.positions[mesh.indices[t + k]] / 3.0f;
    if (is_kept(middle))
      cut.indices.insert(cut.indices.end(), mesh.indices.begin() + static_cast<std::ptrdiff_t>(t),
                         mesh.indices.begin() + static_cast<std::ptrdiff_t>(t) + 3);
  }
  cut.ranges.clear();
  RepairOptions options;
  options.keep_longest_hole = true;
  return repair_to_sphere(cut, options)->mesh;
}

TriangleMesh rough_grid(std::uint32_t columns, std::uint32_t rows, std::uint64_t seed) {
  Random random(seed);
  TriangleMesh mesh;
  const auto number = [&](std::uint32_t x, std::uint32_t y) { return y * (columns + 1) + x; };
  for (std::uint32_t y = 0; y <= rows; ++y)
    for (std::uint32_t x = 0; x <= columns; ++x) {
      const bool is_inside = x > 0 && y > 0 && x < columns && y < rows;
      const auto shift = [&] {
        return is_inside ? 0.6f * (static_cast<float>(random.uniform()) - 0.5f) : 0.0f;
      };
      const float px = (static_cast<float>(x) + shift()) / static_cast<float>(columns);
      const float py = (static_cast<float>(y) + shift()) / static_cast<float>(rows);
      mesh.positions.emplace_back(px, py, 0.15f * static_cast<float>(random.uniform()));
    }
  for (std::uint32_t y = 0; y < rows; ++y)
    for (std::uint32_t x = 0; x < columns; ++x) {
      const std::uint32_t p = number(x, y), q = number(x + 1, y), r = number(x + 1, y + 1),
                          s = number(x, y + 1);
      if (random.below(2) == 0)
        mesh.indices.insert(mesh.indices.end(), {p, q, r, p, r, s});
      else
        mesh.indices.insert(mesh.indices.end(), {p, q, s, q, r, s});
    }
  return mesh;
}

TriangleMesh fan(std::uint32_t corners) {
  TriangleMesh mesh;
  mesh.positions.emplace_back(0, 0, 0.3f);
  for (std::uint32_t i = 0; i < corners; ++i) {
    const glm::dvec2 way = unit_circle(i, corners);
    mesh.positions.emplace_back(way.x, way.y, 0.1 * (i % 3));
    mesh.indices.insert(mesh.indices.end(), {0, i + 1, (i + 1) % corners + 1});
  }
  return mesh;
}

TriangleMesh spiral(std::uint32_t length, float turns) {
  TriangleMesh mesh;
  for (std::uint32_t i = 0; i <= length; ++i) {
    const float along = static_cast<float>(i) / static_cast<float>(length);
    const auto step = static_cast<std::uint64_t>(along * turns * 1'000'000.0f);
    const Vec2 way(unit_circle(step, 1'000'000));
    const float radius = 1 - 0.9f * along, width = 0.5f / turns;
    mesh.positions.emplace_back(way * radius, 0.3f * along);
    mesh.positions.emplace_back(way * (radius + width), 0.3f * along);
    if (i == length) break;
    const std::uint32_t p = 2 * i;
    mesh.indices.insert(mesh.indices.end(), {p, p + 1, p + 3, p, p + 3, p + 2});
  }
  return mesh;
}

TriangleMesh with_ears(const TriangleMesh& disc) {
  TriangleMesh mesh = disc;
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> runs;
  for (std::size_t h = 0; h < disc.indices.size(); ++h)
    ++runs[{disc.indices[h], disc.indices[h % 3 == 2 ? h - 2 : h + 1]}];
  Vec3 middle(0);
  for (const Vec3& p : disc.positions) middle += p / static_cast<float>(disc.positions.size());
  for (const auto& [edge, count] : runs) {
    if (runs.contains({edge.second, edge.first})) continue;
    const Vec3 between = 0.5f * (disc.positions[edge.first] + disc.positions[edge.second]);
    const auto tip = static_cast<std::uint32_t>(mesh.positions.size());
    mesh.positions.push_back(between + 0.2f * (between - middle) + Vec3(0, 0, 0.05f));
    mesh.indices.insert(mesh.indices.end(), {edge.second, edge.first, tip});
  }
  return mesh;
}

TriangleMesh random_chords(std::uint32_t corners, std::uint64_t seed) {
  Random random(seed);
  TriangleMesh mesh;
  std::vector<std::uint32_t> left;
  for (std::uint32_t i = 0; i < corners; ++i) {
    const glm::dvec2 way = unit_circle(i, corners);
    mesh.positions.emplace_back(way.x, way.y, 0.3 * random.uniform());
    left.push_back(i);
  }
  while (left.size() > 2) {
    const auto size = static_cast<std::uint32_t>(left.size());
    const std::uint32_t i = random.below(size);
    mesh.indices.insert(mesh.indices.end(),
                        {left[(i + size - 1) % size], left[i], left[(i + 1) % size]});
    left.erase(left.begin() + i);
  }
  return mesh;
}

std::vector<NamedMesh> small_discs() {
  PlanetOptions rough;
  rough.triangles = 600;
  rough.relief = 0.4f;
  TriangleMesh thin = rough_grid(40, 2, 5);
  for (Vec3& p : thin.positions) p *= Vec3(30, 1, 1);
  return {
      {"triangle", make_mesh({{0, 0, 0}, {3, 0, 0}, {0, 1, 0}}, {0, 1, 2})},
      {"two triangles",
       make_mesh({{0, 0, 0}, {1, 0, 0}, {1, 1, 0.5f}, {0, 1, 0}}, {0, 1, 2, 0, 2, 3})},
      {"fan", fan(7)},
      {"fan of three", fan(3)},
      {"grid", grid(5, 4)},
      {"rough grid", rough_grid(12, 9, 3)},
      {"strip", grid(14, 1)},
      {"spiral", spiral(60, 3)},
      {"chords", random_chords(40, 2)},
      {"ears", with_ears(rough_grid(4, 4, 1))},
      {"ears of a triangle", with_ears(make_mesh({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {0, 1, 2}))},
      {"long and thin", thin},
      {"half a planet", cut_disc(planet(rough), [](const Vec3& p) { return p.y > 0; })},
      {"most of a planet", cut_disc(planet(rough), [](const Vec3& p) { return p.y > -0.7f; })},
  };
}

}  // namespace varifold::test
