#include <tests/models/strips/strips_support.h>

#include <varifold/base/random.h>
#include <varifold/simplify/simplify.h>
#include <algorithm>
#include <cstring>
#include <map>
#include <utility>

namespace varifold::test {

namespace {

bool same(std::span<const std::uint32_t> a, std::span<const std::uint32_t> b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end());
}

}  // namespace

// Wedges that differ in their normals are no seam to the simplifier, so a vertex with one of them
// may go to a point that has several.
NamedMesh torn_sphere(std::uint64_t seed) {
  Random random(seed);
  const TriangleMesh whole = icosphere(500);
  TriangleMesh mesh;
  mesh.positions = mesh.normals = whole.positions;
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> wedges;
  for (const std::uint32_t v : whole.indices) {
    const std::uint32_t sheet = random.below(100) < 10 ? 1 + random.below(2) : 0;
    const auto [found, is_new] = wedges.try_emplace({v, sheet}, v);
    if (is_new && sheet > 0) {
      found->second = mesh.vertex_count();
      mesh.positions.push_back(whole.positions[v]);
      const Vec3 tilt = 0.3f * Vec3(static_cast<float>(sheet), 0, -1);
      mesh.normals.push_back(glm::normalize(whole.positions[v] + tilt));
    }
    mesh.indices.push_back(found->second);
  }
  return {"torn_sphere_" + std::to_string(seed), mesh};
}

// Bumpy, so that collapses come in no particular order. Each tip goes without changing any other
// triangle, two of them at every vertex of the border.
NamedMesh fringed_sheet(std::uint64_t seed) {
  Random random(seed);
  TriangleMesh mesh = grid(8, 8);
  const std::vector<std::uint32_t> indices = mesh.indices;
  for (std::size_t slot = 0; slot < indices.size(); ++slot) {
    const std::uint32_t a = indices[slot], b = indices[slot % 3 == 2 ? slot - 2 : slot + 1];
    bool is_border = true;
    for (std::size_t other = 0; other < indices.size(); ++other)
      if (indices[other] == b && indices[other % 3 == 2 ? other - 2 : other + 1] == a)
        is_border = false;
    if (!is_border) continue;
    const Vec3 along = mesh.positions[b] - mesh.positions[a];
    const Vec3 middle = 0.5f * (mesh.positions[a] + mesh.positions[b]);
    mesh.indices.insert(mesh.indices.end(), {b, a, mesh.vertex_count()});
    mesh.positions.push_back(middle + Vec3(along.y, -along.x, 0));
  }
  for (Vec3& p : mesh.positions) p.z = static_cast<float>(0.4 * random.uniform());
  return {"fringed_sheet_" + std::to_string(seed), mesh};
}

NamedFramework make_framework(const NamedMesh& named) {
  SimplifyOptions options;
  options.threads = 1;
  NamedFramework result;
  result.name = named.name;
  result.detailed = std::move(simplify(named.mesh, options)->detailed);
  result.model = std::make_shared<StripFramework>(
      build_strip_framework(result.detailed, some_strips(result.detailed.mesh)));
  return result;
}

const std::vector<NamedFramework>& all_frameworks() {
  static const std::vector<NamedFramework> models = [] {
    std::vector<NamedFramework> made;
    for (const NamedMesh& named : all_groups()) made.push_back(make_framework(named));
    for (const std::uint64_t seed : {1u, 2u, 3u}) {
      made.push_back(make_framework(torn_sphere(seed)));
      made.push_back(make_framework(fringed_sheet(seed)));
    }
    return made;
  }();
  return models;
}

std::vector<const NamedFramework*> small_frameworks(std::uint32_t levels) {
  std::vector<const NamedFramework*> small;
  for (const NamedFramework& model : all_frameworks())
    if (model.model->finest_level() <= levels) small.push_back(&model);
  return small;
}

std::vector<std::uint32_t> spread_levels(std::uint32_t finest) {
  std::vector<std::uint32_t> levels;
  const std::uint32_t count = finest <= 200 ? finest : 40u;
  for (std::uint32_t i = 0; i <= count; ++i)
    levels.push_back(count == 0 ? 0
                                : static_cast<std::uint32_t>(std::uint64_t{finest} * i / count));
  return levels;
}

Triangle turned(std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t material) {
  Triangle triangle{a, b, c, material};
  std::rotate(triangle.begin(), std::min_element(triangle.begin(), triangle.begin() + 3),
              triangle.begin() + 3);
  return triangle;
}

std::vector<Triangle> triangle_set(const TriangleMesh& mesh) {
  std::vector<Triangle> triangles;
  const std::vector<std::uint32_t> materials = triangle_materials(mesh);
  for (std::uint32_t t = 0; t < mesh.triangle_count(); ++t) {
    const std::uint32_t* c = &mesh.indices[3 * std::size_t{t}];
    if (c[0] == c[1] || c[1] == c[2] || c[2] == c[0]) continue;
    triangles.push_back(turned(c[0], c[1], c[2], materials[t]));
  }
  std::sort(triangles.begin(), triangles.end());
  return triangles;
}

std::vector<Triangle> triangle_set(const DrawList& list) {
  std::vector<Triangle> triangles;
  for (const DrawRange& range : list.ranges) {
    std::vector<std::uint32_t> strip;
    for (std::uint32_t i = 0; i < range.index_count; ++i) {
      const std::uint32_t index = list.indices[range.first_index + i];
      if (index == kStripRestart) {
        strip.clear();
        continue;
      }
      strip.push_back(index);
      if (strip.size() < 3) continue;
      const std::uint32_t* c = strip.data() + strip.size() - 3;
      if (c[0] == c[1] || c[1] == c[2] || c[2] == c[0]) continue;
      triangles.push_back(strip.size() % 2 == 1 ? turned(c[0], c[1], c[2], range.material)
                                                : turned(c[1], c[0], c[2], range.material));
    }
  }
  std::sort(triangles.begin(), triangles.end());
  return triangles;
}

TriangleMesh mesh_of_front(const DetailedMesh& detailed, const std::vector<bool>& split) {
  const CollapseSequence& sequence = detailed.sequence;
  std::vector<std::uint32_t> step_of(detailed.mesh.vertex_count(), kNone);
  for (std::uint32_t k = 0; k < sequence.step_count(); ++k)
    for (std::uint32_t v = sequence.vertices[k]; v < sequence.vertices[k + 1]; ++v) step_of[v] = k;
  TriangleMesh mesh = detailed.mesh;
  for (std::uint32_t& corner : mesh.indices)
    while (step_of[corner] != kNone && !split[step_of[corner]]) corner = sequence.target[corner];
  // Without the triangles that have vanished.
  const std::vector<std::uint32_t> materials = triangle_materials(mesh);
  std::vector<std::uint32_t> indices, kept;
  for (std::uint32_t t = 0; t < mesh.triangle_count(); ++t) {
    const std::uint32_t* c = &mesh.indices[3 * std::size_t{t}];
    const Vec3 p = mesh.positions[c[0]], q = mesh.positions[c[1]], r = mesh.positions[c[2]];
    if (p == q || q == r || r == p) continue;
    indices.insert(indices.end(), c, c + 3);
    kept.push_back(materials[t]);
  }
  mesh.indices = std::move(indices);
  const bool has_ranges = !mesh.ranges.empty();
  mesh.ranges.clear();
  if (has_ranges) set_triangle_materials(mesh, kept);
  return mesh;
}

std::vector<bool> splits_of(const StripFrameworkInstance& instance) {
  std::vector<bool> split(instance.model().finest_level());
  for (std::uint32_t k = 0; k < split.size(); ++k) split[k] = instance.is_split(k);
  return split;
}

std::vector<std::vector<std::uint32_t>> dependencies_of(const StripFramework& model) {
  std::vector<std::vector<std::uint32_t>> of(model.finest_level());
  std::size_t at = 0;
  for (std::size_t k = of.size(); k-- > 0;) {
    bool last = false;
    while (!last) {
      const std::uint32_t word = model.data().dependencies[at++];
      last = word >> 31 != 0;
      if (word != kNone) of[k].push_back(word & 0x7fffffffu);
    }
  }
  return of;
}

std::string difference(StripFrameworkInstance& a, StripFrameworkInstance& b) {
  if (a.level() != b.level()) return "level";
  if (a.vertex_count() != b.vertex_count()) return "vertices";
  if (a.triangle_count() != b.triangle_count()) return "triangles";
  if (splits_of(a) != splits_of(b)) return "splits";
  if (a.slots() != b.slots()) return "slots";
  const DrawList list = a.draw_list(), other = b.draw_list();
  if (!same(list.indices, other.indices)) return "drawn indices";
  const auto same_range = [](const DrawRange& x, const DrawRange& y) {
    return x.first_index == y.first_index && x.index_count == y.index_count &&
           x.primitive == y.primitive && x.material == y.material && x.level == y.level;
  };
  if (!std::equal(list.ranges.begin(), list.ranges.end(), other.ranges.begin(), other.ranges.end(),
                  same_range))
    return "ranges";
  return {};
}

}  // namespace varifold::test
