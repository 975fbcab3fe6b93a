// varifold bench: how fast models change their level, and how fast the levels are drawn.
#include <apps/cli/bench_camera.h>
#include <apps/cli/bench_device.h>
#include <apps/cli/bench_morph.h>
#include <apps/cli/bench_path.h>
#include <apps/cli/commands.h>
#include <apps/cli/input.h>
#include <apps/cli/level_options.h>
#include <fmt/format.h>
#include <varifold/io/any_model.h>
#include <algorithm>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace varifold::cli {
namespace {

struct BenchCommand {
  CommonOptions common;
  std::vector<std::string> inputs;
  BenchTest test;
  CameraTest camera;
  CameraPath path;  // of the camera test
  std::string draw = "auto";
  std::uint32_t samples = 101;

  [[nodiscard]] bool is_camera_test() const { return test.name == "camera"; }
};

/// Models with levels per region say how they follow a plane: full detail on the side that its
/// normal points to.
template <class Model>
concept FollowsPlane = requires(InstanceOf<Model>& instance, const Vec3& vector) {
  ModelKind<Model>::adapt_to_plane(instance, vector, vector);
};

/// How a model is drawn where "auto" may have been asked for.
template <class Model>
std::string drawn_as(const BenchCommand& command) {
  if (command.draw != "auto") return command.draw;
  return DrawsPatches<Model> ? "indirect" : "multi";
}

/// One walk through a test.
template <class Model>
class BenchWalk {
 public:
  BenchWalk(const BenchCommand& command, const std::shared_ptr<const Model>& model,
            BenchDevice* device)
      : command_(command),
        model_(model),
        instance_(model),
        lists_(model, command.camera.lists),
        device_(device) {
    for (const Vec3& p : model_->attributes().positions) box_.add(p);
  }

  Result<Json> run() {
    instance_.go_to_level(model_->finest_level());
    const FrameList first = lists_.of(instance_);
    if (device_) {
      if (auto set = device_->look_at(model_->attributes().positions, command_.draw == "strips");
          !set)
        return tl::unexpected(set.error());
      if (auto drawn = device_->draw(first); !drawn) return tl::unexpected(drawn.error());
    }
    const std::vector<std::uint32_t> path = bench_path(command_.test, model_->finest_level());
    const std::uint32_t steps = command_.test.steps;
    for (std::uint32_t step = 0; step < steps; ++step) {
      const Stopwatch watch;
      if constexpr (FollowsPlane<Model>) {
        if (is_plane())
          move_plane((step + 1.0) / steps);
        else
          instance_.go_to_level(path[step]);
      } else {
        instance_.go_to_level(path[step]);
      }
      const FrameList list = lists_.of(instance_);
      const double extraction = watch.seconds(), drawn_before = drawing_;
      extraction_ += extraction;
      if (auto drawn = draw(list); !drawn) return tl::unexpected(drawn.error());
      note(step, list, extraction, drawing_ - drawn_before);
    }
    return result();
  }

 private:
  Result<void> draw(const FrameList& list) {
    if (!device_) return {};
    const Stopwatch watch;
    const auto drawn = device_->draw(list);
    drawing_ += watch.seconds();
    if (!drawn) return tl::unexpected(drawn.error());
    uploading_ += drawn->seconds;
    uploaded_ += drawn->bytes;
    return {};
  }

  // Along x, from before the model to behind it; what it has passed is coarse.
  void move_plane(double part) {
    if constexpr (FollowsPlane<Model>) {
      const auto x = static_cast<float>(box_.lower.x + part * (box_.upper.x - box_.lower.x));
      front_ = ModelKind<Model>::adapt_to_plane(instance_, Vec3(x, 0, 0), Vec3(1, 0, 0));
    }
  }

  [[nodiscard]] bool is_plane() const { return command_.test.name == "plane"; }

  // A part of all steps, the first and the last among them.
  void note(std::uint32_t step, const FrameList& list, double extraction, double drawing) {
    const SubmittedIndices sent = submitted_indices(list);
    indices_ += sent.indices;
    const std::uint32_t level = instance_.level();
    if (is_plane()) {
      collapses_ += std::uint64_t{front_.splits} + front_.collapses;
    } else {
      collapses_ += level > before_ ? level - before_ : before_ - level;
      before_ = level;
    }
    const std::uint64_t last = command_.test.steps - 1;
    const std::uint64_t intervals = std::clamp<std::uint64_t>(last, 1, command_.samples - 1);
    if (step != samples_.size() * last / intervals) return;
    Json sample{{"step", step},
                {"indices", sent.indices},
                {"vertices", sent.vertices},
                {"strips", sent.strips},
                {"seconds_extraction", extraction},
                {"seconds_drawing", device_ ? Json(drawing) : Json()}};
    if (is_plane()) {
      sample["triangles"] = front_.triangles;
      sample["forced_splits"] = front_.forced_splits;
    } else {
      sample["level"] = level;
      sample["triangles"] = model_->triangle_count(level);
    }
    samples_.push_back(std::move(sample));
  }

  Json result() const {
    const double total = extraction_ + drawing_;
    const double per_second = static_cast<double>(collapses_) / std::max(extraction_, 1e-9);
    const double vertices = std::max(1u, model_->vertex_count(model_->finest_level()));
    return {{"kind", ModelKind<Model>::kName},
            {"test", command_.test.name},
            {"steps", command_.test.steps},
            {"draw", device_ ? drawn_as<Model>(command_) : "none"},
            {"device", device_ ? Json(device_->name()) : Json()},
            {"seconds_total", total},
            {"seconds_extraction", extraction_},
            {"seconds_drawing", device_ ? Json(drawing_) : Json()},
            {"seconds_upload", device_ ? Json(uploading_) : Json()},
            {"uploaded_bytes_mean",
             device_ ? Json(static_cast<double>(uploaded_) / command_.test.steps) : Json()},
            {"extraction_share", total > 0 ? extraction_ / total : 0},
            {"collapses", collapses_},
            {"collapses_per_second", per_second},
            {"indices_submitted", indices_},
            {"model_bytes", model_->bytes()},
            {"instance_bytes", instance_.bytes()},
            {"bytes_per_vertex", static_cast<double>(model_->bytes()) / vertices},
            {"samples", samples_}};
  }

  const BenchCommand& command_;
  std::shared_ptr<const Model> model_;
  InstanceOf<Model> instance_;
  FrameLists<Model> lists_;
  BenchDevice* device_;
  Box box_;
  double extraction_ = 0, drawing_ = 0, uploading_ = 0;
  std::uint64_t uploaded_ = 0;
  std::uint64_t collapses_ = 0, indices_ = 0;
  std::uint32_t before_ = model_->finest_level();
  FrontStatistics front_;  ///< of the last step of the plane test
  Json samples_ = Json::array();
};

// Wrong usage where the test is not for the model.
void check_test(const BenchCommand& command, const std::string& input, const AnyModel& any) {
  std::visit(
      [&]<class Model>(const std::shared_ptr<const Model>& model) {
        if (command.test.name == "morph" && model->attributes().poses.empty())
          wrong_usage(input + ": --test morph needs a model with poses");
        if (command.test.name == "plane" && !FollowsPlane<Model>)
          wrong_usage(input + ": --test plane needs levels per region; a model of kind " +
                      ModelKind<Model>::kName + " has one level for all");
        if (command.camera.paper_priority && !DrawsPatches<Model>)
          wrong_usage(input + ": --paper-priority is for patch trees, not for kind " +
                      ModelKind<Model>::kName);
        if (command.camera.morph_band && !DrawsPatches<Model>)
          wrong_usage(input + ": --morph-band is for patch trees, not for kind " +
                      ModelKind<Model>::kName);
        if (command.draw == "indirect" && !DrawsPatches<Model>)
          wrong_usage(input + ": --draw indirect is for patch trees, not for kind " +
                      ModelKind<Model>::kName);
        if (command.camera.lists.strips && !MakesStrips<Model>)
          wrong_usage(input + ": --strips makes strips of view-dependent meshes, not of kind " +
                      ModelKind<Model>::kName);
      },
      any);
}

template <class Model>
Result<Json> bench_camera(const BenchCommand& command, const std::shared_ptr<const Model>& model,
                          BenchDevice* device) {
  DrawFrame draw;
  if (device) {
    device->begin(Camera(), command.draw == "strips");
    draw = [device](const FrameList& list, const Camera& camera) {
      return device->draw(list, camera);
    };
  }
  auto result = CameraWalk<Model>(command.camera, model).run(command.path, draw);
  if (!result) return result;
  (*result)["draw"] = device ? drawn_as<Model>(command) : "none";
  (*result)["device"] = device ? Json(device->name()) : Json();
  return result;
}

Result<Json> bench_model(const BenchCommand& command, const AnyModel& any, BenchDevice* device) {
  return std::visit(
      [&]<class Model>(const std::shared_ptr<const Model>& model) -> Result<Json> {
        if (command.is_camera_test()) return bench_camera<Model>(command, model, device);
        if (command.test.name == "morph") {
          const ListOptions lists{.arrays = command.camera.lists.arrays};
          auto result = MorphWalk<Model>(model, command.test.steps, lists, device).run();
          if (result) (*result)["draw"] = device ? drawn_as<Model>(command) : "none";
          return result;
        }
        return BenchWalk<Model>(command, model, device).run();
      },
      any);
}

void add_row(const std::string& input, const Json& result, Report& report) {
  if (result["test"] == "morph") return report.row(input, morph_row(result));
  std::string uploads;
  if (!result["uploaded_bytes_mean"].is_null())
    uploads =
        fmt::format(", {:.0f} bytes uploaded a frame", result["uploaded_bytes_mean"].get<double>());
  if (result["test"] == "camera") return report.row(input, camera_row(result) + uploads);
  std::string text = fmt::format("{}: {} of extraction", result["kind"].get<std::string>(),
                                 format_seconds(result["seconds_extraction"].get<double>()));
  text +=
      fmt::format(", {:.1f} M collapses/s", result["collapses_per_second"].get<double>() * 1e-6);
  if (!result["seconds_drawing"].is_null())
    text += fmt::format(", {} of drawing ({:.1f} % extraction)",
                        format_seconds(result["seconds_drawing"].get<double>()),
                        100 * result["extraction_share"].get<double>());
  text += fmt::format(", {} indices in {} steps",
                      format_count(result["indices_submitted"].get<std::uint64_t>()),
                      format_count(result["steps"].get<std::uint64_t>()));
  report.row(input, text + uploads);
}

// Without a device, "auto" draws nothing.
Result<std::optional<BenchDevice>> make_device(BenchCommand& command) {
  std::optional<BenchDevice> device;
  // Drawing between the frames of a camera would disturb their times.
  if (command.is_camera_test() && command.draw == "auto") command.draw = "none";
  if (command.draw == "none") return device;
  auto made = BenchDevice::create();
  if (made) {
    device.emplace(std::move(*made));
    return device;
  }
  if (command.draw != "auto") return tl::unexpected(std::move(made.error()));
  print_message("bench: nothing is drawn: " + made.error().message);
  return device;
}

CommandResult run_bench(BenchCommand command) {
  if (command.is_camera_test()) {
    auto path = camera_test_path(command.camera);
    if (!path) return tl::unexpected(std::move(path.error()));
    command.path = std::move(*path);
  }
  std::vector<AnyModel> models;
  for (const std::string& input : command.inputs) {
    auto any = read_any_model(input_path(input));
    if (!any) return tl::unexpected(any.error());
    models.push_back(std::move(*any));
  }
  for (std::size_t i = 0; i < models.size(); ++i) check_test(command, command.inputs[i], models[i]);
  auto device = make_device(command);
  if (!device) return tl::unexpected(device.error());
  Report report;
  Json results = Json::array();
  for (std::size_t i = 0; i < models.size(); ++i) {
    auto result = bench_model(command, models[i], *device ? &**device : nullptr);
    if (!result) return fail_in(command.inputs[i], std::move(result.error()));
    add_row(command.inputs[i], *result, report);
    results.push_back(std::move(*result));
  }
  report.set("results", std::move(results));
  return finish(report, command.common);
}

void check_camera_test(const CLI::App& command, const BenchCommand& options) {
  if (options.is_camera_test()) {
    if (options.camera.path.empty()) wrong_usage("--test camera needs a --path");
    if (options.camera.paper_priority && (!options.camera.triangles || options.camera.pixels))
      wrong_usage("--paper-priority has no unit: it needs --triangles, without --pixels");
    if (options.camera.morph_band && (options.draw == "multi" || options.draw == "strips"))
      wrong_usage("--morph-band: index arrays do not blend; it needs --draw indirect or none");
    if (command.count("--steps") > 0) wrong_usage("--steps: a camera has the frames of its path");
    return;
  }
  for (const char* const option :
       {"--path", "--pixels", "--triangles", "--size", "--per-frame", "--no-frustum",
        "--no-orientation", "--strips", "--paper-priority", "--morph-band"})
    if (command.count(option) > 0)
      wrong_usage(std::string(option) + " means nothing to --test " + options.test.name);
}

}  // namespace

void add_bench(CLI::App& app, CommandRunner& runner) {
  CLI::App* const command =
      app.add_subcommand("bench", "Time the changes of level of models, and their drawing");
  const auto options = std::make_shared<BenchCommand>();
  command->add_option("models", options->inputs, "Model files")->required()->type_name("MODEL...");
  command
      ->add_option("--test", options->test.name,
                   "linear: equal strides down and up; exponential: as an object goes away and "
                   "comes back; random: the worst case; plane: full detail on one side of a plane "
                   "that moves along x, for models with levels per region; camera: along a --path; "
                   "morph: from pose to pose in --steps frames, at ten levels and with a change of "
                   "level every 24 frames")
      ->check(CLI::IsMember({"linear", "exponential", "random", "plane", "camera", "morph"}))
      ->capture_default_str()
      ->type_name("TEST");
  command->add_option("--steps", options->test.steps, "Changes of level")
      ->check(CLI::Range(1, 10000000))
      ->capture_default_str()
      ->type_name("N");
  command
      ->add_option("--samples", options->samples,
                   "At most so many steps are told one by one in the JSON, the first and the last "
                   "among them")
      ->check(CLI::Range(2, 10000000))
      ->capture_default_str()
      ->type_name("N");
  command->add_option("--seed", options->test.seed, "Of the random test")
      ->capture_default_str()
      ->type_name("S");
  command
      ->add_option("--draw", options->draw,
                   "none: extraction alone; strips: a call for each strip; multi: one for all; "
                   "indirect: one for all patches of a tree, whose indices never change; auto: "
                   "indirect or else multi where there is a device, none for a camera")
      ->check(CLI::IsMember({"auto", "none", "strips", "multi", "indirect"}))
      ->capture_default_str()
      ->type_name("HOW");
  add_camera_test_options(*command, options->camera);
  runner.add_common(*command, options->common, false);
  runner.attach(*command, options->common, [options, command] {
    check_camera_test(*command, *options);
    CameraTest& camera = options->camera;
    if (camera.morph_band)
      camera.lists.morphs =
          camera.paper_priority ? PatchMeasure::kMeanSquared : PatchMeasure::kPixels;
    camera.lists.arrays = options->draw == "multi" || options->draw == "strips";
    return run_bench(*options);
  });
}

}  // namespace varifold::cli
