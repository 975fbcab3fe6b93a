#include <varifold/measure/patch_motion.h>
#include <varifold/measure/picture_projection.h>
#include <varifold/mesh/vertex_arrays.h>
#include <varifold/mesh/weld.h>
#include <cmath>
#include <utility>

namespace varifold {

namespace {

// Where the points of a level are, by number, and where they go.
struct Points {
  std::vector<std::uint32_t> of_vertex;
  std::vector<std::uint32_t> targets;  // kNone for those of level 0
};

void add_level(const PatchTreeData& data, std::uint32_t level, Points& points) {
  const PatchTopology& topology = data.topology;
  const std::uint32_t first = topology.first_of_level[level];
  const std::uint32_t last = topology.first_of_level[level + 1];
  const std::uint32_t base = data.offsets[first].vertex, end = data.offsets[last].vertex;
  const WeldMap weld = weld_points(data.vertices, base, end);
  std::vector<std::uint32_t> point_of_class(weld.class_count, kNone);
  for (std::uint32_t node = first; node < last; ++node) {
    const std::uint32_t parent = topology.parent[node];
    for (std::uint32_t v = data.offsets[node].vertex; v < data.offsets[node + 1].vertex; ++v) {
      std::uint32_t& point = point_of_class[weld.class_of[v - base]];
      if (point == kNone) {
        const std::uint32_t survivor =
            parent == kNone ? kNone : data.offsets[parent].vertex + data.survivors[v];
        if (survivor != kNone && same_point(data.vertices, survivor, v)) {
          point = points.of_vertex[survivor];
        } else {
          point = static_cast<std::uint32_t>(points.targets.size());
          points.targets.push_back(survivor == kNone ? kNone : points.of_vertex[survivor]);
        }
      }
      points.of_vertex[v] = point;
    }
  }
}

Points points_of(const PatchTreeData& data) {
  Points points;
  points.of_vertex.assign(data.vertices.positions.size(), kNone);
  for (std::uint32_t level = 0; level < data.topology.level_count(); ++level)
    add_level(data, level, points);
  return points;
}

bool is_on_its_way(const PatchDrawList& list, const PatchMorphRange& range, std::uint32_t vertex) {
  const PatchMorph& morph = list.morphs[vertex];
  if (morph.target == vertex) return false;
  const float part = morph_part(range, list.positions[vertex], morph.error);
  return part > 0 && part < 1;
}

DVec3 area_of(const Vec3& a, const Vec3& b, const Vec3& c) {
  return glm::cross(DVec3(b) - DVec3(a), DVec3(c) - DVec3(a));
}

// Pixels that a triangle covers where one of its corners is in the picture, else 0.
double covered_pixels(const PictureProjection& picture, const Vec3& a, const Vec3& b,
                      const Vec3& c) {
  const PictureProjection::Point p = picture(DVec3(a)), q = picture(DVec3(b)),
                                 r = picture(DVec3(c));
  if (!p.is_in_front || !q.is_in_front || !r.is_in_front) return 0;
  if (!picture.is_in_picture(p) && !picture.is_in_picture(q) && !picture.is_in_picture(r)) return 0;
  return 0.5 * std::abs((q.x - p.x) * (r.y - p.y) - (r.x - p.x) * (q.y - p.y));
}

}  // namespace

PatchMotion::PatchMotion(std::shared_ptr<const PatchTree> tree) : tree_(std::move(tree)) {
  Points points = points_of(tree_->data());
  point_of_ = std::move(points.of_vertex);
  jumps_.emplace(std::move(points.targets));
  positions_.resize(point_of_.size());
  drawn_in_.assign(point_of_.size(), 0);
}

void PatchMotion::read(const PatchDrawList& list, const std::optional<PatchMorphRange>& morph,
                       Frame& frame) {
  ++frame_;
  indices_.clear();
  for (const PatchDrawCommand& draw : list.draws) {
    for (std::size_t i = draw.first_index; i < draw.first_index + draw.index_count; ++i) {
      const std::uint32_t own = draw.first_vertex + list.indices[i];
      const std::uint32_t v = switched_vertex(own, list.remap[own], draw.parent_vertex, draw.mask);
      indices_.push_back(v);
      if (drawn_in_[v] == frame_) continue;
      drawn_in_[v] = frame_;
      positions_[v] = morph ? morphed_position(list, v, *morph) : list.positions[v];
      ++frame.vertices;
      frame.moving += morph && is_on_its_way(list, *morph, v) ? 1 : 0;
    }
  }
}

void PatchMotion::count_turned(const PatchDrawList& list, const Camera& camera,
                               Frame& frame) const {
  const PictureProjection picture(camera);
  for (std::size_t i = 0; i < indices_.size(); i += 3) {
    const std::uint32_t a = indices_[i], b = indices_[i + 1], c = indices_[i + 2];
    const DVec3 own = area_of(list.positions[a], list.positions[b], list.positions[c]);
    if (own == DVec3(0)) continue;
    ++frame.triangles;
    const DVec3 blended = area_of(positions_[a], positions_[b], positions_[c]);
    if (glm::dot(own, blended) >= 0) continue;
    ++frame.turned;
    if (glm::dot(own, picture.eye() - DVec3(list.positions[a])) > 0 &&
        covered_pixels(picture, positions_[a], positions_[b], positions_[c]) > kSeenPixels)
      ++frame.turned_seen;
  }
}

PatchMotion::Frame PatchMotion::next(const PatchDrawList& list,
                                     const std::optional<PatchMorphRange>& morph,
                                     const Camera& camera) {
  Frame frame;
  read(list, morph, frame);
  count_turned(list, camera, frame);
  DrawList drawn;
  drawn.positions = positions_;
  drawn.indices = indices_;
  const DrawRange range{.index_count = static_cast<std::uint32_t>(indices_.size())};
  drawn.ranges = {&range, 1};
  frame.jumps = jumps_->next(drawn, point_of_, camera);
  return frame;
}

}  // namespace varifold
