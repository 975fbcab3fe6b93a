#include <varifold/models/patch_tree/level_blocks.h>

#include <algorithm>
#include <tuple>

namespace varifold {

namespace {

std::uint32_t point_of(const WorkingSurface& surface, std::uint32_t wedge) {
  return surface.wedge.has_seams() ? surface.wedge.point_of[wedge] : wedge;
}

// The patch of the next level that moves a wedge of a patch with that parent, or kNone.
std::uint32_t controller_of(const FinishedLevel& level, std::uint32_t wedge, std::uint32_t parent) {
  return level.halving ? level.halving->guard().controller(point_of(level.surface, wedge), parent)
                       : kNone;
}

}  // namespace

LevelBlocks BlockLayout::lay_out(const FinishedLevel& level, LevelBlocks* finer,
                                 std::span<const std::uint32_t> first_child) {
  LevelBlocks out;
  const auto patches = static_cast<std::uint32_t>(level.first_face.size() - 1);
  out.offsets.reserve(patches + 1);
  out.offsets.emplace_back();
  out.corners.reserve(level.mesh.corners.size());
  if (finer) finer->parent_vertex.resize(finer->wedges.size());
  for (std::uint32_t patch = 0; patch < patches; ++patch) {
    base_ += count_;
    count_ = 0;
    lay_out_patch(level, patch, out);
    if (finer) place_survivors(level, *finer, first_child[patch], first_child[patch + 1], out);
    out.offsets.push_back({static_cast<std::uint32_t>(out.wedges.size()),
                           static_cast<std::uint32_t>(out.corners.size() / 3),
                           static_cast<std::uint32_t>(out.controllers.size()),
                           static_cast<std::uint32_t>(out.ranges.size())});
  }
  return out;
}

void BlockLayout::lay_out_patch(const FinishedLevel& level, std::uint32_t patch, LevelBlocks& out) {
  sort_triangles(level, patch);
  number_vertices(level, patch, out);
  for (const Triangle& triangle : triangles_) {
    const bool begins = out.ranges.size() == out.offsets.back().range ||
                        out.ranges.back().material != triangle.material;
    if (begins) out.ranges.push_back({triangle.material, 0, 0});
    ++out.ranges.back().triangle_count;
    if (!triangle.is_border) ++out.ranges.back().constant_triangles;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t wedge = level.mesh.corners[3 * std::size_t{triangle.face} + k];
      out.corners.push_back(static_cast<std::uint16_t>(local_[wedge] - base_));
    }
  }
}

// By material; in each those that no switch changes first.
void BlockLayout::sort_triangles(const FinishedLevel& level, std::uint32_t patch) {
  triangles_.clear();
  const std::uint32_t parent = level.parent.empty() ? kNone : level.parent[patch];
  for (std::uint32_t i = level.first_face[patch]; i < level.first_face[patch + 1]; ++i) {
    bool is_border = false;
    for (std::size_t k = 0; k < 3; ++k)
      is_border |=
          controller_of(level, level.mesh.corners[3 * std::size_t{i} + k], parent) != kNone;
    const std::uint32_t material =
        level.material_of.empty() ? 0 : level.material_of[level.mesh.faces[i]];
    triangles_.push_back({material, is_border, i});
  }
  std::stable_sort(triangles_.begin(), triangles_.end(), [](const Triangle& a, const Triangle& b) {
    return std::tie(a.material, a.is_border) < std::tie(b.material, b.is_border);
  });
}

std::uint32_t BlockLayout::add_vertex(const FinishedLevel& level, std::uint32_t wedge,
                                      LevelBlocks& out) {
  local_[wedge] = base_ + count_;
  out.wedges.push_back(wedge);
  out.survivors.push_back(level.halving ? level.halving->survivor(wedge) : wedge);
  return static_cast<std::uint32_t>(count_++);
}

// Those that move first, then the others in the order of the triangles.
void BlockLayout::number_vertices(const FinishedLevel& level, std::uint32_t patch,
                                  LevelBlocks& out) {
  const std::uint32_t parent = level.parent.empty() ? kNone : level.parent[patch];
  for (const bool moving : {true, false}) {
    for (const Triangle& triangle : triangles_) {
      if (moving && !triangle.is_border) continue;
      for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t wedge = level.mesh.corners[3 * std::size_t{triangle.face} + k];
        if (is_known(wedge)) continue;
        if (moving) {
          const std::uint32_t controller = controller_of(level, wedge, parent);
          if (controller == kNone) continue;
          out.controllers.push_back(controller);
        }
        add_vertex(level, wedge, out);
      }
    }
  }
}

// The survivors of the children's vertices, counted in the patch just laid out.
void BlockLayout::place_survivors(const FinishedLevel& level, LevelBlocks& finer,
                                  std::uint32_t first, std::uint32_t last, LevelBlocks& out) {
  for (std::uint32_t v = finer.offsets[first].vertex; v < finer.offsets[last].vertex; ++v) {
    const std::uint32_t wedge = finer.survivors[v];
    if (!is_known(wedge)) add_vertex(level, wedge, out);
    finer.parent_vertex[v] = static_cast<std::uint16_t>(local_[wedge] - base_);
  }
}

}  // namespace varifold
