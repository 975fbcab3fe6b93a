#include <varifold/io/resource_file.h>

#include <varifold/io/import_check.h>
#include <algorithm>

namespace varifold {

Result<MappedFile> open_resource(const std::filesystem::path& folder, std::string_view name) {
  std::string slashes(name);
  std::replace(slashes.begin(), slashes.end(), '\\', '/');
  const auto path = std::filesystem::path(slashes).lexically_normal();
  const auto bad = [&](std::string_view fault) {
    return fail(ErrorKind::kUnreadable, in_quotes(name) + " " + std::string(fault));
  };
  if (folder.empty()) return bad("cannot be looked for: the mesh has no folder");
  if (name.empty() || name.find('\0') != name.npos || !path.has_filename())
    return bad("is not a file name");
  if (path.is_absolute() || *path.begin() == "..") return bad("leads out of the file's folder");
  std::error_code error;
  const auto status = std::filesystem::status(folder / path, error);
  if (!std::filesystem::exists(status)) return bad("does not exist");
  if (!std::filesystem::is_regular_file(status)) return bad("is not a regular file");
  auto file = MappedFile::open(folder / path);
  if (!file) return bad("cannot be read");
  return file;
}

}  // namespace varifold
