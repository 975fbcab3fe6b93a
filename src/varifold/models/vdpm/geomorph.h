// Geomorphs at run time: the vertices of a front slide instead of popping.
//
// Based on: [Hoppe1997] section 7 (geomorphs at run time, left there as an outlook).
// Differs: any number of layers slides at once, since what is to go stays in the buffers as long as
//   it slides, while the front counts it as gone; a morph that is no longer wanted turns round.
#pragma once

#include <varifold/models/vdpm/active_surface.h>
#include <varifold/models/vdpm/view_dependent_mesh.h>
#include <varifold/models/vdpm/view_query.h>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace varifold {

/// Stands between a front and its surface. The front says what it splits and collapses, as it would
/// to the surface; advance() does it, once a frame. A vertex that is split sets out from where its
/// target is drawn, and is at its own place after n frames. One that is to be collapsed slides to
/// where its target is drawn first, and is removed when it is there. So the surface has the front's
/// steps and those that are still on their way out: a front, too.
///
/// What the view of the frame before did not see, outside its frustum or turned away, need not
/// slide: such a split is at its place at once, or with what it requires and is still on its way.
///
/// Positions, in poses too, texture coordinates, colours and the weights of joints move in straight
/// lines toward goals that may move themselves, normals keep a length of 1: in each frame a vertex
/// covers the n-th part, of those left, of what is left. A morph that turns round takes as many
/// frames back as it took so far. So of two steps of which one requires the other, that one is
/// never nearer to its end: steps are removed in an order that the rule allows. At rest for n
/// frames, everything is where it would be without morphs, byte for byte.
///
/// 20 bytes for each vertex that moves and 24 for each that changes in a frame, none for others.
/// Allocates only where there are more of them than ever before.
class FrontGeomorphs {
 public:
  static constexpr std::uint32_t kMostFrames = 255;

  /// `model` must live as long.
  explicit FrontGeomorphs(const ViewDependentMesh& model) : model_(&model) {}

  /// Vertices on their way.
  [[nodiscard]] std::uint32_t moving_vertices() const {
    return static_cast<std::uint32_t>(morphs_.size());
  }
  /// Before the changes of a frame; `surface` must be changed by advance() alone while any moves.
  /// `last_view`: of the frame before; null where it had none, and all may have been seen. In the
  /// first frame of all nothing was.
  void begin_frame(const ActiveSurface& surface, const ViewQuery* last_view, bool is_first) {
    if (morphs_.empty()) triangles_ = surface.triangle_count();
    is_first_ = is_first;
    has_last_view_ = last_view != nullptr;
    if (has_last_view_) last_view_ = *last_view;
  }
  /// Of the front, without what is on its way out.
  [[nodiscard]] std::uint32_t triangle_count() const { return triangles_; }

  /// What the front does, by the rule of ActiveSurface; back and forth in a frame is nothing. O(1).
  void split(std::uint32_t step) {
    triangles_ += model_->levels().step(step).triangles;
    requests_.push_back(step);
  }
  void collapse(std::uint32_t step) {
    triangles_ -= model_->levels().step(step).triangles;
    requests_.push_back(step);
  }

  /// The next frame: all moves go on, each to take `frames` in all (at least 1, which is at once,
  /// at most kMostFrames). Where the surface had more than `max_triangles`, what is nearest to its
  /// end goes at once. O(m + r log r) for m moving vertices and r changes.
  void advance(ActiveSurface& surface, std::uint32_t frames, std::uint32_t max_triangles);
  /// All are where they are bound for. For a front that will be told nothing in this frame.
  void finish(ActiveSurface& surface) { advance(surface, 1, kNone); }

  [[nodiscard]] std::size_t bytes() const {
    return morphs_.capacity() * sizeof(Morph) + events_.capacity() * sizeof(Event) +
           (requests_.capacity() + arrived_.capacity()) * sizeof(std::uint32_t) +
           phases_.capacity();
  }

 private:
  struct Morph {
    std::uint32_t vertex, step;  // of a move alone the step does not matter
    std::uint32_t slot;
    std::uint32_t goal;  // a place of `placed` or kNone, full detail; going: the target's slot
    std::uint8_t phase;  // 0: not there yet; frames_: it is there for good
    std::uint8_t left;   // frames until it is where it is bound for, unless it goes: then `phase`
    bool goes;
  };
  // What happens to a vertex; in the order of these.
  enum class Change : std::uint8_t { kAppears, kGoes, kMoves };
  struct Event {
    std::uint32_t vertex, order;
    std::uint32_t step, look;
    Change change;
    bool slides;
    std::uint8_t phase;  // that it appears with
  };

  // The morph of a vertex, or null.
  [[nodiscard]] const Morph* find(std::uint32_t vertex) const;
  [[nodiscard]] static bool is_before(const Morph& morph, std::uint32_t vertex) {
    return morph.vertex < vertex;
  }
  void set_frames(std::uint32_t frames);
  void take_requests(const ActiveSurface& surface);
  [[nodiscard]] bool was_seen(std::uint32_t step) const;
  // Of steps that the front has split.
  [[nodiscard]] std::uint8_t phase_of(std::uint32_t step) const;
  [[nodiscard]] std::uint8_t first_phase(std::uint32_t step) const;
  void add_split(std::uint32_t step, std::uint8_t phase);
  void add_events(std::uint32_t step, Change change, bool slides, std::uint8_t phase);
  void merge_events(const ActiveSurface& surface);
  [[nodiscard]] std::size_t count_new() const;
  void apply(const Event& event, const ActiveVertices& vertices, Morph& morph) const;
  void keep_budget(const ActiveSurface& surface, std::uint32_t max_triangles);
  void move(ActiveSurface& surface);

  const ViewDependentMesh* model_;
  std::uint32_t frames_ = 1;
  std::uint32_t triangles_ = 0;
  std::vector<Morph> morphs_;            // by vertex, ascending: targets before what slides to them
  std::vector<std::uint32_t> requests_;  // steps that change
  std::vector<Event> events_;
  std::vector<std::uint32_t> arrived_;  // steps to be removed; before that, steps that are split,
  std::vector<std::uint8_t> phases_;    // and what they begin with
  ViewQuery last_view_;
  bool has_last_view_ = false, is_first_ = false;
};

}  // namespace varifold
