// Prints the tables of docs/algorithms/strip_framework.md: what the strips framework takes in
// memory, what it sends at every level, and the plane test of [Ramos2008] section 3.5.
#include <benchmarks/bench_meshes.h>
#include <varifold/base/random.h>
#include <varifold/models/strips/build.h>
#include <varifold/models/strips/encoding.h>
#include <varifold/models/strips/instance.h>
#include <varifold/simplify/simplify.h>
#include <varifold/strip/stripify.h>
#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <ctime>
#include <memory>
#include <string>
#include <vector>

namespace varifold::bench {

namespace {

// Of the processor: all that is timed is one thread, and the machine may have other work to do.
double milliseconds() { return 1e3 * static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }
double milliseconds_since(double start) { return milliseconds() - start; }

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values.empty() ? 0 : values[values.size() / 2];
}

constexpr double kMebi = 1024.0 * 1024.0;

struct Subject {
  std::string name;
  DetailedMesh detailed;
  std::shared_ptr<const StripFramework> model;
};

Subject make_subject(const std::string& name) {
  Subject subject{name.substr(0, name.find('.')), {}, {}};
  auto result = simplify(without_attributes(mesh(name)));
  if (result) subject.detailed = std::move(result->detailed);
  subject.model = std::make_shared<StripFramework>(
      build_strip_framework(subject.detailed, stripify(subject.detailed.mesh)));
  return subject;
}

std::uint64_t indices_sent(const DrawList& list) {
  std::uint64_t count = 0;
  for (const DrawRange& range : list.ranges) count += range.index_count;
  return count;
}

// The thesis' form: positions, targets, strips with two words each, two words a record.
void print_memory(const Subject& subject) {
  const StripFramework& model = *subject.model;
  const double vertices = model.attributes().vertex_count();
  const double records = static_cast<double>(model.record_count());
  const double words = 4 * vertices + model.slot_count() + 2.0 * model.strip_count() + 2 * records;
  const double front =
      4.0 * static_cast<double>(model.data().dependencies.size()) + 10.0 * model.finest_level();
  const double bytes = static_cast<double>(model.bytes());
  const double file = static_cast<double>(encode_strip_framework(model).size());
  const StripFrameworkInstance instance(subject.model);
  std::printf(
      "| %s | %.0f | %u | %u | %.2f | %.1f | %.1f / %.2f | %.1f / %.2f | %.1f | %.1f | %.1f |\n",
      subject.name.c_str(), vertices, model.triangle_count(model.finest_level()),
      model.strip_count(),
      static_cast<double>(model.slot_count()) / model.triangle_count(model.finest_level()),
      records / vertices, 4 * words / vertices, 4 * words / kMebi, bytes / vertices, bytes / kMebi,
      front / vertices, static_cast<double>(instance.bytes()) / vertices, file / vertices);
}

void print_levels(const Subject& subject) {
  StripFrameworkInstance instance(subject.model);
  for (const int percent : {100, 90, 75, 50, 25, 10, 5, 1}) {
    instance.go_to_level(subject.model->level_for_fraction(static_cast<float>(percent) / 100));
    const auto sent = static_cast<double>(indices_sent(instance.draw_list()));
    const double triangles = instance.triangle_count();
    std::printf("| %s | %d %% | %.0f | %u | %.0f | %.2f | %.0f |\n", subject.name.c_str(), percent,
                triangles, subject.model->slot_count(), sent, sent / triangles, 3 * triangles);
  }
}

// The level and the front that have the error of some level.
void print_errors(const Subject& subject) {
  const StripFramework& model = *subject.model;
  StripFrameworkInstance instance(subject.model);
  for (const float part : {0.5f, 0.1f, 0.02f}) {
    const float error = model.error(model.level_for_fraction(part));
    const std::uint32_t level = model.level_for_error(error);
    const FrontStatistics front = instance.adapt_by(
        [&](std::uint32_t step) { return model.step_error(step); }, {.tolerance = error});
    std::printf("| %s | %.3g | %u | %u |\n", subject.name.c_str(), static_cast<double>(error),
                model.triangle_count(level), front.triangles);
  }
}

void print_plane_test(const Subject& subject) {
  const Box box = bounds(subject.detailed.mesh);
  StripFrameworkInstance instance(subject.model);
  for (int i = 0; i <= 10; ++i) {
    const float x = box.lower.x + (box.upper.x - box.lower.x) * static_cast<float>(i) / 10;
    RefineCriteria criteria;
    criteria.plane = Plane{{1, 0, 0}, -x};
    std::vector<double> arriving, staying, drawing;
    FrontStatistics statistics;
    for (int run = 0; run < 9; ++run) {
      // From the position before.
      criteria.plane->offset = -x + 0.1f * (box.upper.x - box.lower.x);
      instance.adapt(criteria);
      static_cast<void>(instance.draw_list());
      criteria.plane->offset = -x;
      auto start = milliseconds();
      statistics = instance.adapt(criteria);
      arriving.push_back(milliseconds_since(start));
      start = milliseconds();
      static_cast<void>(instance.draw_list());
      drawing.push_back(milliseconds_since(start));
      start = milliseconds();
      instance.adapt(criteria);
      staying.push_back(milliseconds_since(start));
    }
    const std::uint64_t sent = indices_sent(instance.draw_list());
    std::printf("| %s | %.1f | %u | %u | %.0f | %.2f | %u | %.3f | %.3f | %.3f |\n",
                subject.name.c_str(), i / 10.0, statistics.vertices, statistics.triangles,
                static_cast<double>(sent), static_cast<double>(sent) / statistics.triangles,
                statistics.forced_splits, median(arriving), median(staying), median(drawing));
  }
}

// Sums of |level - level before| a second; with and without the buffer that is drawn.
void print_seeks(const Subject& subject) {
  const std::uint32_t finest = subject.model->finest_level();
  Random random(1);
  std::vector<std::uint32_t> levels;
  for (int i = 0; i < 200; ++i) levels.push_back(random.below(finest + 1));
  std::vector<std::uint32_t> linear;
  for (std::uint32_t i = 0; i <= 1000; ++i)
    linear.push_back(static_cast<std::uint32_t>(std::uint64_t{finest} * (1000 - i) / 1000));
  const auto tour = [&](const std::vector<std::uint32_t>& stops, bool draw) {
    StripFrameworkInstance instance(subject.model);
    std::vector<double> runs;
    for (int run = 0; run < 7; ++run) {
      instance.go_to_level(stops[0]);
      static_cast<void>(instance.draw_list());
      const auto start = milliseconds();
      for (const std::uint32_t level : stops) {
        instance.go_to_level(level);
        if (draw) static_cast<void>(instance.draw_list());
      }
      runs.push_back(milliseconds_since(start));
    }
    return median(runs);
  };
  double steps = 0;
  for (std::size_t i = 1; i < levels.size(); ++i)
    steps += std::max(levels[i], levels[i - 1]) - std::min(levels[i], levels[i - 1]);
  std::printf("| %s | %.1f | %.1f | %.1f | %.1f |\n", subject.name.c_str(),
              1e-3 * steps / tour(levels, false), 1e-3 * steps / tour(levels, true),
              tour(linear, false), tour(linear, true));
}

}  // namespace

}  // namespace varifold::bench

int main() {
  using namespace varifold::bench;
  const std::vector<std::string> names =
      present({"cow.obj", "bunny.ply", "armadillo.ply", "igea.ply", "fandisk.obj"});
  if (names.empty()) {
    std::fprintf(stderr, "no meshes: set VARIFOLD_MESHES to the folder of cow.obj, ...\n");
    return 1;
  }
  std::vector<Subject> subjects;
  for (const std::string& name : names) subjects.push_back(make_subject(name));
  std::printf(
      "| mesh | vertices | triangles | strips | slots per triangle | records per vertex | thesis' "
      "form: B per vertex / MiB | ours: B per vertex / MiB | of that for fronts | instance | file "
      "|\n");
  for (const Subject& subject : subjects) print_memory(subject);
  std::printf("\n| mesh | level | triangles | unfiltered | sent | per triangle | list |\n");
  for (const Subject& subject : subjects) print_levels(subject);
  std::printf("\n| mesh | error | triangles of the level | of the front |\n");
  for (const Subject& subject : subjects) print_errors(subject);
  std::printf(
      "\n| mesh | plane | vertices | triangles | sent | per triangle | forced splits | adapt ms | "
      "again ms | draw list ms |\n");
  for (const Subject& subject : subjects) print_plane_test(subject);
  std::printf(
      "\n| mesh | random: M collapses/s | with draw list | linear down 1,000: ms | with draw list "
      "|\n");
  for (const Subject& subject : subjects) print_seeks(subject);
  return 0;
}
