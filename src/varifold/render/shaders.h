// Private to this folder: the GLSL sources, without their #version line.
//
// All lighting is computed in linear colour. Directions are in world space; positions are relative
// to the eye, subtracted in the vertex shader, so that large map coordinates keep their precision.
#pragma once

#include <string_view>

namespace varifold::gl {

// What stands before all vertex shaders of surfaces.
inline constexpr std::string_view kSurfaceOutput = R"(
uniform mat4 placement;
uniform mat4 rotation_projection;  // from eye-relative world directions to clip space
uniform vec3 eye;

out Surface {
  vec3 position;  // relative to the eye
  vec3 normal;
  vec3 color;     // sRGB
} surface;

invariant gl_Position;
)";

// Behind kSurfaceOutput.
inline constexpr std::string_view kMeshVertexShader = R"(
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 3) in vec4 color;

void main() {
  surface.position = (placement * vec4(position, 1)).xyz - eye;
  surface.normal = mat3(placement) * normal;
  surface.color = color.rgb;
  gl_Position = rotation_projection * vec4(surface.position, 1);
}
)";

// Only for wireframes: gives each triangle barycentric coordinates, whether from a list or a strip.
inline constexpr std::string_view kWireGeometryShader = R"(
layout(triangles) in;
layout(triangle_strip, max_vertices = 3) out;

in Surface {
  vec3 position;
  vec3 normal;
  vec3 color;
} corners[];

out Surface {
  vec3 position;
  vec3 normal;
  vec3 color;
} surface;
out vec3 barycentric;

void main() {
  for (int i = 0; i < 3; ++i) {
    gl_Position = gl_in[i].gl_Position;
    surface.position = corners[i].position;
    surface.normal = corners[i].normal;
    surface.color = corners[i].color;
    barycentric = vec3(i == 0, i == 1, i == 2);
    EmitVertex();
  }
  EndPrimitive();
}
)";

inline constexpr std::string_view kMeshFragmentShader = R"(
in Surface {
  vec3 position;
  vec3 normal;
  vec3 color;
} surface;

uniform vec3 base_color;         // linear
uniform vec4 back_tint;          // linear, and how much of it back faces take
uniform bool use_vertex_color;
uniform bool flat_shading;
uniform vec3 camera_right;
uniform vec3 camera_up;
uniform vec3 camera_back;

layout(location = 0) out vec4 result;

vec3 linear_from_srgb(vec3 c) {
  return mix(c / 12.92, pow((c + 0.055) / 1.055, vec3(2.4)), step(0.04045, c));
}

vec3 surface_normal() {
  vec3 facet = cross(dFdx(surface.position), dFdy(surface.position));  // faces the eye
  facet = facet / max(length(facet), 1e-30);
  vec3 smooth_normal = gl_FrontFacing ? surface.normal : -surface.normal;
  float length_of_normal = length(smooth_normal);
  return flat_shading || length_of_normal < 1e-6 ? facet : smooth_normal / length_of_normal;
}

vec3 from_camera(vec3 direction) {
  return normalize(direction.x * camera_right + direction.y * camera_up +
                   direction.z * camera_back);
}

// A photographer's three lights, which go with the camera, under a soft sky.
vec3 shade(vec3 albedo, vec3 n, vec3 to_eye) {
  vec3 key = from_camera(vec3(-0.63, 0.66, 0.58));
  vec3 fill = from_camera(vec3(0.90, 0.10, 0.45));
  vec3 rim = from_camera(vec3(0.35, 0.55, -0.85));

  float key_light = max((dot(n, key) + 0.12) / 1.12, 0.0);  // a large lamp: a soft edge
  float fill_light = max(0.5 * dot(n, fill) + 0.5, 0.0);
  float rim_light = pow(max(dot(n, rim), 0.0), 2.0) * pow(1.0 - max(dot(n, to_eye), 0.0), 2.0);
  float sky = 0.5 + 0.5 * dot(n, camera_up);

  vec3 light = vec3(1.00, 0.965, 0.91) * (1.02 * key_light);
  light += vec3(0.62, 0.74, 0.95) * (0.17 * fill_light * fill_light);
  light += mix(vec3(0.095, 0.083, 0.078), vec3(0.24, 0.26, 0.29), sky);

  float facing = max(dot(n, to_eye), 0.0);
  float fresnel = 0.04 + 0.96 * pow(1.0 - facing, 5.0);
  float gloss = pow(max(dot(n, normalize(key + to_eye)), 0.0), 36.0);
  vec3 sheen = vec3(0.10 * gloss) + vec3(0.80, 0.88, 1.0) * (0.55 * rim_light + 0.05 * fresnel);
  return albedo * light + sheen;
}
)"
                                                        R"(
#ifdef WIRE
in vec3 barycentric;
uniform vec4 wire_color;   // linear, and opacity
uniform float wire_width;  // pixels; half of it falls on either side of an edge

// How much of the pixel a line along the triangle's edges covers.
float wire_coverage() {
  vec3 change = sqrt(dFdx(barycentric) * dFdx(barycentric) + dFdy(barycentric) * dFdy(barycentric));
  vec3 altitude = 1.0 / max(change, vec3(1e-12));     // of the triangle, in pixels
  vec3 distances = max(barycentric, 0.0) * altitude;  // to the three edges, in pixels
  vec3 lines = 1.0 - smoothstep(0.5 * wire_width - 0.5, 0.5 * wire_width + 0.5, distances);
  // Triangles of a few pixels would turn all black; they fade to an even tone instead.
  float size = max(altitude.x, max(altitude.y, altitude.z));
  return max(lines.x, max(lines.y, lines.z)) * smoothstep(1.0 * wire_width, 9.0 * wire_width, size);
}
#endif

void main() {
  vec3 albedo = use_vertex_color ? linear_from_srgb(surface.color) : base_color;
  if (!gl_FrontFacing) albedo = mix(albedo, back_tint.rgb, back_tint.a);
  vec3 color = shade(albedo, surface_normal(), -normalize(surface.position));
  // A fault must not hide in the shade.
  if (!gl_FrontFacing) color = mix(color, back_tint.rgb, 0.5 * back_tint.a);
#ifdef WIRE
  color = mix(color, wire_color.rgb, wire_color.a * wire_coverage());
#endif
  result = vec4(color, 1);  // alpha tells the surface from the background
}
)";

/// A triangle that covers the picture, made from the vertex number alone.
inline constexpr std::string_view kScreenVertexShader = R"(
void main() {
  vec2 corner = vec2(gl_VertexID == 1 ? 3 : -1, gl_VertexID == 2 ? 3 : -1);
  gl_Position = vec4(corner, 0, 1);
}
)";

// How much of the sky above each pixel its surroundings hide, from depths alone.
// Based on: [McGuireMaraLuebke2012] (Scalable Ambient Obscurance), its spiral of samples.
// Differs: sums the heights of the horizon with a linear fall-off, and uses no depth pyramid.
inline constexpr std::string_view kOcclusionFragmentShader = R"(
#ifdef MULTISAMPLE
uniform sampler2DMS depths;
#else
uniform sampler2D depths;
#endif
uniform vec2 depth_range;   // near and far
uniform vec2 half_tangent;  // of the angles of view
uniform float radius;       // of the neighbourhood, as a part of the picture's height

layout(location = 0) out float result;

float distance_at(ivec2 at) {
  float depth = texelFetch(depths, at, 0).r;
  return depth_range.x * depth_range.y / (depth_range.y - depth * (depth_range.y - depth_range.x));
}

// Eye space, z positive away from the eye.
vec3 point_at(ivec2 at, ivec2 size) {
  vec2 place = (vec2(at) + 0.5) / vec2(size) * 2.0 - 1.0;
  float z = distance_at(clamp(at, ivec2(0), size - 1));
  return vec3(place * half_tangent * z, z);
}

// Of the two one-sided differences the smaller one stays on this side of silhouettes.
vec3 smaller(vec3 a, vec3 b) { return abs(a.z) < abs(b.z) ? a : b; }

void main() {
  ivec2 at = ivec2(gl_FragCoord.xy);
#ifdef MULTISAMPLE
  ivec2 size = textureSize(depths);
#else
  ivec2 size = textureSize(depths, 0);
#endif
  result = 1.0;
  if (texelFetch(depths, at, 0).r >= 1.0) return;
  vec3 center = point_at(at, size);
  vec3 along_x = smaller(point_at(at + ivec2(1, 0), size) - center,
                         center - point_at(at - ivec2(1, 0), size));
  vec3 along_y = smaller(point_at(at + ivec2(0, 1), size) - center,
                         center - point_at(at - ivec2(0, 1), size));
  vec3 normal = normalize(cross(along_y, along_x));  // towards the eye: z points away from it

  const int count = 14;
  float reach = radius * 2.0 * half_tangent.y * center.z;  // model units
  // A turn that differs within each 4 x 4 block, which the blur evens out.
  float turn = float(((at.x & 3) << 2 | (at.y & 3)) * 7 & 15) * (6.2831853 / 16.0);
  float sum = 0.0;
  for (int i = 0; i < count; ++i) {
    float part = (float(i) + 0.5) / float(count);
    float angle = turn + 2.3999632 * float(i);
    vec2 offset = vec2(cos(angle), sin(angle)) * (part * radius * float(size.y));
    ivec2 place = at + ivec2(round(offset));
    if (any(lessThan(place, ivec2(0))) || any(greaterThanEqual(place, size))) continue;
    vec3 to_sample = point_at(place, size) - center;
    float squared = dot(to_sample, to_sample);
    float near = max(1.0 - squared / (reach * reach), 0.0);
    float height = dot(to_sample, normal) * inversesqrt(max(squared, 1e-30));  // of the horizon
    sum += near * max(height - 0.1, 0.0);
  }
  result = clamp(1.0 - 2.2 * sum / float(count), 0.0, 1.0);
}
)";

// Averages 4 x 4 pixels on the same surface.
inline constexpr std::string_view kOcclusionBlurFragmentShader = R"(
uniform sampler2D occlusion;
#ifdef MULTISAMPLE
uniform sampler2DMS depths;
#else
uniform sampler2D depths;
#endif
uniform vec2 depth_range;

layout(location = 0) out float result;

float distance_at(ivec2 at) {
  float depth = texelFetch(depths, at, 0).r;
  return depth_range.x * depth_range.y / (depth_range.y - depth * (depth_range.y - depth_range.x));
}

void main() {
  ivec2 at = ivec2(gl_FragCoord.xy);
  ivec2 last = textureSize(occlusion, 0) - 1;
  float here = distance_at(at);
  float sum = 0.0, weights = 0.0;
  for (int y = -2; y < 2; ++y)
    for (int x = -2; x < 2; ++x) {
      ivec2 place = clamp(at + ivec2(x, y), ivec2(0), last);
      float apart = abs(distance_at(place) - here) / here;
      float weight = max(1.0 - 60.0 * apart, 0.001);
      sum += weight * texelFetch(occlusion, place, 0).r;
      weights += weight;
    }
  result = sum / weights;
}
)";

// Averages the samples of a pixel, each brought to display values first, so that edges next to
// bright surfaces stay smooth; then the background, and sRGB.
inline constexpr std::string_view kResolveFragmentShader = R"(
#ifdef MULTISAMPLE
uniform sampler2DMS scene;
#else
uniform sampler2D scene;
#endif
uniform int samples;
uniform int supersampling;
uniform vec2 size;               // of the result, in pixels
uniform vec3 background_top;     // sRGB
uniform vec3 background_bottom;  // sRGB
#ifdef OCCLUSION
uniform sampler2D occlusion;
#endif

layout(location = 0) out vec4 result;

// Leaves dark and middle tones alone and rolls off towards white instead of clipping.
vec3 shoulder(vec3 c) {
  const float start = 0.72;
  vec3 over = max(c - start, 0.0) / (1.0 - start);
  return min(c, start) + (1.0 - start) * (1.0 - exp(-over));
}

vec3 srgb_from_linear(vec3 c) {
  return mix(12.92 * c, 1.055 * pow(max(c, 0.0), vec3(1.0 / 2.4)) - 0.055, step(0.0031308, c));
}

void main() {
  ivec2 first = ivec2(gl_FragCoord.xy) * supersampling;
  vec3 sum = vec3(0);
  float covered = 0.0;
  for (int y = 0; y < supersampling; ++y)
    for (int x = 0; x < supersampling; ++x) {
      ivec2 at = first + ivec2(x, y);
      float light = 1.0;
#ifdef OCCLUSION
      light = texelFetch(occlusion, at, 0).r;
#endif
      for (int i = 0; i < samples; ++i) {
        vec4 c = texelFetch(scene, at, i);
        sum += shoulder(c.rgb * light) * c.a;
        covered += c.a;
      }
    }
  float count = float(samples * supersampling * supersampling);
  float height = gl_FragCoord.y / size.y;
  vec3 background = mix(background_bottom, background_top, smoothstep(0.0, 1.0, height));
  vec3 surface = srgb_from_linear(sum / max(covered, 1.0));
  result = vec4(mix(background, surface, covered / count), covered / count);
}
)";

}  // namespace varifold::gl
