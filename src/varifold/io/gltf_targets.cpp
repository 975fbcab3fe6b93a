#include <varifold/io/gltf_targets.h>

#include <fmt/format.h>
#include <algorithm>

namespace varifold::gltf {
namespace {

constexpr const char* kTooMuch = "the poses take many times the size of the file";

Vec3 vector_at(const std::vector<float>& values, std::size_t i) {
  return {values[3 * i], values[3 * i + 1], values[3 * i + 2]};
}

}  // namespace

PoseRange TargetCollector::add_poses(const JsonElement& mesh, const JsonElement& node) {
  const JsonElement primitives = mesh.array("primitives");
  std::size_t count = 0;
  for (std::size_t i = 0; i < primitives.size(); ++i)
    count = std::max(count, primitives.item(i).array("targets").size());
  const auto first = static_cast<std::uint32_t>(names_.size());
  if (count == 0) return {first, 0};
  std::vector<double> weights(count, 0.0);
  if (!node.numbers("weights", weights)) mesh.numbers("weights", weights);
  std::vector<std::string> names = mesh.object_if("extras").texts_if("targetNames");
  if (!budget_->spend(count * sizeof(Pose))) mesh.fault(kTooMuch, ErrorKind::kUnsupported);
  if (faults_->any()) return {first, 0};
  for (std::size_t i = names.size(); i < count; ++i) names.push_back(fmt::format("target {}", i));
  names_.insert(names_.end(), names.begin(), names.begin() + static_cast<std::ptrdiff_t>(count));
  for (const double weight : weights) weights_.push_back(static_cast<float>(weight));
  return {first, static_cast<std::uint32_t>(count)};
}

std::vector<float> TargetCollector::read_offsets(const JsonElement& target, const char* name,
                                                 std::size_t count) {
  if (!target.has(name)) return {};
  const Accessor accessor = buffers_->accessor(target.whole(name));
  if (faults_->any()) return {};
  if (accessor.components != 3 || accessor.elements.type == ComponentType::kUint32)
    target.fault(fmt::format("{} does not have three components of an offset", name));
  if (accessor.elements.count != count)
    target.fault(fmt::format("{} has {} elements, POSITION of the primitive has {}", name,
                             accessor.elements.count, count));
  if (!budget_->spend(2 * count * sizeof(Vec3))) target.fault(kTooMuch, ErrorKind::kUnsupported);
  return faults_->any() ? std::vector<float>() : decode_floats(accessor);
}

void TargetCollector::read(const JsonElement& primitive, const PoseRange& range,
                           std::uint32_t first_vertex, std::size_t count,
                           const std::vector<float>& normals, const Mover& mover) {
  const JsonElement targets = primitive.array("targets");
  for (std::size_t i = 0; i < std::min<std::size_t>(targets.size(), range.count); ++i) {
    const JsonElement target = targets.item(i);
    const auto pose = static_cast<std::uint32_t>(range.first + i);
    const std::vector<float> moves = read_offsets(target, "POSITION", count);
    const std::vector<float> turns = read_offsets(target, "NORMAL", count);
    if (faults_->any()) return;
    std::vector<Vec3> offsets(moves.size() / 3);
    for (std::size_t v = 0; v < offsets.size(); ++v) offsets[v] = mover.offset(vector_at(moves, v));
    positions_.push_back({pose, first_vertex, std::move(offsets)});
    // Without normals at rest there is nothing to turn.
    if (turns.empty() || normals.empty()) continue;
    std::vector<Vec3> changes(count);
    for (std::size_t v = 0; v < count; ++v)
      changes[v] = mover.normal_offset(vector_at(normals, v), vector_at(turns, v));
    normals_.push_back({pose, first_vertex, std::move(changes)});
  }
}

void TargetCollector::make_poses(TriangleMesh& mesh) {
  const std::size_t sets = normals_.empty() ? 1 : 2;
  if (!names_.empty() &&
      !budget_->spend(names_.size() * sets * mesh.positions.size() * sizeof(Vec3)))
    return faults_->set(ErrorKind::kUnsupported, kTooMuch);
  for (std::string& name : names_) mesh.poses.push_back({std::move(name), mesh.positions, {}});
  const auto add = [](std::vector<Vec3>& values, const Offsets& offsets) {
    for (std::size_t i = 0; i < offsets.values.size(); ++i)
      values[offsets.first_vertex + i] += offsets.values[i];
  };
  for (const Offsets& offsets : positions_) add(mesh.poses[offsets.pose].positions, offsets);
  for (const Offsets& offsets : normals_) {
    Pose& pose = mesh.poses[offsets.pose];
    if (pose.normals.empty()) pose.normals = mesh.normals;
    add(pose.normals, offsets);
  }
}

std::vector<float> TargetCollector::weights() const {
  const bool any = std::any_of(weights_.begin(), weights_.end(), [](float w) { return w != 0; });
  return any ? weights_ : std::vector<float>();
}

}  // namespace varifold::gltf
