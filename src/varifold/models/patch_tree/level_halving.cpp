#include <varifold/models/patch_tree/level_halving.h>

#include <varifold/base/parallel.h>
#include <varifold/models/patch_tree/component_removal.h>
#include <varifold/simplify/classify.h>
#include <varifold/simplify/collapse_rounds.h>
#include <varifold/simplify/packed_normal.h>
#include <numeric>

namespace varifold {

namespace {

// Against needles: 2 * area / longest edge^2.
constexpr float kMinShape = 0.01f;
// Where only such dear collapses are left, needles are the lesser evil: a level that has to do
// without its cheap ones would lose whole limbs.
constexpr float kMostCost = 4.0f;
// Beyond so many runs all borders of the level stay as they are.
constexpr std::uint32_t kMaxReruns = 16;
constexpr std::size_t kPatchesPerPiece = 16;
constexpr std::size_t kFacesPerPiece = 16384;
// Quadrics are about the area around a point times a squared distance; a collapse whose real
// distance is up to twice that of its quadric costs no more for it. Lower, spikes of the dragon go
// too early; higher, the mean error rises.
constexpr float kDistanceWeight = 0.25f;

}  // namespace

LevelHalving::LevelHalving(WorkingSurface& surface, AttributeField& attributes,
                           const HalvingOptions& options)
    : surface_(surface),
      attributes_(attributes),
      options_(options),
      guard_(surface, options.poses) {
  const std::size_t wedges =
      surface.wedge.has_seams() ? surface.wedge.vertex_of.size() : surface.point_count();
  survivor_.resize(wedges);
  std::iota(survivor_.begin(), survivor_.end(), 0u);
  live_.resize(surface.point_count());
  std::iota(live_.begin(), live_.end(), 0u);
}

// Remembers how the triangles stand, and how large they are.
void LevelHalving::begin_level(const LevelMesh& mesh) {
  surface_.reference_normal.resize(surface_.is_face.size());
  std::vector<double> areas(mesh.face_count() / kFacesPerPiece + 1, 0);  // twice that of each piece
  parallel_for(options_.threads, mesh.face_count(), kFacesPerPiece,
               [&](std::size_t begin, std::size_t end) {
                 double& area = areas[begin / kFacesPerPiece];
                 for (std::size_t i = begin; i < end; ++i) {
                   const auto at = [&](std::size_t k) {
                     return surface_.points[point_of(mesh.corners[3 * i + k])].position;
                   };
                   const Vec3 normal = glm::cross(at(1) - at(0), at(2) - at(0));
                   area += glm::length(normal);
                   surface_.reference_normal[mesh.faces[i]] = pack_normal(normal);
                 }
               });
  const double area = 0.5 * std::accumulate(areas.begin(), areas.end(), 0.0);
  area_per_point_ = static_cast<float>(area / static_cast<double>(live_.size()));
}

HalvingReport LevelHalving::halve(const LevelMesh& mesh, std::uint32_t target_faces) {
  HalvingReport report;
  BorderLocks locks;
  begin_level(mesh);
  while (true) {
    if (is_first_)
      classify_points(surface_, options_.threads);
    else
      reclassify_points(surface_, live_, options_.threads);
    is_first_ = false;
    guard_.begin_level(locks, live_);
    if (report.reruns == kMaxReruns) guard_.lock_all();
    std::vector<CollapseLogEntry> log;
    report.cancelled = !collapse(target_faces, log);
    const BorderLocks before = locks;
    report.is_sound = !report.cancelled && guard_.verify(locks, options_.threads);
    if (report.is_sound || report.cancelled || report.reruns == kMaxReruns) {
      report.vanished_points = vanish(target_faces, log);
      find_survivors(log);
      break;
    }
    report.reruns = locks == before ? kMaxReruns : report.reruns + 1;
    restore(mesh, log);
  }
  report.locked_points = static_cast<std::uint32_t>(locks.points.size());
  return report;
}

// Down to the target; what keeps needles away is relaxed where nothing else is left to do. False
// where cancelled.
bool LevelHalving::collapse(std::uint32_t target_faces, std::vector<CollapseLogEntry>& log) {
  for (const float min_shape : {kMinShape, LegalityOptions().min_shape}) {
    if (surface_.face_count <= target_faces) break;
    CollapserOptions options;
    options.legality.min_shape = min_shape;
    options.distance_weight = kDistanceWeight * area_per_point_;
    Collapser collapser(surface_, &attributes_, options);
    collapser.guard = &guard_;
    collapser.poses = options_.poses;
    RoundOptions rounds;
    rounds.target_faces = target_faces;
    rounds.exact = true;
    rounds.log_faces = false;
    if (min_shape == kMinShape) rounds.most_cost = kMostCost;
    rounds.live = live_;
    rounds.threads = options_.threads;
    rounds.progress = options_.progress;
    CollapseLog done = run_rounds(surface_, collapser, rounds);
    if (log.empty())
      log = std::move(done.entries);
    else
      log.insert(log.end(), done.entries.begin(), done.entries.end());
    if (done.cancelled) return false;
  }
  return true;
}

// Components that cannot be halved and lie inside one patch go as a whole.
std::uint32_t LevelHalving::vanish(std::uint32_t target_faces, std::vector<CollapseLogEntry>& log) {
  if (surface_.face_count <= target_faces) return 0;
  const auto gone = remove_components(surface_, target_faces);
  WedgeTables& wedge = surface_.wedge;
  for (const auto& [from, onto] : gone) {
    log.push_back({from, onto, 0, 0, 0});
    if (!wedge.has_seams()) continue;
    for (std::uint32_t w = wedge.first[from]; w < wedge.first[from + 1]; ++w)
      wedge.target[w] = wedge.first[onto];
  }
  return static_cast<std::uint32_t>(gone.size());
}

void LevelHalving::restore(const LevelMesh& mesh, std::span<const CollapseLogEntry> log) {
  WedgeTables& wedge = surface_.wedge;
  std::vector<std::uint32_t> points(mesh.corners.size());
  for (std::size_t i = 0; i < points.size(); ++i) points[i] = point_of(mesh.corners[i]);
  rebuild_rings(surface_, mesh.faces, points);
  if (!wedge.has_seams()) return;
  for (std::size_t i = 0; i < mesh.corners.size(); ++i)
    wedge.corners[3 * std::size_t{mesh.faces[i / 3]} + i % 3] = mesh.corners[i];
  for (const CollapseLogEntry& entry : log)
    for (std::uint32_t w = wedge.first[entry.from]; w < wedge.first[entry.from + 1]; ++w)
      wedge.target[w] = kNone;
}

// From the last collapse to the first: where a point went on to is known before it came there.
void LevelHalving::find_survivors(std::span<const CollapseLogEntry> log) {
  const WedgeTables& wedge = surface_.wedge;
  for (std::size_t i = log.size(); i-- > 0;) {
    const auto [from, onto] = std::pair(log[i].from, log[i].onto);
    if (!wedge.has_seams()) {
      survivor_[from] = survivor_[onto];
      continue;
    }
    for (std::uint32_t w = wedge.first[from]; w < wedge.first[from + 1]; ++w)
      survivor_[w] = survivor_[wedge.target[w]];
  }
  went_.clear();
  went_.reserve(live_.size() / 2);
  std::size_t kept = 0;
  for (const std::uint32_t p : live_) {
    if (surface_.points[p].flags & PointState::kDead)
      went_.emplace_back(p, point_of(survivor_[wedge.first_of(p)]));
    else
      live_[kept++] = p;
  }
  live_.resize(kept);
  live_.shrink_to_fit();
}

bool LevelHalving::is_left(const LevelMesh& mesh, std::size_t triangle,
                           std::array<std::uint32_t, 3>& corners) const {
  std::array<std::uint32_t, 3> p{};
  for (std::size_t k = 0; k < 3; ++k) {
    corners[k] = survivor_[mesh.corners[3 * triangle + k]];
    p[k] = point_of(corners[k]);
  }
  return p[0] != p[1] && p[1] != p[2] && p[2] != p[0];
}

std::vector<std::uint32_t> LevelHalving::count_left(const LevelMesh& mesh) const {
  std::vector<std::uint32_t> left(mesh.patch_count(), 0);
  parallel_for(options_.threads, left.size(), kPatchesPerPiece,
               [&](std::size_t begin, std::size_t end) {
                 std::array<std::uint32_t, 3> corners{};
                 for (std::size_t patch = begin; patch < end; ++patch)
                   for (auto i = mesh.first_face[patch]; i < mesh.first_face[patch + 1]; ++i)
                     left[patch] += is_left(mesh, i, corners);
               });
  return left;
}

void LevelHalving::shrink(LevelMesh& mesh, std::span<const std::uint32_t> left,
                          std::span<const std::uint32_t> parent) const {
  LevelMesh result;
  std::vector<std::uint32_t> first(left.size() + 1, 0);
  for (std::size_t patch = 0; patch < left.size(); ++patch) {
    if (patch == 0 || parent[patch] != parent[patch - 1]) result.first_face.push_back(first[patch]);
    first[patch + 1] = first[patch] + left[patch];
  }
  result.first_face.push_back(first.back());
  result.faces.resize(first.back());
  result.corners.resize(3 * result.faces.size());
  parallel_for(options_.threads, left.size(), kPatchesPerPiece,
               [&](std::size_t begin, std::size_t end) {
                 std::size_t to = first[begin];
                 std::array<std::uint32_t, 3> corners{};
                 for (auto i = mesh.first_face[begin]; i < mesh.first_face[end]; ++i) {
                   if (!is_left(mesh, i, corners)) continue;
                   result.faces[to] = mesh.faces[i];
                   for (std::size_t k = 0; k < 3; ++k) result.corners[3 * to + k] = corners[k];
                   ++to;
                 }
               });
  mesh = std::move(result);
}

}  // namespace varifold
