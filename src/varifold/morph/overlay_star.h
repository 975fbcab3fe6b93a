// The triangles around the points of an overlay, and one collapse in both of its shapes.
// Internal to this folder.
#pragma once

#include <varifold/morph/overlay_reduction.h>
#include <array>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace varifold {

/// Triangles over points with a list of corners for each; collapses change it in place.
class OverlayStars {
 public:
  explicit OverlayStars(const OverlayTriangles& overlay);

  /// A triangle of a star: its corner at the centre and the two other points, in order.
  struct Spoke {
    std::uint32_t corner, a, b;
  };
  /// The star of a point, without the fan that closes a disc; empty where it is gone. Valid until
  /// the next call.
  [[nodiscard]] std::span<const Spoke> gather(std::uint32_t point);

  /// The neighbours of the centre of the star gathered last that it may collapse onto as far as the
  /// boundary says: on it, the two others of it.
  [[nodiscard]] std::span<const std::uint32_t> targets() const { return targets_; }

  /// Of a point on the boundary, its neighbours there and the triangles of the fan on the edges to
  /// them.
  struct Rim {
    std::array<std::uint32_t, 2> points{kNone, kNone};
    std::array<std::uint32_t, 2> triangles{kNone, kNone};
    explicit operator bool() const { return points[0] != kNone; }
  };
  /// Of the centre of the star gathered last; false where it is inside.
  [[nodiscard]] const Rim& rim() const { return rim_; }

  /// Whether the surface and its seams stay sound when the centre of the star gathered last goes
  /// onto `target`, one of its neighbours.
  [[nodiscard]] bool can_collapse(std::uint32_t point, std::uint32_t target);

  /// Does it.
  void collapse(std::uint32_t point, std::uint32_t target);

  [[nodiscard]] std::uint32_t live_count() const { return live_points_; }
  /// The vertices of the triangles that are left, three each, and what triangle each was.
  void write(std::vector<std::uint32_t>& vertices, std::vector<std::uint32_t>& triangles) const;

 private:
  [[nodiscard]] std::uint32_t count_common(std::uint32_t point, std::uint32_t target);
  /// Where the vertex (wedge) of a corner of the star goes; kNone where nothing says so.
  [[nodiscard]] std::uint32_t vertex_after(std::uint32_t vertex, std::uint32_t target) const;
  [[nodiscard]] std::uint32_t vertex_at(const Spoke& spoke, std::uint32_t point) const;
  [[nodiscard]] bool materials_agree(std::uint32_t target) const;

  std::vector<std::uint32_t> corner_point_;  // kNone in triangles that are gone
  std::vector<std::uint32_t> corner_vertex_;
  std::vector<std::uint32_t> material_of_;  // per triangle; empty where there is one alone
  std::vector<std::uint32_t> first_corner_, next_corner_;
  std::vector<std::uint32_t> mark_;
  std::uint32_t stamp_ = 0;
  std::uint32_t live_points_ = 0;
  std::uint32_t pole_, first_of_fan_;
  std::vector<Spoke> star_;
  std::vector<std::uint32_t> targets_;
  Rim rim_;
  std::vector<std::pair<std::uint32_t, std::uint32_t>> moved_;  // corners and their vertices
};

}  // namespace varifold
