#include <varifold/models/pm/deformation.h>

#include <varifold/mesh/rig.h>
#include <varifold/models/common/rig_bytes.h>
#include <varifold/models/common/section_reader.h>
#include <cassert>
#include <utility>

namespace varifold {
namespace {

constexpr char kTag[] = "VPD1";
enum Part : std::uint32_t { kSkin = 1, kRig = 2, kAllParts = 3 };

/// Takes the head of the bytes and gives the mesh arrays of the right sizes.
Result<void> take_head(SectionReader& section, TriangleMesh& mesh) {
  if (as_text(section.take_bytes(4)) != kTag)
    return fail(ErrorKind::kInvalidInput, "byte 0: not a deformation (no tag VPD1)");
  const auto parts = section.take<std::uint32_t>();
  if ((parts & ~std::uint32_t{kAllParts}) != 0) section.fail_here();
  PoseHead head = take_pose_names(section);
  mesh.poses = std::move(head.poses);
  if (section.good() && (parts & kRig) != 0) mesh.rig = take_rig(section, mesh.poses.size());
  if (!section.good()) return section.fault("the rig is damaged, or ends too early");

  const std::size_t vertices = mesh.positions.size();
  std::uint64_t bytes_a_vertex = (parts & kSkin) != 0 ? kJointWeightsBytes : 0;
  for (const bool has_normals : head.has_normals)
    bytes_a_vertex += (has_normals ? 2 : 1) * sizeof(Vec3);
  if (bytes_a_vertex != 0 && vertices > section.remaining() / bytes_a_vertex)
    return section.fault("there are fewer vertices than the model has");
  if ((parts & kSkin) != 0) mesh.skin.resize(vertices);
  for (std::size_t k = 0; k < mesh.poses.size(); ++k) {
    mesh.poses[k].positions.resize(vertices);
    if (head.has_normals[k]) mesh.poses[k].normals.resize(vertices);
  }
  return {};
}

// False where the place is not finite.
bool take_place(SectionReader& section, Vec3& place) {
  take_vector(section, place, 3);
  return place.x - place.x == 0 && place.y - place.y == 0 && place.z - place.z == 0;
}

}  // namespace

std::vector<std::byte> encode_deformation(const ProgressiveMesh& model) {
  const TriangleMesh& mesh = model.attributes();
  std::vector<std::byte> bytes;
  if (!mesh.has_skin() && mesh.poses.empty() && !mesh.rig) return bytes;
  assert(!model.moves_vertices());
  append_text(bytes, kTag);
  append_little(bytes, (mesh.has_skin() ? kSkin : 0u) | (mesh.rig ? kRig : 0u));
  append_pose_names(mesh.poses, bytes);
  if (mesh.rig) append_rig(*mesh.rig, bytes);
  for (std::uint32_t v = 0; v < mesh.vertex_count(); ++v) {
    if (mesh.has_skin()) append_joints(mesh.skin[v], bytes);
    for (const Pose& pose : mesh.poses) {
      append_vector(bytes, pose.positions[v], 3);
      if (!pose.normals.empty()) append_vector(bytes, pose.normals[v], 3);
    }
  }
  return bytes;
}

Result<ProgressiveMesh> decode_deformation(std::span<const std::byte> bytes,
                                           ProgressiveMesh model) {
  if (model.moves_vertices())
    return fail(ErrorKind::kInvalidInput, "byte 0: vertices that move back have no poses");
  ProgressiveMeshData data = std::move(model).release();
  TriangleMesh& mesh = data.mesh;
  SectionReader section(bytes);
  if (auto taken = take_head(section, mesh); !taken) return tl::unexpected<Error>(taken.error());
  const std::size_t joints = mesh.rig ? mesh.rig->joints.size() : 0;
  for (std::uint32_t v = 0; v < mesh.vertex_count(); ++v) {
    if (mesh.has_skin()) {
      mesh.skin[v] = take_joints(section);
      if (!is_sound(mesh.skin[v], joints)) return section.fault("a vertex follows no joint");
    }
    for (Pose& pose : mesh.poses)
      if (!take_place(section, pose.positions[v]) ||
          (!pose.normals.empty() && !take_place(section, pose.normals[v])))
        return section.fault("a place is not finite");
  }
  if (!section.good()) return section.fault("the poses end too early");
  return ProgressiveMesh(std::move(data));
}

}  // namespace varifold
