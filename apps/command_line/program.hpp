// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <CLI/CLI.hpp>

#include <string>
#include <utility>
#include <vector>

namespace rhizodont::command_line {

/// A program of several commands.
struct Program {
  std::string name;                           ///< as it is called and as it names itself before an error's sentence
  std::string purpose;                        ///< a sentence at the top of its help
  std::vector<void (*)(CLI::App&)> commands;  ///< each adds its subcommand, in the order of the help
  std::string default_command;                ///< what a file's name as the first word was probably meant for; or empty
  /// Variables of the environment that it heeds beside NO_COLOR, and what each is for.
  std::vector<std::pair<std::string, std::string>> environment = {};
};

/// What the codes that a program ends with mean.
std::vector<std::pair<int, std::string>> exit_codes();

/// Parses the words and runs the command that they name; errors go to standard error as one line. Returns the exit
/// code.
int run_program(const Program& program, int argc, char** argv);

/// Ends a command with a code where everything to be said has been printed.
[[noreturn]] inline void exit_with(int code) { throw CLI::RuntimeError(code); }

}  // namespace rhizodont::command_line
