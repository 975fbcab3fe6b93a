#include <varifold/models/patch_tree/build.h>

#include <varifold/base/large_vector.h>
#include <varifold/base/parallel.h>
#include <varifold/mesh/vertex_arrays.h>
#include <varifold/models/patch_tree/assemble.h>
#include <varifold/models/patch_tree/level_blocks.h>
#include <varifold/models/patch_tree/level_errors.h>
#include <varifold/models/patch_tree/level_halving.h>
#include <varifold/models/patch_tree/patch_errors.h>
#include <varifold/partition/edge_links.h>
#include <varifold/partition/patch_levels.h>
#include <varifold/partition/patches.h>
#include <varifold/simplify/input_fault.h>
#include <varifold/simplify/point_quadric.h>
#include <varifold/simplify/pose_deviation.h>
#include <varifold/simplify/surface_builder.h>
#include <algorithm>
#include <chrono>
#include <numeric>
#include <optional>
#include <utility>

namespace varifold {

namespace {

using Clock = std::chrono::steady_clock;

// A level that keeps more than this part of its triangles is not worth having.
constexpr double kPoorRatio = 0.75;
// More triangles than this in a patch would not fit its 16-bit numbers.
constexpr std::uint32_t kMaxPatchTriangles = 21000;
constexpr std::size_t kPatchesPerPiece = 16;
constexpr std::uint32_t kManyTriangles = 4'000'000;

class Stopwatch {
 public:
  // Adds the time since the last call to `seconds`.
  void add_to(double& seconds) {
    const Clock::time_point now = Clock::now();
    seconds += std::chrono::duration<double>(now - last_).count();
    last_ = now;
  }

 private:
  Clock::time_point last_ = Clock::now();
};

class Builder {
 public:
  Builder(const TriangleMesh& mesh, const PatchTreeOptions& options)
      : mesh_(mesh),
        options_(options),
        shapes_(ordering_shapes(mesh, {true, true, options.poses.samples})) {}

  Result<PatchTreeBuild> build();

 private:
  bool make_surface();
  bool cut_into_patches(const WorkingSurface& surface);
  void set_corners();
  void save_memory() const;
  void order_by_patches(const std::vector<std::uint32_t>& patch_of);
  bool make_levels_of_detail();
  void begin_level(std::uint32_t level);
  bool is_worth_it(std::uint32_t level, std::span<const std::uint32_t> left) const;
  void keep_level(std::uint32_t level, const LevelHalving* halving);
  [[nodiscard]] PatchNeighbors neighbors_of(const LevelBlocks& blocks) const;
  [[nodiscard]] std::uint32_t point_of(std::uint32_t wedge) const {
    return surface_.wedge.has_seams() ? surface_.wedge.point_of[wedge] : wedge;
  }

  const TriangleMesh& mesh_;
  const PatchTreeOptions& options_;
  std::vector<std::span<const Vec3>> shapes_;  // beside that at rest
  PatchTreeBuild result_;
  Stopwatch watch_;
  WorkingSurface surface_;
  AttributeField attributes_;
  std::vector<std::uint32_t> material_of_;  // per triangle of the input, or empty
  PatchLevels levels_;
  LevelMesh level_mesh_;              // of the present level
  std::vector<AssembledLevel> kept_;  // from the leaves on
};

// The surface and, meanwhile, the patches of its leaves. False where cancelled.
bool Builder::make_surface() {
  SurfaceOptions options;
  options.with_wedges = may_have_seams(mesh_);
  options.threads = options_.threads;
  const bool has_materials =
      mesh_.ranges.size() > 1 || (mesh_.ranges.size() == 1 && mesh_.ranges[0].material != 0);
  if (has_materials) material_of_ = triangle_materials(mesh_);
  SurfaceBuilder builder(mesh_, options);
  bool is_cut = false;
  parallel_both(
      options_.threads, [&] { is_cut = cut_into_patches(builder.surface()); },  // reports progress
      [&] { builder.make_rings(); });
  if (!is_cut) return false;
  surface_ = builder.finish(result_.report.faults);
  // Repeated triangles are known now; they must not be in a patch.
  if (result_.report.faults.duplicate_triangles > 0 && !cut_into_patches(surface_)) return false;
  set_corners();
  surface_.point_of_vertex = {};  // corners are all that is asked for from here on
  if (!options.with_wedges) return true;
  attributes_ = AttributeField(mesh_, surface_.wedge.vertex_of, options_.attributes);
  if (!attributes_.empty()) add_faces_to_attributes(surface_, attributes_, options_.threads);
  return true;
}

// The triangles along the numbers of their points, and the leaves and levels made of them.
bool Builder::cut_into_patches(const WorkingSurface& surface) {
  const auto corner = [&](std::uint32_t face, std::size_t k) {
    return surface.point_of_vertex[mesh_.indices[3 * std::size_t{face} + k]];
  };
  const auto first_point = [&](std::uint32_t face) {
    return std::min({corner(face, 0), corner(face, 1), corner(face, 2)});
  };
  std::vector<std::uint32_t> next(surface.point_count() + 1, 0);
  for (std::uint32_t face = 0; face < mesh_.triangle_count(); ++face)
    if (surface.is_face[face]) ++next[first_point(face) + 1];
  for (std::size_t p = 1; p < next.size(); ++p) next[p] += next[p - 1];
  level_mesh_.faces.resize(surface.face_count);
  for (std::uint32_t face = 0; face < mesh_.triangle_count(); ++face)
    if (surface.is_face[face]) level_mesh_.faces[next[first_point(face)]++] = face;
  next = {};

  const std::size_t faces = level_mesh_.faces.size();
  LargeVector<std::uint32_t> corners(3 * faces), materials(material_of_.empty() ? 0 : faces);
  parallel_for(options_.threads, faces, 16384, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const std::uint32_t face = level_mesh_.faces[i];
      for (std::size_t k = 0; k < 3; ++k) corners[3 * i + k] = corner(face, k);
      if (!materials.empty()) materials[i] = material_of_[face];
    }
  });
  LargeVector<Vec3> positions(surface.point_count());
  for (std::size_t p = 0; p < positions.size(); ++p) positions[p] = surface.points[p].position;

  const SurfaceView view{corners, positions, materials};
  PartitionOptions options;
  options.triangles_per_patch = options_.triangles_per_patch;
  options.smooth = options_.smooth_borders;
  options.threads = options_.threads;
  options.progress = options_.progress;
  const EdgeLinks links(view);
  Partition partition = make_patches(view, links, options);
  if (partition.cancelled) return false;
  levels_ = make_levels(view, links, partition, options_.threads);
  result_.report.non_disc_leaves = partition.non_discs;
  order_by_patches(partition.patch_of);
  return true;
}

void Builder::order_by_patches(const std::vector<std::uint32_t>& patch_of) {
  const std::uint32_t patches = levels_.level_count() > 0 ? levels_.patch_count(0) : 0;
  std::vector<std::uint32_t>& first = level_mesh_.first_face;
  first.assign(patches + 1, 0);
  for (const std::uint32_t patch : patch_of) ++first[patch + 1];
  for (std::size_t i = 1; i < first.size(); ++i) first[i] += first[i - 1];
  std::vector<std::uint32_t> next(first.begin(), first.end() - 1);
  std::vector<std::uint32_t> faces(patch_of.size());
  for (std::size_t i = 0; i < patch_of.size(); ++i)
    faces[next[patch_of[i]]++] = level_mesh_.faces[i];
  level_mesh_.faces = std::move(faces);
}

void Builder::set_corners() {
  LevelMesh& mesh = level_mesh_;
  mesh.corners.resize(3 * mesh.faces.size());
  parallel_for(options_.threads, mesh.faces.size(), 16384, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = 3 * begin; i < 3 * end; ++i) {
      const std::size_t at = 3 * std::size_t{mesh.faces[i / 3]} + i % 3;
      mesh.corners[i] = surface_.wedge.has_seams() ? surface_.wedge.corners[at]
                                                   : surface_.point_of_vertex[mesh_.indices[at]];
    }
  });
}

// Taking memory from the system anew costs some percent of the time; that of small meshes is not
// missed.
void Builder::save_memory() const {
  if (mesh_.triangle_count() >= kManyTriangles) release_free_memory();
}

// The patches to come are the regions whose borders are kept.
void Builder::begin_level(std::uint32_t level) {
  surface_.region_of.resize(mesh_.triangle_count(), kNone);
  const LevelMesh& mesh = level_mesh_;
  parallel_for(options_.threads, mesh.patch_count(), kPatchesPerPiece,
               [&](std::size_t begin, std::size_t end) {
                 for (std::size_t patch = begin; patch < end; ++patch)
                   for (auto i = mesh.first_face[patch]; i < mesh.first_face[patch + 1]; ++i)
                     surface_.region_of[mesh.faces[i]] = levels_.parent[level][patch];
               });
}

// `left`: how many triangles are left of each patch.
bool Builder::is_worth_it(std::uint32_t level, std::span<const std::uint32_t> left) const {
  const std::vector<std::uint32_t>& parent = levels_.parent[level];
  std::vector<std::uint32_t> sizes(parent.back() + 1, 0);
  for (std::size_t patch = 0; patch < left.size(); ++patch) sizes[parent[patch]] += left[patch];
  const std::uint32_t sum = std::accumulate(sizes.begin(), sizes.end(), 0u);
  return sum <= kPoorRatio * level_mesh_.face_count() &&
         *std::max_element(sizes.begin(), sizes.end()) <= kMaxPatchTriangles &&
         *std::min_element(sizes.begin(), sizes.end()) > 0;
}

void Builder::keep_level(std::uint32_t level, const LevelHalving* halving) {
  AssembledLevel kept;
  if (halving) kept.parent = levels_.parent[level];
  const FinishedLevel finished{level_mesh_, kept.parent, material_of_, surface_, halving};
  AssembledLevel* finer = kept_.empty() ? nullptr : &kept_.back();
  const std::vector<std::uint32_t> first_child =
      finer ? first_children(*finer, levels_.patch_count(level)) : std::vector<std::uint32_t>{};
  kept.blocks =
      lay_out_blocks(finished, finer ? &finer->blocks : nullptr, first_child, options_.threads);
  kept.neighbors = neighbors_of(kept.blocks);
  result_.report.level_triangles.push_back(level_mesh_.face_count());
  result_.report.level_patches.push_back(level_mesh_.patch_count());
  kept_.push_back(std::move(kept));
}

PatchNeighbors Builder::neighbors_of(const LevelBlocks& blocks) const {
  std::vector<std::uint32_t> points, first{0};
  points.reserve(blocks.wedges.size());
  first.reserve(blocks.offsets.size());
  for (std::uint32_t patch = 0; patch < blocks.patch_count(); ++patch) {
    const std::uint32_t* wedges = blocks.wedges.data() + blocks.offsets[patch].vertex;
    for (std::uint32_t v = 0; v < blocks.drawn[patch]; ++v) points.push_back(point_of(wedges[v]));
    first.push_back(static_cast<std::uint32_t>(points.size()));
  }
  return patch_neighbors(points, first, surface_.point_count());
}

bool Builder::make_levels_of_detail() {
  const PoseField poses(surface_, mesh_.positions, shapes_, options_.threads);
  std::optional<ShapeTable> shapes;
  if (!poses.empty()) shapes.emplace(surface_, poses);
  const auto ordering = ordering_shapes(mesh_, options_.poses);
  const bool all_order = ordering.size() == shapes_.size();
  const PoseField some =
      all_order ? PoseField() : PoseField(surface_, mesh_.positions, ordering, options_.threads);
  LevelHalving halving(surface_, attributes_,
                       {options_.threads, options_.progress,
                        ordering.empty() ? nullptr : (all_order ? &poses : &some)});
  std::optional<LevelErrors> errors;  // made when the first collapses are done: they need room, too
  for (std::uint32_t level = 0;; ++level) {
    if (level + 1 == levels_.level_count()) {
      keep_level(level, nullptr);
      return true;
    }
    begin_level(level);
    const HalvingReport report = halving.halve(level_mesh_, (level_mesh_.face_count() + 1) / 2);
    if (report.cancelled) return false;
    result_.report.reruns += report.reruns;
    result_.report.locked_points += report.locked_points;
    result_.report.vanished_points += report.vanished_points;
    const std::vector<std::uint32_t> left = halving.count_left(level_mesh_);
    watch_.add_to(result_.report.halving_seconds);
    if (!report.is_sound || !is_worth_it(level, left)) {
      result_.report.stop = TreeStop::kPoorRatio;
      keep_level(level, nullptr);
      return true;
    }
    save_memory();  // queues and logs
    if (!errors) errors.emplace(surface_, options_.threads, shapes ? &*shapes : nullptr);
    parallel_both(
        options_.threads,
        [&] {
          errors->measure(halving.take_went(), halving.live());
          watch_.add_to(result_.report.error_seconds);
        },
        [&] { keep_level(level, &halving); });
    add_errors(kept_.back(), *errors, surface_, options_.threads);
    if (options_.priority == PatchPriority::kMeanValue)
      add_mean_value_errors(kept_.back(), *errors, surface_, options_.threads);
    save_memory();  // what the layout was joined from
    halving.shrink(level_mesh_, left, levels_.parent[level]);
    watch_.add_to(result_.report.layout_seconds);
  }
}

Result<PatchTreeBuild> Builder::build() {
  if (!make_surface()) return fail(ErrorKind::kCancelled, "cancelled while making patches");
  if (surface_.face_count == 0) {
    result_.tree = PatchTree(empty_tree(mesh_));
    return std::move(result_);
  }
  watch_.add_to(result_.report.partition_seconds);
  if (!make_levels_of_detail()) return fail(ErrorKind::kCancelled, "cancelled while simplifying");
  // Only where its vertices come from is needed of the surface any more.
  surface_.points = {};
  surface_.lines = {};
  surface_.pools = {};
  surface_.region_of = {};
  surface_.reference_normal = {};
  level_mesh_ = {};
  save_memory();
  result_.tree = PatchTree(
      assemble(mesh_, options_.poses.samples, surface_, std::move(kept_), options_.threads));
  watch_.add_to(result_.report.layout_seconds);
  return std::move(result_);
}

}  // namespace

Result<PatchTreeBuild> build_patch_tree(const TriangleMesh& mesh, const PatchTreeOptions& options) {
  std::string fault = input_fault(mesh);
  if (fault.empty()) fault = sample_fault(mesh, options.poses.samples);
  if (!fault.empty()) return fail(ErrorKind::kInvalidInput, std::move(fault));
  return Builder(mesh, options).build();
}

}  // namespace varifold
