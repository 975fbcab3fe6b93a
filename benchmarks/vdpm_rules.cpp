// Prints what fronts cost and where they fold under the rule that view-dependent meshes follow and
// under that of the paper: the tables of docs/algorithms/view_dependent_mesh.md.
//
// Based on: [Hoppe1997] section 3 (a split needs its predecessor and the faces fn0 to fn3).
#include <benchmarks/bench_meshes.h>
#include <varifold/base/random.h>
#include <varifold/mesh/topology.h>
#include <varifold/mesh/validation.h>
#include <varifold/mesh/weld.h>
#include <varifold/models/common/step_graph.h>
#include <varifold/models/vdpm/assemble.h>
#include <varifold/models/vdpm/step_regions.h>
#include <varifold/models/vdpm/watch_bounds.h>
#include <varifold/simplify/sequence_replay.h>
#include <varifold/simplify/simplify.h>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

namespace varifold::bench {
namespace {

using Steps = std::vector<std::uint32_t>;
using Marks = std::vector<std::uint8_t>;  // per step
using Requirements = std::vector<Steps>;  // per step, coarser ones
constexpr int kViews = 40, kScattered = 40;

// What is split before each step.
Requirements star_rule(const StepGraph& graph) {
  Requirements required(graph.step_count());
  for (std::uint32_t k = 0; k < graph.step_count(); ++k)
    for (const std::uint32_t finer : graph.of(k)) required[finer].push_back(k);
  return required;
}

// The split before a step at the same place: the parent in the paper's tree.
Steps predecessors(const CollapseSequence& sequence) {
  const Steps step_of = steps_of_vertices(sequence);
  Steps parent(sequence.step_count(), kNone), last(sequence.target.size(), kNone);
  for (std::uint32_t k = 0; k < parent.size(); ++k) {
    const std::uint32_t target = sequence.target[sequence.vertices[k]];
    parent[k] = last[target] != kNone ? last[target] : step_of[target];
    last[target] = k;
  }
  return parent;
}

class PaperRule {
 public:
  explicit PaperRule(const DetailedMesh& detailed)
      : sequence_(detailed.sequence), replay_(detailed), required_(sequence_.step_count()) {
    const Steps parent = predecessors(sequence_);
    for (std::uint32_t k = sequence_.step_count(); k-- > 0;) {
      if (parent[k] != kNone) required_[k].push_back(parent[k]);
      add_creators(k);
      replay_.collapse();
    }
  }
  [[nodiscard]] const Requirements& required() const { return required_; }

 private:
  [[nodiscard]] bool has(std::uint32_t triangle, std::uint32_t vertex) const {
    const std::uint32_t* const c = &replay_.corners()[3 * std::size_t{triangle}];
    return c[0] == vertex || c[1] == vertex || c[2] == vertex;
  }
  [[nodiscard]] Steps triangles_of(std::uint32_t vertex) const {
    Steps triangles;
    replay_.slots_of(vertex, triangles);
    for (std::uint32_t& slot : triangles) slot /= 3;
    return triangles;
  }
  // Of the faces beyond the outer edges of those that the split makes.
  void add_creators(std::uint32_t step) {
    const std::uint32_t c = sequence_.vertices[step], t = sequence_.target[c];
    const Steps of_c = triangles_of(c), of_t = triangles_of(t);
    for (const std::uint32_t made : of_c) {
      if (!has(made, t)) continue;
      const std::uint32_t* const corners = &replay_.corners()[3 * std::size_t{made}];
      const std::uint32_t apex = corners[0] ^ corners[1] ^ corners[2] ^ c ^ t;
      for (const Steps* around : {&of_c, &of_t})
        for (const std::uint32_t face : *around)
          if (has(face, apex) && !(has(face, c) && has(face, t))) add_creator(step, face);
    }
  }
  void add_creator(std::uint32_t step, std::uint32_t face) {
    Steps& required = required_[step];
    const std::uint32_t level = sequence_.triangle_level[face];
    if (level != 0 && std::find(required.begin(), required.end(), level - 1) == required.end())
      required.push_back(level - 1);
  }

  const CollapseSequence& sequence_;
  SequenceReplay replay_;
  Requirements required_;
};

Marks with_required(Marks split, const Requirements& required) {
  for (auto k = static_cast<std::uint32_t>(split.size()); k-- > 0;)
    if (split[k] != 0)
      for (const std::uint32_t r : required[k]) split[r] = 1;
  return split;
}

// Every vertex of full detail at its first ancestor that is there.
TriangleMesh surface_of(const DetailedMesh& detailed, const Steps& step_of, const Marks& split) {
  const Steps& target = detailed.sequence.target;
  Steps ancestor(target.size());
  for (std::uint32_t v = 0; v < ancestor.size(); ++v)
    ancestor[v] = step_of[v] == kNone || split[step_of[v]] != 0 ? v : ancestor[target[v]];
  TriangleMesh surface;
  surface.positions = detailed.mesh.positions;
  for (std::size_t i = 0; i < detailed.mesh.indices.size(); i += 3) {
    const std::uint32_t a = ancestor[detailed.mesh.indices[i]],
                        b = ancestor[detailed.mesh.indices[i + 1]],
                        c = ancestor[detailed.mesh.indices[i + 2]];
    if (a != b && b != c && a != c) surface.indices.insert(surface.indices.end(), {a, b, c});
  }
  return surface;
}

struct Tally {
  double triangles = 0, flipped = 0, folded = 0;
  int fronts = 0;

  void add(const DetailedMesh& detailed, const TriangleMesh& surface) {
    ++fronts;
    triangles += surface.triangle_count();
    flipped += static_cast<double>(flipped_triangles(surface, detailed.mesh).size());
    const TopologyReport topology = analyze_topology(surface, weld_exact(surface.positions));
    folded += topology.nonmanifold_edges > 0 || topology.duplicate_triangles > 0;
  }
  void print(const char* rule) const {
    std::printf(
        "    %-6s %9.0f triangles, %8.2f flipped per million, %d of %d fronts with an "
        "edge or a triangle too many\n",
        rule, triangles / fronts, flipped / triangles * 1e6, static_cast<int>(folded), fronts);
  }
};

struct Case {
  DetailedMesh detailed;
  Steps step_of;
  Requirements star, paper;
  std::vector<Vec3> centers;
  std::vector<StepBounds> bounds, along_tree;  // nested along the watch tree, and the paper's
};

Case make_case(const std::string& name) {
  Case c;
  const TriangleMesh mesh = without_attributes(bench::mesh(name));
  c.detailed = simplify(mesh, {.measure_error = false})->detailed;
  const CollapseSequence& sequence = c.detailed.sequence;
  c.step_of = steps_of_vertices(sequence);
  const StepGraph graph(c.detailed);
  c.star = star_rule(graph);
  c.paper = PaperRule(c.detailed).required();
  measure_step_bounds(c.detailed, watch_parents(graph), {}, c.bounds);
  for (const StepBounds& b : c.bounds) c.centers.push_back(c.detailed.mesh.positions[b.vertex]);
  c.along_tree = c.bounds;
  nest_bounds(predecessors(sequence), c.centers, c.along_tree, 100'000);
  const auto mean = [](const Requirements& required) {
    double sum = 0;
    for (const Steps& steps : required) sum += static_cast<double>(steps.size());
    return sum / static_cast<double>(required.size());
  };
  std::printf("%s: %u steps; a step requires %.2f by the star, %.2f by the paper\n", name.c_str(),
              sequence.step_count(), mean(c.star), mean(c.paper));
  return c;
}

Vec3 random_direction(Random& random) {
  const auto z = static_cast<float>(2 * random.uniform() - 1);
  const auto turn = static_cast<float>(6.283185307179586 * random.uniform());
  const float side = std::sqrt(1 - z * z);
  return {side * std::cos(turn), side * std::sin(turn), z};
}

// Eyes around the mesh at a distance in diagonals, 1 px of 1080, all criteria.
void print_views(const Case& c, float distance) {
  const Box box = varifold::bounds(c.detailed.mesh);
  Tally star, paper;
  std::array<double, 3> watched{}, asked{};  // own bounds, nested along the watch tree, the paper's
  Random random(4);
  for (int i = 0; i < kViews; ++i) {
    Camera camera;
    camera.target = box.center();
    camera.eye = box.center() + distance * box.diagonal() * random_direction(random);
    camera.up = random_direction(random);
    camera.width = 1920;
    camera.height = 1080;
    set_depth_range(camera, sphere_around(box));
    const ViewQuery query(ViewCriterion(camera), 1, 1e20f);
    std::array<Marks, 3> wanted;
    wanted.fill(Marks(c.bounds.size(), 0));
    for (std::size_t k = 0; k < c.bounds.size(); ++k) {
      wanted[0][k] = query.test(own_region(c.bounds[k], c.centers[k])).asked;
      wanted[1][k] = query.test(nested_region(c.bounds[k], c.centers[k])).asked;
      wanted[2][k] = query.test(nested_region(c.along_tree[k], c.centers[k])).asked;
    }
    star.add(c.detailed, surface_of(c.detailed, c.step_of, with_required(wanted[0], c.star)));
    paper.add(c.detailed, surface_of(c.detailed, c.step_of, with_required(wanted[0], c.paper)));
    const auto& triangles = c.detailed.sequence.triangles;
    const auto count = [&](const Marks& split) {
      double sum = triangles[0];
      for (std::size_t k = 0; k < split.size(); ++k)
        if (split[k] != 0) sum += triangles[k + 1] - triangles[k];
      return sum / kViews;
    };
    for (std::size_t n = 0; n < wanted.size(); ++n) {
      watched[n] += count(with_required(wanted[n], c.star));
      asked[n] += count(wanted[n]);
    }
  }
  std::printf("  %.1f diagonals, 1 px, all criteria\n", distance);
  star.print("star");
  paper.print("paper");
  std::printf(
      "    star, own bounds %.0f (asked %.0f), nested along the watch tree %.0f (%.0f), "
      "along the paper's %.0f (%.0f)\n",
      watched[0], asked[0], watched[1], asked[1], watched[2], asked[2]);
}

// Fronts that no view asks for: single steps from all over the mesh, 0.1 to 10 % of them.
void print_scattered(const Case& c) {
  Tally star, paper;
  Random random(5);
  for (int i = 0; i < kScattered; ++i) {
    const double part = 0.001 * std::pow(100, random.uniform());
    Marks asked(c.bounds.size(), 0);
    for (std::uint8_t& mark : asked) mark = random.uniform() < part;
    star.add(c.detailed, surface_of(c.detailed, c.step_of, with_required(asked, c.star)));
    paper.add(c.detailed, surface_of(c.detailed, c.step_of, with_required(asked, c.paper)));
  }
  std::printf("  scattered steps\n");
  star.print("star");
  paper.print("paper");
}

}  // namespace
}  // namespace varifold::bench

int main() {
  using namespace varifold::bench;
  for (const std::string& name : present({"bunny.ply", "igea.ply", "armadillo.ply"})) {
    const Case c = make_case(name);
    for (const float distance : {2.0f, 0.6f}) print_views(c, distance);
    print_scattered(c);
    std::fflush(stdout);
  }
}
