#include <varifold/models/patch_tree/front_set.h>

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>

namespace varifold {

using front_bits::add;
using front_bits::has;
using front_bits::remove;

FrontSet::FrontSet(const FrontTables& tables)
    : tables_(&tables),
      split_(tables.word_count()),
      exists_(tables.word_count()),
      wanted_(tables.word_count()),
      blocked_(tables.word_count()),
      gathered_(tables.word_count()),
      words_((tables.word_count() + 63) / 64),
      changed_(words_.size()),
      dependants_(tables.inner_count()),
      priorities_(tables.no_parent() + 1) {
  add_roots();
}

void FrontSet::add_roots() {
  triangles_ = tables_->root_triangles();
  // Roots without children are leaves.
  add_existing(0, std::min(tables_->root_count(), tables_->inner_count()));
}

void FrontSet::add_existing(std::uint32_t first, std::uint32_t end) {
  front_bits::for_each_part(first, end, [&](std::uint32_t word, std::uint64_t mask) {
    exists_[word] |= mask;
    add(words_, word);
  });
}

void FrontSet::remove_existing(std::uint32_t first, std::uint32_t end) {
  front_bits::for_each_part(first, end, [&](std::uint32_t word, std::uint64_t mask) {
    exists_[word] &= ~mask;
    if (exists_[word] == 0) remove(words_, word);
  });
}

void FrontSet::reset() {
  front_bits::for_each(words_, [&](std::uint32_t word) {
    if (split_[word] != 0) add(changed_, word);
    front_bits::for_each_of_word(split_[word], word,
                                 [&](std::uint32_t node) { dependants_[node] = 0; });
    split_[word] = exists_[word] = wanted_[word] = 0;
  });
  std::fill(words_.begin(), words_.end(), 0);
  split_count_ = 0;
  add_roots();
}

std::uint32_t FrontSet::forced_count() const {
  std::uint32_t count = 0;
  front_bits::for_each(words_, [&](std::uint32_t word) {
    count += static_cast<std::uint32_t>(std::popcount(split_[word] & ~wanted_[word]));
  });
  return count;
}

// Split nodes that may not stay so are not wanted: their own children are not resident, or those of
// a node that they require. What is required has smaller numbers.
void FrontSet::unwant_blocked(const ResidentChildren& resident) {
  std::fill(blocked_.begin(), blocked_.end(), 0);
  front_bits::for_each(words_, [&](std::uint32_t word) {
    front_bits::for_each_of_word(split_[word], word, [&](std::uint32_t node) {
      bool is_blocked = !resident.of(node);
      for (const std::uint32_t r : tables_->required_by(node)) is_blocked |= has(blocked_, r);
      if (is_blocked) add(blocked_, node);
    });
    wanted_[word] &= ~blocked_[word];
  });
}

void FrontSet::keep_above(float tolerance, const ResidentChildren& resident) {
  front_scan::find_above(among(split_), tolerance, wanted_);
  if (resident.are_resident != nullptr) unwant_blocked(resident);
  // What depends on a node has a greater number: one pass is enough.
  front_bits::for_each_down(words_, [&](std::uint32_t word) {
    front_bits::for_each_of_word_down(split_[word] & ~wanted_[word], word, [&](std::uint32_t node) {
      if (dependants_[node] == 0) merge(node);
    });
  });
}

bool FrontSet::gather(std::uint32_t node, const ResidentChildren& resident) {
  chain_.clear();
  chain_.push_back(node);
  bool possible = true;
  for (std::size_t i = 0; i < chain_.size() && possible; ++i) {
    possible = resident.of(chain_[i]);
    for (const std::uint32_t r : tables_->required_by(chain_[i])) {
      if (is_split(r) || has(gathered_, r)) continue;
      add(gathered_, r);
      chain_.push_back(r);
    }
  }
  if (chain_.size() == 1) return possible;
  for (const std::uint32_t member : chain_) remove(gathered_, member);
  // Coarse ones first.
  std::sort(chain_.begin(), chain_.end());
  return possible;
}

std::uint64_t FrontSet::chain_growth() const {
  std::uint64_t growth = 0;
  for (const std::uint32_t node : chain_) growth += tables_->growth(node);
  return growth;
}

void FrontSet::split(std::uint32_t node, const FrontPriorities& priorities) {
  assert(has(exists_, node) && !is_split(node));
  add(split_, node);
  add(changed_, node / 64);
  ++split_count_;
  triangles_ += tables_->growth(node);
  for (const std::uint32_t r : tables_->required_by(node)) {
    assert(is_split(r));
    ++dependants_[r];
  }
  const PatchTopology& topology = tables_->topology();
  const std::uint32_t first = topology.first_child[node], end = topology.first_child[node + 1];
  if (first >= tables_->inner_count()) return;
  add_existing(first, end);
  priorities.evaluate_children(*tables_, first, end - first, priorities_[node], priorities_);
}

void FrontSet::merge(std::uint32_t node) {
  assert(dependants_[node] == 0 && is_split(node));
  remove(split_, node);
  add(changed_, node / 64);
  --split_count_;
  triangles_ -= tables_->growth(node);
  for (const std::uint32_t r : tables_->required_by(node)) --dependants_[r];
  const PatchTopology& topology = tables_->topology();
  const std::uint32_t first = topology.first_child[node], end = topology.first_child[node + 1];
  if (first < tables_->inner_count()) remove_existing(first, end);
}

void FrontSet::unwant(std::uint32_t node) {
  remove(wanted_, node);
  if (dependants_[node] != 0) return;
  leaving_.clear();
  leaving_.push_back(node);
  while (!leaving_.empty()) {
    const std::uint32_t next = leaving_.back();
    leaving_.pop_back();
    merge(next);
    for (const std::uint32_t r : tables_->required_by(next))
      if (dependants_[r] == 0 && !is_wanted(r)) leaving_.push_back(r);
  }
}

void FrontSet::collect_unwanted(float above, float up_to, std::vector<std::uint32_t>& nodes) const {
  front_scan::collect(among(exists_), wanted_, {above, up_to}, nodes);
}

void FrontSet::collect_wanted(float above, float up_to, std::vector<std::uint32_t>& nodes) const {
  front_scan::collect(among(wanted_), {}, {above, up_to}, nodes);
}

void FrontSet::collect_unsplit(float tolerance, std::vector<std::uint32_t>& nodes) const {
  front_scan::collect(among(exists_), split_, {tolerance, HUGE_VALF}, nodes);
}

std::size_t FrontSet::bytes() const {
  return (5 * split_.size() + 2 * words_.size()) * sizeof(std::uint64_t) +
         (dependants_.size() + chain_.capacity() + leaving_.capacity()) * sizeof(std::uint32_t) +
         priorities_.size() * sizeof(float);
}

}  // namespace varifold
