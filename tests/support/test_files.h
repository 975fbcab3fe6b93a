// Where tests find real meshes, and a folder of their own to write to.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

namespace varifold::test {

/// The file of that name in the folder of real meshes (VARIFOLD_MESHES, default ../shared/meshes
/// beside the checkout), unpacked where it is gzipped; nothing where the folder or file is missing.
[[nodiscard]] std::optional<std::filesystem::path> real_mesh(const std::string& name);

/// A fresh, empty folder for the running test, below the system's temporary folder; removed when
/// the object goes.
class TemporaryFolder {
 public:
  TemporaryFolder();
  ~TemporaryFolder();
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  [[nodiscard]] std::filesystem::path file(const std::string& name) const { return path_ / name; }

 private:
  std::filesystem::path path_;
};

}  // namespace varifold::test

/// Binds `variable` to the path of a real mesh, or skips the test, saying so.
#define VARIFOLD_REAL_MESH_OR_SKIP(variable, name)                       \
  const auto variable##_found = ::varifold::test::real_mesh(name);       \
  if (!variable##_found) GTEST_SKIP() << "real mesh not here: " << name; \
  const std::filesystem::path variable = *variable##_found
