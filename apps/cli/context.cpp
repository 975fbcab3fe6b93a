#include <apps/cli/context.h>
#include <fmt/format.h>
#include <sys/resource.h>
#include <unistd.h>
#include <atomic>
#include <cctype>
#include <cerrno>
#include <cmath>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <memory>
#include <mutex>
#include <new>

namespace varifold::cli {

ExitCode exit_code_of(ErrorKind kind) {
  switch (kind) {
    case ErrorKind::kInvalidInput:
    case ErrorKind::kUnsupported:
    case ErrorKind::kUnreadable:
      return kBadInput;
    case ErrorKind::kFailed:
    case ErrorKind::kCancelled:
      return kFailure;
  }
  return kFailure;
}

void wrong_usage(const std::string& message) {
  throw CLI::ParseError(message, static_cast<int>(kWrongUsage));
}

CLI::Validator finite_number() {
  const auto check = [](const std::string& text) {
    char* end = nullptr;
    const double value = std::strtod(text.c_str(), &end);
    // What is no number at all is for the conversion to say.
    if (end == text.c_str()) return std::string();
    const bool is_held = std::abs(value) <= std::numeric_limits<float>::max();
    return is_held ? std::string() : "'" + text + "' is not a finite number of single precision";
  };
  return {check, ""};
}

namespace {

std::string printable(const std::string& message) {
  std::string line;
  for (const char c : message) {
    const auto code = static_cast<unsigned char>(c);
    if (code < 0x20 || code == 0x7f)
      line += fmt::format("\\x{:02x}", code);
    else
      line += c;
  }
  return line;
}

volatile std::sig_atomic_t interrupt_flag = 0;

extern "C" void note_interrupt(int) { interrupt_flag = 1; }

// The one bar of the program; jobs run one after the other.
std::mutex bar_mutex;
bool bar_is_shown = false;

void wipe_bar() {
  if (!bar_is_shown) return;
  std::fputs("\r\033[K", stderr);
  bar_is_shown = false;
}

void draw_bar(const std::string& title, float done) {
  constexpr int kWidth = 32;
  const float part = done < 0 ? 0.0f : done > 1 ? 1.0f : done;
  const int filled = static_cast<int>(part * kWidth);
  const std::string line = fmt::format("\r\033[K[{}{}] {:3.0f} %  {}", std::string(filled, '#'),
                                       std::string(kWidth - filled, '.'), 100 * part, title);
  std::fputs(line.c_str(), stderr);
  std::fflush(stderr);
  bar_is_shown = true;
}

}  // namespace

void print_message(const std::string& message) {
  const std::lock_guard lock(bar_mutex);
  wipe_bar();
  const std::string line = printable(message) + "\n";
  std::fwrite(line.data(), 1, line.size(), stderr);
}

bool interrupted() { return interrupt_flag != 0; }

void catch_interrupts() {
  struct sigaction action {};
  action.sa_handler = note_interrupt;
  // The second Ctrl-C finds the system's own handler, which ends the program.
  action.sa_flags = SA_RESETHAND | SA_RESTART;
  sigemptyset(&action.sa_mask);
  (void)::sigaction(SIGINT, &action, nullptr);
  (void)::sigaction(SIGTERM, &action, nullptr);
}

Progress show_progress(const std::string& name) {
  using Clock = std::chrono::steady_clock;
  struct State {
    Clock::time_point start = Clock::now(), last = start;
  };
  const bool is_terminal = ::isatty(STDERR_FILENO) == 1;
  return [name = printable(name), is_terminal, state = std::make_shared<State>()](
             std::string_view stage, float done) {
    if (interrupted()) return false;
    if (!is_terminal) return true;
    // Stages may report from any thread.
    const std::lock_guard lock(bar_mutex);
    const auto now = Clock::now();
    if (now - state->start < std::chrono::seconds(1)) return true;
    if (now - state->last < std::chrono::milliseconds(100)) return true;
    state->last = now;
    draw_bar(fmt::format("{}: {}", name, stage), done);
    return true;
  };
}

void end_progress() {
  const std::lock_guard lock(bar_mutex);
  wipe_bar();
}

Result<void> check_interrupted(const std::filesystem::path& file) {
  if (!interrupted()) return {};
  return fail(ErrorKind::kCancelled, file.string() + ": cancelled");
}

namespace {

// Failures are told on stderr, and to scripts as an object too.
ExitCode tell_error(const Error& error, bool json) {
  const ExitCode code = exit_code_of(error.kind);
  print_message(error.message);
  if (json)
    (void)print_json({{"error", error.message}, {"exit_code", static_cast<int>(code)}}, stdout);
  return code;
}

CommandResult run_body(const std::function<CommandResult()>& body) {
  try {
    return body();
  } catch (const std::bad_alloc&) {
    return fail(ErrorKind::kFailed, "out of memory");
  } catch (const CLI::Error&) {
    throw;
  } catch (const std::exception& error) {
    return fail(ErrorKind::kFailed, std::string("internal error: ") + error.what());
  }
}

}  // namespace

void CommandRunner::add_common(CLI::App& command, CommonOptions& options, bool computes) const {
  command.add_flag("--json", options.json, "One JSON object on stdout instead of a table");
  if (!computes) return;
  command.add_option("--threads", options.threads, "Threads to use (default: all)")
      ->check(CLI::Range(1, 1024));
}

void CommandRunner::attach(CLI::App& command, CommonOptions& options,
                           std::function<CommandResult()> body) {
  command.callback([this, &options, body = std::move(body)] {
    const CommandResult result = run_body(body);
    end_progress();
    exit_code_ = result ? *result : tell_error(result.error(), options.json);
  });
}

namespace {

bool is_stdout(const std::filesystem::path& output) { return output == "/dev/stdout"; }

}  // namespace

CommandResult finish(const Report& report, const CommonOptions& options,
                     const std::filesystem::path& output) {
  end_progress();
  if (report.print(options.json, is_stdout(output) ? stderr : stdout)) return kDone;
  return fail(ErrorKind::kFailed, std::string("stdout: ") + std::strerror(errno));
}

Result<void> check_output(const std::filesystem::path& output, const CommonOptions& options) {
  if (options.json && is_stdout(output))
    wrong_usage("--json and the output file cannot both go to stdout");
  const auto folder = output.has_parent_path() ? output.parent_path() : std::filesystem::path(".");
  if (::access(folder.c_str(), W_OK) == 0 || ::access(output.c_str(), W_OK) == 0) return {};
  return fail(ErrorKind::kFailed, output.string() + ": " + std::strerror(errno));
}

std::string small_extension(const std::filesystem::path& path) {
  std::string extension = path.extension().string();
  for (char& c : extension) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return extension;
}

Result<void> check_output(const std::filesystem::path& output, const CommonOptions& options,
                          const char* extension) {
  const std::string named = small_extension(output);
  if (!named.empty() && named != extension)
    wrong_usage(output.string() + ": this is written as " + extension + " only, not as " + named);
  return check_output(output, options);
}

std::uint64_t peak_rss_bytes() {
  struct rusage usage {};
  (void)::getrusage(RUSAGE_SELF, &usage);
  return static_cast<std::uint64_t>(usage.ru_maxrss) * 1024;
}

}  // namespace varifold::cli
