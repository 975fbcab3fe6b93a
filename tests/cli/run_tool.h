// Runs the built tool as a user does.
#pragma once

#include <chrono>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace varifold::test {

struct ToolResult {
  int exit_code = -1;  ///< 128 + the signal that ended it; kTimedOut where it did not end
  std::string out, err;

  static constexpr int kTimedOut = 1000;
  /// stdout as one JSON object; discarded() where it is none.
  [[nodiscard]] nlohmann::json json() const { return nlohmann::json::parse(out, nullptr, false); }
};

struct ToolOptions {
  std::filesystem::path input;  ///< what stdin is; nothing by default
  std::chrono::milliseconds limit{60'000};
  int interrupt_after_ms = -1;  ///< sends SIGINT then
};

/// `arguments` follow the name of the tool.
[[nodiscard]] ToolResult run_tool(const std::vector<std::string>& arguments,
                                  const ToolOptions& options = {});

/// The lines of a text, without an empty one at its end.
[[nodiscard]] std::vector<std::string> lines_of(const std::string& text);

/// All bytes of a file; empty where there is none.
[[nodiscard]] std::string bytes_of(const std::filesystem::path& path);

}  // namespace varifold::test
