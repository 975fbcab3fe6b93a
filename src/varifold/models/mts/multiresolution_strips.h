// Multiresolution triangle strips (MTS): one graph per strip, in which every level is a path.
//
// Based on: [Belmonte2001], as [Ramos2008] 2.4.2, 3.5 and 4.5
//   describe it: strips both in the data structure and in drawing, a graph for each, extraction by
//   a walk along the arcs of the level, strips that break where they degenerate.
// Differs: a strip numbers its own states, so an arc carries its interval in two bytes and a strip
//   knows without a walk whether a level changes it; only pairs of indices are removed, which keeps
//   the orientation of the rest (the published filter can turn it).
#pragma once

#include <varifold/mesh/triangle_mesh.h>
#include <varifold/models/common/level_queries.h>
#include <varifold/models/common/level_table.h>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace varifold {

/// The arrays of an MTS model, all of it plain data.
///
/// Strip s has the nodes [strips[s].first_node, strips[s + 1].first_node), and arcs and changes
/// likewise. Node 0 is its start and stands for no vertex; `to` of an arc counts from node 0 and is
/// greater than the arc's own node; the number of nodes is the end. State 0 is the strip at full
/// detail; at level k the state is the number of its changes at levels >= k. The arcs of a node
/// follow each other with ascending `last`; at state i the first arc with last >= i is followed.
struct MultiresolutionStripsData {
  struct Arc {
    std::uint16_t to = 0;
    std::uint16_t last = 0;  ///< the last, that is coarsest, state in which it is followed
  };
  struct Strip {
    std::uint32_t first_node = 0;
    std::uint32_t first_arc = 0;
    std::uint32_t first_change = 0;
    /// Its slot in the index buffer: as large as it ever gets, and a restart.
    std::uint32_t first_index = 0;
  };

  /// Vertex attributes at full detail, materials and images; no indices. `mesh.ranges` names the
  /// material ranges; its counts are those of full detail.
  TriangleMesh mesh;
  LevelTable levels;
  std::vector<Strip> strips;               ///< one more than there are, for the end
  std::vector<std::uint32_t> first_strip;  ///< per range of the mesh, and the end
  std::vector<std::uint32_t> node_vertex;  ///< kStripRestart where the strip breaks
  std::vector<std::uint16_t> node_arc;     ///< per node, its first arc, within the strip
  std::vector<Arc> arcs;
  std::vector<std::uint32_t> changes;  ///< per strip, levels, falling

  /// Nodes, arcs and changes of one strip lie below this; a strip with more goes on as another.
  static constexpr std::uint32_t kStripLimit = 0xfff0;
};

/// Immutable, shared by any number of instances and threads; satisfies UniformModel.
class MultiresolutionStrips : public LevelQueries<MultiresolutionStrips> {
 public:
  MultiresolutionStrips() : MultiresolutionStrips(MultiresolutionStripsData{}) {}
  /// The arrays must be consistent, as from build_mts() or decode_mts().
  explicit MultiresolutionStrips(MultiresolutionStripsData data);

  [[nodiscard]] const MultiresolutionStripsData& data() const { return data_; }
  [[nodiscard]] const TriangleMesh& attributes() const { return data_.mesh; }
  [[nodiscard]] const LevelTable& levels() const { return data_.levels; }

  /// Strips at full detail, without those that only coarser levels have.
  [[nodiscard]] std::uint32_t strip_count() const {
    return static_cast<std::uint32_t>(data_.strips.size() - 1);
  }
  /// Memory of all arrays but images; vertices included.
  [[nodiscard]] std::size_t bytes() const;

 private:
  MultiresolutionStripsData data_;
};

}  // namespace varifold
