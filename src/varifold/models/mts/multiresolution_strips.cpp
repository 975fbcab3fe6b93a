#include <varifold/models/mts/multiresolution_strips.h>

#include <varifold/mesh/vertex_arrays.h>

namespace varifold {

MultiresolutionStrips::MultiresolutionStrips(MultiresolutionStripsData data)
    : data_(std::move(data)) {
  if (data_.strips.empty()) data_.strips.emplace_back();
  if (data_.first_strip.empty()) data_.first_strip.assign(2, 0);
}

std::size_t MultiresolutionStrips::bytes() const {
  return vertex_bytes(data_.mesh) + data_.levels.bytes() +
         data_.strips.size() * sizeof(MultiresolutionStripsData::Strip) +
         data_.arcs.size() * sizeof(MultiresolutionStripsData::Arc) +
         data_.node_arc.size() * sizeof(std::uint16_t) +
         (data_.first_strip.size() + data_.node_vertex.size() + data_.changes.size()) *
             sizeof(std::uint32_t);
}

}  // namespace varifold
