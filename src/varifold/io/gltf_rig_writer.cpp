#include <varifold/io/gltf_rig_writer.h>

#include <varifold/io/gltf_scene.h>
#include <varifold/io/pose_channels.h>
#include <varifold/mesh/rig.h>
#include <algorithm>
#include <array>
#include <glm/gtc/type_ptr.hpp>
#include <map>

namespace varifold::gltf {
namespace {

using Json = OutputJson;

Json numbers(const float* values, std::size_t count) {
  Json array = Json::array();
  for (std::size_t i = 0; i < count; ++i) array.push_back(values[i]);
  return array;
}

Json json_of(const RigNode& node) {
  Json json = Json::object();
  if (!node.name.empty()) json["name"] = node.name;
  if (node.has_matrix) {
    json["matrix"] = numbers(glm::value_ptr(node.matrix), 16);
    return json;
  }
  if (node.translation != Vec3(0))
    json["translation"] = numbers(glm::value_ptr(node.translation), 3);
  if (node.rotation != Quat(1, 0, 0, 0))
    json["rotation"] = {node.rotation.x, node.rotation.y, node.rotation.z, node.rotation.w};
  if (node.scale != Vec3(1)) json["scale"] = numbers(glm::value_ptr(node.scale), 3);
  return json;
}

class SceneWriter {
 public:
  SceneWriter(const TriangleMesh& mesh, Output& output)
      : mesh_(mesh), rig_(mesh.rig ? *mesh.rig : kNoRig), output_(output) {}

  void write() {
    for (const RigNode& node : rig_.nodes) nodes_.push_back(json_of(node));
    for (std::size_t i = 0; i < rig_.nodes.size(); ++i)
      if (const std::uint32_t parent = rig_.nodes[i].parent; parent == kNone)
        roots_.push_back(i);
      else
        nodes_[parent]["children"].push_back(i);
    Json mesh_node = {{"mesh", 0}};
    if (mesh_.has_skin() && !rig_.joints.empty()) mesh_node["skin"] = add_skin();
    if (mesh_node.contains("skin")) add_frame();
    mesh_place_ = nodes_.size();
    roots_.push_back(mesh_place_);
    nodes_.push_back(std::move(mesh_node));
    output_.document["scenes"] = Json::array({{{"nodes", roots_}}});
    output_.document["nodes"] = std::move(nodes_);
    add_pose_names();
    for (const Animation& animation : rig_.animations) add_animation(animation);
  }

 private:
  std::size_t add_skin() {
    std::vector<bool> is_taken(rig_.nodes.size(), false);
    Json joints = Json::array();
    std::vector<float> matrices;
    for (const Joint& joint : rig_.joints) {
      std::size_t node = joint.node;
      if (is_taken[node]) {
        node = nodes_.size();
        nodes_[joint.node]["children"].push_back(node);
        nodes_.push_back(Json::object());
      } else {
        is_taken[node] = true;
      }
      joints.push_back(node);
      const float* const values = glm::value_ptr(joint.inverse_bind);
      matrices.insert(matrices.end(), values, values + 16);
    }
    const std::size_t accessor = output_.add_floats(matrices, "MAT4", 16, Output::Target::kNone);
    output_.document["skins"] =
        Json::array({{{"inverseBindMatrices", accessor}, {"joints", std::move(joints)}}});
    return 0;
  }

  /// glTF wants the joints of a skin to have one root; readers of ours take it off again.
  void add_frame() {
    if (roots_.size() < 2) return;
    const std::size_t frame = nodes_.size();
    nodes_.push_back({{"children", roots_}, {"extras", {{kFrameMark, true}}}});
    roots_ = Json::array({frame});
  }

  void add_pose_names() {
    if (mesh_.poses.empty()) return;
    Json& mesh = output_.document["meshes"][0];
    if (!rig_.pose_weights.empty())
      mesh["weights"] = numbers(rig_.pose_weights.data(), rig_.pose_weights.size());
    for (const Pose& pose : mesh_.poses) mesh["extras"]["targetNames"].push_back(pose.name);
  }

  void add_animation(const Animation& animation) {
    Json channels = Json::array();
    Json samplers = Json::array();
    const auto add = [&](const AnimationChannel& channel) {
      const bool weighs = channel.target == ChannelTarget::kPoseWeights;
      static constexpr std::array<const char*, 4> kPaths{"translation", "rotation", "scale",
                                                         "weights"};
      channels.push_back({{"sampler", samplers.size()},
                          {"target",
                           {{"node", weighs ? mesh_place_ : channel.index},
                            {"path", kPaths[static_cast<std::size_t>(channel.target)]}}}});
      samplers.push_back(add_sampler(channel));
    };
    for (const AnimationChannel& channel : animation.channels)
      if (channel.target != ChannelTarget::kPoseWeights && !channel.times.empty()) add(channel);
    if (const auto weights = merge_pose_channels(animation, mesh_.poses.size(), rig_.pose_weights))
      add(*weights);
    if (channels.empty()) return;  // glTF has no empty animations
    Json entry = Json::object();
    if (!animation.name.empty()) entry["name"] = animation.name;
    entry["channels"] = std::move(channels);
    entry["samplers"] = std::move(samplers);
    output_.document["animations"].push_back(std::move(entry));
  }

  Json add_sampler(const AnimationChannel& channel) {
    auto times = accessor_of_times_.find(channel.times);
    if (times == accessor_of_times_.end()) {
      const std::size_t accessor =
          output_.add_floats(channel.times, "SCALAR", 1, Output::Target::kNone);
      output_.set_bounds(channel.times, 1);
      times = accessor_of_times_.emplace(channel.times, accessor).first;
    }
    const bool weighs = channel.target == ChannelTarget::kPoseWeights;
    const bool turns = channel.target == ChannelTarget::kRotation;
    const std::size_t values =
        output_.add_floats(channel.values,
                           weighs  ? "SCALAR"
                           : turns ? "VEC4"
                                   : "VEC3",
                           weighs ? 1 : channel.width, Output::Target::kNone);
    static constexpr std::array<const char*, 3> kInterpolations{"STEP", "LINEAR", "CUBICSPLINE"};
    return {{"input", times->second},
            {"interpolation", kInterpolations[static_cast<std::size_t>(channel.interpolation)]},
            {"output", values}};
  }

  static inline const Rig kNoRig;

  const TriangleMesh& mesh_;
  const Rig& rig_;
  Output& output_;
  Json nodes_ = Json::array();
  Json roots_ = Json::array();
  std::size_t mesh_place_ = 0;
  std::map<std::vector<float>, std::size_t> accessor_of_times_;
};

std::vector<Vec3> offsets(const std::vector<Vec3>& values, const std::vector<Vec3>& rest) {
  std::vector<Vec3> result(values.size());
  for (std::size_t i = 0; i < values.size(); ++i) result[i] = values[i] - rest[i];
  return result;
}

}  // namespace

void add_skin_attributes(const TriangleMesh& mesh, OutputJson& attributes, Output& output) {
  if (!mesh.has_skin() || !mesh.rig || mesh.rig->joints.empty()) return;
  std::vector<std::uint16_t> joints;
  std::vector<float> weights;
  for (const JointWeights& followed : mesh.skin) {
    joints.insert(joints.end(), followed.joints.begin(), followed.joints.end());
    weights.insert(weights.end(), followed.weights.begin(), followed.weights.end());
  }
  constexpr std::size_t kBytes = 256;
  if (mesh.rig->joints.size() <= kBytes)
    attributes["JOINTS_0"] =
        output.add_bytes(std::vector<std::uint8_t>(joints.begin(), joints.end()), "VEC4", 4, false);
  else
    attributes["JOINTS_0"] = output.add_shorts(joints, "VEC4", 4);
  attributes["WEIGHTS_0"] = output.add_floats(weights, "VEC4", 4, Output::Target::kVertices);
}

OutputJson add_targets(const TriangleMesh& mesh, Output& output) {
  OutputJson targets = OutputJson::array();
  for (const Pose& pose : mesh.poses) {
    OutputJson target = {{"POSITION", output.add_offsets(offsets(pose.positions, mesh.positions))}};
    if (!pose.normals.empty() && mesh.has_normals())
      target["NORMAL"] = output.add_offsets(offsets(pose.normals, mesh.normals));
    targets.push_back(std::move(target));
  }
  return targets;
}

void add_scene(const TriangleMesh& mesh, Output& output) { SceneWriter(mesh, output).write(); }

}  // namespace varifold::gltf
