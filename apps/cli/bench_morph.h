// The morph test of `varifold bench`: a mesh that moves, 24 frames a second, at constant levels and
// with a change of level every 24 frames.
//
// Based on: [Ramos2008] section 6.6.2, figure 6.7.
#pragma once

#include <apps/cli/bench_device.h>
#include <apps/cli/context.h>
#include <apps/cli/frame_lists.h>
#include <apps/cli/pose_options.h>
#include <varifold/io/any_model.h>
#include <varifold/mesh/pose_blend.h>
#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace varifold::cli {

inline constexpr double kFramesPerSecond = 24;

/// Weights on the way from the shape at rest through all poses; `part` from 0 to 1.
[[nodiscard]] std::vector<float> weights_on_way(std::size_t poses, double part);

/// One line for people.
[[nodiscard]] std::string morph_row(const Json& result);

template <class Model>
class MorphWalk {
 public:
  MorphWalk(const std::shared_ptr<const Model>& model, std::uint32_t frames,
            const ListOptions& lists, BenchDevice* device)
      : model_(model),
        instance_(model),
        lists_(model, lists),
        frames_(std::max(2u, frames)),
        device_(device) {
    for (std::uint32_t i = 0; i < frames_; ++i)
      weights_.push_back(weights_on_way(model->attributes().poses.size(), i / (frames_ - 1.0)));
  }

  Result<Json> run() {
    instance_.go_to_level(model_->finest_level());
    if (device_)
      if (auto set = device_->look_at(model_->attributes().positions, false); !set)
        return tl::unexpected(set.error());
    Json constant = Json::array();
    for (int tenths = 10; tenths >= 1; --tenths)
      constant.push_back(constant_level(static_cast<float>(tenths) / 10));
    auto changing = level_every_second();
    if (!changing) return changing;
    const double vertices = std::max(1u, model_->vertex_count(model_->finest_level()));
    return Json{
        {"kind", ModelKind<Model>::kName},
        {"test", "morph"},
        {"steps", steps_},
        {"frames", frames_},
        {"device", device_ ? Json(device_->name()) : Json()},
        {"seconds_total", extraction_ + drawing_},
        {"seconds_extraction", extraction_},
        {"seconds_drawing", device_ ? Json(drawing_) : Json()},
        {"collapses_per_second", static_cast<double>(collapses_) / std::max(extraction_, 1e-9)},
        {"indices_submitted", indices_},
        {"model_bytes", model_->bytes()},
        {"instance_bytes", instance_.bytes()},
        {"bytes_per_vertex", static_cast<double>(model_->bytes()) / vertices},
        {"blend_on_processor_ms", blend_milliseconds()},
        {"constant_levels", std::move(constant)},
        {"level_every_24_frames", std::move(*changing)}};
  }

 private:
  // From frame to frame; the time until the list is there.
  double extract(std::uint32_t frame, std::uint32_t level) {
    const Stopwatch watch;
    go_to_pose(instance_, ChosenPose{.weights = weights_[frame]});
    instance_.go_to_level(level);
    list_ = lists_.of(instance_);
    const double seconds = watch.seconds();
    extraction_ += seconds;
    ++steps_;
    indices_ += submitted_indices(list_).indices;
    collapses_ += level > before_ ? level - before_ : before_ - level;
    before_ = level;
    return seconds;
  }

  // Figure 6.7a: what a frame costs while the shape changes and the level does not.
  Json constant_level(float fraction) {
    const std::uint32_t level = model_->level_for_fraction(fraction);
    static_cast<void>(extract(0, level));
    double sum = 0, greatest = 0;
    Json frames = Json::array();
    for (std::uint32_t frame = 0; frame < frames_; ++frame) {
      const double seconds = extract(frame, level);
      sum += seconds;
      greatest = std::max(greatest, seconds);
      frames.push_back(1e3 * seconds);
    }
    const double mean = sum / frames_;
    return {{"fraction", fraction},
            {"triangles", model_->triangle_count(level)},
            {"mean_ms", 1e3 * mean},
            {"greatest_ms", 1e3 * greatest},
            {"mean_share_of_frame", mean * kFramesPerSecond},
            {"greatest_share_of_frame", greatest * kFramesPerSecond},
            {"frames_ms", std::move(frames)}};
  }

  // Figure 6.7b: coarser every 24 frames, drawn where there is a device.
  Result<Json> level_every_second() {
    constexpr std::uint32_t kPerLevel = 24, kLevels = 10;
    double extraction = 0, drawing = 0, greatest = 0;
    Json levels = Json::array();
    for (std::uint32_t coarser = 0; coarser < kLevels; ++coarser) {
      const float fraction = 1 - static_cast<float>(coarser) / kLevels;
      const std::uint32_t level = model_->level_for_fraction(fraction);
      double extracted = 0, drawn = 0;
      for (std::uint32_t i = 0; i < kPerLevel; ++i) {
        const std::uint32_t frame = (coarser * kPerLevel + i) % frames_;
        const double seconds = extract(frame, level);
        extracted += seconds;
        greatest = std::max(greatest, seconds);
        auto shown = draw(frame);
        if (!shown) return tl::unexpected(shown.error());
        drawn += *shown;
      }
      levels.push_back({{"fraction", fraction},
                        {"triangles", model_->triangle_count(level)},
                        {"extraction_ms", 1e3 * extracted / kPerLevel},
                        {"drawing_ms", device_ ? Json(1e3 * drawn / kPerLevel) : Json()}});
      extraction += extracted;
      drawing += drawn;
    }
    drawing_ += drawing;
    const double frames = kPerLevel * kLevels;
    return Json{{"frames", frames},
                {"seconds_extraction", extraction},
                {"seconds_drawing", device_ ? Json(drawing) : Json()},
                {"greatest_share_of_frame", greatest * kFramesPerSecond},
                {"mean_share_of_frame", extraction / frames * kFramesPerSecond},
                {"frames_per_second", device_ ? Json(frames / (extraction + drawing)) : Json()},
                {"levels", std::move(levels)}};
  }

  // Seconds; 0 without a device.
  Result<double> draw(std::uint32_t frame) {
    if (!device_) return 0;
    device_->set_pose({weights_[frame], {}});
    const Stopwatch watch;
    if (auto drawn = device_->draw(list_); !drawn) return tl::unexpected(drawn.error());
    return watch.seconds();
  }

  // What the vertex shader saves.
  [[nodiscard]] double blend_milliseconds() const {
    PosedVertices vertices;
    blend_poses(model_->attributes(), weights_[1], vertices);
    const Stopwatch watch;
    for (const auto& weights : weights_) blend_poses(model_->attributes(), weights, vertices);
    return 1e3 * watch.seconds() / static_cast<double>(weights_.size());
  }

  std::shared_ptr<const Model> model_;
  InstanceOf<Model> instance_;
  FrameLists<Model> lists_;
  std::uint32_t frames_;
  BenchDevice* device_;
  std::vector<std::vector<float>> weights_;
  FrameList list_;
  double extraction_ = 0, drawing_ = 0;
  std::uint64_t steps_ = 0, collapses_ = 0, indices_ = 0;
  std::uint32_t before_ = model_->finest_level();
};

}  // namespace varifold::cli
