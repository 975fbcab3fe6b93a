// Borders between patches while a level is halved: which collapses along them leave every mixture
// of coarse and fine patches sound.
//
// Let K be the mesh before the level and f the map of its points to their survivors. A patch that
// stays fine beside coarse ones is drawn as K with f applied to the points on its borders with
// those. What the points of one border do depends on that border alone, so all mixtures around a
// point are few: one for each subset of the neighbours at its triangles. A collapse is allowed when
// in each of them no triangle turns and the triangles around the target are still one fan a side.
//
// What is read for a collapse are the points that came to its two ends, and where their neighbours
// in K went: to neighbours of the two ends now, since f takes edges to edges. No such neighbour can
// collapse in another cell meanwhile, so cells need not wait for each other.
#pragma once

#include <varifold/simplify/collapser.h>
#include <varifold/simplify/working_surface.h>
#include <cstdint>
#include <span>
#include <tuple>
#include <utility>
#include <vector>

namespace varifold {

/// What a level must do without, found when it is looked at as a whole.
struct BorderLocks {
  std::vector<std::uint32_t> points;  ///< stay; ascending
  /// Pairs of points that no collapse may join, the smaller first; ascending.
  std::vector<std::pair<std::uint32_t, std::uint32_t>> edges;
  [[nodiscard]] bool operator==(const BorderLocks&) const = default;
};

class BorderGuard final : public CollapseGuard {
 public:
  /// `surface` outlives the guard.
  /// `poses`: other poses of the surface, in which no triangle may turn either; or null.
  explicit BorderGuard(WorkingSurface& surface, const PoseField* poses = nullptr)
      : surface_(surface), poses_(poses), border_of_(surface.point_count(), kNone) {}

  /// The surface stands at the beginning of a level, with its regions and kinds. Points in
  /// `locks` become corners. `live` are the points that are left. O(live points).
  void begin_level(const BorderLocks& locks, std::span<const std::uint32_t> live);

  /// After begin_level(): no point of a border moves. O(points on borders).
  void lock_all();

  [[nodiscard]] bool watches(std::uint32_t point) const override {
    return surface_.points[point].kind != VertexKind::kManifold && border_of_[point] != kNone;
  }
  [[nodiscard]] bool allows(std::uint32_t from, std::uint32_t onto) override;
  void collapsed(std::uint32_t from, std::uint32_t onto) override;

  /// Looks at all mixtures of the finished level. True where nothing is wrong; else the locks name
  /// what led to it. O(points on borders), with a sort.
  [[nodiscard]] bool verify(BorderLocks& locks, int threads) const;

  /// The region beside `region` that moves a point of the border between the two, kNone where the
  /// point does not move.
  [[nodiscard]] std::uint32_t controller(std::uint32_t point, std::uint32_t region) const {
    const std::uint32_t border = border_of_[point];
    if (border == kNone || points_[border].target == border) return kNone;
    return points_[border].other_than(region);
  }

 private:
  // A face of K around a point: (point, from, to).
  struct StarFace {
    std::uint32_t from, to, region;
  };
  struct BorderPoint {
    std::uint32_t point;
    std::uint32_t first_face, last_face;  // in star_
    std::uint32_t regions[2];             // kNone both where there are more than two
    std::uint32_t target;                 // where it went: a border point, itself while it stays
    std::uint32_t next, last;             // those that went to the same one, from the target on
    [[nodiscard]] std::uint32_t other_than(std::uint32_t region) const {
      return regions[0] == region ? regions[1] : regions[0];
    }
  };
  // Some of the neighbours of a region: those that are coarse.
  struct Mixture {
    static constexpr std::size_t kMax = 5;
    std::uint32_t controllers[kMax];
    std::size_t count = 0;
    std::uint32_t coarse = 0;  // a bit for each
    [[nodiscard]] bool has(std::uint32_t region) const {
      for (std::size_t i = 0; i < count; ++i)
        if (controllers[i] == region) return (coarse >> i & 1) != 0;
      return false;
    }
  };
  // What a region has to be; kNone: nothing is asked.
  struct Need {
    std::uint32_t region = kNone;
    bool coarse = false;
    // A number for each: an order that no other use is made of.
    [[nodiscard]] std::uint64_t key() const { return 2 * std::uint64_t{region} + (coarse ? 1 : 0); }
  };
  // An edge between two points of borders as a region may show it.
  struct Chord {
    std::uint64_t edge;    // the two points, the smaller first
    Need needs[3];         // the region itself, and what moves the ends
    std::uint32_t beyond;  // the region on the other side; the same inside a region
    std::uint32_t a, b;    // numbers of the border points that were its ends in K
    friend bool operator<(const Chord& x, const Chord& y) {
      const auto key = [](const Chord& c) {
        return std::tuple(c.edge, c.needs[0].key(), c.needs[1].key(), c.needs[2].key(), c.beyond,
                          c.a, c.b);
      };
      return key(x) < key(y);
    }
    [[nodiscard]] bool is_border() const { return beyond != needs[0].region; }
  };
  using Link = std::vector<std::pair<std::uint32_t, std::uint32_t>>;

  void add_point(std::uint32_t point);
  void limit_controllers();
  void join(std::uint32_t from, std::uint32_t onto);
  void part(std::uint32_t from, std::uint32_t onto, std::uint32_t last_of_onto);
  [[nodiscard]] bool may_join(std::uint32_t from, std::uint32_t onto);
  [[nodiscard]] bool is_sound(std::uint32_t target, std::uint32_t region, Link& link) const;
  [[nodiscard]] bool gather_controllers(std::uint32_t target, std::uint32_t region,
                                        Mixture& mixture) const;
  [[nodiscard]] std::uint32_t image(std::uint32_t point, std::uint32_t region,
                                    const Mixture& mixture) const;
  [[nodiscard]] int count_fans(std::uint32_t target, std::uint32_t region, const Mixture& mixture,
                               Link& link) const;
  [[nodiscard]] bool keeps_shapes(std::uint32_t target, std::uint32_t region,
                                  const Mixture& mixture) const;
  [[nodiscard]] static int count_paths(const Link& link);
  [[nodiscard]] std::span<const StarFace> star(const BorderPoint& p) const {
    return {star_.data() + p.first_face, star_.data() + p.last_face};
  }
  template <class Places>
  [[nodiscard]] bool keeps_shapes_in(const Places& places, std::uint32_t target,
                                     std::uint32_t region, const Mixture& mixture) const;
  void lock_around(std::uint32_t target, BorderLocks& locks) const;
  void find_chords(std::uint32_t border, bool all, std::vector<Chord>& chords) const;
  [[nodiscard]] bool is_free_of_clashes(std::uint32_t corner) const;
  void find_new_chords(std::uint32_t border, std::vector<Chord>& chords) const;
  [[nodiscard]] bool was_edge(const Chord& chord) const;
  [[nodiscard]] bool clash(const Chord& x, const Chord& y) const;
  [[nodiscard]] bool verify_some(std::uint32_t begin, std::uint32_t end, std::vector<Chord>& chords,
                                 BorderLocks& locks) const;
  [[nodiscard]] bool lock_chords(std::vector<Chord>& chords, BorderLocks& locks) const;

  WorkingSurface& surface_;
  const PoseField* poses_;
  std::vector<std::uint32_t> border_of_;  // per point: its number in points_, or kNone
  std::vector<BorderPoint> points_;
  std::vector<StarFace> star_;
  std::vector<std::pair<std::uint32_t, std::uint32_t>> forbidden_;
};

}  // namespace varifold
