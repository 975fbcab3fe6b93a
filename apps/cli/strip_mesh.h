// A level of a model as strips, for mesh files that can hold them.
#pragma once

#include <varifold/mesh/triangle_mesh.h>
#include <varifold/strip/triangle_strips.h>
#include <varifold/view/draw_list.h>
#include <CLI/CLI.hpp>
#include <filesystem>
#include <optional>
#include <string>

namespace varifold::cli {

/// The same triangles twice: in the mesh, and as strips over its vertices.
struct StripMesh {
  TriangleMesh mesh;
  JoinedStrips strips;
};

/// --strips: empty for triangles, else restart or degenerate.
void add_strips_option(CLI::App& command, std::string& how);
/// Nothing for triangles. Wrong usage where the format of `output` cannot hold such strips.
[[nodiscard]] std::optional<StripJoin> strip_join(const std::string& how,
                                                  const std::filesystem::path& output);

/// The strips of a draw list; `attributes` has the materials and images. Vertices that no strip has
/// are left out. O(vertices + indices).
[[nodiscard]] StripMesh drawn_strips(const DrawList& list, const TriangleMesh& attributes,
                                     StripJoin join);
/// Strips made for a mesh by stripify().
[[nodiscard]] StripMesh new_strips(TriangleMesh mesh, StripJoin join);

}  // namespace varifold::cli
