// Private to this folder: what the check of a model needs and what does not depend on its kind.
#pragma once

#include <varifold/base/checksum.h>
#include <varifold/measure/check_model.h>
#include <varifold/mesh/triangle_mesh.h>
#include <varifold/mesh/weld.h>
#include <varifold/models/common/uniform_model.h>
#include <varifold/view/draw_list.h>
#include <array>
#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace varifold::check {

/// How many levels, or fronts, have a fault, and the first of them.
class PlaceFaults {
 public:
  /// `noun` is what the places are numbers of; kinds are named with `prefix` before them.
  explicit PlaceFaults(std::string noun, std::string prefix = {})
      : noun_(std::move(noun)), prefix_(std::move(prefix)) {}

  void add(const char* kind, std::uint32_t place, const std::string& detail = {}) {
    Entry& entry = entries_[kind];
    if (++entry.count > kPlaces) return;
    entry.where += (entry.where.empty() ? noun_ + " " : ", ") + std::to_string(place);
    if (!detail.empty()) entry.where += " (" + detail + ")";
  }
  void append_to(std::vector<Fault>& faults) const {
    for (const auto& [kind, entry] : entries_)
      faults.push_back({prefix_ + kind, entry.count,
                        entry.where + (entry.count > kPlaces ? ", ..." : ""), Severity::kFault});
  }

 private:
  static constexpr std::uint64_t kPlaces = 4;
  struct Entry {
    std::uint64_t count = 0;
    std::string where;
  };
  std::string noun_, prefix_;
  std::map<std::string, Entry> entries_;
};

/// The points of a model, those of a level being the first so many, and its history.
struct ModelPoints {
  std::vector<std::uint32_t> point_of;  ///< per vertex
  std::vector<std::uint32_t> target;    ///< per vertex beyond the base, what it collapses onto
  std::uint32_t base_points = 0;

  [[nodiscard]] WeldMap at_level(std::uint32_t level, std::uint32_t vertices) const;
  /// Of all vertices.
  [[nodiscard]] WeldMap all() const;
};

template <class Model>
ModelPoints points_of(const Model& model) {
  const std::vector<Vec3>& positions = model.attributes().positions;
  std::uint32_t vertices = model.vertex_count(0);
  const WeldMap base = weld_points(model.attributes(), 0, vertices);
  ModelPoints points{base.class_of, {}, base.class_count};
  points.point_of.reserve(positions.size());
  points.target.assign(vertices, kNone);
  for (std::uint32_t k = 0; k < model.finest_level(); ++k) {
    const std::uint32_t end = model.vertex_count(k + 1);
    for (; vertices < end; ++vertices) {
      points.point_of.push_back(points.base_points + k);
      points.target.push_back(model.ancestor(vertices, k));
    }
  }
  return points;
}

/// All levels of a small model; of a large one, half of the spread even, half dense at the base.
[[nodiscard]] std::vector<std::uint32_t> levels_to_visit(std::uint32_t finest,
                                                         const ModelCheckOptions& options);

/// Three corners, the least first, orientation kept, and the material.
using CanonicalTriangle = std::array<std::uint32_t, 4>;
[[nodiscard]] CanonicalTriangle canonical(CanonicalTriangle triangle);
/// Those of a mesh, sorted.
[[nodiscard]] std::vector<CanonicalTriangle> canonical_triangles(const TriangleMesh& mesh);

struct TriangleDifferences {
  bool wrong = false;    ///< a triangle that is not expected
  bool lost = false;     ///< an expected triangle that is not there
  bool doubled = false;  ///< an expected triangle that is there once more
};
/// Both sorted. O(n).
[[nodiscard]] TriangleDifferences compare_triangles(const std::vector<CanonicalTriangle>& expected,
                                                    const std::vector<CanonicalTriangle>& found);

/// Whether every index that is drawn is below `vertices`, or a restart of a strip, and every range
/// lies within the indices.
[[nodiscard]] bool indices_exist(const DrawList& list, std::uint32_t vertices);

/// A checksum of all that a list draws: the bytes of its buffers but for attributes that are those
/// of the model, and its ranges.
[[nodiscard]] std::uint64_t fingerprint_of(const DrawList& list, const TriangleMesh& attributes);

/// The same of the triangles with their corners' attributes and materials, whatever their order and
/// numbers.
[[nodiscard]] std::uint64_t set_fingerprint_of(const DrawList& list);

template <class Instance>
std::uint64_t fingerprint(Instance& instance) {
  if constexpr (order_depends_on_way<Instance>()) return set_fingerprint_of(instance.draw_list());
  return fingerprint_of(instance.draw_list(), instance.model().attributes());
}

}  // namespace varifold::check
