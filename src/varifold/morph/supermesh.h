// One connectivity for two shapes: the supermesh that a morph runs over.
#pragma once

#include <varifold/base/progress.h>
#include <varifold/base/result.h>
#include <varifold/mesh/triangle_mesh.h>
#include <varifold/morph/alignment.h>
#include <cstdint>
#include <vector>

namespace varifold {

struct SupermeshOptions {
  /// Vertices of a and b that shall become one in the morph. Of discs, those on the boundary must
  /// be on both boundaries and come in the same order there.
  std::vector<FeaturePoint> features;
  /// The overlay is simplified while each shape stays this near its input, as a part of the
  /// diagonal of its box. 0: every vertex of the overlay is kept.
  double tolerance = 8e-5;
  /// Moves the shape of b: turned about axes by multiples of 90 degrees where it fits better so
  /// (not with features), as large as a by the diagonals of their boxes, and with its middle.
  bool fit = false;
  int threads = 0;  ///< 0 = all; the result does not depend on it
  Progress progress;
};

/// p -> scale * turn(p) + offset
struct Similarity {
  Rotation turn = kNoRotation;
  double scale = 1;
  DVec3 offset{0};

  [[nodiscard]] Vec3 operator()(const Vec3& p) const {
    return Vec3(scale * rotated(turn, DVec3(p)) + offset);
  }
};

/// What went in and what came of it.
struct SupermeshReport {
  bool are_discs = false;                    ///< and not spheres
  std::uint32_t input_vertices[2] = {0, 0};  ///< points of a and b: position classes
  std::uint32_t input_triangles[2] = {0, 0};
  std::uint32_t crossings = 0;          ///< of edges of a with edges of b
  std::uint32_t overlay_triangles = 0;  ///< of both laid over each other
  std::uint32_t merged_points = 0;      ///< of the overlay, in one place with others on both shapes
  std::uint32_t removed_points = 0;     ///< of it, by the tolerance
  /// Triangles of a and b that are not strictly positive on the sphere; always 0.
  std::uint32_t flipped_on_sphere = 0;
  double distortion = 0;        ///< between the shapes, in bits; see PairGrowth
  double feature_distance = 0;  ///< the farthest pair of features on the sphere, in radians
  Similarity moved_b;           ///< what `fit` did to the shape of b
  double embed_seconds = 0;     ///< both surfaces onto the sphere
  double overlay_seconds = 0;
  double reduce_seconds = 0;
};

struct Supermesh {
  /// positions are the places on a, poses[0] those on b.
  TriangleMesh mesh;
  SupermeshReport report;
};

/// Builds the mesh that is both a and b: at rest its surface is that of a, in pose 0 that of b,
/// up to the tolerance and the rounding of floats; in between vertices go straight.
///
/// Both must be closed, or both discs: with one boundary loop, which becomes that of the other one.
/// They are laid onto the sphere, or discs onto half of it with their boundaries on the equator;
/// the map of b is turned and bent until features meet (without any, until the shapes are alike),
/// and the maps are laid over each other. No triangle of either folds
/// on the sphere; signs are exact. Normals, texture coordinates, colours and materials come from a
/// (one mesh has one set of them), normals of the pose from b where both have normals; the rest of
/// b's attributes is dropped, as are skins and poses of the inputs.
///
/// Errors: kInvalidInput where one is not manifold, oriented, of one component and a sphere
/// (closed, of genus 0) or a disc (one boundary loop, Euler characteristic 1; repair_sphere.h mends
/// what is simply mended), where they are not the same of these, or a feature is no vertex; kFailed
/// where a surface needs more than the resolution of the sphere; kCancelled. O(n log n +
/// crossings). The same bytes for any number of threads. Source: [Ramos2008] section 6.3.1, after
/// [KentCarlsonParent1992] and [Alexa2000].
[[nodiscard]] Result<Supermesh> build_supermesh(const TriangleMesh& a, const TriangleMesh& b,
                                                const SupermeshOptions& options = {});

}  // namespace varifold
