#include <tests/models/strips/strips_support.h>

#include <varifold/base/random.h>
#include <varifold/simplify/simplify.h>
#include <algorithm>
#include <cstring>
#include <map>
#include <utility>

namespace varifold::test {

namespace {

class GreedyStrips {
 public:
  GreedyStrips(const TriangleMesh& mesh, std::uint64_t seed) : mesh_(mesh), random_(seed) {
    used_.assign(mesh.triangle_count(), false);
    range_of_.assign(mesh.triangle_count(), 0);
    for (std::uint32_t r = 0; r < mesh.ranges.size(); ++r)
      std::fill_n(range_of_.begin() + mesh.ranges[r].first_triangle, mesh.ranges[r].triangle_count,
                  r);
    for (std::uint32_t slot = 0; slot < mesh.indices.size(); ++slot)
      slots_.emplace(std::pair{corner(slot), corner(next(slot))}, slot);
    for (std::uint32_t t = 0; t < mesh.triangle_count(); ++t)
      if (!used_[t]) strip_from(t);
    end_strip();
  }
  TriangleStrips take() { return std::move(strips_); }

 private:
  static std::uint32_t next(std::uint32_t slot) { return slot % 3 == 2 ? slot - 2 : slot + 1; }
  std::uint32_t corner(std::uint32_t slot) const { return mesh_.indices[slot]; }

  void strip_from(std::uint32_t t) {
    std::vector<std::uint32_t>& indices = strips_.indices;
    const bool same_range = indices.size() > strips_.first.back() && range_ == range_of_[t];
    if (same_range && random_.below(2) == 0) {
      // Two indices repeated, or three, so that the new triangle stands at an even place.
      const std::uint32_t last = indices.back(), count = here();
      indices.push_back(last);
      if (count % 2 == 1) indices.push_back(last);
      indices.push_back(corner(3 * t));
    } else {
      end_strip();
    }
    range_ = range_of_[t];
    used_[t] = true;
    for (std::uint32_t c = 0; c < 3; ++c) indices.push_back(corner(3 * t + c));
    while (go_on()) continue;
  }
  std::uint32_t here() const {
    return static_cast<std::uint32_t>(strips_.indices.size()) - strips_.first.back();
  }
  bool go_on() {
    const std::uint32_t a = strips_.indices[strips_.indices.size() - 2], b = strips_.indices.back();
    const bool odd = here() % 2 == 1;  // of the triangle that comes next
    const auto found = slots_.equal_range(odd ? std::pair{b, a} : std::pair{a, b});
    for (auto i = found.first; i != found.second; ++i) {
      const std::uint32_t t = i->second / 3;
      if (used_[t] || range_of_[t] != range_) continue;
      used_[t] = true;
      strips_.indices.push_back(corner(next(next(i->second))));
      return true;
    }
    return false;
  }
  void end_strip() {
    if (here() > 0) strips_.end_strip(range_);
  }

  const TriangleMesh& mesh_;
  Random random_;
  std::vector<bool> used_;
  std::vector<std::uint32_t> range_of_;
  std::multimap<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> slots_;
  TriangleStrips strips_;
  std::uint32_t range_ = 0;
};

bool same(std::span<const std::uint32_t> a, std::span<const std::uint32_t> b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end());
}

}  // namespace

TriangleStrips greedy_strips(const TriangleMesh& mesh, std::uint64_t seed) {
  return GreedyStrips(mesh, seed).take();
}

NamedFramework make_framework(const NamedMesh& named) {
  SimplifyOptions options;
  options.threads = 1;
  NamedFramework result;
  result.name = named.name;
  result.detailed = std::move(simplify(named.mesh, options)->detailed);
  result.model = std::make_shared<StripFramework>(
      build_strip_framework(result.detailed, greedy_strips(result.detailed.mesh)));
  return result;
}

const std::vector<NamedFramework>& all_frameworks() {
  static const std::vector<NamedFramework> models = [] {
    std::vector<NamedFramework> made;
    for (const NamedMesh& named : all_groups()) made.push_back(make_framework(named));
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
    if (c[0] == c[1] || c[1] == c[2] || c[2] == c[0]) continue;
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
