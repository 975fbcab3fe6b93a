#include <varifold/measure/legal_fronts.h>

#include <varifold/base/random.h>
#include <cmath>

namespace varifold::check {

namespace {

class Maker {
 public:
  Maker(const PatchTopology& topology, std::uint64_t seed) : topology_(topology), random_(seed) {
    front_.is_split.assign(topology.node_count(), 0);
    inner_ = topology.first_of_level[topology.level_count() - 1];
    first_of_finest_ =
        topology.level_count() < 2 ? 0 : topology.first_of_level[topology.level_count() - 2];
  }

  LegalFront make(std::uint32_t kind) {
    if (inner_ == 0) {
      front_.name = "the only level";
      return front_;
    }
    switch (kind) {
      case 0:
        return make_random();
      case 1:
        return make_deepest(1, "one leaf");
      case 2:
        return make_chain();
      case 3:
        return make_deepest(2 + random_.below(4), "a few leaves");
      default:
        return make_holes();
    }
  }

 private:
  // Splits a node and all that it needs.
  void split(std::uint32_t node) {
    open_.assign(1, node);
    while (!open_.empty()) {
      const std::uint32_t next = open_.back();
      open_.pop_back();
      if (front_.is_split[next] != 0) continue;
      front_.is_split[next] = 1;
      if (topology_.parent[next] == kNone) continue;
      open_.push_back(topology_.parent[next]);
      for (const std::uint32_t neighbor : topology_.neighbors_of(next))
        open_.push_back(topology_.parent[neighbor]);
    }
  }
  // As many small numbers as large ones.
  std::uint32_t up_to(std::uint32_t most) {
    return static_cast<std::uint32_t>(std::pow(most + 1.0, random_.uniform()));
  }
  [[nodiscard]] std::uint32_t deepest() {
    return first_of_finest_ + random_.below(inner_ - first_of_finest_);
  }

  LegalFront make_random() {
    front_.name = "at random";
    for (std::uint32_t i = up_to(inner_); i > 0; --i) split(random_.below(inner_));
    return front_;
  }
  LegalFront make_deepest(std::uint32_t leaves, const char* name) {
    front_.name = name;
    for (std::uint32_t i = 0; i < leaves; ++i) split(deepest());
    return front_;
  }
  LegalFront make_chain() {
    front_.name = "a chain";
    std::uint32_t node = deepest();
    for (std::uint32_t i = up_to(64); i > 0; --i) {
      split(node);
      const auto neighbors = topology_.neighbors_of(node);
      if (neighbors.empty()) break;
      node = neighbors[random_.below(static_cast<std::uint32_t>(neighbors.size()))];
    }
    return front_;
  }
  // All nodes down to some level but for a few, and those that are in the way of these.
  LegalFront make_holes() {
    front_.name = "holes in a level";
    const std::uint32_t level = random_.below(topology_.level_count() - 1);
    const std::uint32_t first = topology_.first_of_level[level];
    const std::uint32_t end = topology_.first_of_level[level + 1];
    std::vector<std::uint8_t> is_hole(topology_.node_count(), 0);
    for (std::uint32_t i = up_to((end - first) / 4); i > 0; --i)
      is_hole[first + random_.below(end - first)] = 1;
    for (std::uint32_t node = 0; node < end; ++node)
      if (is_hole[node] == 0) split(node);
    return front_;
  }

  const PatchTopology& topology_;
  Random random_;
  LegalFront front_;
  std::uint32_t inner_ = 0, first_of_finest_ = 0;
  std::vector<std::uint32_t> open_;
};

}  // namespace

LegalFront legal_front(const PatchTopology& topology, std::uint32_t number) {
  return Maker(topology, number).make(number % 5);
}

}  // namespace varifold::check
