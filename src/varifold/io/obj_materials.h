// Material files (.mtl) of OBJ.
#pragma once

#include <varifold/io/obj.h>
#include <varifold/mesh/triangle_mesh.h>
#include <cstddef>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

namespace varifold::obj {

/// The materials of any number of material files, by name; of one name the first counts.
class MaterialLibrary {
 public:
  /// Reads newmtl, Kd, Ke, d, Tr, Pm, Pr, map_Kd, map_Ke and norm; skips the rest. Numbers that
  /// are not readable leave the default.
  void add(std::string_view file);

  /// Appends the material, and its images where these are new, to the mesh. False, with a material
  /// of that name and nothing else, where no file has it.
  bool append_to(TriangleMesh& mesh, const std::string& name);

 private:
  struct Entry {
    Material material;
    std::array<std::string, static_cast<std::size_t>(TextureUse::kCount)> textures;
  };
  void read_line(std::string_view keyword, std::string_view rest, Entry& entry);

  std::unordered_map<std::string, Entry> entries_;
  std::unordered_map<std::string, std::uint32_t> images_;  ///< by uri
};

/// The materials of a mesh as a material file, under the names `names`; images with bytes are
/// listed in `images` under names that begin with `stem`.
[[nodiscard]] std::vector<std::byte> write_materials(const TriangleMesh& mesh,
                                                     const std::vector<std::string>& names,
                                                     std::string_view stem,
                                                     std::vector<ObjFiles::ImageFile>& images);

}  // namespace varifold::obj
