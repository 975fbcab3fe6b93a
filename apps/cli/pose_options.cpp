#include <apps/cli/input.h>
#include <apps/cli/pose_options.h>
#include <fmt/format.h>
#include <varifold/io/pose_files.h>
#include <varifold/mesh/pose_blend.h>
#include <varifold/mesh/rig_pose.h>
#include <algorithm>
#include <charconv>

namespace varifold::cli {

void add_pose_sources(CLI::App& command, CLI::Option& mesh, PoseSources& sources) {
  mesh.required();
  CLI::Option* const required = &mesh;
  command
      .add_option(
          "--poses", sources.files,
          "Other shapes of the mesh, files of the same triangles; without MESH the first is "
          "the mesh")
      ->each([required](const std::string&) { required->required(false); })
      ->type_name("FILE...");
  command
      .add_option("--pose-samples", sources.samples_per_animation,
                  "Heed so many shapes of each animation of the mesh; 0: none")
      ->check(CLI::Range(0u, 10000u))
      ->capture_default_str()
      ->type_name("N");
  command.add_flag("--rest-only", sources.rest_only,
                   "Order collapses by the shape at rest alone; errors still bound all shapes");
}

std::filesystem::path rest_path(const std::string& mesh, const PoseSources& sources) {
  if (!mesh.empty()) return input_path(mesh);
  return input_path(sources.files.front());
}

namespace {

Result<ImportedMesh> read_files(const std::string& mesh, const PoseSources& sources) {
  const auto rest = rest_path(mesh, sources);
  auto imported = read_surface(rest);
  if (!imported || sources.files.empty()) return imported;
  std::vector<std::filesystem::path> poses;
  for (std::size_t i = mesh.empty() ? 1 : 0; i < sources.files.size(); ++i)
    poses.push_back(input_path(sources.files[i]));
  imported = read_pose_files(rest, poses);
  if (!imported) return imported;
  for (const std::string& warning : imported->warnings)
    print_message(rest.string() + ": warning: " + warning);
  return imported;
}

}  // namespace

Result<PosedInput> read_posed_surface(const std::string& mesh, const PoseSources& sources) {
  auto imported = read_files(mesh, sources);
  if (!imported) return tl::unexpected(std::move(imported.error()));
  PosedInput input{std::move(imported->mesh), {}};
  if (sources.samples_per_animation > 0)
    input.samples = sample_poses(input.mesh, {sources.samples_per_animation});
  return input;
}

PoseUse pose_use(const PosedInput& input, const PoseSources& sources) {
  PoseUse use;
  use.poses_order = use.samples_order = !sources.rest_only;
  use.samples = input.samples;
  return use;
}

void add_pose_choice(CLI::App& command, PoseChoice& choice) {
  CLI::Option* const pose =
      command.add_option("--pose", choice.pose, "The pose of that number; 0 is the shape at rest")
          ->type_name("I");
  CLI::Option* const blend =
      command
          .add_option("--blend", choice.blend,
                      "Weights of poses 1, 2, ... with commas between: T leads from the shape at "
                      "rest (0) to pose 1 (1)")
          ->delimiter(',')
          ->check(finite_number())
          ->type_name("T");
  CLI::Option* const animation =
      command.add_option("--animation", choice.animation, "By name or number, from 0")
          ->type_name("NAME");
  CLI::Option* const time =
      command.add_option("--time", choice.time, "Seconds into the animation (default: its start)")
          ->check(finite_number())
          ->type_name("S");
  pose->excludes(blend)->excludes(animation)->excludes(time);
  blend->excludes(animation)->excludes(time);
}

namespace {

std::uint32_t find_animation(const std::string& input, const TriangleMesh& mesh,
                             const PoseChoice& choice) {
  const std::size_t count = mesh.rig ? mesh.rig->animations.size() : 0;
  if (count == 0) wrong_usage(input + ": there are no animations");
  if (!choice.animation) return 0;
  const std::string& name = *choice.animation;
  for (std::uint32_t i = 0; i < count; ++i)
    if (mesh.rig->animations[i].name == name) return i;
  std::uint32_t number = 0;
  const auto [end, error] = std::from_chars(name.data(), name.data() + name.size(), number);
  if (error != std::errc() || end != name.data() + name.size() || number >= count)
    wrong_usage(fmt::format("{}: no animation '{}' ({} animations)", input, name, count));
  return number;
}

}  // namespace

ChosenPose choose_pose(const std::string& input, const TriangleMesh& mesh,
                       const PoseChoice& choice) {
  ChosenPose chosen;
  const std::size_t poses = mesh.poses.size();
  if (choice.pose) {
    if (*choice.pose > poses)
      wrong_usage(fmt::format("{}: no pose {} ({} poses beside the shape at rest)", input,
                              *choice.pose, poses));
    chosen.weights.assign(*choice.pose, 0);
    if (*choice.pose > 0) chosen.weights.back() = 1;
    return chosen;
  }
  if (!choice.blend.empty()) {
    if (choice.blend.size() > poses)
      wrong_usage(fmt::format("{}: {} weights for {} poses", input, choice.blend.size(), poses));
    chosen.weights = choice.blend;
    return chosen;
  }
  if (!choice.animation && !choice.time) return chosen;
  chosen.moves_rig = true;
  chosen.animation = find_animation(input, mesh, choice);
  chosen.time = choice.time.value_or(time_range(mesh.rig->animations[chosen.animation]).first);
  return chosen;
}

TriangleMesh frozen(const TriangleMesh& mesh, const ChosenPose& pose) {
  if (pose.moves_rig) return posed_mesh(mesh, pose.animation, pose.time);
  return blended_mesh(mesh, pose.weights);
}

ShownPose shown_pose(const TriangleMesh& mesh, const ChosenPose& pose) {
  RigPose rig;
  rig.weights = pose.weights;
  if (pose.moves_rig) pose_rig(mesh, pose.animation, pose.time, rig);
  PosedVertices vertices;
  posed_vertices(mesh, rig, vertices);
  return {std::move(rig.weights), std::move(rig.joints), std::move(vertices.positions)};
}

}  // namespace varifold::cli
