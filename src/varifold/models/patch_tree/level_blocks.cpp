#include <varifold/models/patch_tree/level_blocks.h>

#include <varifold/base/parallel.h>
#include <varifold/strip/cache_order.h>
#include <algorithm>
#include <bit>
#include <utility>

namespace varifold {

namespace {

constexpr std::uint32_t kPatchesPerPiece = 16;

// The wedges of a patch and their numbers in it: a small table with open addressing.
class LocalNumbers {
 public:
  void reset(std::size_t most_wedges) {
    const std::size_t size = std::bit_ceil(2 * most_wedges + 2);
    shift_ = 32 - std::countr_zero(size);
    entries_.assign(size, {kNone, 0});
    count_ = 0;
  }
  [[nodiscard]] std::uint32_t count() const { return count_; }
  /// The number of a wedge, and whether it is new.
  std::pair<std::uint32_t, bool> add(std::uint32_t wedge) {
    std::size_t at = (wedge * 0x9e3779b1u) >> shift_;
    while (entries_[at].wedge != wedge) {
      if (entries_[at].wedge == kNone) {
        if (2 * std::size_t{count_} >= entries_.size()) return grow_and_add(wedge);
        entries_[at] = {wedge, count_};
        return {count_++, true};
      }
      at = at + 1 == entries_.size() ? 0 : at + 1;
    }
    return {entries_[at].number, false};
  }

 private:
  struct Entry {
    std::uint32_t wedge, number;
  };
  std::pair<std::uint32_t, bool> grow_and_add(std::uint32_t wedge) {
    const std::vector<Entry> old = std::move(entries_);
    const std::uint32_t count = count_;
    reset(old.size());
    for (const Entry& entry : old) {
      if (entry.wedge == kNone) continue;
      std::size_t at = (entry.wedge * 0x9e3779b1u) >> shift_;
      while (entries_[at].wedge != kNone) at = at + 1 == entries_.size() ? 0 : at + 1;
      entries_[at] = entry;
    }
    count_ = count;
    return add(wedge);
  }

  std::vector<Entry> entries_;
  std::uint32_t count_ = 0;
  int shift_ = 0;
};

// The blocks of some patches in a row.
class PieceLayout {
 public:
  PieceLayout(const FinishedLevel& level, LevelBlocks& out) : level_(level), out_(out) {
    out_.offsets.emplace_back();
  }

  void add_patch(std::uint32_t patch) {
    parent_ = level_.parent.empty() ? kNone : level_.parent[patch];
    numbers_.reset(level_.mesh.first_face[patch + 1] - level_.mesh.first_face[patch]);
    constant_.clear();
    border_.clear();
    for (std::uint32_t i = level_.mesh.first_face[patch]; i < level_.mesh.first_face[patch + 1];
         ++i)
      (number_movers(i) ? border_ : constant_).push_back(i);
    if (!level_.material_of.empty())
      add_by_material();
    else
      add_range(0, constant_, border_);
    out_.drawn.push_back(numbers_.count());
  }

  /// The survivors of vertices of the finer level, counted in the patch just added.
  void place_survivors(LevelBlocks& finer, std::uint32_t first, std::uint32_t last) {
    for (std::uint32_t v = finer.offsets[first].vertex; v < finer.offsets[last].vertex; ++v)
      finer.parent_vertex[v] = number(finer.survivors[v]);
  }

  void end_patch() {
    out_.offsets.push_back({static_cast<std::uint32_t>(out_.wedges.size()),
                            static_cast<std::uint32_t>(out_.corners.size() / 3),
                            static_cast<std::uint32_t>(out_.controllers.size()),
                            static_cast<std::uint32_t>(out_.ranges.size())});
  }

 private:
  // Vertices that move come first. True where the triangle has one.
  bool number_movers(std::uint32_t face) {
    if (!level_.halving) return false;
    bool any = false;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t wedge = level_.mesh.corners[3 * std::size_t{face} + k];
      const std::uint32_t point =
          level_.surface.wedge.has_seams() ? level_.surface.wedge.point_of[wedge] : wedge;
      const std::uint32_t controller = level_.halving->guard().controller(point, parent_);
      if (controller == kNone) continue;
      any = true;
      const std::size_t before = out_.wedges.size();
      (void)number(wedge);
      if (out_.wedges.size() > before) out_.controllers.push_back(controller);
    }
    return any;
  }

  std::uint16_t number(std::uint32_t wedge) {
    const auto [number, is_new] = numbers_.add(wedge);
    if (is_new) {
      out_.wedges.push_back(wedge);
      out_.survivors.push_back(level_.halving ? level_.halving->survivor(wedge) : wedge);
    }
    return static_cast<std::uint16_t>(number);
  }

  // In an order that is good for vertex caches.
  void add_triangles(std::span<const std::uint32_t> faces) {
    const std::size_t first = out_.corners.size();
    for (const std::uint32_t face : faces)
      for (std::size_t k = 0; k < 3; ++k)
        out_.corners.push_back(number(level_.mesh.corners[3 * std::size_t{face} + k]));
    cache_order_.reorder(std::span(out_.corners).subspan(first), numbers_.count());
  }

  void add_range(std::uint32_t material, std::span<const std::uint32_t> constant,
                 std::span<const std::uint32_t> border) {
    add_triangles(constant);
    add_triangles(border);
    out_.ranges.push_back({material, static_cast<std::uint32_t>(constant.size()),
                           static_cast<std::uint32_t>(constant.size() + border.size())});
  }

  [[nodiscard]] std::uint32_t material(std::uint32_t face) const {
    return level_.material_of[level_.mesh.faces[face]];
  }

  void add_by_material() {
    const auto by_material = [&](std::uint32_t a, std::uint32_t b) {
      return material(a) < material(b);
    };
    std::stable_sort(constant_.begin(), constant_.end(), by_material);
    std::stable_sort(border_.begin(), border_.end(), by_material);
    const auto take = [&](const std::vector<std::uint32_t>& faces, std::size_t& at,
                          std::uint32_t which) {
      const std::size_t first = at;
      while (at < faces.size() && material(faces[at]) == which) ++at;
      return std::span(faces).subspan(first, at - first);
    };
    std::size_t constant = 0, border = 0;
    while (constant < constant_.size() || border < border_.size()) {
      std::uint32_t next = kNone;
      if (constant < constant_.size()) next = material(constant_[constant]);
      if (border < border_.size()) next = std::min(next, material(border_[border]));
      const auto constant_part = take(constant_, constant, next);
      add_range(next, constant_part, take(border_, border, next));
    }
  }

  const FinishedLevel& level_;
  LevelBlocks& out_;
  LocalNumbers numbers_;
  CacheOrder cache_order_;
  std::uint32_t parent_ = kNone;
  std::vector<std::uint32_t> constant_, border_;  // triangles of the level
};

template <class T>
void append(std::vector<T>& to, const std::vector<T>& from) {
  to.insert(to.end(), from.begin(), from.end());
}

LevelBlocks join(std::vector<LevelBlocks>& pieces) {
  LevelBlocks all;
  PatchOffsets sum;
  for (const LevelBlocks& piece : pieces) {
    const PatchOffsets& end = piece.offsets.back();
    sum = {sum.vertex + end.vertex, sum.triangle + end.triangle, sum.controller + end.controller,
           sum.range + end.range};
  }
  all.wedges.reserve(sum.vertex);
  all.survivors.reserve(sum.vertex);
  all.controllers.reserve(sum.controller);
  all.corners.reserve(3 * std::size_t{sum.triangle});
  all.ranges.reserve(sum.range);
  all.offsets.emplace_back();
  for (LevelBlocks& piece : pieces) {
    const PatchOffsets base = all.offsets.back();
    for (std::size_t p = 1; p < piece.offsets.size(); ++p) {
      const PatchOffsets& end = piece.offsets[p];
      all.offsets.push_back({base.vertex + end.vertex, base.triangle + end.triangle,
                             base.controller + end.controller, base.range + end.range});
    }
    append(all.drawn, piece.drawn);
    append(all.wedges, piece.wedges);
    append(all.survivors, piece.survivors);
    append(all.controllers, piece.controllers);
    append(all.corners, piece.corners);
    append(all.ranges, piece.ranges);
    piece = {};
  }
  return all;
}

}  // namespace

LevelBlocks lay_out_blocks(const FinishedLevel& level, LevelBlocks* finer,
                           std::span<const std::uint32_t> first_child, int threads) {
  const auto patches = level.mesh.patch_count();
  if (finer) finer->parent_vertex.resize(finer->wedges.size());
  std::vector<LevelBlocks> pieces((patches + kPatchesPerPiece - 1) / kPatchesPerPiece);
  parallel_for(threads, patches, kPatchesPerPiece, [&](std::size_t begin, std::size_t end) {
    PieceLayout layout(level, pieces[begin / kPatchesPerPiece]);
    for (auto patch = static_cast<std::uint32_t>(begin); patch < end; ++patch) {
      layout.add_patch(patch);
      if (finer) layout.place_survivors(*finer, first_child[patch], first_child[patch + 1]);
      layout.end_patch();
    }
  });
  return join(pieces);
}

}  // namespace varifold
