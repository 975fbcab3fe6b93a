#include <varifold/models/patch_tree/patch_draws.h>

#include <varifold/mesh/vertex_arrays.h>
#include <varifold/mesh/weld.h>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace varifold {

namespace {

std::uint32_t level_of(const PatchTopology& topology, std::uint32_t node) {
  const auto& first = topology.first_of_level;
  return static_cast<std::uint32_t>(std::upper_bound(first.begin(), first.end(), node) -
                                    first.begin() - 1);
}

float length_of(const PatchBounds& bounds, PatchMeasure measure) {
  return measure == PatchMeasure::kMeanSquared ? std::sqrt(bounds.mean_squared) : bounds.error;
}

}  // namespace

PatchDrawTables::PatchDrawTables(std::shared_ptr<const PatchTree> tree,
                                 std::optional<PatchMeasure> morphs)
    : tree_(std::move(tree)) {
  find_remap();
  if (morphs) find_morphs(*morphs);
}

void PatchDrawTables::find_remap() {
  const PatchTreeData& data = tree_->data();
  remap_.reserve(data.survivors.size());
  for (std::uint32_t node = 0; node < tree_->node_count(); ++node) {
    const PatchOffsets &at = data.offsets[node], &next = data.offsets[node + 1];
    draws_per_patch_ = std::max(draws_per_patch_, next.range - at.range);
    for (std::uint32_t v = at.vertex; v < next.vertex; ++v) {
      const std::uint32_t controller = at.controller + (v - at.vertex);
      const std::uint32_t bit =
          controller < next.controller ? data.controllers[controller] : kPatchNeverMoves;
      remap_.push_back(patch_remap(data.survivors[v], bit));
    }
  }
}

void PatchDrawTables::find_morphs(PatchMeasure measure) {
  const PatchTopology& topology = tree_->topology();
  morphs_.resize(remap_.size());
  for (std::uint32_t v = 0; v < morphs_.size(); ++v) morphs_[v].target = v;
  for (std::uint32_t level = 1; level < topology.level_count(); ++level)
    find_morphs_of_level(level, measure);
}

// A point moves where the level above has another in its place. It is as finely drawn as the
// coarsest of the patches that hold it, and so its error is the least of their parents': all
// vertices at that point must have the same.
void PatchDrawTables::find_morphs_of_level(std::uint32_t level, PatchMeasure measure) {
  const PatchTreeData& data = tree_->data();
  const std::uint32_t first = data.topology.first_of_level[level];
  const std::uint32_t last = data.topology.first_of_level[level + 1];
  const std::uint32_t base = data.offsets[first].vertex, end = data.offsets[last].vertex;
  const WeldMap weld = weld_points(data.vertices, base, end);
  std::vector<float> errors(weld.class_count, std::numeric_limits<float>::infinity());
  for (std::uint32_t node = first; node < last; ++node) {
    const float error = length_of(data.bounds[data.topology.parent[node]], measure);
    const std::uint32_t offset = data.offsets[node].vertex - base;
    for (std::size_t i = 3 * std::size_t{data.offsets[node].triangle};
         i < 3 * std::size_t{data.offsets[node + 1].triangle}; ++i) {
      float& of_point = errors[weld.class_of[offset + data.corners[i]]];
      of_point = std::min(of_point, error);
    }
  }
  for (std::uint32_t node = first; node < last; ++node) {
    const std::uint32_t parent_vertex = data.offsets[data.topology.parent[node]].vertex;
    for (std::uint32_t v = data.offsets[node].vertex; v < data.offsets[node + 1].vertex; ++v) {
      const std::uint32_t survivor = parent_vertex + data.survivors[v];
      if (!same_point(data.vertices, survivor, v))
        morphs_[v] = {survivor, errors[weld.class_of[v - base]]};
      else if (morphs_[survivor].target != survivor)
        morphs_[v] = morphs_[survivor];  // the same point, which goes at a coarser level
    }
  }
}

std::size_t PatchDrawTables::bytes() const {
  return remap_.size() * sizeof(PatchRemap) + morphs_.size() * sizeof(PatchMorph);
}

void PatchDraws::write(std::uint32_t slot, const PatchDraw& draw) {
  const PatchTreeData& data = tables_->tree().data();
  const PatchTopology& topology = data.topology;
  const PatchOffsets &at = data.offsets[draw.node], &next = data.offsets[draw.node + 1];
  const std::uint32_t parent = topology.parent[draw.node];
  const std::uint32_t levels = topology.level_count();
  PatchDrawCommand command;
  command.first_index = 3 * at.triangle;
  command.first_vertex = at.vertex;
  command.parent_vertex = parent == kNone ? at.vertex : data.offsets[parent].vertex;
  command.mask = draw.mask;
  command.patch = draw.node;
  command.level = levels < 2 ? 1
                             : static_cast<float>(level_of(topology, draw.node)) /
                                   static_cast<float>(levels - 1);
  for (std::uint32_t i = 0; i < tables_->draws_per_patch(); ++i) {
    command.draw = slot * tables_->draws_per_patch() + i;
    command.first_index += command.index_count;
    command.index_count = 0;
    if (at.range + i < next.range) {
      command.index_count = 3 * data.ranges[at.range + i].triangle_count;
      command.material = data.ranges[at.range + i].material;
    }
    commands_[command.draw] = command;
    changed_.push_back(command.draw);
  }
}

void PatchDraws::write_all(std::span<const PatchDraw> draws) {
  commands_.resize(draws.size() * tables_->draws_per_patch());
  for (std::uint32_t slot = 0; slot < draws.size(); ++slot) write(slot, draws[slot]);
}

void PatchDraws::follow(const FrontDraws& draws, bool rewrite) {
  changed_.clear();
  if (rewrite || !is_begun_) {
    write_all(draws.draws());
  } else {
    commands_.resize(draws.draws().size() * tables_->draws_per_patch());
    for (const std::uint32_t slot : draws.changed_slots()) write(slot, draws.draws()[slot]);
  }
  is_begun_ = true;
}

void PatchDraws::show(SplitFlags is_split) {
  const PatchTopology& topology = tables_->tree().topology();
  changed_.clear();
  commands_.clear();
  std::uint32_t slot = 0;
  for (std::uint32_t node = 0; node < topology.node_count(); ++node) {
    if (!is_in_front(topology, is_split, node)) continue;
    const std::uint32_t parent = topology.parent[node];
    commands_.resize(commands_.size() + tables_->draws_per_patch());
    write(slot++, {node, parent == kNone ? 0 : coarse_neighbors(topology, is_split, parent)});
  }
  is_begun_ = false;
}

PatchDrawList PatchDraws::list() const {
  const PatchTreeData& data = tables_->tree().data();
  PatchDrawList list;
  list.positions = data.vertices.positions;
  list.normals = data.vertices.normals;
  list.texcoords = data.vertices.texcoords;
  list.colors = data.vertices.colors;
  list.skin = data.vertices.skin;
  list.poses = data.vertices.poses;
  list.remap = tables_->remap();
  list.morphs = tables_->morphs();
  list.indices = data.corners;
  list.draws = commands_;
  list.changed_draws = changed_;
  return list;
}

std::size_t PatchDraws::bytes() const {
  return commands_.capacity() * sizeof(PatchDrawCommand) +
         changed_.capacity() * sizeof(std::uint32_t);
}

}  // namespace varifold
