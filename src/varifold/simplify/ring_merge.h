// Editing the rings, and with them the wedges, for one collapse.
#pragma once

#include <varifold/simplify/attribute_field.h>
#include <varifold/simplify/working_surface.h>
#include <cstdint>
#include <vector>

namespace varifold {

/// Memory that merges use again and again; one for each thread.
struct MergeScratch {
  std::vector<RingEntry> ring;                        ///< the ring of the vanished point, as it was
  std::vector<std::uint32_t> moved_from, moved_onto;  ///< wedges, as match_wedges() paired them
  std::vector<LinkEdge> edges, apex_edges;
  std::vector<RingEntry> ordered;
  std::vector<std::uint32_t> dead_faces, apexes;
};

/// Collapses the connectivity; knows nothing of costs. Cheap to make.
class RingMerger {
 public:
  RingMerger(WorkingSurface& surface, MergeScratch& scratch)
      : surface_(surface), scratch_(scratch) {}

  /// Finds for every wedge of `from` the wedge of `onto` that takes its place: on the same side of
  /// the charts, as the faces along the edge show, and there the one with the nearest attributes
  /// (`attributes` may be null). False where a side would have nowhere to go.
  [[nodiscard]] bool match_wedges(const AttributeField* attributes, std::uint32_t from,
                                  std::uint32_t onto);

  /// Moves the paired wedges, if there are any, and merges the ring of `from` into that of `onto`.
  /// Appends the faces that vanish. The collapse must be legal. O(valence).
  void merge(std::uint32_t from, std::uint32_t onto, std::vector<std::uint32_t>& removed_faces);

 private:
  void move_wedges(std::uint32_t from);
  [[nodiscard]] bool is_regular_edge(std::uint32_t from, std::uint32_t onto);
  void merge_regular(std::uint32_t from, std::uint32_t onto, std::vector<std::uint32_t>& removed);
  void merge_irregular(std::uint32_t from, std::uint32_t onto, std::vector<std::uint32_t>& removed);
  void drop_neighbor(std::uint32_t point, std::uint32_t from, bool keep_its_face);
  void rename_neighbor(std::uint32_t point, std::uint32_t from, std::uint32_t onto);
  void rename_in_plain_ring(std::uint32_t point, std::uint32_t from, std::uint32_t onto);
  [[nodiscard]] bool sides_along(std::uint32_t from, std::uint32_t onto);

  struct Side {
    std::uint32_t from_group, onto_group;
  };
  WorkingSurface& surface_;
  MergeScratch& scratch_;
};

}  // namespace varifold
