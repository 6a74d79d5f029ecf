// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <CLI/CLI.hpp>

namespace rhizodont::command_line {

// Each command is one file command_<name>.cpp that defines `void add_<name>_command(CLI::App& app)`: it adds its
// subcommand with options and a callback. The names stand in this folder's CMakeLists.txt, from which
// `command_list.inc` is written.
//
// A callback ends by returning (exit code 0), by throwing rhizodont::Error (its code; the sentence goes to
// stderr), or by `exit_with(code)` where everything to be said has been printed.

#define RHIZODONT_COMMAND(name) void add_##name##_command(CLI::App& app);
#include "command_list.inc"
#undef RHIZODONT_COMMAND

[[noreturn]] inline void exit_with(int code) { throw CLI::RuntimeError(code); }

}  // namespace rhizodont::command_line
