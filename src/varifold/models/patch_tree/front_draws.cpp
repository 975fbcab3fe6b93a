#include <varifold/models/patch_tree/front_draws.h>

#include <algorithm>

namespace varifold {

FrontDraws::FrontDraws(const FrontTables& tables)
    : tables_(&tables),
      split_(tables.word_count()),
      is_new_(tables.inner_count()),
      masks_(tables.inner_count()),
      slot_of_(tables.topology().node_count(), kNone) {
  for (std::uint32_t root = 0; root < tables.root_count(); ++root) add(root, 0);
}

void FrontDraws::follow(FrontSet& set) {
  for (const std::uint32_t slot : changed_) touched_[slot] = 0;
  changed_.clear();
  switched_.clear();
  find_changed_nodes(set);
  set.forget_changes();
  // Masks first: draws that come get theirs from the parent.
  for (const std::uint32_t node : nodes_) change_masks(node);
  for (const std::uint32_t node : nodes_) change_members(node);
  fill_holes();
  for (const std::uint32_t node : switched_) {
    for (std::uint32_t child = tables_->topology().first_child[node];
         child < tables_->topology().first_child[node + 1]; ++child) {
      const std::uint32_t slot = slot_of_[child];
      if (slot == kNone) continue;
      draws_[slot].mask = masks_[node];
      touch(slot);
    }
  }
  for (const std::uint32_t node : nodes_) is_new_[node] = 0;
  // Holes at the end were not filled.
  const auto is_gone = [&](std::uint32_t slot) {
    if (slot < draws_.size()) return false;
    touched_[slot] = 0;
    return true;
  };
  changed_.erase(std::remove_if(changed_.begin(), changed_.end(), is_gone), changed_.end());
}

void FrontDraws::find_changed_nodes(const FrontSet& set) {
  nodes_.clear();
  splits_ = 0;
  front_bits::for_each(set.changed_words(), [&](std::uint32_t word) {
    const std::uint64_t now = set.split()[word];
    front_bits::for_each_of_word(split_[word] ^ now, word, [&](std::uint32_t node) {
      const bool is_now = (now >> node % 64 & 1u) != 0;
      nodes_.push_back(node);
      is_new_[node] = is_now ? 1 : 0;
      splits_ += is_now ? 1 : 0;
    });
    split_[word] = now;
  });
  merges_ = static_cast<std::uint32_t>(nodes_.size()) - splits_;
}

// The mask of the node itself, and its bit in those of its neighbours.
void FrontDraws::change_masks(std::uint32_t node) {
  const PatchTopology& t = tables_->topology();
  const std::uint8_t* const reverse = tables_->reverse_slots();
  const bool is_now = is_new_[node] != 0;
  std::uint32_t mask = 0;
  const std::uint32_t begin = t.first_neighbor[node], end = t.first_neighbor[node + 1];
  for (std::uint32_t e = begin; e < end; ++e) {
    const std::uint32_t neighbor = t.neighbors[e];
    if (!is_split(neighbor)) {
      if (e - begin < kMaxControllers) mask |= 1u << (e - begin);
      continue;
    }
    // Those that are new look for themselves.
    if (reverse[e] == FrontTables::kNoSlot || is_new_[neighbor] != 0) continue;
    masks_[neighbor] ^= 1u << reverse[e];
    switched_.push_back(neighbor);
  }
  masks_[node] = is_now ? mask : 0;
}

void FrontDraws::change_members(std::uint32_t node) {
  const PatchTopology& t = tables_->topology();
  const std::uint32_t first = t.first_child[node], end = t.first_child[node + 1];
  if (is_new_[node] != 0) {
    if (slot_of_[node] != kNone) remove(node);
    for (std::uint32_t child = first; child < end; ++child)
      if (!is_split(child) && slot_of_[child] == kNone) add(child, masks_[node]);
    return;
  }
  for (std::uint32_t child = first; child < end; ++child)
    if (slot_of_[child] != kNone) remove(child);
  const std::uint32_t parent = t.parent[node];
  if (parent == kNone)
    add(node, 0);
  else if (is_split(parent) && slot_of_[node] == kNone)
    add(node, masks_[parent]);
}

void FrontDraws::add(std::uint32_t node, std::uint32_t mask) {
  auto slot = static_cast<std::uint32_t>(draws_.size());
  if (holes_.empty()) {
    draws_.emplace_back();
    if (touched_.size() < draws_.size()) touched_.push_back(0);
  } else {
    slot = holes_.back();
    holes_.pop_back();
  }
  draws_[slot] = {node, mask};
  slot_of_[node] = slot;
  touch(slot);
  triangles_ += tables_->tree().triangle_count_of(node);
  vertices_ += tables_->tree().vertex_count_of(node);
}

void FrontDraws::remove(std::uint32_t node) {
  const std::uint32_t slot = slot_of_[node];
  slot_of_[node] = kNone;
  draws_[slot].node = kNone;
  holes_.push_back(slot);
  triangles_ -= tables_->tree().triangle_count_of(node);
  vertices_ -= tables_->tree().vertex_count_of(node);
}

// Moves the last draws into the slots that are free.
void FrontDraws::fill_holes() {
  for (; !holes_.empty(); holes_.pop_back()) {
    while (!draws_.empty() && draws_.back().node == kNone) draws_.pop_back();
    const std::uint32_t hole = holes_.back();
    if (hole >= draws_.size()) continue;
    draws_[hole] = draws_.back();
    slot_of_[draws_[hole].node] = hole;
    touch(hole);
    draws_.pop_back();
  }
  while (!draws_.empty() && draws_.back().node == kNone) draws_.pop_back();
}

std::size_t FrontDraws::bytes() const {
  return split_.size() * sizeof(std::uint64_t) + is_new_.size() + touched_.capacity() +
         draws_.capacity() * sizeof(PatchDraw) +
         (masks_.size() + slot_of_.size() + changed_.capacity() + holes_.capacity() +
          nodes_.capacity() + switched_.capacity()) *
             sizeof(std::uint32_t);
}

}  // namespace varifold
