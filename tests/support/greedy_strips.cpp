#include <tests/support/greedy_strips.h>

#include <varifold/base/random.h>
#include <algorithm>
#include <map>
#include <utility>
#include <vector>

namespace varifold::test {

namespace {

class GreedyStrips {
 public:
  GreedyStrips(const TriangleMesh& mesh, Joins joins) : mesh_(mesh), joins_(joins), random_(1) {
    used_.assign(mesh.triangle_count(), false);
    range_of_.assign(mesh.triangle_count(), 0);
    for (std::uint32_t r = 0; r < mesh.ranges.size(); ++r)
      std::fill_n(range_of_.begin() + mesh.ranges[r].first_triangle, mesh.ranges[r].triangle_count,
                  r);
    for (std::uint32_t slot = 0; slot < mesh.indices.size(); ++slot)
      slots_.emplace(std::pair{corner(slot), corner(next(slot))}, slot);
    for (std::uint32_t t = 0; t < mesh.triangle_count(); ++t)
      if (!used_[t]) strip_from(t);
    end_strip();
  }
  TriangleStrips take() { return std::move(strips_); }

 private:
  static std::uint32_t next(std::uint32_t slot) { return slot % 3 == 2 ? slot - 2 : slot + 1; }
  std::uint32_t corner(std::uint32_t slot) const { return mesh_.indices[slot]; }

  void strip_from(std::uint32_t t) {
    std::vector<std::uint32_t>& indices = strips_.indices;
    const bool same_range = indices.size() > strips_.first.back() && range_ == range_of_[t];
    if (joins_ == Joins::kSome && same_range && random_.below(2) == 0) {
      // Two indices repeated, or three, so that the new triangle stands at an even place.
      const std::uint32_t last = indices.back(), count = here();
      indices.push_back(last);
      if (count % 2 == 1) indices.push_back(last);
      indices.push_back(corner(3 * t));
    } else {
      end_strip();
    }
    range_ = range_of_[t];
    used_[t] = true;
    for (std::uint32_t c = 0; c < 3; ++c) indices.push_back(corner(3 * t + c));
    while (go_on()) continue;
  }
  std::uint32_t here() const {
    return static_cast<std::uint32_t>(strips_.indices.size()) - strips_.first.back();
  }
  bool go_on() {
    const std::uint32_t a = strips_.indices[strips_.indices.size() - 2], b = strips_.indices.back();
    const bool odd = here() % 2 == 1;  // of the triangle that comes next
    const auto found = slots_.equal_range(odd ? std::pair{b, a} : std::pair{a, b});
    for (auto i = found.first; i != found.second; ++i) {
      const std::uint32_t t = i->second / 3;
      if (used_[t] || range_of_[t] != range_) continue;
      used_[t] = true;
      strips_.indices.push_back(corner(next(next(i->second))));
      return true;
    }
    return false;
  }
  void end_strip() {
    if (here() > 0) strips_.end_strip(range_);
  }

  const TriangleMesh& mesh_;
  Joins joins_;
  Random random_;
  std::vector<bool> used_;
  std::vector<std::uint32_t> range_of_;
  std::multimap<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> slots_;
  TriangleStrips strips_;
  std::uint32_t range_ = 0;
};

}  // namespace

TriangleStrips greedy_strips(const TriangleMesh& mesh, Joins joins) {
  return GreedyStrips(mesh, joins).take();
}

}  // namespace varifold::test
