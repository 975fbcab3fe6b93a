// TriangleMesh: the value type that carries every mesh through the house.
#pragma once

#include <varifold/base/math.h>
#include <varifold/mesh/pose.h>
#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace varifold {

struct Rig;  // rig.h

/// What a material's texture is used for; the order is that of Material::textures.
enum class TextureUse { kBaseColor, kMetallicRoughness, kNormal, kOcclusion, kEmissive, kCount };

/// A metallic-roughness material as in glTF 2.0; OBJ materials map onto it.
struct Material {
  std::string name;
  Vec4 base_color{1, 1, 1, 1};
  Vec3 emissive{0, 0, 0};
  float metallic = 0;
  float roughness = 1;
  bool double_sided = false;
  std::string alpha_mode = "OPAQUE";  ///< OPAQUE, MASK or BLEND
  float alpha_cutoff = 0.5f;
  /// Index into TriangleMesh::images per TextureUse, or kNone.
  std::array<std::uint32_t, static_cast<std::size_t>(TextureUse::kCount)> textures{
      kNone, kNone, kNone, kNone, kNone};
};

/// A texture image, carried along unread: either its bytes or the path that the file named.
struct Image {
  std::string name;
  std::string mime_type;
  std::string uri;                  ///< as written in the file; empty when `bytes` holds the image
  std::vector<std::uint8_t> bytes;  ///< the encoded image (PNG, JPEG, ...)
};

/// Triangles [first_triangle, first_triangle + triangle_count) have material `material`.
struct MaterialRange {
  std::uint32_t material = 0;  ///< index into TriangleMesh::materials
  std::uint32_t first_triangle = 0;
  std::uint32_t triangle_count = 0;
  friend bool operator==(const MaterialRange&, const MaterialRange&) = default;
};

/// Indexed triangles over one vertex buffer.
///
/// Positions always; normals, texture coordinates and colours are either empty or have one entry
/// per vertex. Vertices that share a position but not attributes (seams) are separate vertices
/// ("wedges"); weld.h gives the position classes. `ranges` is empty (one nameless material) or
/// covers all triangles in order, without gaps, each material at most once. A mesh that moves has
/// poses, a skin, or both; `positions` is its shape at rest.
struct TriangleMesh {
  std::vector<Vec3> positions;
  std::vector<Vec3> normals;
  std::vector<Vec2> texcoords;  ///< (0, 0) is the upper left corner of the image, as in glTF
  std::vector<Color> colors;
  std::vector<JointWeights> skin;      ///< empty or one a vertex; joints are those of `rig`
  std::vector<Pose> poses;             ///< other shapes; what blends make of them: pose_blend.h
  std::shared_ptr<const Rig> rig;      ///< null where nothing but weights of poses moves the mesh
  std::vector<std::uint32_t> indices;  ///< three per triangle, counter-clockwise seen from outside
  std::vector<MaterialRange> ranges;
  std::vector<Material> materials;
  std::vector<Image> images;

  [[nodiscard]] std::uint32_t vertex_count() const {
    return static_cast<std::uint32_t>(positions.size());
  }
  [[nodiscard]] std::uint32_t triangle_count() const {
    return static_cast<std::uint32_t>(indices.size() / 3);
  }
  [[nodiscard]] bool has_normals() const { return !normals.empty(); }
  [[nodiscard]] bool has_texcoords() const { return !texcoords.empty(); }
  [[nodiscard]] bool has_colors() const { return !colors.empty(); }
  [[nodiscard]] bool has_skin() const { return !skin.empty(); }
};

/// The box around all vertices that a triangle uses; O(indices).
[[nodiscard]] Box bounds(const TriangleMesh& mesh);

/// The material index of every triangle; all zero where the mesh has no ranges. O(triangles).
[[nodiscard]] std::vector<std::uint32_t> triangle_materials(const TriangleMesh& mesh);

/// Sorts triangles by material (stable) and sets `ranges`. `materials_of` has one entry a triangle.
void set_triangle_materials(TriangleMesh& mesh, const std::vector<std::uint32_t>& materials_of);

/// The same mesh without the vertices that no triangle uses; their order is kept. O(n).
[[nodiscard]] TriangleMesh without_unused_vertices(const TriangleMesh& mesh);

}  // namespace varifold
