#include <varifold/io/pose_channels.h>

#include <varifold/mesh/rig_pose.h>
#include <algorithm>
#include <span>

namespace varifold::gltf {
namespace {

/// All keys of the channels, and times between them where `is_dense`; ascending, each once.
std::vector<float> union_of_times(const std::vector<const AnimationChannel*>& channels,
                                  bool is_dense) {
  std::vector<float> times;
  for (const AnimationChannel* channel : channels)
    times.insert(times.end(), channel->times.begin(), channel->times.end());
  std::sort(times.begin(), times.end());
  constexpr double kSamplesPerSecond = 60;
  constexpr double kMostSamples = 1 << 16;
  const double first = times.front();
  const double samples = std::min((double{times.back()} - first) * kSamplesPerSecond, kMostSamples);
  const double seconds = samples > 0 ? (double{times.back()} - first) / samples : 0;
  if (is_dense)
    for (double i = 1; i < samples; ++i) times.push_back(static_cast<float>(first + i * seconds));
  std::sort(times.begin(), times.end());
  times.erase(std::unique(times.begin(), times.end()), times.end());
  return times;
}

}  // namespace

std::optional<AnimationChannel> merge_pose_channels(const Animation& animation,
                                                    std::size_t pose_count,
                                                    const std::vector<float>& rest) {
  std::vector<const AnimationChannel*> channels;
  for (const AnimationChannel& channel : animation.channels)
    if (channel.target == ChannelTarget::kPoseWeights && !channel.times.empty())
      channels.push_back(&channel);
  if (channels.empty() || pose_count == 0) return std::nullopt;
  if (channels.size() == 1 && channels[0]->width == pose_count) return *channels[0];

  const auto all = [&](Interpolation interpolation) {
    return std::all_of(channels.begin(), channels.end(), [&](const AnimationChannel* channel) {
      return channel->interpolation == interpolation;
    });
  };
  AnimationChannel merged;
  merged.target = ChannelTarget::kPoseWeights;
  merged.width = static_cast<std::uint32_t>(pose_count);
  const bool are_steps = all(Interpolation::kStep);
  merged.interpolation = are_steps ? Interpolation::kStep : Interpolation::kLinear;
  merged.times = union_of_times(channels, !are_steps && !all(Interpolation::kLinear));
  std::vector<float> row(pose_count, 0.0f);
  std::copy_n(rest.begin(), std::min(rest.size(), pose_count), row.begin());
  for (const float time : merged.times) {
    for (const AnimationChannel* channel : channels)
      sample_channel(*channel, time, std::span(row).subspan(channel->index, channel->width));
    merged.values.insert(merged.values.end(), row.begin(), row.end());
  }
  return merged;
}

}  // namespace varifold::gltf
