// Moves a stretch of border onto a shorter path, and the triangles between to the other side.
#pragma once

#include <varifold/partition/corridor.h>
#include <cstdint>
#include <span>
#include <vector>

namespace varifold {

/// Works on stretches one after the other. Threads have one each, for stretches of different
/// patches.
class PathMover {
 public:
  /// `sizes` are the triangles per patch; no patch grows beyond `max_triangles`.
  PathMover(PatchedSurface& patched, std::span<std::uint32_t> sizes, std::uint32_t max_triangles)
      : patched_(patched), sizes_(sizes), max_triangles_(max_triangles) {}

  /// Shortens the stretch until nothing gets shorter; whether anything did.
  bool shorten(std::uint32_t stretch);
  /// Whether the last stretch may still get shorter once its patches change.
  [[nodiscard]] bool is_blocked() const { return is_blocked_; }

 private:
  using Places = Corridor::Places;

  [[nodiscard]] Places places(std::uint32_t point) const {
    return corridor_.places(patched_, point);
  }
  bool move(std::uint32_t number);
  [[nodiscard]] bool is_sound(std::uint32_t point);
  [[nodiscard]] bool is_sound_path();
  void flip(const Stretch& stretch, std::uint32_t triangle);
  bool count_sizes(const Stretch& stretch);
  bool flip_between(const Stretch& stretch);
  bool flip_piece(const Stretch& stretch, std::uint32_t begin, std::uint32_t from,
                  std::uint32_t to);
  [[nodiscard]] bool is_between(const Stretch& stretch, std::uint32_t h) const;
  void take(const Stretch& stretch, std::uint32_t triangle, std::uint32_t side);
  [[nodiscard]] std::uint32_t side_of(std::uint32_t begin) const;
  [[nodiscard]] std::uint32_t triangle_at(std::uint32_t p, std::uint32_t q,
                                          std::uint32_t patch) const;
  template <class Visit>
  void for_each_side(std::uint32_t p, std::uint32_t q, const Visit& visit) const;
  [[nodiscard]] std::uint32_t find_edge(std::uint32_t p, std::uint32_t q) const;
  [[nodiscard]] bool is_step_of(std::uint32_t h, std::uint32_t Places::*path) const;
  [[nodiscard]] bool is_border(const Stretch& stretch) const;
  [[nodiscard]] std::uint32_t changes_around(std::uint32_t point) const;

  PatchedSurface& patched_;
  std::span<std::uint32_t> sizes_;
  std::uint32_t max_triangles_;
  Corridor corridor_;
  bool is_blocked_ = false;
  std::vector<std::uint32_t> changed_;
};

}  // namespace varifold
