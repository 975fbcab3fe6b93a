// varifold bench: how fast models change their level.
//
// Based on: the linear, exponential and random tests by which the LodStrips thesis measures
//   extraction.
#include <apps/cli/commands.h>
#include <apps/cli/input.h>
#include <fmt/format.h>
#include <varifold/base/random.h>
#include <varifold/models/pm/instance.h>
#include <algorithm>
#include <memory>
#include <string>
#include <vector>

namespace varifold::cli {
namespace {

struct BenchCommand {
  CommonOptions common;
  std::vector<std::string> inputs;
  std::string test = "linear";
  std::uint32_t steps = 1000;
  std::uint64_t seed = 1;
};

// Equal strides from full detail to the base and back.
std::vector<std::uint32_t> linear_path(std::uint32_t finest, std::uint32_t steps) {
  std::vector<std::uint32_t> path;
  for (std::uint32_t i = 0; i < steps; ++i) {
    const double t = 2.0 * (i + 1) / steps;
    path.push_back(static_cast<std::uint32_t>(finest * (t <= 1 ? 1 - t : t - 1)));
  }
  return path;
}

// Down and up again like an object that goes away at a steady speed: the detail that it needs falls
// with the square of its distance, here from one to thirty times the nearest.
std::vector<std::uint32_t> exponential_path(std::uint32_t finest, std::uint32_t steps) {
  std::vector<std::uint32_t> path;
  for (std::uint32_t i = 0; i < steps; ++i) {
    const double t = 2.0 * (i + 1) / steps;
    const double distance = 1 + 29 * (t <= 1 ? t : 2 - t);
    path.push_back(static_cast<std::uint32_t>(finest / (distance * distance)));
  }
  return path;
}

std::vector<std::uint32_t> random_path(std::uint32_t finest, const BenchCommand& command) {
  Random random(command.seed);
  std::vector<std::uint32_t> path(command.steps);
  for (std::uint32_t& level : path) level = random.below(finest + 1);
  return path;
}

std::vector<std::uint32_t> path_of(const BenchCommand& command, std::uint32_t finest) {
  if (command.test == "linear") return linear_path(finest, command.steps);
  if (command.test == "exponential") return exponential_path(finest, command.steps);
  return random_path(finest, command);
}

Json bench_model(const BenchCommand& command, const SharedModel& model) {
  const std::vector<std::uint32_t> path = path_of(command, model->finest_level());
  ProgressiveMeshInstance instance(model);
  instance.go_to_level(model->finest_level());
  std::uint64_t collapses = 0, indices = 0;
  std::uint32_t before = instance.level();
  const Stopwatch watch;
  for (const std::uint32_t level : path) {
    instance.go_to_level(level);
    for (const DrawRange& range : instance.draw_list().ranges) indices += range.index_count;
    collapses += level > before ? level - before : before - level;
    before = level;
  }
  const double seconds = watch.seconds();
  return {{"kind", "pm"},
          {"test", command.test},
          {"steps", command.steps},
          {"seconds_total", seconds},
          {"seconds_extraction", seconds},
          {"seconds_drawing", nullptr},  // nothing is drawn
          {"collapses", collapses},
          {"collapses_per_second", static_cast<double>(collapses) / std::max(seconds, 1e-9)},
          {"indices_submitted", indices},
          {"bytes_per_vertex",
           static_cast<double>(model->bytes()) / std::max(1u, model->data().mesh.vertex_count())}};
}

CommandResult run_bench(const BenchCommand& command) {
  Report report;
  Json results = Json::array();
  for (const std::string& input : command.inputs) {
    const auto model = read_model(input_path(input));
    if (!model) return tl::unexpected(model.error());
    Json result = bench_model(command, *model);
    report.row(input, fmt::format("{:.1f} M collapses/s, {} in {} steps",
                                  result["collapses_per_second"].get<double>() * 1e-6,
                                  format_seconds(result["seconds_total"].get<double>()),
                                  format_count(command.steps)));
    results.push_back(std::move(result));
  }
  report.set("results", std::move(results));
  return finish(report, command.common);
}

}  // namespace

void add_bench(CLI::App& app, CommandRunner& runner) {
  CLI::App* const command = app.add_subcommand("bench", "Time the changes of level of models");
  const auto options = std::make_shared<BenchCommand>();
  command->add_option("models", options->inputs, "Model files")->required()->type_name("MODEL...");
  command
      ->add_option("--test", options->test,
                   "linear: equal strides down and up; exponential: as an object goes away and "
                   "comes back; random: the worst case")
      ->check(CLI::IsMember({"linear", "exponential", "random"}))
      ->capture_default_str()
      ->type_name("TEST");
  command->add_option("--steps", options->steps, "Changes of level")
      ->check(CLI::Range(1, 10000000))
      ->capture_default_str()
      ->type_name("N");
  command->add_option("--seed", options->seed, "Of the random test")
      ->capture_default_str()
      ->type_name("S");
  runner.add_common(*command, options->common, false);
  runner.attach(*command, options->common, [options] { return run_bench(*options); });
}

}  // namespace varifold::cli
