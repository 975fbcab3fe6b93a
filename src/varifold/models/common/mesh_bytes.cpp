#include <varifold/models/common/mesh_bytes.h>

#include <varifold/mesh/rig.h>
#include <varifold/models/common/rig_bytes.h>
#include <algorithm>
#include <string>
#include <string_view>

namespace varifold {

namespace {

constexpr std::size_t kLeastMaterial = 69;
constexpr std::size_t kLeastImage = 3 * 4 + 8;

void append_string(std::vector<std::byte>& bytes, std::string_view text) {
  append_little(bytes, static_cast<std::uint32_t>(text.size()));
  append_text(bytes, text);
}

void append_material(std::vector<std::byte>& bytes, const Material& material) {
  append_string(bytes, material.name);
  append_vector(bytes, material.base_color, 4);
  append_vector(bytes, material.emissive, 3);
  append_little(bytes, material.metallic);
  append_little(bytes, material.roughness);
  append_little(bytes, static_cast<std::uint8_t>(material.double_sided ? 1 : 0));
  append_string(bytes, material.alpha_mode);
  append_little(bytes, material.alpha_cutoff);
  for (const std::uint32_t image : material.textures) append_little(bytes, image);
}

Material take_material(SectionReader& section) {
  Material material;
  material.name = section.take_string();
  take_vector(section, material.base_color, 4);
  take_vector(section, material.emissive, 3);
  material.metallic = section.take<float>();
  material.roughness = section.take<float>();
  material.double_sided = section.take<std::uint8_t>() != 0;
  material.alpha_mode = section.take_string();
  material.alpha_cutoff = section.take<float>();
  for (std::uint32_t& image : material.textures) image = section.take<std::uint32_t>();
  return material;
}

template <class V>
void append_vectors(const std::vector<V>& values, std::vector<std::byte>& bytes) {
  for (const V& value : values) append_vector(bytes, value, V::length());
}

template <class V>
void take_vectors(SectionReader& section, std::uint32_t count, std::vector<V>& values) {
  const auto part = section.take_bytes(std::uint64_t{count} * sizeof(V));
  if (!section.good()) return;
  values.resize(count);
  SectionReader reader(part);
  for (V& value : values) {
    take_vector(reader, value, V::length());
    for (int i = 0; i < V::length(); ++i)
      if (!(value[i] - value[i] == 0)) section.fail_here();
  }
}

}  // namespace

std::uint32_t stored_attributes(const TriangleMesh& mesh) {
  return (mesh.has_normals() ? kStoredNormals : 0u) |
         (mesh.has_texcoords() ? kStoredTexcoords : 0u) | (mesh.has_colors() ? kStoredColors : 0u) |
         (mesh.has_skin() ? kStoredSkin : 0u) | (mesh.poses.empty() ? 0u : kStoredPoses) |
         (mesh.rig ? kStoredRig : 0u);
}

void append_materials(const std::vector<Material>& materials, std::vector<std::byte>& bytes) {
  append_little(bytes, static_cast<std::uint32_t>(materials.size()));
  for (const Material& material : materials) append_material(bytes, material);
}

void append_images(const std::vector<Image>& images, std::vector<std::byte>& bytes) {
  append_little(bytes, static_cast<std::uint32_t>(images.size()));
  for (const Image& image : images) {
    append_string(bytes, image.name);
    append_string(bytes, image.mime_type);
    append_string(bytes, image.uri);
    append_little(bytes, static_cast<std::uint64_t>(image.bytes.size()));
    const auto* first = reinterpret_cast<const std::byte*>(image.bytes.data());
    bytes.insert(bytes.end(), first, first + image.bytes.size());
  }
}

void append_attributes(const TriangleMesh& mesh, std::vector<std::byte>& bytes, bool has_rig) {
  const std::uint32_t all = has_rig ? kStoredAll : kStoredAll & ~std::uint32_t{kStoredRig};
  const std::uint32_t stored = stored_attributes(mesh) & all;
  append_little(bytes, mesh.vertex_count());
  append_little(bytes, stored);
  append_vectors(mesh.positions, bytes);
  append_vectors(mesh.normals, bytes);
  append_vectors(mesh.texcoords, bytes);
  append_vectors(mesh.colors, bytes);
  for (const JointWeights& followed : mesh.skin) append_joints(followed, bytes);
  if (!mesh.poses.empty()) append_pose_names(mesh.poses, bytes);
  for (const Pose& pose : mesh.poses) {
    append_vectors(pose.positions, bytes);
    append_vectors(pose.normals, bytes);
  }
  if ((stored & kStoredRig) != 0) append_rig(*mesh.rig, bytes);
}

std::vector<Material> take_materials(SectionReader& section) {
  std::vector<Material> materials;
  const std::uint32_t count = section.take_count(kLeastMaterial);
  for (std::uint32_t i = 0; i < count && section.good(); ++i)
    materials.push_back(take_material(section));
  return materials;
}

std::vector<Image> take_images(SectionReader& section) {
  std::vector<Image> images;
  const std::uint32_t count = section.take_count(kLeastImage);
  for (std::uint32_t i = 0; i < count && section.good(); ++i) {
    Image image;
    image.name = section.take_string();
    image.mime_type = section.take_string();
    image.uri = section.take_string();
    const auto content = section.take_bytes(section.take<std::uint64_t>());
    const auto* first = reinterpret_cast<const std::uint8_t*>(content.data());
    image.bytes.assign(first, first + content.size());
    images.push_back(std::move(image));
  }
  return images;
}

namespace {

void take_skin(SectionReader& section, std::uint32_t count, TriangleMesh& mesh) {
  const auto part = section.take_bytes(std::uint64_t{count} * kJointWeightsBytes);
  if (!section.good()) return;
  SectionReader reader(part);
  mesh.skin.reserve(count);
  for (std::uint32_t v = 0; v < count; ++v) mesh.skin.push_back(take_joints(reader));
}

void take_poses(SectionReader& section, std::uint32_t count, TriangleMesh& mesh) {
  PoseHead head = take_pose_names(section);
  mesh.poses = std::move(head.poses);
  for (std::size_t k = 0; k < mesh.poses.size() && section.good(); ++k) {
    take_vectors(section, count, mesh.poses[k].positions);
    if (head.has_normals[k]) take_vectors(section, count, mesh.poses[k].normals);
  }
}

}  // namespace

void take_attributes(SectionReader& section, TriangleMesh& mesh,
                     const std::shared_ptr<const Rig>& rig) {
  const auto count = section.take<std::uint32_t>();
  const auto present = section.take<std::uint32_t>();
  if ((present & ~std::uint32_t{kStoredAll}) != 0) section.fail_here();
  take_vectors(section, count, mesh.positions);
  if ((present & kStoredNormals) != 0) take_vectors(section, count, mesh.normals);
  if ((present & kStoredTexcoords) != 0) take_vectors(section, count, mesh.texcoords);
  if ((present & kStoredColors) != 0) take_vectors(section, count, mesh.colors);
  if ((present & kStoredSkin) != 0) take_skin(section, count, mesh);
  if ((present & kStoredPoses) != 0) take_poses(section, count, mesh);
  mesh.rig =
      (present & kStoredRig) != 0 && section.good() ? take_rig(section, mesh.poses.size()) : rig;
  const std::size_t joints = mesh.rig ? mesh.rig->joints.size() : 0;
  for (const JointWeights& followed : mesh.skin)
    if (!is_sound(followed, joints)) section.fail_here();
}

bool have_same_attributes(const TriangleMesh& a, const TriangleMesh& b) {
  return a.has_normals() == b.has_normals() && a.has_texcoords() == b.has_texcoords() &&
         a.has_colors() == b.has_colors() && a.has_skin() == b.has_skin() &&
         std::equal(
             a.poses.begin(), a.poses.end(), b.poses.begin(), b.poses.end(),
             [](const Pose& p, const Pose& q) { return p.normals.empty() == q.normals.empty(); });
}

Result<std::vector<Image>> read_images(std::span<const std::byte> bytes, std::size_t offset) {
  SectionReader section(bytes, offset);
  std::vector<Image> images = take_images(section);
  if (!section.good()) return section.fault("the images end too early");
  if (!section.at_end()) return section.fault("the images section is too long");
  return images;
}

}  // namespace varifold
