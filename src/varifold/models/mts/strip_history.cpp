#include <varifold/models/mts/strip_history.h>

#include <algorithm>
#include <cassert>

namespace varifold::mts {

StripHistory::StripHistory() : vertex_{kNone, kNone}, next_{kEnd, kNone}, arc_{kNone, kNone} {}

void StripHistory::advance(std::uint32_t level, std::vector<StripItem>& items) {
  take_over_nodes(items);
  const auto same_node = [](const StripItem& a, const StripItem& b) { return a.node == b.node; };
  const bool same = std::equal(items.begin(), items.end(), items_.begin(), items_.end(), same_node);
  if (same && !arcs_.empty()) return;
  if (!arcs_.empty()) changes_.push_back(level);
  const auto state = static_cast<std::uint32_t>(changes_.size());

  const auto known = static_cast<std::uint32_t>(vertex_.size());
  std::uint32_t before = kStart;
  for (StripItem& item : items) {
    if (item.node == kNone) {
      item.node = static_cast<std::uint32_t>(vertex_.size());
      vertex_.push_back(item.vertex);
      next_.push_back(next_[before]);
      next_[before] = item.node;
      arc_.push_back(kNone);
    }
    before = item.node;
  }
  // Nodes that stay do so in their order, so the first that is not next is gone.
  std::size_t i = 0;
  for (const StripItem& item : items_) {
    while (i < items.size() && items[i].node >= known) ++i;
    if (i < items.size() && items[i].node == item.node)
      ++i;
    else
      leave(item.node, state);
  }
  before = kStart;
  for (const StripItem& item : items) {
    link(before, item.node, state);
    before = item.node;
  }
  link(before, kEnd, state);
  items_ = items;
  longest_ = std::max(longest_, static_cast<std::uint32_t>(items.size()));
}

// Where the strip lost a node and gains one for the same vertex between two that stay, it is one.
void StripHistory::take_over_nodes(std::vector<StripItem>& items) const {
  std::size_t old = 0;
  for (std::size_t i = 0; i < items.size();) {
    std::size_t stays = i;
    while (stays < items.size() && items[stays].node == kNone) ++stays;
    const std::uint32_t until = stays < items.size() ? items[stays].node : kEnd;
    for (; i < stays; ++i) {
      std::size_t found = old;
      while (found < items_.size() && items_[found].node != until &&
             items_[found].vertex != items[i].vertex)
        ++found;
      if (found == items_.size() || items_[found].node == until) continue;
      items[i].node = items_[found].node;
      old = found + 1;
    }
    while (old < items_.size() && items_[old].node != until) ++old;
    ++old;
    i = stays + 1;
  }
}

void StripHistory::link(std::uint32_t from, std::uint32_t to, std::uint32_t state) {
  if (arc_[from] != kNone) {
    if (arcs_[arc_[from]].to == to) return;
    leave(from, state);
  }
  arc_[from] = static_cast<std::uint32_t>(arcs_.size());
  arcs_.push_back({from, to, kNone});
}

void StripHistory::leave(std::uint32_t node, std::uint32_t state) {
  arcs_[arc_[node]].last = state - 1;
  arc_[node] = kNone;
}

bool StripHistory::has_room(std::uint32_t largest_graph) const {
  const std::size_t more = 2 * items_.size() + 8;
  return std::max({vertex_.size(), arcs_.size(), changes_.size()}) + more < largest_graph;
}

std::vector<std::uint32_t> StripHistory::ordered_numbers() const {
  std::vector<std::uint32_t> number(vertex_.size());
  std::uint32_t count = 0;
  for (std::uint32_t node = kStart; node != kEnd; node = next_[node]) number[node] = count++;
  number[kEnd] = count;
  return number;
}

bool StripHistory::append_to(MultiresolutionStripsData& data) const {
  if (longest_ == 0) return false;
  const std::vector<std::uint32_t> number = ordered_numbers();
  const auto nodes = static_cast<std::uint32_t>(vertex_.size() - 1);
  const std::size_t first_node = data.node_vertex.size();
  data.node_vertex.resize(first_node + nodes);
  for (std::uint32_t node = 0; node < vertex_.size(); ++node)
    if (node != kEnd) data.node_vertex[first_node + number[node]] = vertex_[node];

  std::vector<Arc> arcs = arcs_;
  const auto last_state = static_cast<std::uint32_t>(changes_.size());
  for (Arc& arc : arcs) {
    arc = {number[arc.from], number[arc.to], std::min(arc.last, last_state)};
    assert(arc.from < arc.to);
  }
  // Stable: the arcs of a node stay in the order of time.
  std::stable_sort(arcs.begin(), arcs.end(),
                   [](const Arc& a, const Arc& b) { return a.from < b.from; });
  for (std::uint32_t i = 0, node = 0; i < arcs.size(); ++i) {
    for (; node <= arcs[i].from; ++node) data.node_arc.push_back(static_cast<std::uint16_t>(i));
    data.arcs.push_back(
        {static_cast<std::uint16_t>(arcs[i].to), static_cast<std::uint16_t>(arcs[i].last)});
  }
  assert(data.node_arc.size() == data.node_vertex.size());
  data.changes.insert(data.changes.end(), changes_.begin(), changes_.end());

  if (data.strips.empty()) data.strips.emplace_back();
  data.strips.push_back({static_cast<std::uint32_t>(data.node_vertex.size()),
                         static_cast<std::uint32_t>(data.arcs.size()),
                         static_cast<std::uint32_t>(data.changes.size()),
                         data.strips.back().first_index + longest_ + 1});
  return true;
}

}  // namespace varifold::mts
