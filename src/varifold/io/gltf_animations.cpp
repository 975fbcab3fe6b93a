#include <varifold/io/gltf_animations.h>

#include <fmt/format.h>
#include <varifold/io/import_check.h>
#include <algorithm>
#include <cmath>
#include <optional>

namespace varifold::gltf {
namespace {

class AnimationReader {
 public:
  AnimationReader(const JsonElement& root, const AnimatedNodes& nodes, BufferStore& buffers,
                  Budget& budget, FirstFault& faults)
      : root_(root), nodes_(nodes), buffers_(buffers), budget_(budget), fault_(faults) {}

  void read() {
    const JsonElement animations = root_.array("animations");
    for (std::size_t i = 0; i < animations.size() && !fault_.any(); ++i)
      read_animation(animations.item(i));
  }
  [[nodiscard]] std::size_t dropped_channels() const { return dropped_channels_; }

 private:
  void read_animation(const JsonElement& element) {
    Animation animation{element.text("name"), {}};
    const JsonElement channels = element.array("channels");
    for (std::size_t i = 0; i < channels.size() && !fault_.any(); ++i) {
      const JsonElement channel = channels.item(i);
      auto target = read_target(channel.object("target"));
      if (!target) {
        ++dropped_channels_;
        continue;
      }
      read_sampler(element.array("samplers").item(channel.whole("sampler")), *target);
      if (!target->times.empty()) animation.channels.push_back(std::move(*target));
    }
    if (!animation.channels.empty()) nodes_.rig.animations.push_back(std::move(animation));
  }

  /// Nothing where the channel moves nothing that the mesh has.
  std::optional<AnimationChannel> read_target(const JsonElement& target) {
    const std::string path = target.text("path");
    const std::uint64_t node = target.has("node") ? target.whole("node") : kNone;
    if (node >= nodes_.rig_node.size()) return std::nullopt;
    AnimationChannel channel;
    if (path == "weights") {
      const PoseRange& poses = nodes_.poses[node];
      channel.target = ChannelTarget::kPoseWeights;
      channel.index = poses.first;
      channel.width = poses.count;
      return poses.count > 0 ? std::optional(channel) : std::nullopt;
    }
    channel.index = nodes_.rig_node[node];
    // A matrix leaves nothing that could be animated.
    if (channel.index == kNone || nodes_.rig.nodes[channel.index].has_matrix) return std::nullopt;
    if (path == "translation") return channel;
    channel.target = ChannelTarget::kScale;
    if (path == "scale") return channel;
    channel.target = ChannelTarget::kRotation;
    channel.width = 4;
    return path == "rotation" ? std::optional(channel) : std::nullopt;
  }

  void read_sampler(const JsonElement& sampler, AnimationChannel& channel) {
    const std::string interpolation = sampler.text("interpolation", "LINEAR");
    if (interpolation == "STEP")
      channel.interpolation = Interpolation::kStep;
    else if (interpolation == "CUBICSPLINE")
      channel.interpolation = Interpolation::kCubicSpline;
    else if (interpolation != "LINEAR")
      sampler.fault("unknown interpolation " + in_quotes(interpolation));
    const std::uint64_t input = sampler.whole("input");
    const std::uint64_t output = sampler.whole("output");
    if (fault_.any()) return;
    const Accessor times = buffers_.accessor(input);
    const Accessor values = buffers_.accessor(output);
    if (fault_.any()) return;
    if (times.components != 1 || times.elements.type != ComponentType::kFloat32)
      return sampler.fault("input is not one float a key");
    const bool are_weights = channel.target == ChannelTarget::kPoseWeights;
    if (values.components != (are_weights ? 1 : channel.width) ||
        values.elements.type == ComponentType::kUint32)
      return sampler.fault(fmt::format("output has {} components", values.components));
    const std::size_t keys = times.elements.count;
    // Neither product can overflow: counts are at most 2^53, but bounded by the bytes of buffers.
    const std::size_t a_key = (channel.interpolation == Interpolation::kCubicSpline ? 3 : 1) *
                              std::size_t{are_weights ? channel.width : 1};
    if (values.elements.count / a_key != keys || values.elements.count % a_key != 0)
      return sampler.fault(fmt::format("{} keys need {} elements each, but output has {}", keys,
                                       a_key, values.elements.count));
    if (!budget_.spend((keys + values.elements.count * values.components) * sizeof(float)))
      return sampler.fault("the animations take many times the size of the file",
                           ErrorKind::kUnsupported);
    channel.times = decode_floats(times);
    channel.values = decode_floats(values);
    check_keys(sampler, channel);
  }

  static void check_keys(const JsonElement& sampler, const AnimationChannel& channel) {
    const auto is_finite = [](float value) { return std::isfinite(value); };
    for (std::size_t i = 0; i < channel.times.size(); ++i)
      if (!is_finite(channel.times[i]) || (i > 0 && channel.times[i] < channel.times[i - 1]))
        return sampler.fault(fmt::format("input: time {} is not after the one before it", i));
    const auto bad = std::find_if_not(channel.values.begin(), channel.values.end(), is_finite);
    if (bad != channel.values.end())
      sampler.fault(fmt::format("output: number {} is not finite", bad - channel.values.begin()));
  }

  JsonElement root_;
  const AnimatedNodes& nodes_;
  BufferStore& buffers_;
  Budget& budget_;
  FirstFault& fault_;
  std::size_t dropped_channels_ = 0;
};

}  // namespace

void read_animations(const JsonElement& root, const AnimatedNodes& nodes, BufferStore& buffers,
                     Budget& budget, FirstFault& faults, ImportedMesh& imported) {
  AnimationReader reader(root, nodes, buffers, budget, faults);
  reader.read();
  warn_count(imported, reader.dropped_channels(),
             "channels of animations move nothing of the mesh, and were dropped");
}

}  // namespace varifold::gltf
