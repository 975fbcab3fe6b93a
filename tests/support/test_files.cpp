#include <stdlib.h>
#include <unistd.h>

#include <tests/support/test_files.h>
#include <cstdlib>
#include <stdexcept>

namespace varifold::test {

namespace fs = std::filesystem;

std::optional<fs::path> real_mesh(const std::string& name) {
  const char* folder = std::getenv("VARIFOLD_MESHES");
  const fs::path root = folder ? fs::path(folder) : fs::path("../shared/meshes");
  std::error_code ignored;
  if (fs::exists(root / name, ignored)) return root / name;
  const fs::path packed = root / (name + ".gz");
  if (!fs::exists(packed, ignored)) return std::nullopt;

  // Unpack beside the other build products, under a name that appears only when it is whole.
  const fs::path folder_out = fs::path("build") / "meshes";
  const fs::path unpacked = folder_out / name;
  if (fs::exists(unpacked, ignored)) return unpacked;
  fs::create_directories(folder_out, ignored);
  const fs::path part = folder_out / (name + "." + std::to_string(getpid()));
  const std::string command = "gzip -dc '" + packed.string() + "' > '" + part.string() + "'";
  if (std::system(command.c_str()) != 0) return std::nullopt;
  fs::rename(part, unpacked, ignored);
  return unpacked;
}

TemporaryFolder::TemporaryFolder() {
  std::string pattern = (fs::temp_directory_path() / "varifold-XXXXXX").string();
  if (!mkdtemp(pattern.data())) throw std::runtime_error("no temporary folder");
  path_ = pattern;
}

TemporaryFolder::~TemporaryFolder() {
  std::error_code ignored;
  fs::remove_all(path_, ignored);
}

}  // namespace varifold::test
