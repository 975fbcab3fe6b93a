#include <varifold/models/pm/geomorph.h>

#include <varifold/mesh/pose_blend.h>
#include <varifold/mesh/vertex_arrays.h>
#include <varifold/models/pm/instance.h>
#include <varifold/view/draw_vertices.h>
#include <algorithm>
#include <cmath>
#include <memory>

namespace varifold {

namespace {

// A pointer for an instance that does not outlive the model.
std::shared_ptr<const ProgressiveMesh> borrowed(const ProgressiveMesh& model) {
  return {std::shared_ptr<const ProgressiveMesh>(), &model};
}

template <class V>
V between(const V& a, const V& b, float s) {
  return (1 - s) * a + s * b;  // no overflow, unlike a + s (b - a)
}

Vec3 normal_between(const Vec3& a, const Vec3& b, float s) {
  const Vec3 sum = between(a, b, s);
  const float square = glm::dot(sum, sum);
  // Opposite normals meet at zero: there is no direction in between.
  if (!(square > 1e-12f) || !std::isfinite(square)) return s < 0.5f ? a : b;
  return sum / std::sqrt(square);
}

Color color_between(const Color& a, const Color& b, float s) {
  Color result;
  for (int i = 0; i < 4; ++i)
    result[i] = static_cast<std::uint8_t>(
        std::lround(between(static_cast<float>(a[i]), static_cast<float>(b[i]), s)));
  return result;
}

}  // namespace

Geomorph::Geomorph(const ProgressiveMesh& model, std::uint32_t level, std::uint32_t other_level,
                   const GeomorphOptions& options)
    : options_(options),
      fine_level_(std::min(std::max(level, other_level), model.finest_level())),
      coarse_level_(std::min({level, other_level, model.finest_level()})) {
  options_.share = options.share > 0 ? std::min(options.share, 1.0f) : 1;
  if (model.finest_level() > 0)
    level_fraction_ = static_cast<float>(fine_level_) / static_cast<float>(model.finest_level());
  ProgressiveMeshInstance instance(borrowed(model));
  instance.go_to_level(coarse_level_);
  const TriangleMesh coarse = instance.extract();
  instance.go_to_level(fine_level_);
  mesh_ = instance.extract();
  find_moves(model, coarse);

  for (const MaterialRange& range : mesh_.ranges)
    ranges_.push_back({3 * range.first_triangle, 3 * range.triangle_count, Primitive::kTriangles,
                       range.material, level_fraction_});
  if (mesh_.ranges.empty())
    ranges_.push_back({0, static_cast<std::uint32_t>(mesh_.indices.size()), Primitive::kTriangles,
                       0, level_fraction_});
}

namespace {

// `b` is only read: there is no other way to visit two meshes at once.
bool are_equal(const TriangleMesh& a, std::uint32_t of_a, TriangleMesh& b, std::uint32_t of_b) {
  bool equal = true;
  for_each_vertex_array(a, b, [&](const auto& one, const auto& other) {
    if (!one.empty()) equal = equal && one[of_a] == other[of_b];
  });
  return equal;
}

}  // namespace

void Geomorph::find_moves(const ProgressiveMesh& model, const TriangleMesh& coarse) {
  const std::uint32_t old_count = coarse.vertex_count();
  const std::uint32_t count = mesh_.vertex_count();
  std::vector<std::uint32_t> ancestor(count), from, to;
  for (std::uint32_t v = 0; v < count; ++v) {
    ancestor[v] = v < old_count ? v : ancestor[model.data().target[v]];
    if (are_equal(coarse, ancestor[v], mesh_, v)) continue;
    from.push_back(ancestor[v]);
    to.push_back(v);
    moves_.push_back({v, v < old_count ? 0
                                       : (1 - options_.share) * static_cast<float>(v - old_count) /
                                             static_cast<float>(count - old_count)});
  }
  coarse_ = gather_vertices(coarse, from);
  fine_ = gather_vertices(mesh_, to);
}

void Geomorph::set(std::size_t number, const TriangleMesh& end) {
  for_each_vertex_array(end, mesh_, [&](const auto& values, auto& drawn) {
    if (!values.empty()) drawn[moves_[number].vertex] = values[number];
  });
}

void Geomorph::set_between(std::size_t number, float part) {
  const std::uint32_t vertex = moves_[number].vertex;
  const auto blend_all = [&](const auto& a, const auto& b, auto& drawn, const auto& rule) {
    if (!a.empty()) drawn[vertex] = rule(a[number], b[number], part);
  };
  const auto straight = [](const auto& a, const auto& b, float s) { return between(a, b, s); };
  blend_all(coarse_.positions, fine_.positions, mesh_.positions, straight);
  blend_all(coarse_.normals, fine_.normals, mesh_.normals, normal_between);
  blend_all(coarse_.texcoords, fine_.texcoords, mesh_.texcoords, straight);
  blend_all(coarse_.colors, fine_.colors, mesh_.colors, color_between);
  blend_all(coarse_.skin, fine_.skin, mesh_.skin, mix_joints);
  for (std::size_t k = 0; k < mesh_.poses.size(); ++k) {
    const Pose &a = coarse_.poses[k], &b = fine_.poses[k];
    blend_all(a.positions, b.positions, mesh_.poses[k].positions, straight);
    blend_all(a.normals, b.normals, mesh_.poses[k].normals, straight);
  }
}

void Geomorph::blend(float t) {
  vertices_changed_ = true;
  t = t > 0 ? std::min(t, 1.0f) : 0;
  for (std::size_t i = 0; i < moves_.size(); ++i) {
    // At the ends the very attributes, whatever rounding would make of them.
    float s = (t - moves_[i].start) / options_.share;
    if (t >= 1 || s >= 1) {
      set(i, fine_);
      continue;
    }
    if (s <= 0) {
      set(i, coarse_);
      continue;
    }
    if (options_.smooth_step) s = s * s * (3 - 2 * s);
    set_between(i, s);
  }
}

DrawList Geomorph::draw_list() {
  DrawList list = draw_vertices(mesh_);
  list.indices = mesh_.indices;
  list.ranges = ranges_;
  const std::span changed(changed_);
  if (indices_are_new_) {
    changed_[0] = {0, mesh_.vertex_count()};
    changed_[1] = {0, static_cast<std::uint32_t>(mesh_.indices.size())};
    list.changed_vertices = changed.first(1);
    list.changed_indices = changed.last(1);
  } else if (vertices_changed_ && !moves_.empty()) {
    const std::uint32_t first = moves_.front().vertex;
    changed_[0] = {first, moves_.back().vertex + 1 - first};
    list.changed_vertices = changed.first(1);
  }
  indices_are_new_ = vertices_changed_ = false;
  return list;
}

}  // namespace varifold
