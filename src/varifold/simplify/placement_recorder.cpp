#include <varifold/simplify/placement_recorder.h>

#include <algorithm>

namespace varifold {

float edge_parameter(const Vec3& start, const Vec3& end, const Vec3& place) {
  const Vec3 edge = end - start;
  const float length = glm::dot(edge, edge);
  return length > 0 ? std::clamp(glm::dot(place - start, edge) / length, 0.0f, 1.0f) : 1.0f;
}

PlacementRecorder::PlacementRecorder(const WorkingSurface& surface, const TriangleMesh& mesh,
                                     PlacementLog& log)
    : surface_(surface), log_(log) {
  for (const std::uint32_t v : surface.wedge.vertex_of) {
    if (mesh.has_normals()) attributes_.normals.push_back(mesh.normals[v]);
    if (mesh.has_texcoords()) attributes_.texcoords.push_back(mesh.texcoords[v]);
    if (mesh.has_colors()) attributes_.colors.push_back(mesh.colors[v]);
  }
  log_.first.push_back(0);
}

void PlacementRecorder::record(std::uint32_t onto, const Vec3& place, float t,
                               const MergeScratch& scratch) {
  const Vec3 in_model = Vec3(DVec3(place) / surface_.scale + surface_.center);
  const std::uint32_t first = surface_.wedge.first_of(onto);
  const auto& moved_onto = scratch.moved_onto;
  for (std::uint32_t wedge = first; wedge < first + surface_.wedge.count_of(onto); ++wedge) {
    const auto found = std::find(moved_onto.begin(), moved_onto.end(), wedge);
    if (found != moved_onto.end()) blend(scratch.moved_from[found - moved_onto.begin()], wedge, t);
    push(wedge, in_model);
  }
  log_.first.push_back(static_cast<std::uint32_t>(log_.wedge.size()));
}

void PlacementRecorder::blend(std::uint32_t from, std::uint32_t onto, float t) {
  TriangleMesh& a = attributes_;
  if (a.has_normals())
    a.normals[onto] = normalize_or_zero((1 - t) * a.normals[from] + t * a.normals[onto]);
  if (a.has_texcoords()) a.texcoords[onto] = (1 - t) * a.texcoords[from] + t * a.texcoords[onto];
  if (a.has_colors())
    a.colors[onto] = Color((1 - t) * Vec4(a.colors[from]) + t * Vec4(a.colors[onto]) + 0.5f);
}

void PlacementRecorder::push(std::uint32_t wedge, const Vec3& position) {
  log_.wedge.push_back(wedge);
  TriangleMesh& out = log_.attributes;
  out.positions.push_back(position);
  if (attributes_.has_normals()) out.normals.push_back(attributes_.normals[wedge]);
  if (attributes_.has_texcoords()) out.texcoords.push_back(attributes_.texcoords[wedge]);
  if (attributes_.has_colors()) out.colors.push_back(attributes_.colors[wedge]);
}

}  // namespace varifold
