// Fronts of variable resolution: sound models pass, planted faults are named.
#include <gtest/gtest.h>

#include <tests/support/greedy_strips.h>
#include <tests/support/meshes.h>
#include <varifold/measure/model_checker.h>
#include <varifold/models/common/extract_level.h>
#include <varifold/models/strips/build.h>
#include <varifold/models/strips/dependencies.h>
#include <varifold/models/strips/encoding.h>
#include <varifold/models/strips/instance.h>
#include <varifold/models/strips/verify_dependencies.h>
#include <varifold/simplify/simplify.h>
#include <algorithm>
#include <cmath>
#include <functional>
#include <set>

namespace varifold {
namespace {

using Shared = std::shared_ptr<const StripFramework>;

Shared framework_of(const TriangleMesh& mesh) {
  const DetailedMesh detailed = simplify(mesh)->detailed;
  return std::make_shared<const StripFramework>(
      build_strip_framework(detailed, test::greedy_strips(detailed.mesh)));
}

// Not so even that collapses would come in the order of places.
TriangleMesh bumpy_sphere(std::uint32_t triangles) {
  TriangleMesh mesh = test::icosphere(triangles);
  mesh.normals = {};
  for (Vec3& p : mesh.positions)
    p *= 1 + 0.1f * std::sin(9 * p.x) * std::cos(7 * p.y + 1) + 0.05f * std::sin(23 * p.z);
  return mesh;
}

std::string listed(const std::vector<Fault>& faults) {
  std::string text;
  for (const Fault& fault : faults) text += fault.kind + " at " + fault.where + "; ";
  return text;
}

bool has(const std::vector<Fault>& faults, const std::string& kind) {
  return std::any_of(faults.begin(), faults.end(),
                     [&](const Fault& fault) { return fault.kind == kind; });
}

std::vector<Fault> faults_of(const Shared& model, std::uint32_t fronts = 60) {
  ModelCheckOptions options;
  options.fronts = fronts;
  options.all_levels_up_to = 50;
  options.spread_levels = 8;
  const auto check = check_model<StripFrameworkInstance>(model, options);
  EXPECT_TRUE(check);
  const bool is_empty = model->triangle_count(model->finest_level()) == 0;
  EXPECT_EQ(check->fronts_checked, is_empty ? 0 : fronts);
  return check->faults;
}

TEST(CheckFronts, AllGroupsAreSound) {
  for (const auto& [name, mesh] : test::all_groups()) {
    const std::vector<Fault> faults = faults_of(framework_of(mesh), 40);
    EXPECT_TRUE(is_sound(faults)) << name << ": " << listed(faults);
  }
}

TEST(CheckFronts, AreOfAllSortsAndDependOnTheirNumber) {
  const TriangleMesh mesh = test::icosphere(1280);
  std::set<std::string> names;
  for (std::uint32_t number = 0; number < 30; ++number) {
    const check::SeededFront front = check::seeded_front(mesh, 4, number);
    const check::SeededFront again = check::seeded_front(mesh, 4, number);
    names.insert(front.name);
    EXPECT_EQ(front.options.tolerance, again.options.tolerance);
    EXPECT_EQ(front.options.max_triangles, again.options.max_triangles);
    EXPECT_EQ(front.criteria.view.has_value(), std::string(front.name).starts_with("view"));
  }
  EXPECT_EQ(names.size(), 8u);
}

// Most of them are between the base and full detail, and are no levels.
TEST(CheckFronts, AreFrontsIndeed) {
  const Shared model = framework_of(bumpy_sphere(5120));
  StripFrameworkInstance instance(model);
  instance.go_to_level(model->finest_level());
  const TriangleMesh full = instance.extract();
  int no_levels = 0;
  for (std::uint32_t number = 3; number < 63; ++number) {
    const auto front = check::seeded_front(full, model->triangle_count(0), number);
    instance.adapt(front.criteria, front.options);
    no_levels += instance.level() == kNone ? 1 : 0;
  }
  EXPECT_GT(no_levels, 45);
}

TEST(CheckFronts, CanBeCancelled) {
  ModelCheckOptions options;
  options.progress = [](std::string_view stage, float) { return stage != "fronts"; };
  const auto check = check_model<StripFrameworkInstance>(framework_of(bumpy_sphere(320)), options);
  ASSERT_FALSE(check);
  EXPECT_EQ(check.error().kind, ErrorKind::kCancelled);
}

// The dependencies of all steps, changed, in their own form.
using Lists = std::vector<std::vector<std::uint32_t>>;
Shared with_dependencies(const Shared& model, const std::function<void(Lists&)>& change) {
  StripFrameworkData data = model->data();
  const std::uint32_t steps = model->finest_level();
  DependencyLists read;
  EXPECT_EQ(read.read(data.dependencies, steps), nullptr);
  Lists lists(steps);
  for (std::uint32_t k = 0; k < steps; ++k) lists[k].assign(read.of(k).begin(), read.of(k).end());
  change(lists);
  data.dependencies.clear();
  for (std::uint32_t k = steps; k-- > 0;) {
    data.dependencies.insert(data.dependencies.end(), lists[k].begin(), lists[k].end());
    if (lists[k].empty())
      data.dependencies.push_back(kNone);
    else
      data.dependencies.back() |= StripFrameworkData::kLastDependency;
  }
  const auto bytes = encode_strip_framework(StripFramework(std::move(data), model->full_strips()));
  // As it would come from a file.
  auto decoded = decode_strip_framework(bytes);
  EXPECT_TRUE(decoded) << decoded.error().message;
  return decoded ? std::make_shared<const StripFramework>(std::move(*decoded)) : nullptr;
}

// What a decoder must ask for to write slots right, and no more: every step waits for those whose
// vertices go to its own.
Shared thinned(const Shared& model) {
  return with_dependencies(model, [&](Lists& lists) {
    const LevelTable& levels = model->levels();
    std::vector<std::uint32_t> step_of(levels.vertex_count(0), kNone);
    for (std::uint32_t k = 0; k < levels.finest_level(); ++k)
      step_of.insert(step_of.end(), levels.step(k).vertices, k);
    std::vector<std::set<std::uint32_t>> coming(lists.size());
    for (std::uint32_t v = levels.vertex_count(0); v < step_of.size(); ++v)
      if (const std::uint32_t to = step_of[levels.target(v)]; to != kNone)
        coming[to].insert(step_of[v]);
    for (std::size_t k = 0; k < lists.size(); ++k)
      lists[k].assign(coming[k].begin(), coming[k].end());
  });
}

// The dependencies of the thesis: none but that. Levels are right, fronts are not, and both what
// the fronts look like and the dependencies themselves tell.
TEST(CheckFronts, FindsThinnedDependencies) {
  const Shared model = thinned(framework_of(bumpy_sphere(5120)));
  ASSERT_NE(model, nullptr);
  const std::vector<Fault> faults = faults_of(model);
  EXPECT_TRUE(has(faults, "missing_dependency")) << listed(faults);
  EXPECT_TRUE(has(faults, "front_flipped_triangle")) << listed(faults);
  EXPECT_TRUE(has(faults, "front_new_duplicate_triangle") ||
              has(faults, "front_new_nonmanifold_edge") || has(faults, "front_euler_changed"))
      << listed(faults);
  for (const Fault& fault : faults)
    EXPECT_TRUE(fault.kind == "missing_dependency" || fault.kind.starts_with("front_"))
        << fault.kind;
  EXPECT_TRUE(is_sound(faults_of(framework_of(bumpy_sphere(5120)))));
}

TEST(CheckFronts, FindsOneMissingDependency) {
  const Shared model = framework_of(bumpy_sphere(500));
  const std::uint32_t steps = model->finest_level();
  std::uint32_t tried = 0, found = 0;
  for (std::uint32_t step = 0; step < steps; step += 7) {
    StripFrameworkData data = model->data();
    DependencyLists read;
    ASSERT_EQ(read.read(data.dependencies, steps), nullptr);
    if (read.of(step).empty()) continue;
    // Beyond what a decoder accepts, too.
    std::vector<std::uint32_t> words;
    for (std::uint32_t k = steps; k-- > 0;) {
      const auto own = read.of(k).subspan(k == step ? 1 : 0);
      words.insert(words.end(), own.begin(), own.end());
      if (own.empty())
        words.push_back(kNone);
      else
        words.back() |= StripFrameworkData::kLastDependency;
    }
    data.dependencies = words;
    const auto lacking =
        steps_lacking_dependencies(StripFramework(std::move(data), model->full_strips()));
    ++tried;
    if (lacking.empty()) continue;
    ++found;
    EXPECT_EQ(std::count(lacking.begin(), lacking.end(), step), 1) << step;
  }
  // The build leaves out nearly all that follow from others.
  EXPECT_GT(tried, 20u);
  EXPECT_GE(found * 10, tried * 9);
}

TEST(CheckFronts, MoreDependenciesThanNeededAreSound) {
  const Shared model = with_dependencies(framework_of(bumpy_sphere(1280)), [](Lists& lists) {
    for (std::size_t k = 0; k < lists.size(); ++k) {
      std::set<std::uint32_t> more(lists[k].begin(), lists[k].end());
      // Those of the first one, which follow; and one that does not.
      if (!lists[k].empty())
        more.insert(lists[lists[k].front()].begin(), lists[lists[k].front()].end());
      if (k % 50 == 3 && k + 1 < lists.size())
        more.insert(static_cast<std::uint32_t>(lists.size() - 1));
      lists[k].assign(more.begin(), more.end());
    }
  });
  ASSERT_NE(model, nullptr);
  EXPECT_EQ(listed(faults_of(model)), "");
}

TEST(CheckFronts, DependenciesOfAllGroupsAreComplete) {
  for (const auto& [name, mesh] : test::all_groups())
    EXPECT_TRUE(steps_lacking_dependencies(*framework_of(mesh)).empty()) << name;
}

TEST(CheckFronts, FindsBallsThatAreTooSmall) {
  const Shared good = framework_of(bumpy_sphere(2000));
  StripFrameworkData data = good->data();
  for (float& radius : data.radius) radius = 0;
  const auto faults =
      faults_of(std::make_shared<const StripFramework>(std::move(data), good->full_strips()));
  EXPECT_TRUE(has(faults, "front_too_coarse")) << listed(faults);
}

// A kind of model that draws plain triangles over vertices of its own; and may do so badly, at
// fronts alone.
enum class Tamper {
  kNothing,
  kHistory,
  kBudget,
  kCount,
  kExtract,
  kIndex,
  kLost,
  kDoubled,
  kTurned,
  kFlat
};

template <Tamper kHow>
class OwnBuffers {
 public:
  explicit OwnBuffers(Shared model) : instance_(std::move(model)) {}
  [[nodiscard]] const StripFramework& model() const { return instance_.model(); }
  [[nodiscard]] std::uint32_t level() const { return instance_.level(); }
  [[nodiscard]] std::size_t bytes() const { return 0; }
  void go_to_level(std::uint32_t level) {
    is_front_ = false;
    instance_.go_to_level(level);
  }
  FrontStatistics adapt(const RefineCriteria& criteria, AdaptOptions options) {
    if (kHow == Tamper::kHistory && is_front_ && ++adapted_ % 5 == 0) return {};
    if (kHow == Tamper::kBudget) options.max_triangles = kNone;
    FrontStatistics statistics = instance_.adapt(criteria, options);
    statistics.triangles += kHow == Tamper::kCount ? 1 : 0;
    is_front_ = true;
    return statistics;
  }
  DrawList draw_list() {
    mesh_ = extract_level(model().attributes(), model().attributes().vertex_count(),
                          instance_.draw_list());
    std::vector<std::uint32_t>& indices = mesh_.indices;
    if (is_front_ && indices.size() > 100) spoil(indices);
    DrawList list;
    list.positions = mesh_.positions;
    list.indices = indices;
    range_.index_count = static_cast<std::uint32_t>(indices.size());
    list.ranges = {&range_, 1};
    return list;
  }
  [[nodiscard]] TriangleMesh extract() const {
    TriangleMesh mesh = instance_.extract();
    if (kHow == Tamper::kExtract && is_front_) std::swap(mesh.indices[0], mesh.indices[1]);
    return mesh;
  }

 private:
  void spoil(std::vector<std::uint32_t>& indices) {
    if (kHow == Tamper::kIndex) indices[50] = mesh_.vertex_count();
    if (kHow == Tamper::kLost) indices.resize(indices.size() - 3);
    if (kHow == Tamper::kDoubled) std::copy_n(indices.begin(), 3, indices.end() - 3);
    if (kHow == Tamper::kTurned) std::swap(indices[6], indices[7]);
    // Two corners become the one point: a triangle on a line, and others that are longer.
    if (kHow == Tamper::kFlat)
      mesh_.positions[indices[0]] =
          0.5f * (mesh_.positions[indices[1]] + mesh_.positions[indices[2]]);
  }

  StripFrameworkInstance instance_;
  TriangleMesh mesh_;
  DrawRange range_;
  bool is_front_ = false;
  int adapted_ = 0;
};

template <Tamper kHow>
std::vector<Fault> faults_of_tampered() {
  static_assert(FrontInstance<OwnBuffers<kHow>>);
  ModelCheckOptions options;
  options.all_levels_up_to = 10;
  options.spread_levels = 4;
  options.distance_levels = 1;
  // Coordinates with few bits, so that the middle of an edge is one exactly.
  TriangleMesh mesh = bumpy_sphere(1280);
  for (Vec3& p : mesh.positions) p = glm::round(p * 4096.0f) / 4096.0f;
  const auto check = ModelChecker<OwnBuffers<kHow>>(framework_of(mesh), options).run();
  EXPECT_TRUE(check);
  for (const Fault& fault : check->faults)
    EXPECT_TRUE(fault.kind.starts_with("front_")) << fault.kind << " at " << fault.where;
  return check->faults;
}

TEST(CheckFronts, AnyKindOfModel) { EXPECT_EQ(listed(faults_of_tampered<Tamper::kNothing>()), ""); }

TEST(CheckFronts, FindsEveryTampering) {
  EXPECT_TRUE(has(faults_of_tampered<Tamper::kHistory>(), "front_not_identical"));
  EXPECT_TRUE(has(faults_of_tampered<Tamper::kBudget>(), "front_over_budget"));
  EXPECT_TRUE(has(faults_of_tampered<Tamper::kCount>(), "front_wrong_count"));
  EXPECT_TRUE(has(faults_of_tampered<Tamper::kExtract>(), "front_not_identical"));
  EXPECT_TRUE(has(faults_of_tampered<Tamper::kIndex>(), "front_wrong_corner"));
  EXPECT_TRUE(has(faults_of_tampered<Tamper::kLost>(), "front_not_closed"));
  EXPECT_TRUE(has(faults_of_tampered<Tamper::kLost>(), "front_wrong_count"));
  EXPECT_TRUE(has(faults_of_tampered<Tamper::kDoubled>(), "front_new_duplicate_triangle"));
  EXPECT_TRUE(has(faults_of_tampered<Tamper::kTurned>(), "front_new_misoriented_edge"));
  EXPECT_TRUE(has(faults_of_tampered<Tamper::kTurned>(), "front_flipped_triangle"));
  EXPECT_TRUE(has(faults_of_tampered<Tamper::kFlat>(), "front_zero_area"));
}

}  // namespace
}  // namespace varifold
