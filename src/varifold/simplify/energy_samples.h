// The points of the original that an energy measures a simplified surface by.
#pragma once

#include <varifold/simplify/attribute_field.h>
#include <varifold/simplify/sample_blocks.h>
#include <varifold/simplify/working_surface.h>
#include <cstdint>
#include <span>
#include <vector>

namespace varifold {

struct EnergyOptions {
  /// Samples beside the vertices, spread evenly over the area: so many for each triangle of the
  /// input on average.
  float samples_per_triangle = 1;
  /// Multiplies the spring constants of the paper, 1e-2, 1e-4 and 1e-8, which are made for dozens
  /// of samples a triangle: with few, springs of that strength outweigh the distances.
  float spring = 0.01f;
  std::uint64_t seed = 1;  ///< of the places of the samples
};

/// Samples by the face that they are attached to, and their attribute values.
struct SurfaceSamples {
  SampleBlocks blocks;        ///< owner: a triangle of the input
  std::vector<float> values;  ///< weighted values, a row of channel_count for each sample with any
  std::uint32_t channel_count = 0;

  [[nodiscard]] std::span<const float> values_of(const EnergySample& sample) const {
    return {&values[std::size_t{sample.attributes} * channel_count], channel_count};
  }
  [[nodiscard]] std::size_t bytes() const {
    return blocks.bytes() + values.capacity() * sizeof(float);
  }
};

/// A sample at every point, without attributes where it has several wedges since there no single
/// value is right, and samples inside the triangles, as many as the options say. `attributes` may
/// be empty. The same for any number of threads. O(n + samples).
[[nodiscard]] SurfaceSamples make_samples(const WorkingSurface& surface, const TriangleMesh& mesh,
                                          const AttributeField& attributes,
                                          const EnergyOptions& options);

}  // namespace varifold
