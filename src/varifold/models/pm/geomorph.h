// Smooth changes between two levels of a progressive mesh.
//
// Based on: [Hoppe1996] section 3.1.
// Differs: colours, poses and the weights of joints move as well, and vertices may set off one
// after
//   the other.
#pragma once

#include <varifold/models/pm/progressive_mesh.h>
#include <varifold/view/draw_list.h>
#include <array>
#include <cstdint>
#include <vector>

namespace varifold {

struct GeomorphOptions {
  /// Every vertex starts and stops gently: 3 s^2 - 2 s^3 instead of s.
  bool smooth_step = false;
  /// The part of the time for which a vertex moves, in (0, 1]. With 1 all move together; with less
  /// they set off in the order in which their levels gain them.
  float share = 1;
};

/// The connectivity of the finer level; each vertex moves between the attributes of its ancestor at
/// the coarser level and its own. Allocates in the constructor only.
class Geomorph {
 public:
  /// Between two levels, in any order; begins with the looks of the finer one. Levels are cut to
  /// those of the model. O(fine level).
  Geomorph(const ProgressiveMesh& model, std::uint32_t level, std::uint32_t other_level,
           const GeomorphOptions& options = {});

  [[nodiscard]] std::uint32_t fine_level() const { return fine_level_; }
  [[nodiscard]] std::uint32_t coarse_level() const { return coarse_level_; }
  [[nodiscard]] std::uint32_t moving_vertices() const {
    return static_cast<std::uint32_t>(moves_.size());
  }

  /// 0: the looks of the coarse level, with triangles without area where it has none; 1: the fine
  /// level, byte for byte. Cut to [0, 1]. Positions, in poses too, texture coordinates, colours and
  /// weights of joints (mix_joints) move in straight lines, normals keep their length of 1.
  /// O(moving vertices).
  void blend(float t);

  /// What is drawn, and what blend() changed since the last call. Valid until the next blend().
  [[nodiscard]] DrawList draw_list();
  /// The same as a mesh.
  [[nodiscard]] const TriangleMesh& mesh() const { return mesh_; }

 private:
  struct Move {
    std::uint32_t vertex;
    float start;  // when it sets off
  };
  void find_moves(const ProgressiveMesh& model, const TriangleMesh& coarse);
  // Of a move by its number.
  void set(std::size_t number, const TriangleMesh& end);
  void set_between(std::size_t number, float part);

  GeomorphOptions options_;
  std::uint32_t fine_level_, coarse_level_;
  float level_fraction_ = 1;
  TriangleMesh mesh_;
  std::vector<Move> moves_;
  TriangleMesh coarse_, fine_;  // the attributes of the moves at their ends
  std::vector<DrawRange> ranges_;
  bool indices_are_new_ = true;
  bool vertices_changed_ = true;
  std::array<ElementRange, 2> changed_;  // vertices, indices
};

}  // namespace varifold
