#include <varifold/models/patch_tree/front_tables.h>

#include <algorithm>
#include <cassert>
#include <utility>

namespace varifold {

FrontTables::FrontTables(std::shared_ptr<const PatchTree> tree)
    : tree_(std::move(tree)),
      inner_count_(inner_node_count(topology())),
      required_(topology()),
      growth_(inner_count_) {
  const PatchTopology& t = topology();
  root_count_ = t.level_count() == 0 ? 0 : t.first_of_level[1];
  for (std::uint32_t root = 0; root < root_count_; ++root)
    root_triangles_ += tree_->triangle_count_of(root);
  for (std::uint32_t node = 0; node < inner_count_; ++node) {
    std::uint32_t triangles = 0;
    for (std::uint32_t child = t.first_child[node]; child < t.first_child[node + 1]; ++child)
      triangles += tree_->triangle_count_of(child);
    assert(triangles >= tree_->triangle_count_of(node));
    growth_[node] = triangles - std::min(triangles, tree_->triangle_count_of(node));
  }
  lay_out_bounds();
  find_reverse_slots();
}

void FrontTables::lay_out_bounds() {
  const std::uint32_t padded = no_parent() + 8;  // for runs of children, too
  FrontLanes& lanes = lanes_;
  for (std::vector<float>* numbers :
       {&lanes.x, &lanes.y, &lanes.z, &lanes.radius, &lanes.error, &lanes.mean_squared,
        &lanes.axis_x, &lanes.axis_y, &lanes.axis_z, &lanes.cosine, &lanes.sine})
    numbers->assign(padded, 0);
  lanes.parent.assign(padded, no_parent());
  for (std::uint32_t node = 0; node < inner_count_; ++node) {
    const PatchBounds& bounds = tree_->data().bounds[node];
    lanes.x[node] = bounds.ball.center.x;
    lanes.y[node] = bounds.ball.center.y;
    lanes.z[node] = bounds.ball.center.z;
    lanes.radius[node] = bounds.ball.radius;
    lanes.error[node] = bounds.error;
    lanes.mean_squared[node] = bounds.mean_squared;
    lanes.axis_x[node] = bounds.cone.axis.x;
    lanes.axis_y[node] = bounds.cone.axis.y;
    lanes.axis_z[node] = bounds.cone.axis.z;
    lanes.cosine[node] = bounds.cone.cosine;
    lanes.sine[node] = bounds.cone.sine;
    const std::uint32_t parent = topology().parent[node];
    lanes.parent[node] = parent == kNone ? no_parent() : parent;
    if (parent != kNone && node - parent < 8) first_apart_ = node + 1;
  }
}

void FrontTables::find_reverse_slots() {
  const PatchTopology& t = topology();
  reverse_slots_.assign(inner_count_ == 0 ? 0 : t.first_neighbor[inner_count_], kNoSlot);
  for (std::uint32_t node = 0; node < inner_count_; ++node) {
    for (std::uint32_t e = t.first_neighbor[node]; e < t.first_neighbor[node + 1]; ++e) {
      const auto others = t.neighbors_of(t.neighbors[e]);
      const std::size_t looked_at = std::min<std::size_t>(others.size(), kMaxControllers);
      const auto* const end = others.data() + looked_at;
      const auto* const found = std::find(others.data(), end, node);
      if (found != end) reverse_slots_[e] = static_cast<std::uint8_t>(found - others.data());
    }
  }
}

std::size_t FrontTables::bytes() const {
  return lanes_.x.size() * (11 * sizeof(float) + sizeof(std::uint32_t)) + required_.bytes() +
         growth_.size() * sizeof(std::uint32_t) + reverse_slots_.size();
}

}  // namespace varifold
