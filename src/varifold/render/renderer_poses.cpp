// What a renderer does with meshes that move.
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

// Programs of meshes that move differ in their vertex shader alone.
Result<void> Renderer::Impl::make_posed_programs() {
  if (posed_program) return {};
  const gl::ShaderStage vertex{GL_VERTEX_SHADER, gl::kPosedVertexShader, gl::kSurfaceOutput};
  const gl::ShaderStage geometry{GL_GEOMETRY_SHADER, gl::kWireGeometryShader};
  const gl::ShaderStage fragment{GL_FRAGMENT_SHADER, gl::kMeshFragmentShader};
  const gl::ShaderStage wire{GL_FRAGMENT_SHADER, gl::kMeshFragmentShader, "#define WIRE\n"};
  auto made = gl::assign(posed_program, gl::make_program("poses", {vertex, fragment}));
  if (made)
    made = gl::assign(posed_wire_program, gl::make_program("pose wires", {vertex, geometry, wire}));
  if (made && in_frame) {
    set_camera_uniforms(posed_program);
    set_camera_uniforms(posed_wire_program);
  }
  return made;
}

Result<void> Renderer::Impl::set_pose(const gl::Program& program, gl::MeshBuffers& buffers,
                                      const DrawPose& pose) const {
  gl::PoseBuffers& poses = buffers.poses();
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
  const bool use_joints = !pose.joints.empty() && buffers.has(gl::MeshBuffers::kJoints);
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
