// Based on: [DeyEdelsbrunnerGuhaNekhayev1999], the link condition for a closed surface.
#include <varifold/morph/ring_mesh.h>
#include <algorithm>
#include <cassert>
#include <iterator>

namespace varifold {
namespace {

using Ring = std::vector<std::uint32_t>;

// Rings are searched as they are up to this product of their sizes.
constexpr std::size_t kSorted = 2048;

Ring::iterator place_of(Ring& ring, std::uint32_t vertex) {
  const auto place = std::find(ring.begin(), ring.end(), vertex);
  assert(place != ring.end());
  return place;
}

// Chains the directed edges that face one vertex, (from, to) of each triangle, into a cycle.
Ring chained(std::span<std::pair<std::uint32_t, std::uint32_t>> links) {
  std::sort(links.begin(), links.end());
  Ring ring;
  ring.reserve(links.size());
  std::uint32_t at = links[0].first;
  for (std::size_t i = 0; i < links.size(); ++i) {
    ring.push_back(at);
    at = std::lower_bound(links.begin(), links.end(), std::pair(at, 0u))->second;
  }
  assert(at == ring[0]);
  return ring;
}

}  // namespace

RingMesh::RingMesh(std::span<const std::uint32_t> indices, std::uint32_t vertex_count)
    : rings_(vertex_count), live_count_(vertex_count) {
  std::vector<std::uint32_t> offsets(vertex_count + 1, 0);
  for (const std::uint32_t vertex : indices) ++offsets[vertex + 1];
  for (std::uint32_t v = 0; v < vertex_count; ++v) offsets[v + 1] += offsets[v];
  std::vector<std::pair<std::uint32_t, std::uint32_t>> links(indices.size());
  std::vector<std::uint32_t> filled(offsets.begin(), offsets.end() - 1);
  for (std::size_t t = 0; t < indices.size(); t += 3)
    for (std::size_t k = 0; k < 3; ++k)
      links[filled[indices[t + k]]++] = {indices[t + (k + 1) % 3], indices[t + (k + 2) % 3]};
  for (std::uint32_t v = 0; v < vertex_count; ++v)
    rings_[v] = chained({links.data() + offsets[v], links.data() + offsets[v + 1]});
}

bool RingMesh::can_collapse(std::uint32_t vertex, std::uint32_t target) const {
  if (live_count_ <= 4) return false;
  const Ring &ring = rings_[vertex], &others = rings_[target];
  std::uint32_t common = 0;
  if (ring.size() * others.size() > kSorted) {
    Ring few = ring.size() < others.size() ? ring : others;
    std::sort(few.begin(), few.end());
    for (const std::uint32_t neighbour : ring.size() < others.size() ? others : ring)
      common += std::binary_search(few.begin(), few.end(), neighbour);
    return common == 2;
  }
  for (const std::uint32_t neighbour : ring)
    common += std::find(others.begin(), others.end(), neighbour) != others.end();
  return common == 2;
}

void RingMesh::collapse(std::uint32_t vertex, std::uint32_t target, CollapseRecord& record) {
  Ring ring = std::move(rings_[vertex]);
  rings_[vertex].clear();
  std::rotate(ring.begin(), place_of(ring, target), ring.end());
  const std::size_t size = ring.size();
  // Around the target, the vertex gives way to what lies between its first and last neighbour.
  Ring& around_target = rings_[target];
  const auto gap = around_target.erase(place_of(around_target, vertex));
  around_target.insert(gap, ring.begin() + 2, ring.end() - 1);
  for (std::size_t i = 1; i < size; ++i) {
    Ring& other = rings_[ring[i]];
    const auto place = place_of(other, vertex);
    if (i == 1 || i + 1 == size)
      other.erase(place);
    else
      *place = target;
  }
  --live_count_;
  record.steps.push_back(
      {vertex, static_cast<std::uint32_t>(record.rings.size()), static_cast<std::uint32_t>(size)});
  record.rings.insert(record.rings.end(), ring.begin(), ring.end());
}

void RingMesh::undo(const CollapseRecord& record, const RecordedCollapse& step) {
  const std::span<const std::uint32_t> ring = record.ring(step);
  const std::uint32_t target = ring[0];
  Ring& around_target = rings_[target];
  // The first neighbour to the front, so that what the vertex hides does not wrap around.
  std::rotate(around_target.begin(), place_of(around_target, ring[1]), around_target.end());
  const auto first_hidden = around_target.begin() + 1;
  const auto hidden = static_cast<std::ptrdiff_t>(ring.size()) - 3;
  around_target.insert(around_target.erase(first_hidden, first_hidden + hidden), step.vertex);
  for (std::size_t i = 1; i < ring.size(); ++i) {
    Ring& other = rings_[ring[i]];
    const auto place = place_of(other, target);
    if (i == 1)
      other.insert(place, step.vertex);
    else if (i + 1 == ring.size())
      other.insert(std::next(place), step.vertex);
    else
      *place = step.vertex;
  }
  rings_[step.vertex].assign(ring.begin(), ring.end());
  ++live_count_;
}

std::vector<std::uint32_t> RingMesh::triangles() const {
  std::vector<std::uint32_t> result;
  for (std::uint32_t v = 0; v < rings_.size(); ++v)
    for (std::size_t i = 0; i < rings_[v].size(); ++i) {
      const std::uint32_t a = rings_[v][i], b = rings_[v][(i + 1) % rings_[v].size()];
      if (v < a && v < b) result.insert(result.end(), {v, a, b});
    }
  return result;
}

}  // namespace varifold
