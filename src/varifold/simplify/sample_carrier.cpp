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
  WeldMap weld = weld_exact(mesh.positions);
  first_.assign(weld.class_count + 1, 0);
  for (const std::uint32_t c : weld.class_of) ++first_[c + 1];
  for (std::size_t c = 1; c < first_.size(); ++c) first_[c] += first_[c - 1];
  std::vector<std::uint32_t> cursor(first_.begin(), first_.end() - 1);
  vertices_.resize(weld.class_of.size());
  for (std::uint32_t v = 0; v < weld.class_of.size(); ++v)
    vertices_[cursor[weld.class_of[v]]++] = v;
  class_of_ = std::move(weld.class_of);
}

std::vector<SurfaceSample> surface_samples(const DetailedMesh& detailed,
                                           const SampleOptions& options) {
  const TriangleMesh& mesh = detailed.mesh;
  std::vector<std::uint32_t> triangle_of(mesh.vertex_count(), kNone);
  for (std::size_t slot = 0; slot < mesh.indices.size(); ++slot)
    triangle_of[mesh.indices[slot]] = static_cast<std::uint32_t>(slot / 3);
  std::vector<Vec3> positions;
  std::vector<std::uint32_t> triangles;
  for (std::uint32_t v = options.share; v < mesh.vertex_count(); v += options.shares) {
    if (triangle_of[v] == kNone) continue;
    positions.push_back(mesh.positions[v]);
    triangles.push_back(triangle_of[v]);
  }

  // Uniform in the triangle: a point of the square, folded along its diagonal.
  for (std::size_t i = options.share;
       i < std::size_t{mesh.triangle_count()} * options.inside_triangles; i += options.shares) {
    const auto triangle = static_cast<std::uint32_t>(i / options.inside_triangles);
    Random random(i);
    auto u = static_cast<float>(random.uniform()), v = static_cast<float>(random.uniform());
    if (u + v > 1) u = 1 - u, v = 1 - v;
    const std::uint32_t* corner = &mesh.indices[3 * std::size_t{triangle}];
    const Vec3 a = mesh.positions[corner[0]];
    positions.push_back(a + u * (mesh.positions[corner[1]] - a) +
                        v * (mesh.positions[corner[2]] - a));
    triangles.push_back(triangle);
  }

  // Along a Morton curve, so that the samples of a triangle share cache lines.
  std::vector<std::uint32_t> all(positions.size());
  std::iota(all.begin(), all.end(), 0u);
  std::vector<SurfaceSample> samples;
  samples.reserve(all.size());
  for (const std::uint32_t i : morton_order(positions, all, bounds(mesh)))
    samples.push_back({positions[i], triangles[i]});
  return samples;
}

SampleCarrier::SampleCarrier(const DetailedMesh& detailed, const VerticesByPlace& places,
                             const std::vector<SurfaceSample>& samples)
    : detailed_(detailed),
      places_(places),
      positions_(detailed.mesh.positions),
      replay_(detailed),
      first_sample_(detailed.mesh.triangle_count(), kNone) {
  samples_.reserve(samples.size());
  for (const SurfaceSample& sample : samples) {
    samples_.push_back({sample.position, kNone});
    attach(static_cast<std::uint32_t>(samples_.size() - 1), sample.triangle);
  }
}

std::span<const std::uint32_t> SampleCarrier::placed_by(std::uint32_t step) const {
  const CollapseSequence& sequence = detailed_.sequence;
  if (!sequence.moves_vertices()) return {};
  const std::uint32_t begin = sequence.first_placed[step];
  return {sequence.placed_vertex.data() + begin, sequence.first_placed[step + 1] - begin};
}

// Detach the samples of all triangles at the vertices that move (and, with placement, at those
// that are moved).
void SampleCarrier::gather_before() {
  const CollapseSequence& sequence = detailed_.sequence;
  const std::uint32_t level = replay_.level();
  slots_.clear();
  for (std::uint32_t v = sequence.vertices[level - 1]; v < sequence.vertices[level]; ++v)
    replay_.slots_of(v, slots_);
  for (const std::uint32_t v : placed_by(level - 1)) replay_.slots_of(v, slots_);
  moving_ = kNone;
  for (const std::uint32_t slot : slots_) {
    std::uint32_t sample = first_sample_[slot / 3];
    first_sample_[slot / 3] = kNone;
    while (sample != kNone) {
      const std::uint32_t next = samples_[sample].next;
      samples_[sample].next = moving_;
      moving_ = sample;
      sample = next;
    }
  }
}

void SampleCarrier::move_placed() {
  const CollapseSequence& sequence = detailed_.sequence;
  if (!sequence.moves_vertices()) return;
  const std::uint32_t level = replay_.level();
  for (std::uint32_t j = sequence.first_placed[level]; j < sequence.first_placed[level + 1]; ++j)
    positions_[sequence.placed_vertex[j]] = sequence.placed.positions[j];
}

// The triangles that the samples may go to: those of the star that are left.
void SampleCarrier::gather_after() {
  const CollapseSequence& sequence = detailed_.sequence;
  const std::uint32_t level = replay_.level();
  const auto placed = placed_by(level);
  is_ear_ = replay_.changed().empty() && placed.empty();
  candidates_.clear();
  if (moving_ == kNone) return;
  slots_.assign(replay_.changed().begin(), replay_.changed().end());
  for (const std::uint32_t v : placed) replay_.slots_of(v, slots_);
  if (slots_.empty())
    for (std::uint32_t v = sequence.vertices[level]; v < sequence.vertices[level + 1]; ++v)
      places_.for_each_at(sequence.target[v],
                          [&](std::uint32_t w) { replay_.slots_of(w, slots_); });
  if (slots_.empty()) slots_.push_back(0);  // never: a collapse leaves faces behind
  if (!placed.empty()) {
    for (std::uint32_t& slot : slots_) slot -= slot % 3;
    std::sort(slots_.begin(), slots_.end());
    slots_.erase(std::unique(slots_.begin(), slots_.end()), slots_.end());
  }
  for (const std::uint32_t slot : slots_) {
    const std::uint32_t* corner = &replay_.corners()[3 * std::size_t{slot / 3}];
    candidates_.push_back(
        {slot / 3, {positions_[corner[0]], positions_[corner[1]], positions_[corner[2]]}});
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
                          surface_samples(detailed, {options.inside_triangles, share, shares}));
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
