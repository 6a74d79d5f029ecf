// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <CLI/CLI.hpp>

#include <string>
#include <vector>

namespace rhizodont::command_line {

/// An option or an argument of a command, as help, manual and shells need to know it.
struct DescribedOption {
  std::vector<std::string> names;    ///< "-o", "--output"; of an argument its name alone: "CROWN"
  std::string value;                 ///< what it takes: "TEXT", "NUMBER"; empty for a flag
  std::vector<std::string> choices;  ///< the words that it takes; empty: any
  bool takes_other_words = false;    ///< beside the choices, such as a number
  std::string text;                  ///< what it is for
  std::string default_value;         ///< empty: none
  bool is_required = false;
  bool is_repeated = false;        ///< it takes several values
  bool is_value_optional = false;  ///< it may stand without a value
};

/// A command with those below it.
struct DescribedCommand {
  std::vector<std::string> path;  ///< "rhizodont", "batch", "status"
  std::string text;               ///< what it does
  std::vector<DescribedOption> arguments, options;
  std::vector<DescribedCommand> commands;

  const std::string& name() const { return path.back(); }
};

/// What was defined, in the order of the definitions. `app`: the program.
DescribedCommand described(const CLI::App& app);

/// The command and all below it, each before its own.
std::vector<const DescribedCommand*> all_commands(const DescribedCommand& command);

/// The words of a command's path, with `between` between them.
std::string joined_path(const DescribedCommand& command, const std::string& between);

}  // namespace rhizodont::command_line
