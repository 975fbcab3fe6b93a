#include <tests/support/rigged_meshes.h>

#include <varifold/base/random.h>
#include <varifold/mesh/weld.h>
#include <glm/gtc/matrix_transform.hpp>
#include <memory>

namespace varifold::test {
namespace {

class RigMaker {
 public:
  RigMaker(TriangleMesh mesh, std::uint64_t seed, const RigOptions& options)
      : mesh_(std::move(mesh)), random_(seed), options_(options) {}

  TriangleMesh make() {
    add_poses();
    Rig rig;
    for (std::uint32_t i = 0; i < options_.joints; ++i) add_joint(i, rig);
    if (options_.joints > 0) add_skin();
    for (std::uint32_t k = 0; k < options_.poses; ++k) rig.pose_weights.push_back(number());
    for (std::uint32_t i = 0; i < options_.animations; ++i) rig.animations.push_back(animation(i));
    mesh_.rig = std::make_shared<const Rig>(std::move(rig));
    return std::move(mesh_);
  }

 private:
  /// In [-1, 1).
  float number() { return static_cast<float>(2 * random_.uniform() - 1); }
  Vec3 vector() {
    const float x = number();
    const float y = number();
    return {x, y, number()};
  }
  Quat turn() {
    const Vec3 axis = vector();
    return glm::normalize(Quat(number(), axis.x, axis.y, axis.z));
  }

  void add_poses() {
    const WeldMap weld = weld_exact(mesh_.positions);
    for (std::uint32_t k = 0; k < options_.poses; ++k) {
      Pose pose{"pose " + std::to_string(k), {}, {}};
      std::vector<Vec3> moves(weld.class_count);
      for (Vec3& move : moves)
        if (random_.below(k + 1) == 0) move = 0.25f * vector();
      for (std::uint32_t v = 0; v < mesh_.vertex_count(); ++v)
        pose.positions.push_back(mesh_.positions[v] + moves[weld.class_of[v]]);
      if (mesh_.has_normals() && k % 2 == 0)
        for (const Vec3& normal : mesh_.normals) pose.normals.push_back(normal + 0.5f * vector());
      mesh_.poses.push_back(std::move(pose));
    }
  }

  void add_joint(std::uint32_t i, Rig& rig) {
    RigNode node;
    node.name = "joint " + std::to_string(i);
    if (i > 0 && i % 4 != 3) node.parent = random_.below(i);
    if (i == 1) {
      node.has_matrix = true;
      node.matrix = glm::translate(Mat4(1), vector());
    } else {
      node.translation = vector();
      node.rotation = turn();
      node.scale = Vec3(1) + 0.5f * vector();
    }
    rig.nodes.push_back(node);
    rig.joints.push_back({i, glm::translate(Mat4(1), vector())});
  }

  void add_skin() {
    const WeldMap weld = weld_exact(mesh_.positions);
    std::vector<JointWeights> skin(weld.class_count);
    for (JointWeights& followed : skin) {
      const std::uint32_t used = 1 + random_.below(4);
      float left = 1;
      for (std::uint32_t i = 0; i < used; ++i) {
        followed.joints[i] = static_cast<std::uint16_t>(random_.below(options_.joints));
        followed.weights[i] = i + 1 == used ? left : left * 0.5f;
        left -= followed.weights[i];
      }
    }
    for (const std::uint32_t point : weld.class_of) mesh_.skin.push_back(skin[point]);
  }

  AnimationChannel channel(ChannelTarget target, std::uint32_t index, std::uint32_t width) {
    AnimationChannel result{target, index, width, {}, {}, {}};
    result.interpolation = static_cast<Interpolation>(random_.below(3));
    const std::uint32_t keys = 1 + random_.below(4);
    float time = 0.25f * static_cast<float>(random_.below(4));
    for (std::uint32_t key = 0; key < keys; ++key) {
      result.times.push_back(time);
      time += 0.125f + static_cast<float>(random_.uniform());
    }
    const std::uint32_t sets = result.interpolation == Interpolation::kCubicSpline ? 3 : 1;
    for (std::uint32_t i = 0; i < keys * sets * width; ++i) result.values.push_back(number());
    return result;
  }

  Animation animation(std::uint32_t i) {
    Animation result{"animation " + std::to_string(i), {}};
    for (std::uint32_t joint = 0; joint < options_.joints; ++joint) {
      if (joint == 1) continue;  // a matrix
      result.channels.push_back(channel(ChannelTarget::kTranslation, joint, 3));
      if (i % 2 == 0) result.channels.push_back(channel(ChannelTarget::kRotation, joint, 4));
      if (joint % 2 == 0) result.channels.push_back(channel(ChannelTarget::kScale, joint, 3));
    }
    if (options_.poses > 0)
      result.channels.push_back(channel(ChannelTarget::kPoseWeights, 0, options_.poses));
    return result;
  }

  TriangleMesh mesh_;
  Random random_;
  RigOptions options_;
};

}  // namespace

TriangleMesh with_random_rig(TriangleMesh mesh, std::uint64_t seed, const RigOptions& options) {
  return RigMaker(std::move(mesh), seed, options).make();
}

}  // namespace varifold::test
