#include <varifold/simplify/sample_carrier.h>

#include <varifold/base/parallel.h>
#include <varifold/base/random.h>
#include <varifold/mesh/weld.h>
#include <varifold/simplify/morton.h>
#include <algorithm>
#include <atomic>
#include <numeric>
#include <utility>

namespace varifold {

VerticesByPlace::VerticesByPlace(const TriangleMesh& mesh) {
  if (!mesh.has_normals() && !mesh.has_texcoords() && !mesh.has_colors() && mesh.ranges.size() <= 1)
    return;  // without attributes there is one vertex at a place
  WeldMap weld = weld_points(mesh);
  first_.assign(weld.class_count + 1, 0);
  for (const std::uint32_t c : weld.class_of) ++first_[c + 1];
  for (std::size_t c = 1; c < first_.size(); ++c) first_[c] += first_[c - 1];
  std::vector<std::uint32_t> cursor(first_.begin(), first_.end() - 1);
  vertices_.resize(weld.class_of.size());
  for (std::uint32_t v = 0; v < weld.class_of.size(); ++v)
    vertices_[cursor[weld.class_of[v]]++] = v;
  class_of_ = std::move(weld.class_of);
}

namespace {

// Some samples with one place along the Morton curve.
struct SampleGroup {
  std::uint32_t triangle;
  std::uint32_t from, to;  // the ends of the edge that it is on; a vertex and kNone; or kNone both
};

struct SampleGroups {
  std::vector<SampleGroup> groups;
  std::vector<Vec3> places;  // of each

  void add(const Vec3& place, const SampleGroup& group) {
    groups.push_back(group);
    places.push_back(place);
  }
};

void add_vertices(const TriangleMesh& mesh, const SampleOptions& options, SampleGroups& groups) {
  std::vector<std::uint32_t> triangle_of(mesh.vertex_count(), kNone);
  for (std::size_t slot = 0; slot < mesh.indices.size(); ++slot)
    triangle_of[mesh.indices[slot]] = static_cast<std::uint32_t>(slot / 3);
  for (std::uint32_t v = options.share; v < mesh.vertex_count(); v += options.shares)
    if (triangle_of[v] != kNone) groups.add(mesh.positions[v], {triangle_of[v], v, kNone});
}

void add_insides(const TriangleMesh& mesh, const SampleOptions& options, SampleGroups& groups) {
  // Uniform in the triangle: a point of the square, folded along its diagonal.
  for (std::size_t i = options.share;
       i < std::size_t{mesh.triangle_count()} * options.inside_triangles; i += options.shares) {
    const auto triangle = static_cast<std::uint32_t>(i / options.inside_triangles);
    Random random(i);
    auto u = static_cast<float>(random.uniform()), v = static_cast<float>(random.uniform());
    if (u + v > 1) u = 1 - u, v = 1 - v;
    const std::uint32_t* corner = &mesh.indices[3 * std::size_t{triangle}];
    const Vec3 a = mesh.positions[corner[0]];
    groups.add(a + u * (mesh.positions[corner[1]] - a) + v * (mesh.positions[corner[2]] - a),
               {triangle, kNone, kNone});
  }
}

// Every edge once, where no seam doubles it.
void add_edges(const TriangleMesh& mesh, const SampleOptions& options, SampleGroups& groups) {
  // Slots by the lesser end of the edge to the triangle's next corner.
  const auto next = [](std::uint32_t slot) { return slot % 3 == 2 ? slot - 2 : slot + 1; };
  const auto slots = static_cast<std::uint32_t>(mesh.indices.size());
  const auto ends = [&](std::uint32_t slot) {
    return std::minmax({mesh.indices[slot], mesh.indices[next(slot)]});
  };
  std::vector<std::uint32_t> first(mesh.vertex_count() + 1, 0), by_end(slots);
  for (std::uint32_t slot = 0; slot < slots; ++slot) ++first[ends(slot).first + 1];
  for (std::size_t v = 1; v < first.size(); ++v) first[v] += first[v - 1];
  std::vector<std::uint32_t> cursor(first.begin(), first.end() - 1);
  for (std::uint32_t slot = 0; slot < slots; ++slot) by_end[cursor[ends(slot).first]++] = slot;

  std::uint32_t number = 0;
  std::vector<std::uint32_t> taken;
  for (std::uint32_t v = 0; v < mesh.vertex_count(); ++v) {
    taken.clear();
    for (std::uint32_t i = first[v]; i < first[v + 1]; ++i) {
      const std::uint32_t w = ends(by_end[i]).second;
      if (std::find(taken.begin(), taken.end(), w) != taken.end()) continue;
      taken.push_back(w);
      if (number++ % options.shares == options.share)
        groups.add(0.5f * (mesh.positions[v] + mesh.positions[w]), {by_end[i] / 3, v, w});
    }
  }
}

// f(sample) for all samples in their order.
template <class F>
void for_each_sample(const DetailedMesh& detailed, const SampleOptions& options, const F& f) {
  const TriangleMesh& mesh = detailed.mesh;
  SampleGroups all;
  add_vertices(mesh, options, all);
  if (options.inside_triangles > 0) add_insides(mesh, options, all);
  if (options.on_edges > 0) add_edges(mesh, options, all);

  // Along a Morton curve, so that the samples of a triangle share cache lines.
  std::vector<std::uint32_t> order(all.groups.size());
  std::iota(order.begin(), order.end(), 0u);
  order = morton_order(all.places, order, bounds(mesh));
  constexpr std::size_t kAhead = 16;
  for (std::size_t place = 0; place < order.size(); ++place) {
    if (place + kAhead < order.size()) __builtin_prefetch(&all.groups[order[place + kAhead]]);
    const SampleGroup& group = all.groups[order[place]];
    if (group.to == kNone) {
      f(SurfaceSample{all.places[order[place]], group.triangle, group.from, group.from, 0});
      continue;
    }
    const Vec3 a = mesh.positions[group.from], way = mesh.positions[group.to] - a;
    const float released_at = kReleaseAt * glm::dot(way, way);
    for (std::uint32_t i = 1; i <= options.on_edges; ++i) {
      const float part = static_cast<float>(i) / static_cast<float>(options.on_edges + 1);
      f(SurfaceSample{a + part * way, group.triangle, group.from, group.to, part,
                      2 * i == options.on_edges + 1 ? 2 * released_at : released_at});
    }
  }
}

}  // namespace

std::vector<SurfaceSample> surface_samples(const DetailedMesh& detailed,
                                           const SampleOptions& options) {
  std::vector<SurfaceSample> samples;
  for_each_sample(detailed, options, [&](const SurfaceSample& s) { samples.push_back(s); });
  return samples;
}

SampleCarrier::SampleCarrier(const DetailedMesh& detailed, const VerticesByPlace& places,
                             const SampleOptions& options, const SequenceHistory* history)
    : detailed_(detailed),
      places_(places),
      positions_(detailed.mesh.positions),
      walk_(detailed, history),
      samples_(detailed.mesh.triangle_count()) {
  std::uint32_t number = 0;
  for_each_sample(detailed, options, [&](const SurfaceSample& sample) {
    samples_.add(sample.triangle, {sample.position, sample.released_at, number++});
  });
}

std::span<const std::uint32_t> SampleCarrier::placed_by(std::uint32_t step) const {
  const CollapseSequence& sequence = detailed_.sequence;
  if (!sequence.moves_vertices()) return {};
  const std::uint32_t begin = sequence.first_placed[step];
  return {sequence.placed_vertex.data() + begin, sequence.first_placed[step + 1] - begin};
}

// Triangles and their samples lie all over memory; what a later collapse needs is fetched early.
void SampleCarrier::prefetch() const {
  walk_.for_each_later(16, [&](std::uint32_t slot) {
    __builtin_prefetch(&walk_.corners()[slot]);
    samples_.prefetch_owner(slot / 3);
  });
  walk_.for_each_later(8, [&](std::uint32_t slot) { samples_.prefetch(slot / 3); });
}

// The slots at the vertices that go and, with placement, at those that are moved.
void SampleCarrier::gather_before() {
  slots_.clear();
  walk_.removed_slots(slots_);
  for (const std::uint32_t v : placed_by(walk_.level() - 1)) walk_.slots_of(v, slots_);
}

void SampleCarrier::detach() {
  moving_.clear();
  for (const std::uint32_t slot : slots_) {
    const std::span<const Sample> samples = samples_.of(slot / 3);
    moving_.insert(moving_.end(), samples.begin(), samples.end());
    samples_.clear(slot / 3);
  }
}

void SampleCarrier::move_placed() {
  const CollapseSequence& sequence = detailed_.sequence;
  if (!sequence.moves_vertices()) return;
  const std::uint32_t level = walk_.level();
  for (std::uint32_t j = sequence.first_placed[level]; j < sequence.first_placed[level + 1]; ++j)
    positions_[sequence.placed_vertex[j]] = sequence.placed.positions[j];
}

// What is left of the star.
void SampleCarrier::gather_left() {
  const auto placed = placed_by(walk_.level());
  is_ear_ = walk_.changed().empty() && placed.empty();
  slots_.assign(walk_.changed().begin(), walk_.changed().end());
  for (const std::uint32_t v : placed) walk_.slots_of(v, slots_);
}

// The triangles that the samples may go to: those of the star that are left.
void SampleCarrier::gather_candidates() {
  const CollapseSequence& sequence = detailed_.sequence;
  const std::uint32_t level = walk_.level();
  candidates_.clear();
  doubled_areas_.clear();
  if (moving_.empty()) return;
  if (slots_.empty())
    for (std::uint32_t v = sequence.vertices[level]; v < sequence.vertices[level + 1]; ++v)
      places_.for_each_at(sequence.target[v], [&](std::uint32_t w) { walk_.slots_of(w, slots_); });
  if (slots_.empty()) slots_.push_back(0);  // never: a collapse leaves faces behind
  if (!placed_by(level).empty()) {
    for (std::uint32_t& slot : slots_) slot -= slot % 3;
    std::sort(slots_.begin(), slots_.end());
    slots_.erase(std::unique(slots_.begin(), slots_.end()), slots_.end());
  }
  for (const std::uint32_t slot : slots_) {
    const std::uint32_t* corner = &walk_.corners()[3 * std::size_t{slot / 3}];
    const Vec3 a = positions_[corner[0]], b = positions_[corner[1]], c = positions_[corner[2]];
    candidates_.push_back({slot / 3, {a, b, c}});
    doubled_areas_.push_back(glm::length(glm::cross(b - a, c - a)));
  }
}

std::uint32_t sample_shares(int threads, const CollapseSequence& sequence) {
  return (threads > 0 ? threads : hardware_threads()) > 1 && sequence.step_count() > 10000 ? 2 : 1;
}

bool carry_samples(const DetailedMesh& detailed, const CarryOptions& options,
                   const std::function<void(std::uint32_t share, SampleCarrier&)>& collapse) {
  constexpr std::uint32_t kReportEvery = 4096;
  const std::uint32_t shares = sample_shares(options.threads, detailed.sequence);
  const auto steps = static_cast<float>(detailed.sequence.step_count());
  const VerticesByPlace places(detailed.mesh);
  std::atomic<bool> cancelled{false};
  parallel_for(options.threads, shares, 1, [&](std::size_t begin, std::size_t) {
    const auto share = static_cast<std::uint32_t>(begin);
    SampleCarrier carrier(detailed, places,
                          {options.inside_triangles, options.on_edges, share, shares},
                          options.history);
    while (carrier.level() > 0 && !cancelled) {
      collapse(share, carrier);
      if (share == 0 && carrier.level() % kReportEvery == 0 &&
          !report(options.progress, "measuring", 1 - static_cast<float>(carrier.level()) / steps))
        cancelled = true;
    }
  });
  return !cancelled;
}

}  // namespace varifold
