// Files that a mesh file names: material libraries, buffers.
#pragma once

#include <varifold/base/result.h>
#include <varifold/io/mapped_file.h>
#include <filesystem>
#include <string_view>

namespace varifold {

/// Opens the file `name`, written with slashes or backslashes, below `folder`. A mesh file may come
/// from anyone, so names cannot lead out of the folder, nor to anything but a regular file; with an
/// empty folder no file is opened at all.
/// Errors: kUnreadable, beginning with the name in quotes.
[[nodiscard]] Result<MappedFile> open_resource(const std::filesystem::path& folder,
                                               std::string_view name);

}  // namespace varifold
