// What the steps of a view-dependent mesh need, require and change, in one stream of bytes.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <vector>

namespace varifold {

/// One step, in full.
struct StepChange {
  struct Corner {
    std::uint32_t triangle = 0, corner = 0, vertex = 0;
  };
  struct Added {
    std::uint32_t triangle = 0;
    std::array<std::uint32_t, 3> corners{};
  };
  std::vector<std::uint32_t> required, watched;
  std::vector<Corner> changed;
  std::vector<Added> added;
};

/// Records of variable length, found by their number in O(1): a word for every eight of them and a
/// byte for each. Most steps have a short form: one new vertex c on the target t, whose new
/// triangles have c and t as corners. Immutable once all are appended.
class StepRecords {
 public:
  /// The vertices and triangles of the whole mesh, the steps, and whether new triangles have the
  /// numbers that follow those of the level (else their numbers are stored).
  void begin(std::uint32_t vertices, std::uint32_t triangles, std::uint32_t steps,
             bool triangles_in_order);
  /// `vertex` and `target`: the step's only vertex; kNone, kNone where it has several.
  void append(const StepChange& step, std::uint32_t vertex, std::uint32_t target);
  /// After the last one.
  void finish();

  /// Where the parts of a record are.
  struct View {
    const std::uint8_t* words = nullptr;
    std::uint32_t required = 0, watched = 0, changed = 0, added = 0;
    bool is_short = true;
  };
  void prefetch(std::uint32_t step) const {
    const Group& group = groups_[step >> 3u];
    __builtin_prefetch(bytes_.data() + group.begin + sum_before(group, step & 7u));
  }
  [[nodiscard]] View find(std::uint32_t step) const {
    const Group& group = groups_[step >> 3u];
    const std::uint8_t* at = bytes_.data() + group.begin + sum_before(group, step & 7u);
    const std::uint32_t first = at[0], second = at[1];
    View view;
    view.is_short = (second & kForm) == 0;
    if (view.is_short) [[likely]] {
      view.words = at + 2;
      view.required = first & 15u;
      view.changed = first >> 4u;
      view.watched = second & 15u;
      view.added = second >> 4u & 7u;
      return view;
    }
    return find_long(at);
  }

  template <class F>
  void for_each_required(const View& view, const F& f) const {
    for (std::uint32_t i = 0; i < view.required; ++i) f(word(view, i));
  }
  template <class F>
  void for_each_watched(const View& view, const F& f) const {
    for (std::uint32_t i = 0; i < view.watched; ++i) f(word(view, view.required + i));
  }
  /// f(triangle, corner, vertex); `vertex` is the step's first.
  template <class F>
  void for_each_changed(const View& view, std::uint32_t vertex, const F& f) const {
    const std::uint32_t begin = view.required + view.watched;
    if (view.is_short) {
      for (std::uint32_t i = 0; i < view.changed; ++i) {
        const std::uint32_t slot = word(view, begin + i);
        f(slot >> 2u, slot & 3u, vertex);
      }
      return;
    }
    for (std::uint32_t i = 0; i < view.changed; ++i) {
      const std::uint32_t slot = word(view, begin + 2 * i);
      f(slot >> 2u, slot & 3u, word(view, begin + 2 * i + 1));
    }
  }
  /// f(triangle, corners); `vertex` the step's first, `target` where it goes, `triangle` the first
  /// one beyond the coarser level.
  template <class F>
  void for_each_added(const View& view, std::uint32_t vertex, std::uint32_t target,
                      std::uint32_t triangle, const F& f) const {
    std::uint32_t at = view.required + view.watched + view.changed * (view.is_short ? 1 : 2);
    for (std::uint32_t i = 0; i < view.added; ++i) {
      if (!view.is_short) {
        f(word(view, at), Corners{word(view, at + 1), word(view, at + 2), word(view, at + 3)});
        at += 4;
        continue;
      }
      const std::uint32_t code = word(view, at++);
      const std::array<std::uint32_t, 3> choice{vertex, target, code >> 3u};
      const auto& order = kOrders[code & 7u];
      const std::uint32_t number = triangles_in_order_ ? triangle + i : word(view, at++);
      f(number, Corners{choice[order[0]], choice[order[1]], choice[order[2]]});
    }
  }

  [[nodiscard]] std::size_t bytes() const {
    return bytes_.size() + far_.size() + groups_.size() * sizeof(Group);
  }

 private:
  using Corners = std::array<std::uint32_t, 3>;
  static constexpr std::uint32_t kForm = 0x80;
  static constexpr std::uint32_t kLongest = 255;
  // Of the new triangles of short records: which corner is vertex (0), target (1), other (2).
  static constexpr std::array<std::array<std::uint8_t, 3>, 8> kOrders{
      {{0, 1, 2}, {2, 0, 1}, {1, 2, 0}, {0, 2, 1}, {1, 0, 2}, {2, 1, 0}, {0, 1, 2}, {0, 1, 2}}};
  struct Group {
    std::uint32_t begin = 0;
    std::array<std::uint8_t, 8> sizes{};
  };

  // The sizes of the first `count` records of a group.
  static std::uint32_t sum_before(const Group& group, std::uint32_t count) {
    std::uint64_t sizes = 0;
    for (std::uint32_t i = 0; i < 8; ++i)
      sizes |= static_cast<std::uint64_t>(group.sizes[i]) << (8 * i);
    constexpr std::uint64_t kEven = 0x00ff00ff00ff00ffu;
    sizes &= (std::uint64_t{1} << (8 * count)) - 1;
    const std::uint64_t pairs = (sizes & kEven) + (sizes >> 8u & kEven);
    return static_cast<std::uint32_t>(pairs * 0x0001000100010001u >> 48u);
  }
  [[nodiscard]] std::uint32_t word(const View& view, std::uint32_t index) const {
    return load(view.words + std::size_t{index} * word_bytes_) & word_mask_;
  }
  // Little-endian, like all that the project runs on; bytes_ has room behind the last word.
  static std::uint32_t load(const std::uint8_t* at) {
    std::uint32_t word = 0;
    std::memcpy(&word, at, sizeof word);
    return word;
  }
  [[nodiscard]] View find_long(const std::uint8_t* at) const;
  [[nodiscard]] static std::uint32_t order_code(const StepChange::Added& added,
                                                std::uint32_t vertex, std::uint32_t target);
  [[nodiscard]] static bool has_short_form(const StepChange& step, std::uint32_t vertex,
                                           std::uint32_t target);
  void push(std::vector<std::uint8_t>& bytes, std::uint32_t word, std::uint32_t count) const;
  void append_long(const StepChange& step, std::vector<std::uint8_t>& record) const;

  std::uint32_t word_bytes_ = 4, word_mask_ = 0xffffffffu, count_ = 0;
  bool triangles_in_order_ = true;
  std::vector<Group> groups_;
  std::vector<std::uint8_t> bytes_, far_;  // records; those that are too long for a byte's size
};

}  // namespace varifold
