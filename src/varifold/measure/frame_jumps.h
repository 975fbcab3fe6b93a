// How far what is drawn jumps from one frame to the next, in pixels.
#pragma once

#include <varifold/base/math.h>
#include <varifold/view/camera.h>
#include <varifold/view/draw_list.h>
#include <cstdint>
#include <span>
#include <vector>

namespace varifold {

/// Compares the draw lists of successive frames of one instance. A test, not for every frame:
/// allocates, and takes O(vertices of the model) memory and O(what is drawn) time.
///
/// Vertices are known by their numbers in the collapse sequence. The *stand-in* of a vertex is
/// itself where it is drawn, else the stand-in of the vertex that it collapses onto. Both frames
/// are looked at with the camera of the second one, so that the motion of the camera is no jump.
///
/// A vertex that is drawn in the second frame jumps from where its stand-in of the first frame was
/// drawn to where it is; one that was drawn in the first only, from where it was to where its
/// stand-in is. So a split is a jump by the length of its edge, and a geomorph many small ones.
/// Jumps count where the place is seen in both frames: around the end of the first frame a triangle
/// faces the eye of the first camera, around that of the second that of the second; and for both
/// cameras both ends lie beyond the near plane and one of them in the picture. Hiding by other
/// parts of the surface is not looked at.
class FrameJumps {
 public:
  struct Jumps {
    float vertex_pixels = 0;  ///< the greatest jump of a vertex across the picture
    /// The same from the vertex to the nearest point of the triangles around its stand-in in the
    /// other frame: no vertex leaves the other surface by more. Sliding within a flat part is none.
    float surface_pixels = 0;
  };

  /// `targets`: per vertex of full detail where it collapses to, a smaller number; kNone for
  /// vertices of the base.
  explicit FrameJumps(std::vector<std::uint32_t> targets);

  /// The next frame; zero jumps for the first one. `vertices` are the numbers of the vertices in
  /// the list's buffers, or empty where they are those of the sequence.
  Jumps next(const DrawList& list, std::span<const std::uint32_t> vertices, const Camera& camera);

 private:
  // What a frame draws. `place` is per vertex of the model, all else per drawn vertex.
  struct Frame {
    std::vector<std::uint32_t> place;
    std::vector<std::uint32_t> vertices;
    std::vector<Vec3> positions;
    std::vector<std::uint32_t> corners;                    // three places a triangle
    std::vector<std::uint32_t> first_triangle, triangles;  // around each drawn vertex
    std::vector<std::uint8_t> is_facing;
  };

  void read(const DrawList& list, std::span<const std::uint32_t> vertices);
  void add_triangle(const DrawList& list, std::span<const std::uint32_t> vertices,
                    const std::uint32_t* corners);
  static void link(Frame& frame);
  static void mark_facing(Frame& frame, const Vec3& eye);
  [[nodiscard]] std::uint32_t stand_in(const Frame& frame, std::uint32_t vertex) const;
  struct Projections;
  void compare(const Frame& with, const Frame& other, const Projections& cameras, bool only_missing,
               Jumps& jumps) const;

  std::vector<std::uint32_t> targets_;
  Frame before_, now_;
  Camera camera_before_;
  bool is_first_ = true;
};

}  // namespace varifold
