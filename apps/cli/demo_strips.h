// The station of the demo that shows triangle strips: LodStrips in its three forms.
#pragma once

#include <varifold/base/result.h>
#include <varifold/mesh/validation.h>
#include <cstdint>
#include <string>
#include <vector>

namespace varifold::cli {

struct DemoPlace;

/// One form of the model of strips, and its file.
struct DemoStripForm {
  std::string name, file;
  std::uint64_t model_bytes = 0, instance_bytes = 0, file_bytes = 0;
  std::uint32_t levels_checked = 0;
  std::vector<Fault> faults;
};

/// One level of all of them. "Indices" are per triangle, a restart between any two strips counted.
struct DemoStripLevel {
  double share = 0;  ///< of the triangles
  std::uint32_t triangles = 0;
  std::vector<double> indices;  ///< by the forms
  double fresh_indices = 0;     ///< of strips that are made for this level alone
  std::uint64_t strips = 0;     ///< of the form that is drawn, the first
  std::string picture;          ///< empty where there is none
};

struct DemoStrips {
  std::string mesh_file;
  std::uint32_t vertices = 0, triangles = 0;
  std::vector<DemoStripForm> forms;
  std::vector<DemoStripLevel> levels;  ///< from fine to coarse
  double seconds = 0;
};

/// Bytes a vertex of the full mesh.
[[nodiscard]] inline double per_vertex(std::uint64_t bytes, const DemoStrips& strips) {
  return static_cast<double>(bytes) / strips.vertices;
}

/// Builds, writes and checks every form for a planet, counts its indices, and draws the first.
/// Errors: of writing and drawing, and kCancelled.
[[nodiscard]] Result<DemoStrips> show_strips(const DemoPlace& place);

}  // namespace varifold::cli
