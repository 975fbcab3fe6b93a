// The runtime parts of the models in a program without exceptions; see
// cmake/check_no_exceptions.sh. One vertex split by hand, there and back.
#include <varifold/models/pm/instance.h>
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

}  // namespace

int main() {
  const auto model = std::make_shared<const varifold::ProgressiveMesh>(split_triangle());
  varifold::ProgressiveMeshInstance instance(model);
  const std::vector<std::uint32_t> coarse = instance.indices();
  instance.go_to_level(1);
  const bool refined = instance.triangle_count() == 3 && instance.indices()[0] == 3;
  instance.go_to_level(0);
  const bool undone = instance.triangle_count() == 1 && instance.indices() == coarse;
  if (!refined || !undone) {
    std::puts("a level is wrong");
    return 1;
  }
  std::puts("no exceptions: levels are right");
  return 0;
}
