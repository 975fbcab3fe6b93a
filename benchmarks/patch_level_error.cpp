// Prints the table of docs/algorithms/patch_tree.md that compares whole levels of patch trees with
// plain simplifications to the same number of triangles: two-sided sampled distances to the
// original, as fractions of the bounding box's diagonal.
//   varifold_patch_level_error [MESH...]
#include <benchmarks/bench_meshes.h>
#include <varifold/measure/surface_distance.h>
#include <varifold/models/patch_tree/build.h>
#include <varifold/models/patch_tree/extract.h>
#include <varifold/simplify/simplify.h>
#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <string>
#include <vector>

namespace varifold::bench {

namespace {

// All nodes above a level are split.
TriangleMesh level_of(const PatchTree& tree, std::uint32_t level) {
  const PatchTopology& topology = tree.topology();
  std::vector<std::uint8_t> is_split(topology.node_count(), 0);
  std::fill_n(is_split.begin(), topology.first_of_level[level], std::uint8_t{1});
  return extract_front(tree, is_split);
}

void print_levels(const std::string& name, std::uint32_t triangles_per_patch) {
  const TriangleMesh original = without_attributes(mesh(name));
  SimplifyOptions simplify_options;
  simplify_options.measure_error = false;
  const auto plain = simplify(original, simplify_options);
  PatchTreeOptions options;
  options.triangles_per_patch = triangles_per_patch;
  const auto built = build_patch_tree(original, options);
  if (!plain || !built) return;
  DistanceOptions distance;
  distance.samples = 200'000;
  for (std::uint32_t level = built->tree.topology().level_count() - 1; level-- > 0;) {
    const TriangleMesh cut = level_of(built->tree, level);
    const CollapseSequence& sequence = plain->detailed.sequence;
    const TriangleMesh peer =
        mesh_at_level(plain->detailed, sequence.level_for_triangles(cut.triangle_count()));
    const SurfaceDistanceReport ours = surface_distance(cut, original, distance);
    const SurfaceDistanceReport theirs =
        surface_distance(without_unused_vertices(peer), original, distance);
    std::printf("| %s | %u | %u | %.2e | %.2e | %.2f | %.2f |\n", name.c_str(), triangles_per_patch,
                cut.triangle_count(), ours.rms / ours.diagonal, theirs.rms / theirs.diagonal,
                ours.rms / theirs.rms, ours.hausdorff / theirs.hausdorff);
  }
}

}  // namespace

}  // namespace varifold::bench

int main(int argc, char** argv) {
  using namespace varifold::bench;
  std::vector<std::string> names(argv + 1, argv + argc);
  if (names.empty()) names = {"bunny.ply", "igea.ply", "armadillo.ply", "dragon.ply"};
  std::puts("| mesh | patches of | triangles | RMS | of plain | ratio of RMS | of greatest |");
  std::puts("| --- | --- | --- | --- | --- | --- | --- |");
  for (const std::string& name : present(names))
    for (const std::uint32_t triangles : {128u, 1000u}) print_levels(name, triangles);
  return 0;
}
