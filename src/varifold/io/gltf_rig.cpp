#include <varifold/io/gltf_rig.h>

#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <glm/gtc/type_ptr.hpp>
#include <glm/matrix.hpp>
#include <numeric>
#include <optional>

namespace varifold::gltf {
namespace {

bool is_finite(const Mat4& matrix) {
  const float* const values = glm::value_ptr(matrix);
  return std::all_of(values, values + 16, [](float value) { return std::isfinite(value); });
}

/// Nothing where the inverse has no room in floats.
std::optional<Mat4> inverse(const glm::dmat4& matrix) {
  const Mat4 result(glm::inverse(matrix));
  return is_finite(result) ? std::optional(result) : std::nullopt;
}

template <std::size_t kCount>
bool read_floats(const JsonElement& node, const char* key, float* values) {
  std::array<double, kCount> numbers{};
  if (!node.numbers(key, numbers)) return false;
  for (std::size_t i = 0; i < kCount; ++i) {
    values[i] = static_cast<float>(numbers[i]);
    if (!std::isfinite(values[i])) node.fault(fmt::format("{} is not finite", key));
  }
  return true;
}

RigNode read_node(const JsonElement& node) {
  RigNode result;
  result.name = node.text("name");
  result.has_matrix = read_floats<16>(node, "matrix", glm::value_ptr(result.matrix));
  if (result.has_matrix) return result;
  read_floats<3>(node, "translation", glm::value_ptr(result.translation));
  std::array<float, 4> rotation{0, 0, 0, 1};
  read_floats<4>(node, "rotation", rotation.data());
  result.rotation = Quat(rotation[3], rotation[0], rotation[1], rotation[2]);
  read_floats<3>(node, "scale", glm::value_ptr(result.scale));
  return result;
}

}  // namespace

RigBuilder::RigBuilder(const JsonElement& root, const Scene& scene, BufferStore& buffers,
                       Budget& budget, FirstFault& faults)
    : root_(root),
      scene_(scene),
      buffers_(buffers),
      budget_(budget),
      fault_(faults),
      moves_(scene.nodes.size(), false),
      joints_of_skin_(root.array("skins").size()),
      joints_at_(scene.nodes.size() + 1) {
  find_moving_nodes();
  for (std::size_t place = 0; place < scene.nodes.size(); ++place) {
    const SceneNode& node = scene.nodes[place];
    if (!node.has_mesh || node.index == kNone) continue;
    if (moves_[place] || root_.array("nodes").item(node.index).has("skin")) has_joints_ = true;
  }
}

void RigBuilder::find_moving_nodes() {
  const JsonElement animations = root_.array("animations");
  for (std::size_t a = 0; a < animations.size() && !fault_.any(); ++a) {
    const JsonElement channels = animations.item(a).array("channels");
    for (std::size_t c = 0; c < channels.size(); ++c) {
      const JsonElement target = channels.item(c).object("target");
      const std::string path = target.text("path");
      if (!target.has("node")) continue;
      const std::uint64_t node = target.whole("node");
      if (node >= scene_.place_of.size())
        return target.fault(
            fmt::format("node {} does not exist ({} nodes)", node, scene_.place_of.size()));
      const bool is_move = path == "translation" || path == "rotation" || path == "scale";
      if (is_move && scene_.place_of[node] != kNone) moves_[scene_.place_of[node]] = true;
    }
  }
  for (std::size_t place = 0; place < moves_.size(); ++place)
    if (const std::uint32_t parent = scene_.nodes[place].parent; parent != kNone && moves_[parent])
      moves_[place] = true;
}

std::uint16_t RigBuilder::add_joint(const BoundJoint& joint) {
  const std::size_t at = joint.place == kNone ? scene_.nodes.size() : joint.place;
  // Skins share few matrices of a node; a file that has many would make this quadratic.
  constexpr std::size_t kMostCompared = 64;
  const std::span known_here(joints_at_[at]);
  for (const std::uint16_t known : known_here.first(std::min(known_here.size(), kMostCompared)))
    if (joints_[known].inverse_bind == joint.inverse_bind) return known;
  constexpr std::size_t kMostJoints = 65536;
  if (joints_.size() >= kMostJoints) {
    fault_.set(ErrorKind::kUnsupported, "skins: more joints than 16 bits can count");
    return 0;
  }
  const auto added = static_cast<std::uint16_t>(joints_.size());
  joints_.push_back(joint);
  joints_at_[at].push_back(added);
  return added;
}

void RigBuilder::read_skin(std::uint64_t index) {
  const JsonElement skin = root_.array("skins").item(index);
  const JsonElement joints = skin.array("joints");
  if (joints.size() == 0) skin.fault("has no joints");
  if (fault_.any()) return;
  std::vector<Mat4> matrices(1, Mat4(1));
  if (skin.has("inverseBindMatrices")) {
    const Accessor accessor = buffers_.accessor(skin.whole("inverseBindMatrices"));
    if (fault_.any()) return;
    if (accessor.components != 16 || accessor.elements.type != ComponentType::kFloat32)
      return skin.fault("inverseBindMatrices are not 4 x 4 floats");
    if (accessor.elements.count < joints.size())
      return skin.fault(fmt::format("{} joints, but {} inverseBindMatrices", joints.size(),
                                    accessor.elements.count));
    if (!budget_.spend(2 * accessor.elements.count * sizeof(Mat4)))
      return skin.fault("the skins take many times the size of the file", ErrorKind::kUnsupported);
    const std::vector<float> values = decode_floats(accessor);
    matrices.resize(accessor.elements.count);
    for (std::size_t i = 0; i < matrices.size(); ++i) matrices[i] = glm::make_mat4(&values[16 * i]);
  }
  for (std::size_t i = 0; i < joints.size() && !fault_.any(); ++i) {
    const std::uint64_t node = joints.whole_item(i);
    if (node >= scene_.place_of.size() || scene_.place_of[node] == kNone)
      return skin.fault(fmt::format("joint {}: node {} is not in the scene", i, node));
    const Mat4& inverse_bind = matrices.size() == 1 ? matrices[0] : matrices[i];
    if (!is_finite(inverse_bind))
      return skin.fault(fmt::format("joint {}: inverseBindMatrices are not finite", i));
    joints_of_skin_[index].push_back(add_joint({scene_.place_of[node], inverse_bind}));
  }
}

JointBinding RigBuilder::bind_to_skin(std::uint32_t place) {
  const JsonElement node = root_.array("nodes").item(scene_.nodes[place].index);
  const std::uint64_t skin = node.whole("skin");
  if (skin >= joints_of_skin_.size())
    node.fault(fmt::format("skin {} does not exist ({} skins)", skin, joints_of_skin_.size()));
  if (fault_.any()) return {};
  if (joints_of_skin_[skin].empty()) read_skin(skin);
  return {JointBinding::Kind::kSkin, 0, joints_of_skin_[skin]};
}

JointBinding RigBuilder::bind_to_node(std::uint32_t place) {
  if (!has_joints_) return {};
  BoundJoint joint{kNone, Mat4(1)};
  if (moves_[place]) joint = {place, inverse(scene_.nodes[place].transform).value_or(Mat4(1))};
  return {JointBinding::Kind::kOneJoint, add_joint(joint), {}};
}

Mover RigBuilder::mover_of(std::uint32_t place) const {
  const glm::dmat4& transform = scene_.nodes[place].transform;
  return Mover(moves_[place] && !inverse(transform) ? glm::dmat4(1) : transform);
}

/// A root of the scene that the writer of this project has put there.
bool RigBuilder::is_frame(std::uint32_t place) const {
  const SceneNode& node = scene_.nodes[place];
  return node.parent == kNone && !node.has_mesh && !moves_[place] &&
         node.transform == glm::dmat4(1) &&
         root_.array("nodes").item(node.index).object_if("extras").has(kFrameMark);
}

/// In the order of the file where parents come first in it, else depth first.
std::vector<std::uint32_t> RigBuilder::needed_places() const {
  std::vector<bool> is_needed(scene_.nodes.size(), false);
  for (const BoundJoint& joint : joints_)
    for (std::uint32_t at = joint.place; at != kNone && !is_needed[at]; at = parent_of(at))
      is_needed[at] = true;
  std::vector<std::uint32_t> places;
  bool is_file_ordered = true;
  for (std::uint32_t place = 0; place < is_needed.size(); ++place) {
    if (!is_needed[place]) continue;
    places.push_back(place);
    const SceneNode& node = scene_.nodes[place];
    if (const std::uint32_t parent = parent_of(place);
        parent != kNone && scene_.nodes[parent].index > node.index)
      is_file_ordered = false;
  }
  if (is_file_ordered)
    std::sort(places.begin(), places.end(), [&](std::uint32_t a, std::uint32_t b) {
      return scene_.nodes[a].index < scene_.nodes[b].index;
    });
  return places;
}

Rig RigBuilder::take() {
  Rig rig;
  rig_node_of_.assign(scene_.place_of.size(), kNone);
  for (const std::uint32_t place : needed_places()) {
    const SceneNode& node = scene_.nodes[place];
    RigNode rig_node = read_node(root_.array("nodes").item(node.index));
    if (const std::uint32_t parent = parent_of(place); parent != kNone)
      rig_node.parent = rig_node_of_[scene_.nodes[parent].index];
    rig_node_of_[node.index] = static_cast<std::uint32_t>(rig.nodes.size());
    rig.nodes.push_back(std::move(rig_node));
  }
  for (const BoundJoint& joint : joints_) {
    const bool stands = joint.place == kNone;
    if (stands) rig.nodes.push_back({.name = "at rest"});
    const auto last = static_cast<std::uint32_t>(rig.nodes.size() - 1);
    rig.joints.push_back(
        {stands ? last : rig_node_of_[scene_.nodes[joint.place].index], joint.inverse_bind});
  }
  return rig;
}

}  // namespace varifold::gltf
