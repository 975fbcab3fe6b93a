// May this half-edge collapse be done without breaking the surface?
//
// Based on: [DeyEdelsbrunnerGuhaNekhayev1999] (link condition), [Hoppe1996] section 3.2.
// Differs: edges of one face (borders) and of more than two faces use the same rule with their own
//   face count; normals may turn by 75 degrees, not 90, since a series of near-90 turns flips a
//   face; a face must agree with the input's normal at one corner; fresh needles are refused.
#pragma once

#include <varifold/simplify/pose_places.h>
#include <varifold/simplify/working_surface.h>
#include <cstdint>

namespace varifold {

/// Why a collapse is refused; kLegal if it is not.
enum class Refusal : std::uint8_t {
  kLegal,
  kTopology,  ///< the link condition: the surface would pinch, close a hole or lose a component
  kValence,   ///< the target would have too many neighbours
  kNormal,    ///< a triangle would turn too far
  kShape,     ///< a triangle would become a needle or have no area
  kSeam,      ///< a wedge would have no wedge to go to
  kFixed,     ///< the vertex' kind does not allow it to go at all, or along this edge
  kCount
};

inline constexpr int kRefusalCount = static_cast<int>(Refusal::kCount);
inline constexpr const char* kRefusalNames[kRefusalCount] = {
    "legal", "topology", "valence", "normal", "shape", "seam", "fixed"};

struct LegalityOptions {
  float min_normal_cosine = 0.2588f;  ///< cosine of the largest turn, 75 degrees
  float min_shape = 1e-3f;            ///< 2 * area / longest edge^2, unless it was below before
  std::uint32_t max_valence = 32;     ///< of the target, unless it had more before
};

/// Tests everything about collapsing `from` onto its neighbour `onto` but seams. O(valence).
[[nodiscard]] Refusal test_collapse(WorkingSurface& surface, std::uint32_t from, std::uint32_t onto,
                                    const LegalityOptions& options);

/// The part of it that no position matters to: kinds, link condition, valence.
[[nodiscard]] Refusal test_connectivity(WorkingSurface& surface, std::uint32_t from,
                                        std::uint32_t onto, const LegalityOptions& options);

/// A point whose faces, but those at `partner`, get a new apex.
struct ApexMove {
  std::uint32_t point, partner;
  Vec3 position;
  std::uint32_t input_normal;  ///< packed; of the input around the new apex
};

/// The part of it that is about the shape of the faces around one point.
[[nodiscard]] Refusal test_faces(WorkingSurface& surface, const ApexMove& move,
                                 const LegalityOptions& options);
/// The same in another pose; the move is one there.
[[nodiscard]] Refusal test_faces(WorkingSurface& surface, const ApexMove& move,
                                 const LegalityOptions& options, const PosePlaces& pose);

}  // namespace varifold
