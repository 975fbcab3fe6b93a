#include <varifold/models/common/error_code.h>
#include <varifold/models/common/level_table_bytes.h>
#include <varifold/models/common/mesh_bytes.h>
#include <varifold/models/common/section_reader.h>
#include <varifold/models/vdpm/assemble.h>
#include <varifold/models/vdpm/connectivity_code.h>
#include <varifold/models/vdpm/encoding.h>
#include <varifold/models/vdpm/encoding_parts.h>
#include <algorithm>
#include <cmath>
#include <utility>

namespace varifold {

namespace {

using vdpm::GrowingSurface;
using vdpm::NewTriangle;
using vdpm::SplitFrame;

tl::unexpected<Error> pass(Error& error) { return tl::unexpected<Error>(std::move(error)); }

// Reads the parts in their order; what each needs of those before it is in the members.
class Decoder {
 public:
  Decoder(std::span<const std::byte> bytes, int threads) : section_(bytes), threads_(threads) {}

  Result<ViewDependentMesh> decode() {
    if (as_text(section_.take_bytes(vdpm::kTag.size())) != vdpm::kTag)
      return section_.fault("this is no view-dependent mesh of version 1");
    if (auto taken = take_mesh(); !taken) return pass(taken.error());
    if (auto taken = take_levels(); !taken) return pass(taken.error());
    if (auto taken = take_ranges(); !taken) return pass(taken.error());
    if (auto taken = take_steps(); !taken) return pass(taken.error());
    std::vector<PackedBounds> bounds(levels_.finest_level());
    if (auto taken = take_bounds(bounds); !taken) return pass(taken.error());
    std::vector<Vec3> centers;
    if (has_centers_ && !take_centers(centers))
      return section_.fault("the centres end too early, or are not finite");
    if (!section_.at_end()) return section_.fault("there are bytes behind the end");
    const SequenceHistory history(detailed_.sequence, std::move(taken_), std::move(taken_end_),
                                  std::move(first_corners_));
    const StepGraph graph(detailed_, history, threads_);
    ViewDependentMeshData data = assemble_steps(detailed_, history, graph, watch_parents(graph));
    data.mesh = std::move(detailed_.mesh);
    data.mesh.indices = {};
    data.levels = std::move(levels_);  // the sequence has no errors
    data.bounds = std::move(bounds);
    data.centers = std::move(centers);
    return ViewDependentMesh(std::move(data));
  }

 private:
  Result<void> take_mesh() {
    TriangleMesh& mesh = detailed_.mesh;
    take_attributes(section_, mesh);
    if (!section_.good()) return section_.fault("the attributes end too early, or are unknown");
    mesh.materials = take_materials(section_);
    mesh.images = take_images(section_);
    if (!section_.good()) return section_.fault("the materials end too early");
    for (const Material& material : mesh.materials)
      for (const std::uint32_t image : material.textures)
        if (image != kNone && image >= mesh.images.size())
          return section_.fault("a material names no image");
    return {};
  }

  Result<void> take_levels() {
    auto levels = LevelTableCoder::take(section_, detailed_.mesh.vertex_count());
    if (!levels) return pass(levels.error());
    levels_ = std::move(*levels);
    const auto targets = levels_.targets();
    if (targets.size() != detailed_.mesh.vertex_count())
      return section_.fault("the levels do not have all vertices");
    if (targets.size() >= 1u << 29u || triangles() >= 1u << 30u)
      return section_.fault("there are too many vertices or triangles");
    detailed_.sequence.target.assign(targets.begin(), targets.end());
    return {};
  }

  // The triangles of full detail must be as many as the bytes justify: three words for each of the
  // base, a bit for each other one.
  Result<void> take_ranges() {
    const std::uint32_t count = section_.take_count(12);
    std::uint64_t all = 0, base = 0;
    std::vector<bool> has_range(detailed_.mesh.materials.size(), false);
    for (std::uint32_t r = 0; r < count; ++r) {
      const MaterialRange range{section_.take<std::uint32_t>(), static_cast<std::uint32_t>(all),
                                section_.take<std::uint32_t>()};
      base_of_range_.push_back(section_.take<std::uint32_t>());
      all += range.triangle_count;
      base += base_of_range_.back();
      if (range.material >= has_range.size() || has_range[range.material])
        return section_.fault("a range without a material, or a material with two");
      if (range.triangle_count == 0 || base_of_range_.back() > range.triangle_count)
        return section_.fault("a range without triangles, or with more in its base");
      has_range[range.material] = true;
      detailed_.mesh.ranges.push_back(range);
    }
    if (!section_.good()) return section_.fault("the ranges end too early");
    if (count > 0 && (all != triangles() || base != levels_.triangle_count(0)))
      return section_.fault("the ranges do not have the triangles of the levels");
    if (count == 0) base_of_range_.push_back(levels_.triangle_count(0));
    return {};
  }

  Result<void> take_steps() {
    const std::uint32_t base = levels_.triangle_count(0);
    const auto corners = section_.take_array<std::uint32_t>(std::uint64_t{3} * base);
    const auto flags = section_.take<std::uint32_t>();
    const auto steps = section_.take_bytes(section_.take<std::uint64_t>());
    if (!section_.good() || flags > (vdpm::kMovesVertices | vdpm::kHasCenters))
      return section_.fault("the base ends too early");
    if (triangles() - base > 8 * std::uint64_t{steps.size()})
      return section_.fault("there are fewer bits than triangles");
    moves_vertices_ = (flags & vdpm::kMovesVertices) != 0;
    has_centers_ = (flags & vdpm::kHasCenters) != 0;
    if (!replay(corners, steps)) return section_.fault("the steps are damaged");
    if (!moves_vertices_) return {};

    CollapseSequence& sequence = detailed_.sequence;
    const TriangleMesh &mesh = detailed_.mesh, &placed = sequence.placed;
    take_attributes(section_, sequence.placed, mesh.rig);
    if (!section_.good() || placed.vertex_count() != sequence.placed_vertex.size() ||
        (placed.vertex_count() > 0 && !have_same_attributes(placed, mesh)))
      return section_.fault("the places of moved vertices are not there");
    return {};
  }

  // Builds the full mesh and the sequence.
  bool replay(std::span<const std::uint32_t> corners, std::span<const std::byte> steps) {
    CollapseSequence& sequence = detailed_.sequence;
    sequence.triangle_level.assign(triangles(), 0);
    GrowingSurface surface(detailed_.mesh.vertex_count(), triangles());
    first_corners_.resize(std::size_t{3} * triangles());
    if (!add_base(corners, surface)) return false;
    taken_end_.assign(1, 0);
    BitReader bits(steps);
    SplitFrame frame;
    frame.target = levels_.targets();
    frame.ranges = static_cast<std::uint32_t>(base_of_range_.size());
    frame.end_vertex = levels_.vertex_count(0);
    sequence.vertices.assign(1, frame.end_vertex);
    sequence.triangles.assign(1, levels_.triangle_count(0));
    if (moves_vertices_) sequence.first_placed.assign(1, 0);
    for (std::uint32_t k = 0; k < levels_.finest_level(); ++k) {
      frame.first_vertex = frame.end_vertex;
      frame.end_vertex += levels_.step(k).vertices;
      if (!read_step(k, frame, surface, bits)) return false;
      sequence.vertices.push_back(frame.end_vertex);
      sequence.triangles.push_back(sequence.triangles.back() + levels_.step(k).triangles);
    }
    // The last byte is filled up with zeros.
    if (bits.exhausted() || (bits.position() + 7) / 8 != steps.size()) return false;
    detailed_.mesh.indices = surface.corners();
    return true;
  }

  bool add_base(std::span<const std::uint32_t> corners, GrowingSurface& surface) {
    const std::uint32_t vertices = levels_.vertex_count(0);
    std::size_t at = 0;
    for (std::size_t r = 0; r < base_of_range_.size(); ++r) {
      const std::uint32_t first =
          detailed_.mesh.ranges.empty() ? 0 : detailed_.mesh.ranges[r].first_triangle;
      next_of_range_.push_back(first + base_of_range_[r]);
      end_of_range_.push_back(detailed_.mesh.ranges.empty()
                                  ? triangles()
                                  : first + detailed_.mesh.ranges[r].triangle_count);
      for (std::uint32_t i = 0; i < base_of_range_[r]; ++i, at += 3) {
        const std::uint32_t a = corners[at], b = corners[at + 1], c = corners[at + 2];
        if (std::max({a, b, c}) >= vertices || a == b || b == c || c == a) return false;
        add(first + i, {a, b, c}, surface);
      }
    }
    return true;
  }

  void add(std::uint32_t triangle, const std::array<std::uint32_t, 3>& corners,
           GrowingSurface& surface) {
    surface.add(triangle, corners);
    std::copy(corners.begin(), corners.end(),
              first_corners_.begin() + 3 * std::ptrdiff_t{triangle});
  }

  bool read_step(std::uint32_t step, const SplitFrame& frame, GrowingSurface& surface,
                 BitReader& bits) {
    CollapseSequence& sequence = detailed_.sequence;
    if (!vdpm::read_division(frame, surface, bits, taken_, taken_end_)) return false;
    const std::uint32_t added = levels_.step(step).triangles;
    NewTriangle triangle;
    for (std::uint32_t i = 0; i < added; ++i) {
      if (!vdpm::read_triangle(frame, surface, bits, triangle) || bits.exhausted()) return false;
      std::uint32_t& number = next_of_range_[triangle.range];
      if (number == end_of_range_[triangle.range]) return false;
      add(number, triangle.corners, surface);
      sequence.triangle_level[number++] = step + 1;
    }
    if (!moves_vertices_) return true;
    if (!vdpm::read_moved(frame, bits, sequence.placed_vertex)) return false;
    sequence.first_placed.push_back(static_cast<std::uint32_t>(sequence.placed_vertex.size()));
    return true;
  }

  Result<void> take_bounds(std::vector<PackedBounds>& bounds) {
    for (PackedBounds& b : bounds) b.cone = section_.take<std::uint32_t>();
    for (const auto member : vdpm::kShortBounds)
      for (PackedBounds& b : bounds) {
        b.*member = section_.take<std::uint16_t>();
        if (member != vdpm::kShortBounds.back() && b.*member >= kErrorCodes)
          return section_.fault("a bound that is no number");
      }
    if (!section_.good()) return section_.fault("the bounds end too early");
    return {};
  }

  bool take_centers(std::vector<Vec3>& centers) {
    const auto bytes = section_.take_bytes(std::uint64_t{levels_.finest_level()} * sizeof(Vec3));
    if (!section_.good()) return false;
    SectionReader reader(bytes);
    centers.resize(levels_.finest_level());
    bool is_finite = true;
    for (Vec3& center : centers) {
      take_vector(reader, center, 3);
      for (int i = 0; i < 3; ++i) is_finite = is_finite && std::isfinite(center[i]);
    }
    return is_finite;
  }

  [[nodiscard]] std::uint32_t triangles() const {
    return levels_.triangle_count(levels_.finest_level());
  }

  SectionReader section_;
  int threads_;
  DetailedMesh detailed_;
  LevelTable levels_;
  bool moves_vertices_ = false, has_centers_ = false;
  std::vector<std::uint32_t> base_of_range_;
  std::vector<std::uint32_t> taken_, taken_end_, first_corners_;  // a SequenceHistory
  std::vector<std::uint32_t> next_of_range_, end_of_range_;       // numbers of triangles to come
};

}  // namespace

Result<ViewDependentMesh> decode_view_dependent_mesh(std::span<const std::byte> bytes,
                                                     int threads) {
  return Decoder(bytes, threads).decode();
}

}  // namespace varifold
