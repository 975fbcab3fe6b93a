// What all commands share: messages, progress bars, Ctrl-C, exit codes.
#pragma once

#include <apps/cli/report.h>
#include <varifold/base/progress.h>
#include <varifold/base/result.h>
#include <CLI/CLI.hpp>
#include <chrono>
#include <filesystem>
#include <functional>
#include <string>

namespace varifold::cli {

/// Scripts depend on these.
enum ExitCode : int {
  kDone = 0,
  kFailure = 1,     ///< the job failed, or a check found faults
  kWrongUsage = 2,  ///< options that do not exist or do not fit together
  kBadInput = 3,    ///< a file that cannot be read, or that is malformed
};

[[nodiscard]] ExitCode exit_code_of(ErrorKind kind);

/// The options that every command has.
struct CommonOptions {
  bool json = false;
  int threads = 0;  ///< 0 = all
};

/// To be thrown while options are looked at: ends the program with kWrongUsage.
[[noreturn]] void wrong_usage(const std::string& message);

/// For options that take a number: refuses nan, infinities, and what single precision cannot hold.
[[nodiscard]] CLI::Validator finite_number();

/// One line to stderr. Control characters, as hostile files may bring them, are made visible.
void print_message(const std::string& message);

/// True once Ctrl-C was pressed; a second time ends the program at once.
[[nodiscard]] bool interrupted();
void catch_interrupts();

/// Progress for a long job: a bar on stderr when that is a terminal and the job takes more than a
/// second; cancels on Ctrl-C. `name` (of the file) is put before the stage.
[[nodiscard]] Progress show_progress(const std::string& name);
/// Wipes the bar of show_progress() off the terminal.
void end_progress();

/// The error of a job that Ctrl-C stopped between two of its stages; nothing otherwise.
[[nodiscard]] Result<void> check_interrupted(const std::filesystem::path& file);

/// A command's main function: what it did, or why it could not.
using CommandResult = Result<ExitCode>;

/// Adds --json and --threads and runs `body` when the command was given.
class CommandRunner {
 public:
  /// `options` and whatever `body` refers to must live until the command line is parsed.
  void attach(CLI::App& command, CommonOptions& options, std::function<CommandResult()> body);
  void add_common(CLI::App& command, CommonOptions& options, bool computes) const;
  [[nodiscard]] ExitCode exit_code() const { return exit_code_; }

 private:
  ExitCode exit_code_ = kDone;
};

/// Prints the report, on stderr where the job's output goes to stdout.
[[nodiscard]] CommandResult finish(const Report& report, const CommonOptions& options,
                                   const std::filesystem::path& output = {});

/// Refuses, before the work begins, an output that could not be written at its end, and JSON on a
/// stdout that the output goes to.
[[nodiscard]] Result<void> check_output(const std::filesystem::path& output,
                                        const CommonOptions& options);
/// The same, and wrong usage where the name says another format than `extension`, such as ".vfm".
/// Names that say none, as of devices, are good.
[[nodiscard]] Result<void> check_output(const std::filesystem::path& output,
                                        const CommonOptions& options, const char* extension);

/// The extension of a path in small letters.
[[nodiscard]] std::string small_extension(const std::filesystem::path& path);

/// The most memory that the program had so far.
[[nodiscard]] std::uint64_t peak_rss_bytes();

/// Seconds since it was made.
class Stopwatch {
 public:
  [[nodiscard]] double seconds() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

}  // namespace varifold::cli
