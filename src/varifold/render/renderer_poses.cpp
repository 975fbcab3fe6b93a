// What a renderer does with meshes that move.
#include <varifold/render/patch_shaders.h>
#include <varifold/render/pose_shaders.h>
#include <varifold/render/renderer.h>
#include <varifold/render/renderer_impl.h>
#include <varifold/render/shaders.h>
#include <string>

namespace varifold {

namespace {

constexpr GLuint kPoseUnit = 0, kJointUnit = 1;

const char* const kPoseOf[gl::kMostPoses] = {"pose_of[0]", "pose_of[1]", "pose_of[2]",
                                             "pose_of[3]", "pose_of[4]", "pose_of[5]",
                                             "pose_of[6]", "pose_of[7]"};
const char* const kWeightOf[gl::kMostPoses] = {"weight_of[0]", "weight_of[1]", "weight_of[2]",
                                               "weight_of[3]", "weight_of[4]", "weight_of[5]",
                                               "weight_of[6]", "weight_of[7]"};

}  // namespace

Result<void> Renderer::Impl::make_posed_programs() {
  const std::string head = std::string(gl::kSurfaceOutput).append(gl::kPoseFunctions);
  return make_programs({posed_program, posed_wire_program, "poses", gl::kPosedVertexShader, head});
}

Result<void> Renderer::Impl::make_posed_patch_programs() {
  const std::string head =
      std::string(gl::kSurfaceOutput).append(gl::kPoseFunctions).append("#define POSED\n");
  return make_programs(
      {posed_patch_program, posed_patch_wire_program, "patch poses", gl::kPatchVertexShader, head});
}

Result<void> Renderer::Impl::set_pose(const gl::Program& program, gl::PoseBuffers& poses,
                                      bool has_skin, const DrawPose& pose) const {
  int count = 0;
  for (std::size_t i = 0; i < pose.weights.size(); ++i) {
    if (pose.weights[i] == 0) continue;
    if (i >= poses.pose_count())
      return fail(ErrorKind::kInvalidInput, "renderer: a weight for pose " + std::to_string(i + 1) +
                                                " of " + std::to_string(poses.pose_count()));
    if (count == gl::kMostPoses)
      return fail(ErrorKind::kUnsupported, "renderer: more than 8 poses with a weight");
    gl::set_uniform(program, kPoseOf[count], static_cast<int>(i));
    gl::set_uniform(program, kWeightOf[count], pose.weights[i]);
    ++count;
  }
  const bool use_joints = !pose.joints.empty() && has_skin;
  if (use_joints) poses.set_joints(pose.joints);
  gl::set_uniform(program, "pose_count", count);
  gl::set_uniform(program, "pose_stride", static_cast<int>(poses.stride()));
  gl::set_uniform(program, "use_joints", static_cast<int>(use_joints));
  gl::set_uniform(program, "poses", static_cast<int>(kPoseUnit));
  gl::set_uniform(program, "matrices", static_cast<int>(kJointUnit));
  poses.bind(kPoseUnit, kJointUnit);
  return {};
}

}  // namespace varifold
