#include <fcntl.h>
#include <signal.h>
#include <sys/wait.h>
#include <tests/cli/run_tool.h>
#include <tests/support/test_files.h>
#include <unistd.h>
#include <fstream>
#include <iterator>
#include <sstream>
#include <thread>

namespace varifold::test {

namespace {

using Clock = std::chrono::steady_clock;

void redirect(const std::filesystem::path& path, int flags, int to) {
  const int file = ::open(path.c_str(), flags, 0600);
  if (file < 0 || ::dup2(file, to) < 0) ::_exit(126);
}

int wait_for(pid_t child, const ToolOptions& options) {
  const auto start = Clock::now();
  bool is_interrupted = options.interrupt_after_ms < 0;
  int status = 0;
  while (::waitpid(child, &status, WNOHANG) == 0) {
    const auto passed = Clock::now() - start;
    if (!is_interrupted && passed > std::chrono::milliseconds(options.interrupt_after_ms)) {
      ::kill(child, SIGINT);
      is_interrupted = true;
    }
    if (passed > options.limit) {
      ::kill(child, SIGKILL);
      ::waitpid(child, &status, 0);
      return ToolResult::kTimedOut;
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

}  // namespace

ToolResult run_tool(const std::vector<std::string>& arguments, const ToolOptions& options) {
  const TemporaryFolder folder;
  const auto out = folder.file("out"), err = folder.file("err");
  std::vector<std::string> words{VARIFOLD_TOOL};
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<char*> pointers;
  pointers.reserve(words.size() + 1);
  for (std::string& word : words) pointers.push_back(word.data());
  pointers.push_back(nullptr);

  ToolResult result;
  const pid_t child = ::fork();
  if (child == 0) {
    redirect(options.input.empty() ? "/dev/null" : options.input, O_RDONLY, STDIN_FILENO);
    redirect(out, O_WRONLY | O_CREAT, STDOUT_FILENO);
    redirect(err, O_WRONLY | O_CREAT, STDERR_FILENO);
    ::execv(pointers[0], pointers.data());
    ::_exit(127);
  }
  if (child < 0) return result;
  result.exit_code = wait_for(child, options);
  result.out = bytes_of(out);
  result.err = bytes_of(err);
  return result;
}

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

std::string bytes_of(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

}  // namespace varifold::test
