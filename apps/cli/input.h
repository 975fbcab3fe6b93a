// Files that commands read: meshes, prepared as asked, and models.
#pragma once

#include <apps/cli/context.h>
#include <varifold/base/result.h>
#include <varifold/io/imported_mesh.h>
#include <varifold/io/model_file.h>
#include <varifold/strip/triangle_strips.h>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

namespace varifold::cli {

/// "-" stands for the standard input and output.
[[nodiscard]] std::filesystem::path input_path(const std::string& argument);
[[nodiscard]] std::filesystem::path output_path(const std::string& argument);

/// True for a .vfm file, by its first bytes where it is a file that can be read twice, else by its
/// name. Standard input is taken for a model.
[[nodiscard]] bool is_model_file(const std::filesystem::path& path);

/// What happens to a mesh between reading and simplifying.
struct PrepareOptions {
  float weld = -1;                  ///< tolerance in model units; below 0: none
  std::vector<std::string> ignore;  ///< normals, texcoords, colors, materials
};
void add_prepare_options(CLI::App& command, PrepareOptions& options);

/// Gives vertices within the tolerance one position and drops what shall be ignored.
void prepare_mesh(TriangleMesh& mesh, const PrepareOptions& options);

/// Reads a mesh and tells its warnings on stderr.
[[nodiscard]] Result<ImportedMesh> read_mesh_loudly(const std::filesystem::path& path);
/// The same for jobs that need triangles: a mesh without any that has three
/// corners is invalid.
[[nodiscard]] Result<ImportedMesh> read_surface(const std::filesystem::path& path);

/// Writes a mesh by the extension of its path, and tells what the format could not hold. `strips`:
/// see write_mesh().
[[nodiscard]] Result<void> write_mesh_loudly(const TriangleMesh& mesh,
                                             const std::filesystem::path& path,
                                             const JoinedStrips* strips = nullptr);
/// check_output(), and that the extension is one that can be written.
[[nodiscard]] Result<void> check_mesh_output(const std::filesystem::path& path,
                                             const CommonOptions& options);

/// The attributes that a mesh has: ["normals", "texcoords", ...].
[[nodiscard]] std::vector<std::string> attribute_names(const TriangleMesh& mesh);
/// The names with commas between, or "none".
[[nodiscard]] std::string joined(const std::vector<std::string>& names);

}  // namespace varifold::cli
