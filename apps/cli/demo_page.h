// The page that shows a demo: one HTML file with everything in it.
#pragma once

#include <apps/cli/demo_tour.h>
#include <varifold/base/result.h>
#include <filesystem>
#include <string>

namespace varifold::cli {

/// The page as text. Pictures are read from the folder and put into the page.
[[nodiscard]] Result<std::string> demo_page(const DemoResult& result,
                                            const std::filesystem::path& folder);

}  // namespace varifold::cli
