// The shapes of meshes that move: which ones a model is built for, and which one is shown.
#pragma once

#include <apps/cli/context.h>
#include <varifold/base/result.h>
#include <varifold/io/imported_mesh.h>
#include <varifold/simplify/simplify.h>
#include <cstdint>
#include <filesystem>
#include <glm/mat4x4.hpp>
#include <optional>
#include <string>
#include <vector>

namespace varifold::cli {

/// What `build` and `simplify` are told of poses.
struct PoseSources {
  std::vector<std::string> files;           ///< --poses
  std::uint32_t samples_per_animation = 8;  ///< 0: none
  bool rest_only = false;                   ///< the order heeds the shape at rest alone
};
/// --poses, --pose-samples, --rest-only. `mesh` is the option of the mesh, which is not needed
/// where there are files of poses: the first of them is the mesh then.
void add_pose_sources(CLI::App& command, CLI::Option& mesh, PoseSources& sources);

/// The file that has the mesh at rest.
[[nodiscard]] std::filesystem::path rest_path(const std::string& mesh, const PoseSources& sources);

/// A mesh with its poses, and what its animations make of it.
struct PosedInput {
  TriangleMesh mesh;
  std::vector<Pose> samples;
};
/// Reads the mesh and the files of poses, and samples the animations of its rig. Tells warnings.
[[nodiscard]] Result<PosedInput> read_posed_surface(const std::string& mesh,
                                                    const PoseSources& sources);

/// What the simplifier is told of them; `input` must live on.
[[nodiscard]] PoseUse pose_use(const PosedInput& input, const PoseSources& sources);

/// What `extract` and `render` are told.
struct PoseChoice {
  std::optional<std::uint32_t> pose;  ///< 0: at rest
  std::vector<float> blend;           ///< a weight for each pose
  std::optional<std::string> animation;
  std::optional<float> time;

  [[nodiscard]] bool empty() const { return !pose && blend.empty() && !animation && !time; }
};
/// --pose, --blend, --animation, --time.
void add_pose_choice(CLI::App& command, PoseChoice& choice);

/// What the choice means for a mesh: weights of its poses and, where it has a rig, the joints.
/// Wrong usage where the mesh has no such pose or animation.
struct ChosenPose {
  std::vector<float> weights;  ///< of TriangleMesh::poses; may be fewer
  std::uint32_t animation = kNone;
  float time = 0;
  bool moves_rig = false;
};
[[nodiscard]] ChosenPose choose_pose(const std::string& input, const TriangleMesh& mesh,
                                     const PoseChoice& choice);

/// Where a model simplifies shapes in different ways, it is told which one is shown.
template <class Instance>
void go_to_pose(Instance& instance, const ChosenPose& pose) {
  if constexpr (requires { instance.go_to_frame(0u); })
    instance.go_to_frame(instance.model().frame_for(pose.weights));
}

/// The mesh frozen in the pose: its places and normals, without poses, skin and rig. O(mesh).
[[nodiscard]] TriangleMesh frozen(const TriangleMesh& mesh, const ChosenPose& pose);

/// What the vertex shader is told of a pose, and where it takes the vertices, for a camera.
struct ShownPose {
  std::vector<float> weights;
  std::vector<glm::mat4> joints;
  std::vector<Vec3> positions;
};
/// At rest nothing moves: weights and joints are empty then. O(mesh).
[[nodiscard]] ShownPose shown_pose(const TriangleMesh& mesh, const ChosenPose& pose);

}  // namespace varifold::cli
