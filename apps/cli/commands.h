// The commands of the tool: each adds itself to the command line.
#pragma once

#include <apps/cli/context.h>
#include <CLI/CLI.hpp>

namespace varifold::cli {

void add_generate(CLI::App& app, CommandRunner& runner);
void add_info(CLI::App& app, CommandRunner& runner);
void add_simplify(CLI::App& app, CommandRunner& runner);
void add_build(CLI::App& app, CommandRunner& runner);
void add_extract(CLI::App& app, CommandRunner& runner);
void add_check(CLI::App& app, CommandRunner& runner);
void add_render(CLI::App& app, CommandRunner& runner);
void add_bench(CLI::App& app, CommandRunner& runner);
void add_morph(CLI::App& app, CommandRunner& runner);
void add_demo(CLI::App& app, CommandRunner& runner);

}  // namespace varifold::cli
