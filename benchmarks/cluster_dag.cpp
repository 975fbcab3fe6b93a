#include <benchmarks/cluster_dag.h>

#include <benchmarks/cluster_groups.h>
#include <meshoptimizer.h>
#include <algorithm>
#include <limits>

namespace varifold::bench {
namespace {

constexpr float kStuck = std::numeric_limits<float>::infinity();

// A ball around balls: grown from two that are far apart, a little larger than it need be, so that
// rounding leaves none outside.
Sphere ball_around(std::span<const Sphere> balls) {
  const auto farthest = [&](const Sphere& from) {
    const auto reach = [&](const Sphere& b) {
      return glm::length(b.center - from.center) + b.radius;
    };
    return *std::max_element(balls.begin(), balls.end(),
                             [&](const Sphere& a, const Sphere& b) { return reach(a) < reach(b); });
  };
  Sphere ball = farthest(balls.front());
  const auto include = [&](const Sphere& other) {
    const Vec3 way = other.center - ball.center;
    const float distance = glm::length(way);
    if (distance + other.radius <= ball.radius) return;
    if (distance + ball.radius <= other.radius) {
      ball = other;
      return;
    }
    const float radius = 0.5f * (distance + ball.radius + other.radius);
    ball.center += (radius - ball.radius) / distance * way;
    ball.radius = radius;
  };
  include(farthest(ball));
  for (const Sphere& other : balls) include(other);
  float radius = 0;
  for (const Sphere& other : balls)
    radius = std::max(radius, glm::length(other.center - ball.center) + other.radius);
  ball.radius = radius * (1 + 1e-5f);
  return ball;
}

}  // namespace

// Triangles with vertices of their own, as functions of meshoptimizer take time and memory for all
// vertices that they are given.
struct ClusterDag::Piece {
  std::vector<std::uint32_t> vertices;  // those of the whole
  std::vector<Vec3> positions;
  std::vector<std::uint32_t> indices;

  Piece(std::span<const std::uint32_t> whole, const std::vector<Vec3>& all,
        std::vector<std::uint32_t>& local_of) {
    indices.reserve(whole.size());
    for (const std::uint32_t v : whole) {
      if (local_of[v] == kNone) {
        local_of[v] = static_cast<std::uint32_t>(vertices.size());
        vertices.push_back(v);
        positions.push_back(all[v]);
      }
      indices.push_back(local_of[v]);
    }
    for (const std::uint32_t v : vertices) local_of[v] = kNone;
  }
};

ClusterDag::ClusterDag(const TriangleMesh& mesh, const ClusterDagOptions& options)
    : options_(options), positions_(mesh.positions), local_of_(mesh.positions.size(), kNone) {
  add_clusters(mesh.indices, kNone);
  while (pending_.size() > 1) {
    std::vector<std::vector<std::uint32_t>> vertices(pending_.size());
    for (std::size_t i = 0; i < pending_.size(); ++i) {
      const auto corners = indices_of(clusters_[pending_[i]]);
      vertices[i].assign(corners.begin(), corners.end());
      std::sort(vertices[i].begin(), vertices[i].end());
      vertices[i].erase(std::unique(vertices[i].begin(), vertices[i].end()), vertices[i].end());
    }
    auto groups = group_clusters(vertices, options_.group_clusters);
    for (auto& group : groups)
      for (std::uint32_t& member : group) member = pending_[member];
    pending_.clear();
    for (const auto& group : groups) simplify_group(group);
  }
  // The last cluster, if one is left, is as coarse as it gets.
  for (const std::uint32_t c : pending_) {
    clusters_[c].group = static_cast<std::uint32_t>(groups_.size());
    groups_.push_back({ball_of(clusters_[c]), kStuck, groups_.back().depth + 1});
  }
  pending_ = {};
  local_of_ = {};
}

Sphere ClusterDag::ball_of(const Cluster& cluster) const {
  if (cluster.made_by != kNone) return groups_[cluster.made_by].ball;
  const auto corners = indices_of(cluster);
  const meshopt_Bounds bounds = meshopt_computeClusterBounds(
      corners.data(), corners.size(), &positions_[0].x, positions_.size(), sizeof(Vec3));
  return {{bounds.center[0], bounds.center[1], bounds.center[2]}, bounds.radius};
}

void ClusterDag::add_clusters(std::span<const std::uint32_t> indices, std::uint32_t made_by) {
  const Piece piece(indices, positions_, local_of_);
  const std::size_t bound =
      meshopt_buildMeshletsBound(indices.size(), options_.max_vertices, options_.max_triangles);
  std::vector<meshopt_Meshlet> meshlets(bound);
  std::vector<std::uint32_t> vertices(bound * options_.max_vertices);
  std::vector<unsigned char> corners(bound * options_.max_triangles * 3);
  meshlets.resize(meshopt_buildMeshlets(meshlets.data(), vertices.data(), corners.data(),
                                        piece.indices.data(), piece.indices.size(),
                                        &piece.positions[0].x, piece.positions.size(), sizeof(Vec3),
                                        options_.max_vertices, options_.max_triangles, 0));
  for (const meshopt_Meshlet& meshlet : meshlets) {
    pending_.push_back(static_cast<std::uint32_t>(clusters_.size()));
    clusters_.push_back({stored_triangles(), meshlet.triangle_count, made_by, kNone});
    for (std::uint32_t i = 0; i < 3 * meshlet.triangle_count; ++i) {
      const std::uint32_t local =
          vertices[meshlet.vertex_offset + corners[meshlet.triangle_offset + i]];
      indices_.push_back(piece.vertices[local]);
    }
  }
}

void ClusterDag::simplify_group(std::span<const std::uint32_t> members) {
  const auto number = static_cast<std::uint32_t>(groups_.size());
  ClusterGroup group;
  std::vector<Sphere> balls;
  std::vector<std::uint32_t> merged;
  for (const std::uint32_t c : members) {
    const Cluster& cluster = clusters_[c];
    balls.push_back(ball_of(cluster));
    group.error = std::max(group.error, error_of(cluster));
    if (cluster.made_by != kNone)
      group.depth = std::max(group.depth, groups_[cluster.made_by].depth + 1);
    const auto corners = indices_of(cluster);
    merged.insert(merged.end(), corners.begin(), corners.end());
  }
  group.ball = ball_around(balls);
  for (const std::uint32_t c : members) clusters_[c].group = number;

  const Piece piece(merged, positions_, local_of_);
  const std::size_t faces = merged.size() / 3;
  const std::size_t target =
      3 * static_cast<std::size_t>(options_.ratio * static_cast<float>(faces));
  constexpr float kNoLimit = 1e10f;
  float error = 0;
  std::vector<std::uint32_t> simplified(merged.size());
  simplified.resize(meshopt_simplify(simplified.data(), piece.indices.data(), piece.indices.size(),
                                     &piece.positions[0].x, piece.positions.size(), sizeof(Vec3),
                                     target, kNoLimit, meshopt_SimplifyLockBorder, &error));
  const bool is_stuck = static_cast<float>(simplified.size()) >
                        options_.stuck_ratio * static_cast<float>(merged.size());
  error *= meshopt_simplifyScale(&piece.positions[0].x, piece.positions.size(), sizeof(Vec3));
  group.error = is_stuck ? kStuck : std::max(group.error, error);
  groups_.push_back(group);
  if (is_stuck || simplified.empty()) return;
  for (std::uint32_t& v : simplified) v = piece.vertices[v];
  add_clusters(simplified, number);
}

std::vector<std::uint32_t> ClusterDag::cut(const PixelScale& scale, float pixels) const {
  std::vector<std::uint8_t> is_too_coarse(groups_.size());
  for (std::size_t g = 0; g < groups_.size(); ++g)
    is_too_coarse[g] = scale.pixels_of(groups_[g].error, groups_[g].ball) > pixels ? 1 : 0;
  std::vector<std::uint32_t> chosen;
  for (std::uint32_t c = 0; c < clusters_.size(); ++c) {
    const Cluster& cluster = clusters_[c];
    const bool is_good = cluster.made_by == kNone || !is_too_coarse[cluster.made_by];
    if (is_good && is_too_coarse[cluster.group]) chosen.push_back(c);
  }
  return chosen;
}

}  // namespace varifold::bench
