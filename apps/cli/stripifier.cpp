#include <apps/cli/context.h>
#include <apps/cli/stripifier.h>
#include <algorithm>
#include <array>
#include <tuple>
#include <utility>
#include <vector>

namespace varifold::cli {

namespace {

/// A directed edge of a triangle, and the corner opposite.
struct HalfEdge {
  std::uint32_t from, to, triangle, opposite;
  [[nodiscard]] bool operator<(const HalfEdge& other) const {
    return std::tie(from, to, triangle) < std::tie(other.from, other.to, other.triangle);
  }
};

// From each triangle that is left, a strip goes on as long as it needs no swap.
class PlainStrips {
 public:
  explicit PlainStrips(const TriangleMesh& mesh) : mesh_(mesh), used_(mesh.triangle_count()) {
    edges_.reserve(mesh.indices.size());
    for (std::uint32_t t = 0; t < mesh.triangle_count(); ++t)
      for (std::uint32_t k = 0; k < 3; ++k)
        edges_.push_back({corner(t, k), corner(t, k + 1), t, corner(t, k + 2)});
    std::sort(edges_.begin(), edges_.end());
  }

  TriangleStrips make() {
    std::vector<MaterialRange> ranges = mesh_.ranges;
    if (ranges.empty()) ranges.push_back({0, 0, mesh_.triangle_count()});
    for (std::uint32_t r = 0; r < ranges.size(); ++r)
      for (std::uint32_t i = 0; i < ranges[r].triangle_count; ++i)
        if (!used_[ranges[r].first_triangle + i]) grow(ranges[r].first_triangle + i, ranges[r], r);
    return std::move(strips_);
  }

 private:
  [[nodiscard]] std::uint32_t corner(std::uint32_t t, std::uint32_t k) const {
    return mesh_.indices[3 * std::size_t{t} + k % 3];
  }

  void grow(std::uint32_t t, const MaterialRange& range, std::uint32_t r) {
    used_[t] = true;
    std::array<std::uint32_t, 3> last{corner(t, 0), corner(t, 1), corner(t, 2)};
    strips_.indices.insert(strips_.indices.end(), last.begin(), last.end());
    for (bool odd = true;; odd = !odd) {
      const HalfEdge* const next =
          odd ? find(last[2], last[1], range) : find(last[1], last[2], range);
      if (!next) break;
      used_[next->triangle] = true;
      last = {last[1], last[2], next->opposite};
      strips_.indices.push_back(next->opposite);
    }
    strips_.end_strip(r);
  }

  [[nodiscard]] const HalfEdge* find(std::uint32_t from, std::uint32_t to,
                                     const MaterialRange& range) const {
    const HalfEdge wanted{from, to, range.first_triangle, 0};
    for (auto e = std::lower_bound(edges_.begin(), edges_.end(), wanted);
         e != edges_.end() && e->from == from && e->to == to &&
         e->triangle - range.first_triangle < range.triangle_count;
         ++e)
      if (!used_[e->triangle]) return &*e;
    return nullptr;
  }

  const TriangleMesh& mesh_;
  std::vector<bool> used_;
  std::vector<HalfEdge> edges_;
  TriangleStrips strips_;
};

}  // namespace

void add_stripifier_options(CLI::App& command, StripifierOptions& options) {
  command
      .add_option("--stripifier", options.name,
                  "length: few indices; cache: few misses of a vertex cache; sequence: along the "
                  "collapses")
      ->check(CLI::IsMember({"length", "cache", "sequence"}))
      ->capture_default_str()
      ->type_name("KIND");
  command.add_option("--cache-size", options.cache_size, "Entries that --stripifier cache is for")
      ->check(CLI::IsMember({16u, 24u}))
      ->capture_default_str()
      ->type_name("N");
}

TriangleStrips make_strips(const DetailedMesh& detailed, const StripifierOptions& options) {
  if (options.name != "length")
    wrong_usage("--stripifier " + options.name + ": there is no such stripifier yet");
  return PlainStrips(detailed.mesh).make();
}

double indices_per_triangle(const TriangleStrips& strips, std::uint32_t triangles) {
  const std::size_t restarts = strips.count() > 0 ? strips.count() - 1 : 0;
  return static_cast<double>(strips.indices.size() + restarts) / std::max(1u, triangles);
}

}  // namespace varifold::cli
