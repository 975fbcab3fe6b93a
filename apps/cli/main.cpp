// varifold: continuous level of detail of triangle meshes, from the command line.
#include <apps/cli/commands.h>
#include <algorithm>
#include <cstring>
#include <string>
#include <vector>

namespace varifold::cli {
namespace {

void add_commands(CLI::App& app, CommandRunner& runner) {
  app.require_subcommand(1);
  app.set_version_flag("--version", "varifold " VARIFOLD_VERSION);
  add_generate(app, runner);
  add_info(app, runner);
  add_simplify(app, runner);
  add_build(app, runner);
  add_extract(app, runner);
  add_check(app, runner);
  add_render(app, runner);
  add_bench(app, runner);
  add_morph(app, runner);
  add_demo(app, runner);
  app.footer(
      "Exit codes: 0 done; 1 the job failed, or a check found faults; 2 wrong usage;\n"
      "3 unreadable or invalid input. `varifold COMMAND --help` tells the options of a command.");
}

// The command line is not understood, so neither is whether it wants JSON; look for ourselves.
bool wants_json(int argc, char** argv) {
  for (int i = 1; i < argc; ++i)
    if (std::strcmp(argv[i], "--json") == 0) return true;
  return false;
}

// CLI11 says no more of an unknown command, or kind of `build`, than that one is required.
std::string explain(const CLI::App& app, const std::vector<std::string>& arguments,
                    const CLI::ParseError& error) {
  const std::string first = arguments.empty() ? "" : arguments[0];
  if (first.empty() || first[0] == '-') return error.what();
  const auto is_named = [](const CLI::App* command, const std::string& name) {
    return command->check_name(name);
  };
  const auto commands = app.get_subcommands({});
  const auto command = std::find_if(commands.begin(), commands.end(),
                                    [&](const CLI::App* c) { return is_named(c, first); });
  if (command == commands.end()) return "no command '" + first + "'";
  // Groups of options have no name.
  const auto kinds =
      (*command)->get_subcommands([](const CLI::App* kind) { return !kind->get_name().empty(); });
  if (kinds.empty()) return error.what();
  std::string known;
  for (const CLI::App* const kind : kinds) {
    if (arguments.size() > 1 && is_named(kind, arguments[1])) return error.what();
    known += (known.empty() ? "" : ", ") + kind->get_name();
  }
  const std::string named = arguments.size() > 1 ? "no kind '" + arguments[1] + "'" : "which kind?";
  return first + ": " + named + "; known are " + known;
}

ExitCode tell_usage(const std::string& message, bool json) {
  print_message("varifold: " + message + " (see --help)");
  if (json)
    (void)print_json({{"error", message}, {"exit_code", static_cast<int>(kWrongUsage)}}, stdout);
  return kWrongUsage;
}

int run(int argc, char** argv) {
  CLI::App app("Continuous level of detail of triangle meshes.", "varifold");
  CommandRunner runner;
  add_commands(app, runner);
  catch_interrupts();
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    // --help and --version come this way too.
    if (error.get_exit_code() == 0) return app.exit(error);
    end_progress();
    return tell_usage(explain(app, {argv + 1, argv + argc}, error), wants_json(argc, argv));
  }
  return runner.exit_code();
}

}  // namespace
}  // namespace varifold::cli

int main(int argc, char** argv) { return varifold::cli::run(argc, argv); }
