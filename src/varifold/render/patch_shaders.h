// Private to this folder: the vertex shader of patches. What follows it is that of meshes.
//
// Nothing but what stands in the indirect command comes as an attribute: vertices are fetched from
// buffers, so that one of the parent's patch can be fetched in place of the patch's own.
#pragma once

#include <string_view>

namespace varifold::gl {

/// Behind kSurfaceOutput (shaders.h) and, to be drawn in poses, kPoseFunctions
/// (pose_shaders.h) with POSED defined. The buffers stand in the order of PatchBuffers::Storage.
inline constexpr std::string_view kPatchVertexShader = R"(
layout(location = 0) in uvec4 words;  // first vertex of the parent's patch, mask, material, patch
layout(location = 1) in float level;

layout(std430, binding = 0) readonly buffer Positions { float positions[]; };
layout(std430, binding = 1) readonly buffer Normals { float normals[]; };
layout(std430, binding = 2) readonly buffer Colors { uint colors[]; };
layout(std430, binding = 3) readonly buffer Remap { uint remap[]; };
layout(std430, binding = 4) readonly buffer Morphs { uvec2 morphs[]; };  // target, bits of error
layout(std430, binding = 6) readonly buffer Materials { vec4 material_colors[]; };  // linear

uniform bool switch_borders;
uniform bool has_normals;
uniform int color_mode;   // the order of ColorMode
uniform vec3 plain_color;  // sRGB
uniform int material_count;
// As in PatchMorphRange; band 0: nothing blends.
uniform vec3 morph_eye;
uniform float morph_near;
uniform float morph_scale;
uniform float morph_tolerance;
uniform float morph_band;

struct Place {
  vec3 position;
  vec3 normal;
};

Place place_at_rest(uint v) {
  uint at = 3u * v;
  vec3 normal = has_normals ? vec3(normals[at], normals[at + 1u], normals[at + 2u]) : vec3(0);
  return Place(vec3(positions[at], positions[at + 1u], positions[at + 2u]), normal);
}

#ifdef POSED
// Of each vertex two words with two joints each, and four weights.
layout(std430, binding = 5) readonly buffer Skin { uint skin[]; };

Place place_of(uint v) {
  Place place = place_at_rest(v);
  uvec4 joints = uvec4(0);
  vec4 weights = vec4(0);
  if (use_joints) {
    uint at = 6u * v;
    joints = uvec4(skin[at] & 0xffffu, skin[at] >> 16, skin[at + 1u] & 0xffffu, skin[at + 1u] >> 16);
    weights = uintBitsToFloat(uvec4(skin[at + 2u], skin[at + 3u], skin[at + 4u], skin[at + 5u]));
  }
  move_vertex(int(v), joints, weights, place.position, place.normal);
  return place;
}
#else
Place place_of(uint v) { return place_at_rest(v); }
#endif

vec3 vertex_color(uint v) { return unpackUnorm4x8(colors[v]).rgb; }

// The vertex itself, or its survivor where the draw's mask has the bit that moves it.
uint drawn_vertex(uint v) {
  uint word = remap[v];
  uint bit = word >> 16;
  bool moves = switch_borders && bit < 32u && (words.y >> bit & 1u) != 0u;
  return moves ? words.x + (word & 0xffffu) : v;
}

float morph_part(vec3 position, float error) {
  float seen = error * morph_scale / max(distance(position, morph_eye), morph_near);
  return clamp((morph_band * morph_tolerance - seen) / ((morph_band - 1.0) * morph_tolerance), 0.0,
               1.0);
}

// As level_color and strip_color in colors.h.
vec3 level_color(float part) {
  const vec3 stops[5] = vec3[5](vec3(0.27, 0.35, 0.72), vec3(0.20, 0.62, 0.70),
                                vec3(0.50, 0.78, 0.47), vec3(0.96, 0.83, 0.40),
                                vec3(0.92, 0.50, 0.22));
  float place = clamp(part, 0.0, 1.0) * 4.0;
  int stop = min(int(place), 3);
  return mix(stops[stop], stops[stop + 1], place - float(stop));
}
vec3 number_color(uint number) {
  uint hash = number * 0x9e3779b9u;
  hash ^= hash >> 15;
  hash *= 0x85ebca6bu;
  hash ^= hash >> 13;
  float hue = (45.0 + 255.0 * float(hash & 0xffffu) / 65535.0) / 360.0;
  float saturation = 0.45 + 0.35 * float(hash >> 16 & 0xffu) / 255.0;
  float value = 0.62 + 0.36 * float(hash >> 24) / 255.0;
  vec3 place = mod(hue * 6.0 + vec3(5, 3, 1), 6.0);
  return value * (1.0 - saturation * clamp(min(place, 4.0 - place), 0.0, 1.0));
}
vec3 srgb_from_linear(vec3 c) {
  return mix(12.92 * c, 1.055 * pow(max(c, 0.0), vec3(1.0 / 2.4)) - 0.055, step(0.0031308, c));
}
)"
                                                       R"(
void main() {
  uint v = drawn_vertex(uint(gl_VertexID));
  Place here = place_of(v);
  vec3 own = here.position;
  vec3 normal = here.normal;
  bool by_vertex = color_mode == 2;
  vec3 color = by_vertex ? vertex_color(v) : plain_color;
  if (color_mode == 1 && words.z < uint(material_count))
    color = srgb_from_linear(material_colors[words.z].rgb);
  if (color_mode == 3) color = level_color(level);
  if (color_mode == 5) color = number_color(words.w);

  // On the way to the target, and to the target of that (morphed_position in patch_morph.h).
  vec3 way = vec3(0);
  float weight = 1.0;
  for (int step = 0; step < 64 && morph_band > 0.0; ++step) {  // far more than there are levels
    uvec2 morph = morphs[v];
    if (morph.x == v) break;
    float part = morph_part(here.position, uintBitsToFloat(morph.y));
    weight *= part;
    if (weight <= 0.0) break;
    Place next = place_of(morph.x);
    way += weight * (next.position - here.position);
    normal += weight * (next.normal - here.normal);
    if (by_vertex) color += weight * (vertex_color(morph.x) - vertex_color(v));
    v = morph.x;
    here = next;
  }

  surface.position = (placement * vec4(own, 1)).xyz - eye + mat3(placement) * way;
  surface.normal = mat3(placement) * normal;
  surface.color = color;
  gl_Position = rotation_projection * vec4(surface.position, 1);
}
)";

}  // namespace varifold::gl
