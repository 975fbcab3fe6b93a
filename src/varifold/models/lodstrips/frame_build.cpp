#include <varifold/models/lodstrips/frame_build.h>

#include <varifold/base/parallel.h>
#include <varifold/mesh/pose_blend.h>
#include <varifold/models/lodstrips/frame_clusters.h>
#include <varifold/simplify/deviation.h>
#include <algorithm>
#include <chrono>
#include <numeric>
#include <utility>

namespace varifold {

namespace {

// Frames are compared at the level that has this part of the triangles.
constexpr std::uint32_t kComparedPart = 10;

using Clock = std::chrono::steady_clock;

class Builder {
 public:
  Builder(const TriangleMesh& mesh, const FrameStripsOptions& options)
      : mesh_(mesh), options_(options), frames_(options.frames) {
    if (frames_.empty()) {
      frames_.emplace_back();
      for (std::size_t i = 0; i < mesh.poses.size(); ++i) {
        frames_.emplace_back(i + 1, 0.0f);
        frames_.back().back() = 1;
      }
    }
    shapes_ = frame_shapes(mesh, frames_);
  }

  Result<FrameStripsBuild> build() {
    std::vector<std::uint32_t> group_of(frames_.size());
    std::iota(group_of.begin(), group_of.end(), 0u);
    const auto frames = static_cast<std::uint32_t>(frames_.size());
    if (options_.sequences == 1) {
      std::fill(group_of.begin(), group_of.end(), 0u);
    } else if (options_.sequences > 1 && options_.sequences < frames) {
      auto grouped = group(options_.sequences);
      if (!grouped) return tl::unexpected(std::move(grouped.error()));
      group_of = std::move(*grouped);
    }
    const std::uint32_t groups = *std::max_element(group_of.begin(), group_of.end()) + 1;
    std::vector<DetailedMesh> sequences;
    for (std::uint32_t g = 0; g < groups; ++g) {
      std::vector<std::uint32_t> members;
      for (std::uint32_t frame = 0; frame < frames; ++frame)
        if (group_of[frame] == g) members.push_back(frame);
      auto simplified = simplify_frames(members, options_.simplify.measure_error);
      if (!simplified) return tl::unexpected(std::move(simplified.error()));
      sequences.push_back(std::move(*simplified));
    }
    result_.model = FrameStrips(assemble(std::move(sequences), group_of));
    return std::move(result_);
  }

 private:
  // One sequence for some frames. The mesh takes the shape of the first; its own shapes stay as
  // poses that do not count, so that points are those of all shapes.
  Result<DetailedMesh> simplify_frames(const std::vector<std::uint32_t>& members, bool measure) {
    TriangleMesh mesh = mesh_;
    if (!mesh.poses.empty()) {
      mesh.poses.push_back({"rest", std::move(mesh.positions), {}});
      mesh.positions = shapes_[members[0]].positions;
    }
    std::vector<Pose> others;
    for (std::size_t i = 1; i < members.size(); ++i) others.push_back(shapes_[members[i]]);
    SimplifyOptions options = options_.simplify;
    options.poses = {false, true, others};
    options.target_triangles = 0;
    options.measure_error = false;
    auto simplified = simplify(mesh, options);
    if (!simplified) return tl::unexpected(std::move(simplified.error()));
    result_.faults = simplified->faults;
    result_.simplify_seconds += simplified->collapse_seconds;
    if (simplified->stop.triangles >= result_.stop.triangles) result_.stop = simplified->stop;
    DetailedMesh detailed = std::move(simplified->detailed);
    detailed.mesh.poses.clear();
    if (!measure) return detailed;
    const auto start = Clock::now();
    if (!measure_deviation(detailed, {options.threads, options.progress}))
      return fail(ErrorKind::kCancelled, "cancelled while measuring the error");
    result_.measure_seconds += std::chrono::duration<double>(Clock::now() - start).count();
    return detailed;
  }

  // Frames whose sequences cost each other little.
  Result<std::vector<std::uint32_t>> group(std::uint32_t groups) {
    const auto start = Clock::now();
    const auto count = static_cast<std::uint32_t>(frames_.size());
    std::vector<double> loss(std::size_t{count} * count);
    for (std::uint32_t i = 0; i < count; ++i) {
      const auto detailed = simplify_frames({i}, false);
      if (!detailed) return tl::unexpected(detailed.error());
      const std::uint32_t level =
          detailed->sequence.level_for_triangles(detailed->mesh.triangle_count() / kComparedPart);
      parallel_for(options_.simplify.threads, count, 1, [&](std::size_t j, std::size_t) {
        std::vector<Vec3> shape;
        for (const std::uint32_t v : detailed->original_vertex)
          shape.push_back(shapes_[j].positions[v]);
        loss[std::size_t{i} * count + j] = level_distance(*detailed, level, shape);
      });
    }
    std::vector<std::uint32_t> groups_of = group_frames(loss, count, groups);
    result_.simplify_seconds = 0;  // what it took is in this time
    result_.cluster_seconds = std::chrono::duration<double>(Clock::now() - start).count();
    return groups_of;
  }

  FrameStripsData assemble(std::vector<DetailedMesh> sequences,
                           const std::vector<std::uint32_t>& group_of) {
    FrameStripsData data;
    std::uint32_t steps = kNone;
    for (const DetailedMesh& detailed : sequences)
      steps = std::min(steps, detailed.sequence.step_count());
    for (DetailedMesh& detailed : sequences)
      cut_below(detailed.sequence.step_count() - steps, detailed.sequence);

    // The vertices have the numbers of the first sequence.
    const std::vector<std::uint32_t> original = sequences[0].original_vertex;
    std::vector<std::uint32_t> number(mesh_.vertex_count(), kNone);
    for (std::uint32_t v = 0; v < original.size(); ++v) number[original[v]] = v;
    for (const DetailedMesh& detailed : sequences) {
      FrameSequence& sequence = data.sequences.emplace_back();
      sequence.levels = LevelTable(detailed.sequence);
      for (const std::uint32_t v : detailed.original_vertex) sequence.vertex.push_back(number[v]);
    }
    data.mesh = std::move(sequences[0].mesh);
    data.mesh.poses = {};
    gather_shapes(original, data.mesh);
    data.strips = sorted_by_range(stripify(data.mesh, options_.stripify));
    data.frames.reserve(frames_.size());
    for (std::size_t frame = 0; frame < frames_.size(); ++frame)
      data.frames.push_back({frames_[frame], group_of[frame]});
    return data;
  }

  // The mesh at rest and its poses, in the numbers of the first sequence.
  void gather_shapes(const std::vector<std::uint32_t>& original, TriangleMesh& mesh) const {
    const auto gather = [&](const std::vector<Vec3>& from, std::vector<Vec3>& to) {
      to.clear();
      if (from.empty()) return;
      for (const std::uint32_t v : original) to.push_back(from[v]);
    };
    gather(mesh_.positions, mesh.positions);
    for (const Pose& pose : mesh_.poses) {
      Pose& gathered = mesh.poses.emplace_back();
      gathered.name = pose.name;
      gather(pose.positions, gathered.positions);
      gather(pose.normals, gathered.normals);
    }
  }

  const TriangleMesh& mesh_;
  const FrameStripsOptions& options_;
  std::vector<std::vector<float>> frames_;
  std::vector<Pose> shapes_;
  FrameStripsBuild result_;
};

}  // namespace

std::vector<Pose> frame_shapes(const TriangleMesh& mesh,
                               const std::vector<std::vector<float>>& frames) {
  std::vector<Pose> shapes;
  shapes.reserve(frames.size());
  for (const std::vector<float>& weights : frames)
    shapes.push_back({"", blend_poses(mesh, weights).positions, {}});
  return shapes;
}

std::vector<std::vector<float>> morph_frames(std::uint32_t count) {
  std::vector<std::vector<float>> frames;
  for (std::uint32_t i = 0; i < count; ++i)
    frames.push_back({count > 1 ? static_cast<float>(i) / static_cast<float>(count - 1) : 0.0f});
  return frames;
}

Result<FrameStripsBuild> build_frame_strips(const TriangleMesh& mesh,
                                            const FrameStripsOptions& options) {
  return Builder(mesh, options).build();
}

}  // namespace varifold
