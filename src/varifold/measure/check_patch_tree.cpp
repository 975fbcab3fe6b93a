#include <varifold/measure/check_patch_tree.h>

#include <varifold/base/parallel.h>
#include <varifold/measure/front_parts.h>
#include <varifold/measure/legal_fronts.h>
#include <varifold/measure/patch_borders.h>
#include <varifold/measure/seeded_front.h>
#include <varifold/measure/shape_checker.h>
#include <varifold/measure/surface_counts.h>
#include <varifold/measure/surface_distance.h>
#include <varifold/mesh/pose_blend.h>
#include <varifold/models/patch_tree/extract.h>
#include <varifold/models/patch_tree/instance.h>
#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

namespace varifold {

namespace {

using check::PlaceFaults;

// What is wrong with a level or a front; gathered by threads, told in order.
struct Finding {
  const char* kind;
  std::string detail;
};
using Findings = std::vector<Finding>;

struct FrontLook {
  Findings findings;
  std::uint64_t collapsed = 0;
  bool lost_component = false;
};

class PatchTreeChecker {
 public:
  PatchTreeChecker(std::shared_ptr<const PatchTree> tree, const ModelCheckOptions& options)
      : tree_(std::move(tree)), options_(options) {}

  Result<ModelCheck> run() {
    check_borders(*tree_, level_faults_);
    if (!go_on("patches", 0.05f)) return cancelled();
    check_turns(*tree_, patch_faults_);
    check_bounds_of_patches(*tree_, patch_faults_);
    if (!go_on("levels", 0.1f)) return cancelled();
    full_ = extract_front(*tree_, level_flags(tree_->finest_level()));
    full_counts_ = check::count_surface(full_);
    materials_.materials = full_.materials;
    materials_.ranges = full_.ranges;
    if (!check_levels() || !check_fronts()) return cancelled();
    for (const PlaceFaults* faults : {&level_faults_, &patch_faults_, &front_faults_})
      faults->append_to(check_.faults);
    add_notes();
    return std::move(check_);
  }

 private:
  [[nodiscard]] bool go_on(const char* stage, float done) const {
    return report(options_.progress, stage, done);
  }
  static tl::unexpected<Error> cancelled() {
    return fail(ErrorKind::kCancelled, "cancelled while checking");
  }

  [[nodiscard]] std::vector<std::uint8_t> level_flags(std::uint32_t level) const {
    const PatchTopology& t = tree_->topology();
    std::vector<std::uint8_t> flags(t.node_count(), 0);
    std::fill(flags.begin(), flags.begin() + t.first_of_level[level], std::uint8_t{1});
    return flags;
  }

  bool check_levels();
  void check_distance(std::uint32_t level, const TriangleMesh& mesh);
  bool check_fronts();
  [[nodiscard]] FrontLook look_at_legal(std::uint32_t number) const;
  [[nodiscard]] FrontLook look_at_seeded(std::uint32_t number) const;
  [[nodiscard]] FrontLook look_at(SplitFlags is_split, const char* name) const;
  void compare_surface(const TriangleMesh& mesh, const char* name, FrontLook& look) const;
  void add_notes();

  std::shared_ptr<const PatchTree> tree_;
  const ModelCheckOptions& options_;
  TriangleMesh full_, materials_;  // the latter has those and the ranges of the former alone
  check::SurfaceCounts full_counts_;
  ModelCheck check_;
  PlaceFaults level_faults_{"level"}, patch_faults_{"patch"}, front_faults_{"front", "front_"};
  std::vector<std::uint32_t> exceeded_, lost_component_;
  double worst_excess_ = 0;  // distance over error, of the levels that exceed it
};

// What must hold for the surface of any front.
void PatchTreeChecker::compare_surface(const TriangleMesh& mesh, const char* name,
                                       FrontLook& look) const {
  const check::SurfaceCounts counts = check::count_surface(mesh);
  const auto expect_no_more = [&](std::uint64_t count, std::uint64_t most, const char* kind) {
    if (count > most)
      look.findings.push_back(
          {kind, std::string(name) + ": " + std::to_string(count - most) + " more"});
  };
  expect_no_more(counts.boundary_edges, full_counts_.boundary_edges, "open_edge");
  expect_no_more(counts.nonmanifold_edges, full_counts_.nonmanifold_edges, "new_nonmanifold_edge");
  expect_no_more(counts.misoriented_edges, full_counts_.misoriented_edges, "new_misoriented_edge");
  expect_no_more(counts.duplicate_triangles, full_counts_.duplicate_triangles,
                 "new_duplicate_triangle");
  expect_no_more(counts.degenerate_triangles, 0, "degenerate_triangle");
  if (!check::are_among(counts.euler_of_component, full_counts_.euler_of_component))
    look.findings.push_back({"euler_changed", name});
  look.lost_component = counts.euler_of_component.size() < full_counts_.euler_of_component.size();
}

FrontLook PatchTreeChecker::look_at(SplitFlags is_split, const char* name) const {
  FrontLook look;
  const PatchTreeData& data = tree_->data();
  if (!is_legal(data.topology, is_split)) look.findings.push_back({"illegal", name});
  std::uint64_t stored = 0;
  for (std::uint32_t node = 0; node < tree_->node_count(); ++node) {
    if (!is_in_front(data.topology, is_split, node)) continue;
    const std::uint32_t parent = data.topology.parent[node];
    const std::uint32_t mask =
        parent == kNone ? 0 : coarse_neighbors(data.topology, is_split, parent);
    stored += tree_->triangle_count_of(node);
    look.collapsed += collapsed_triangles(data, node, mask);
  }
  const TriangleMesh mesh = extract_front(*tree_, is_split);
  if (mesh.triangle_count() + look.collapsed != stored)
    look.findings.push_back({"wrong_count", name});
  compare_surface(mesh, name, look);
  return look;
}

FrontLook PatchTreeChecker::look_at_legal(std::uint32_t number) const {
  const check::LegalFront front = check::legal_front(tree_->topology(), number);
  return look_at(front.is_split, front.name);
}

FrontLook PatchTreeChecker::look_at_seeded(std::uint32_t number) const {
  const std::uint32_t base = tree_->triangle_count(0);
  const check::SeededFront front = check::seeded_front(full_, base, number);
  PatchTreeInstance instance(tree_);
  const FrontStatistics told = instance.adapt(front.criteria, front.options);
  FrontLook look = look_at(instance.split_flags(), front.name);
  if (told.triangles > std::max(front.options.max_triangles, base))
    look.findings.push_back({"over_budget", front.name});
  const DrawList list = instance.draw_list();
  if (!check::indices_exist(list, static_cast<std::uint32_t>(list.positions.size()))) {
    look.findings.push_back({"wrong_corner", front.name});
    return look;
  }
  const auto drawn = check::sorted(check::placed_triangles(check::drawn_mesh(materials_, list)));
  if (drawn != check::sorted(check::placed_triangles(instance.extract())))
    look.findings.push_back({"not_identical", front.name});
  if (told.triangles != drawn.size() + look.collapsed)
    look.findings.push_back({"wrong_count", front.name});
  return look;
}

bool PatchTreeChecker::check_levels() {
  const std::uint32_t levels = tree_->topology().level_count();
  for (std::uint32_t level = 0; level < levels; ++level) {
    if (!go_on("levels", 0.1f + 0.4f * static_cast<float>(level) / static_cast<float>(levels)))
      return false;
    const float error = tree_->error(level);
    if (!std::isfinite(error) || error < 0 || (level > 0 && error > tree_->error(level - 1)))
      level_faults_.add("error_not_monotone", level);
    const std::vector<std::uint8_t> flags = level_flags(level);
    const FrontLook look = look_at(flags, "level");
    for (const Finding& finding : look.findings)
      level_faults_.add(finding.kind, level, finding.detail);
    if (look.collapsed > 0) level_faults_.add("wrong_count", level, "collapsed triangles");
    if (look.lost_component) lost_component_.push_back(level);
    if (level + 1 < levels) check_distance(level, extract_front(*tree_, flags));
    ++check_.levels_checked;
  }
  return true;
}

void PatchTreeChecker::check_distance(std::uint32_t level, const TriangleMesh& mesh) {
  const SurfaceDistance surface(mesh);
  double reach = 0;
  for (const Vec3& p : full_.positions) reach = std::max<double>(reach, glm::length(p));
  std::vector<double> farthest((full_.positions.size() + 4095) / 4096, 0);
  parallel_for(
      options_.threads, full_.positions.size(), 4096, [&](std::size_t begin, std::size_t end) {
        for (std::size_t v = begin; v < end; ++v)
          farthest[begin / 4096] =
              std::max(farthest[begin / 4096], surface.distance(DVec3(full_.positions[v])));
      });
  const double most = farthest.empty() ? 0 : *std::max_element(farthest.begin(), farthest.end());
  const double error = tree_->error(level);
  ++check_.distances_checked;
  // Even a point on a triangle is a few bits of a float away from it.
  if (most <= error * (1 + 1e-5) + 1e-7 * reach) return;
  exceeded_.push_back(level);
  worst_excess_ = std::max(worst_excess_, error > 0 ? most / error : 0);
}

bool PatchTreeChecker::check_fronts() {
  constexpr std::uint32_t kBatch = 32;
  if (full_.indices.empty()) return true;
  std::vector<FrontLook> looks(kBatch);
  for (std::uint32_t first = 0; first < options_.fronts; first += kBatch) {
    if (!go_on("fronts",
               0.5f + 0.5f * static_cast<float>(first) / static_cast<float>(options_.fronts)))
      return false;
    const std::uint32_t count = std::min(kBatch, options_.fronts - first);
    parallel_for(options_.threads, count, 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        const std::uint32_t number = first + static_cast<std::uint32_t>(i);
        looks[i] = number % 2 == 0 ? look_at_seeded(number / 2) : look_at_legal(number / 2);
      }
    });
    for (std::uint32_t i = 0; i < count; ++i) {
      for (const Finding& finding : looks[i].findings)
        front_faults_.add(finding.kind, first + i, finding.detail);
      check_.collapsed_triangles += looks[i].collapsed;
    }
    check_.fronts_checked += count;
  }
  return true;
}

void PatchTreeChecker::add_notes() {
  const auto add = [&](const char* kind, const std::vector<std::uint32_t>& levels,
                       const std::string& detail, Severity severity) {
    if (levels.empty()) return;
    std::string where = "level";
    for (std::size_t i = 0; i < std::min<std::size_t>(levels.size(), 4); ++i)
      where += (i == 0 ? " " : ", ") + std::to_string(levels[i]);
    check_.faults.push_back(
        {kind, levels.size(), where + (levels.size() > 4 ? ", ..." : "") + detail, severity});
  };
  add("error_exceeded", exceeded_,
      " (at most " + std::to_string(worst_excess_) + " times the error)", Severity::kFault);
  add("lost_component", lost_component_, "", Severity::kNote);
}

// In a blend places are rounded, and the mesh may fold by itself.
bool is_of_orientation(const Fault& fault) {
  return fault.kind == "turned_triangle" || fault.kind == "outside_cone";
}

std::shared_ptr<const PatchTree> blended(const PatchTree& tree, const std::vector<float>& weights) {
  PatchTreeData data = tree.data();
  data.vertices = blended_mesh(data.vertices, weights);
  return std::make_shared<const PatchTree>(std::move(data));
}

}  // namespace

Result<ModelCheck> check_patch_tree(const std::shared_ptr<const PatchTree>& tree,
                                    const ModelCheckOptions& options) {
  if (tree->node_count() == 0) return ModelCheck{};
  auto check = PatchTreeChecker(tree, options).run();
  if (!check) return check;
  // In every pose and in blends it is a tree of another shape, with the same bounds and errors.
  const std::size_t poses = tree->attributes().poses.size();
  const auto all_weights = check::checked_weights(poses);
  for (std::size_t i = 0; i < all_weights.size(); ++i) {
    auto in_pose = PatchTreeChecker(blended(*tree, all_weights[i]), options).run();
    if (!in_pose) return in_pose;
    for (Fault fault : in_pose->faults) {
      if (fault.severity == Severity::kNote || (i >= poses && is_of_orientation(fault))) continue;
      fault.kind = "pose_" + fault.kind;
      fault.where = (i < poses ? "pose " + std::to_string(i + 1) : "a blend") + ": " + fault.where;
      check->faults.push_back(std::move(fault));
    }
  }
  return check;
}

}  // namespace varifold
