// The runtime parts of the models in a program without exceptions; see
// cmake/check_no_exceptions.sh. One vertex split by hand, there and back, and through its bytes.
#include <varifold/models/mts/encoding.h>
#include <varifold/models/mts/instance.h>
#include <varifold/models/patch_tree/encoding.h>
#include <varifold/models/patch_tree/front.h>
#include <varifold/models/patch_tree/instance.h>
#include <varifold/models/pm/encoding.h>
#include <varifold/models/pm/geomorph.h>
#include <varifold/models/pm/instance.h>
#include <varifold/models/strips/encoding.h>
#include <varifold/models/strips/instance.h>
#include <cstdio>
#include <memory>
#include <utility>
#include <vector>

namespace {

//   2 --- 1      vertex 3 stands in the middle of the triangle 0 1 2 and collapses onto 0
//    \ 3 /
//      0
varifold::ProgressiveMeshData split_triangle() {
  varifold::ProgressiveMeshData data;
  data.mesh.positions = {{0, 0, 0}, {1, 2, 0}, {-1, 2, 0}, {0, 1, 0}};
  data.mesh.indices = {0, 1, 2, 3, 0, 1, 3, 2, 0};
  data.base_vertices = 3;
  data.base_triangles = 1;
  data.splits = {{1, 1, 2}};
  data.slots = {0 | varifold::ProgressiveMeshData::kLastSlot};
  data.target = {varifold::kNone, varifold::kNone, varifold::kNone, 0};
  data.error = {0, 0};
  return data;
}

// The same in strips: one of the triangles 3 0 1 and 3 1 2, and one of 3 2 0.
varifold::LevelTable levels_of_triangle() {
  varifold::CollapseSequence sequence;
  sequence.target = {varifold::kNone, varifold::kNone, varifold::kNone, 0};
  sequence.vertices = {3, 4};
  sequence.triangles = {1, 3};
  sequence.error = {0.5f, 0};
  return varifold::LevelTable(sequence);
}

varifold::StripFramework strips_of_triangle() {
  varifold::StripFrameworkData data;
  data.mesh.positions = split_triangle().mesh.positions;
  data.levels = levels_of_triangle();
  data.dependencies = {varifold::kNone};
  data.radius = {3};
  data.cone = {varifold::kWideConeCode};
  data.error_codes = {0x3f00};
  varifold::TriangleStrips strips;
  strips.indices = {0, 1, 3, 2};
  strips.end_strip(0);
  strips.indices.insert(strips.indices.end(), {3, 2, 0});
  strips.end_strip(0);
  return {std::move(data), std::move(strips)};
}

// As graphs: 0 1 3 2, then 0 1 2; and 3 2 0, then nothing.
varifold::MultiresolutionStrips graphs_of_triangle() {
  varifold::MultiresolutionStripsData data;
  data.mesh.positions = split_triangle().mesh.positions;
  data.levels = levels_of_triangle();
  data.strips = {{0, 0, 0, 0}, {5, 6, 1, 5}, {9, 11, 2, 9}};
  data.first_strip = {0, 2};
  data.node_vertex = {varifold::kNone, 0, 1, 3, 2, varifold::kNone, 3, 2, 0};
  data.node_arc = {0, 1, 2, 4, 5, 0, 2, 3, 4};
  data.arcs = {{1, 1}, {2, 1}, {3, 0}, {4, 1}, {4, 0}, {5, 1},
               {1, 0}, {4, 1}, {2, 0}, {3, 0}, {4, 0}};
  data.changes = {0, 0};
  return varifold::MultiresolutionStrips(std::move(data));
}

bool graphs_are_right() {
  const auto decoded = varifold::decode_mts(varifold::encode_mts(graphs_of_triangle()));
  if (!decoded || varifold::decode_mts({})) return false;
  const auto model = std::make_shared<const varifold::MultiresolutionStrips>(*decoded);
  varifold::MultiresolutionStripsInstance instance(model);
  const bool coarse = varifold::submitted_triangles(instance.draw_list()) == 1;
  instance.go_to_level(1);
  const bool fine = varifold::submitted_triangles(instance.draw_list()) == 3;
  instance.go_to_level(0);
  return coarse && fine && instance.extract().triangle_count() == 1;
}

bool strips_are_right() {
  const auto decoded =
      varifold::decode_strip_framework(varifold::encode_strip_framework(strips_of_triangle()));
  if (!decoded || varifold::decode_strip_framework({})) return false;
  const auto model = std::make_shared<const varifold::StripFramework>(*decoded);
  varifold::StripFrameworkInstance instance(model);
  const bool coarse = varifold::submitted_triangles(instance.draw_list()) == 1;
  instance.go_to_level(1);
  const bool fine = varifold::submitted_triangles(instance.draw_list()) == 3;
  varifold::RefineCriteria criteria;
  instance.adapt(criteria);
  const bool coarsened = instance.level() == 0 && instance.extract().triangle_count() == 1;
  criteria.sphere = varifold::Sphere{{0, 1, 0}, 1};
  return coarse && fine && coarsened && instance.adapt(criteria).triangles == 3;
}

// A patch of one triangle, which is two of two triangles each in detail.
varifold::PatchTreeData patch_tree() {
  varifold::PatchTreeData data;
  data.topology.first_of_level = {0, 1, 3};
  data.topology.parent = {varifold::kNone, 0, 0};
  data.topology.first_child = {1, 3, 3, 3};
  data.topology.first_neighbor = {0, 0, 1, 2};
  data.topology.neighbors = {2, 1};
  data.bounds.resize(3);
  for (varifold::PatchBounds& bounds : data.bounds) bounds.ball.radius = 1;
  data.bounds[0].error = 0.5f;
  data.offsets = {{0, 0, 0, 0}, {3, 1, 0, 1}, {7, 3, 0, 2}, {11, 5, 0, 3}};
  data.vertices.positions.assign(11, {0, 0, 0});
  data.survivors = {0, 1, 2, 0, 1, 2, 2, 0, 1, 2, 2};
  data.corners = {0, 1, 2, 0, 1, 2, 2, 1, 3, 0, 1, 2, 2, 1, 3};
  data.ranges = {{0, 1, 1}, {0, 2, 2}, {0, 2, 2}};
  return data;
}

bool patch_front_is_right() {
  varifold::PatchFront front(std::make_shared<const varifold::PatchTree>(patch_tree()));
  varifold::RefineCriteria criteria;
  criteria.view.emplace(varifold::Camera{});
  const bool fine = front.adapt(criteria, {}).statistics.triangles == 4;
  varifold::PatchFrontOptions options;
  options.limits.max_triangles = 3;
  const bool coarse = front.adapt(criteria, options).statistics.triangles == 1;
  return fine && coarse && front.draws().draws().size() == 1;
}

bool patch_bytes_are_right() {
  const auto bytes = varifold::encode_patch_tree(varifold::PatchTree(patch_tree()));
  auto decoded = varifold::decode_patch_tree(bytes);
  if (!decoded || varifold::decode_patch_tree(std::span(bytes).first(40))) return false;
  varifold::PatchTreeInstance instance(
      std::make_shared<const varifold::PatchTree>(std::move(*decoded)));
  const bool coarse = varifold::submitted_triangles(instance.draw_list()) == 1;
  instance.go_to_level(1);
  return coarse && varifold::submitted_triangles(instance.draw_list()) == 4;
}

}  // namespace

int main() {
  const auto model = std::make_shared<const varifold::ProgressiveMesh>(split_triangle());
  varifold::ProgressiveMeshInstance instance(model);
  const std::vector<std::uint32_t> coarse = instance.indices();
  instance.go_to_level(1);
  const bool refined = instance.triangle_count() == 3 && instance.indices()[0] == 3;
  instance.go_to_level(0);
  const bool undone = instance.triangle_count() == 1 && instance.indices() == coarse;
  const auto decoded = varifold::decode_progressive_mesh(varifold::encode_progressive_mesh(*model));
  const bool survives = decoded && decoded->data().slots == model->data().slots;
  const bool refused = !varifold::decode_progressive_mesh({});
  varifold::Geomorph geomorph(*model, 0, 1);
  geomorph.blend(0);
  const bool morphs = geomorph.mesh().positions[3] == varifold::Vec3(0, 0, 0);
  if (!refined || !undone || !survives || !refused || !morphs || !strips_are_right() ||
      !graphs_are_right() || !patch_front_is_right() || !patch_bytes_are_right()) {
    std::puts("no exceptions: a level is wrong");
    return 1;
  }
  std::puts("no exceptions: levels are right");
  return 0;
}
