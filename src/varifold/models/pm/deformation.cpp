#include <varifold/models/pm/deformation.h>

#include <varifold/mesh/rig.h>
#include <varifold/models/common/rig_bytes.h>
#include <varifold/models/common/section_reader.h>
#include <utility>

namespace varifold {
namespace {

constexpr char kTag[] = "VPD1";
enum Part : std::uint32_t { kSkin = 1, kRig = 2, kAllParts = 3 };

/// Calls visit(mesh, vertex) for all places that vertices take, in the order of a stream: those of
/// the base, then, split by split, those of new vertices and those that vertices move back to.
template <class Data, class Visit>
void for_each_place(Data& data, const Visit& visit) {
  std::vector<std::uint32_t> coarsest(data.mesh.positions.size(), kNone);
  for (auto j = static_cast<std::uint32_t>(data.placed_vertex.size()); j-- > 0;)
    coarsest[data.placed_vertex[j]] = j;
  const auto visit_first = [&](std::uint32_t vertex) {
    if (coarsest[vertex] == kNone)
      visit(data.mesh, vertex);
    else
      visit(data.placed, coarsest[vertex]);
  };
  std::uint32_t vertex = 0;
  for (; vertex < data.base_vertices; ++vertex) visit_first(vertex);
  for (std::size_t k = 0; k < data.splits.size(); ++k) {
    for (std::uint32_t i = 0; i < data.splits[k].vertices; ++i) visit_first(vertex++);
    if (data.first_placed.empty()) continue;
    for (std::uint32_t j = data.first_placed[k]; j < data.first_placed[k + 1]; ++j) {
      if (data.finer[j] == kNone)
        visit(data.mesh, data.placed_vertex[j]);
      else
        visit(data.placed, data.finer[j]);
    }
  }
}

/// Takes the head of the bytes and gives both meshes arrays of the right sizes.
Result<void> take_head(SectionReader& section, ProgressiveMeshData& data) {
  if (as_text(section.take_bytes(4)) != kTag)
    return fail(ErrorKind::kInvalidInput, "byte 0: not a deformation (no tag VPD1)");
  const auto parts = section.take<std::uint32_t>();
  if ((parts & ~std::uint32_t{kAllParts}) != 0) section.fail_here();
  PoseHead head = take_pose_names(section);
  std::shared_ptr<const Rig> rig;
  if (section.good() && (parts & kRig) != 0) rig = take_rig(section, head.poses.size());
  if (!section.good()) return section.fault("the rig is damaged, or ends too early");

  std::uint64_t bytes_a_place = (parts & kSkin) != 0 ? kJointWeightsBytes : 0;
  for (const bool has_normals : head.has_normals)
    bytes_a_place += (has_normals ? 2 : 1) * sizeof(Vec3);
  const std::uint64_t places =
      std::uint64_t{data.mesh.positions.size()} + data.placed_vertex.size();
  if (bytes_a_place != 0 && places > section.remaining() / bytes_a_place)
    return section.fault("there are fewer places than the model has");
  for (TriangleMesh* mesh : {&data.mesh, &data.placed}) {
    const std::size_t count = mesh->positions.size();
    mesh->rig = rig;
    mesh->poses = head.poses;
    for (std::size_t k = 0; k < mesh->poses.size(); ++k) {
      mesh->poses[k].positions.resize(count);
      if (head.has_normals[k]) mesh->poses[k].normals.resize(count);
    }
    if ((parts & kSkin) != 0) mesh->skin.resize(count);
  }
  return {};
}

}  // namespace

std::vector<std::byte> encode_deformation(const ProgressiveMesh& model) {
  const ProgressiveMeshData& data = model.data();
  std::vector<std::byte> bytes;
  const TriangleMesh& mesh = data.mesh;
  if (!mesh.has_skin() && mesh.poses.empty() && !mesh.rig) return bytes;
  append_text(bytes, kTag);
  append_little(bytes, (mesh.has_skin() ? kSkin : 0u) | (mesh.rig ? kRig : 0u));
  append_pose_names(mesh.poses, bytes);
  if (mesh.rig) append_rig(*mesh.rig, bytes);
  for_each_place(data, [&](const TriangleMesh& from, std::uint32_t vertex) {
    if (from.has_skin()) append_joints(from.skin[vertex], bytes);
    for (const Pose& pose : from.poses) {
      append_vector(bytes, pose.positions[vertex], 3);
      if (!pose.normals.empty()) append_vector(bytes, pose.normals[vertex], 3);
    }
  });
  return bytes;
}

Result<ProgressiveMesh> decode_deformation(std::span<const std::byte> bytes,
                                           ProgressiveMesh model) {
  ProgressiveMeshData data = std::move(model).release();
  SectionReader section(bytes);
  if (auto taken = take_head(section, data); !taken) return tl::unexpected<Error>(taken.error());
  const std::size_t joints = data.mesh.rig ? data.mesh.rig->joints.size() : 0;
  const auto take = [&](std::vector<Vec3>& values, std::uint32_t vertex) {
    if (values.empty()) return;
    take_vector(section, values[vertex], 3);
    for (int i = 0; i < 3; ++i)
      if (!(values[vertex][i] - values[vertex][i] == 0)) section.fail_here();
  };
  for_each_place(data, [&](TriangleMesh& to, std::uint32_t vertex) {
    if (to.has_skin()) {
      to.skin[vertex] = take_joints(section);
      if (!is_sound(to.skin[vertex], joints)) section.fail_here();
    }
    for (Pose& pose : to.poses) {
      take(pose.positions, vertex);
      take(pose.normals, vertex);
    }
  });
  if (!section.good()) return section.fault("a place is not finite, or follows no joint");
  return ProgressiveMesh(std::move(data));
}

}  // namespace varifold
