// Private to this folder: what moves vertices in shaders, and the vertex shader of meshes.
//
// Based on: [Ramos2008] figure 6.10 (two shapes and a parameter).
// Differs: up to eight weighted poses, and joints after them; normals by the cofactors of a joint's
//   matrix, which are right under scales that differ by axis, too.
#pragma once

#include <string_view>

namespace varifold::gl {

// So many poses may have a weight in one draw.
inline constexpr int kMostPoses = 8;

// Where vertices go; before the shader that asks.
inline constexpr std::string_view kPoseFunctions = R"(
uniform samplerBuffer poses;   // of each pose the places, then the normals, pose_stride each
uniform samplerBuffer matrices;  // of each joint four columns
uniform int pose_stride;
uniform int pose_count;
uniform int pose_of[8];
uniform float weight_of[8];
uniform bool use_joints;

mat4 matrix_of(uint joint) {
  int at = 4 * int(joint);
  return mat4(texelFetch(matrices, at), texelFetch(matrices, at + 1),
              texelFetch(matrices, at + 2), texelFetch(matrices, at + 3));
}

// The normal becomes a unit, or zero where there is no direction.
void move_vertex(int v, uvec4 joints, vec4 joint_weights, inout vec3 place, inout vec3 normal) {
  vec3 rest_place = place, rest_normal = normal;
  for (int i = 0; i < pose_count; ++i) {
    int at = 2 * pose_of[i] * pose_stride + v;
    place += weight_of[i] * (texelFetch(poses, at).xyz - rest_place);
    normal += weight_of[i] * (texelFetch(poses, at + pose_stride).xyz - rest_normal);
  }
  if (use_joints) {
    mat4 joint = joint_weights.x * matrix_of(joints.x) + joint_weights.y * matrix_of(joints.y) +
                 joint_weights.z * matrix_of(joints.z) + joint_weights.w * matrix_of(joints.w);
    place = (joint * vec4(place, 1)).xyz;
    mat3 m = mat3(joint);
    mat3 cofactors = mat3(cross(m[1], m[2]), cross(m[2], m[0]), cross(m[0], m[1]));
    normal = sign(dot(m[0], cofactors[0])) * (cofactors * normal);
  }
  float size = length(normal);
  normal = size > 1e-20 ? normal / size : vec3(0);
}
)";

// Behind kSurfaceOutput and kPoseFunctions.
inline constexpr std::string_view kPosedVertexShader = R"(
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 3) in vec4 color;
layout(location = 4) in uvec4 joints;
layout(location = 5) in vec4 joint_weights;

void main() {
  vec3 place = position, direction = normal;
  move_vertex(gl_VertexID, joints, joint_weights, place, direction);
  surface.position = (placement * vec4(place, 1)).xyz - eye;
  surface.normal = mat3(placement) * direction;
  surface.color = color.rgb;
  gl_Position = rotation_projection * vec4(surface.position, 1);
}
)";

}  // namespace varifold::gl
