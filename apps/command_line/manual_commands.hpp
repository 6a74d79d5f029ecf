// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "command_line/program.hpp"

namespace rhizodont::command_line {

/// The commands `shell-completion SHELL` and `manual`, which every program has: both are made from the definitions of
/// its commands, so that they say what the program does. `app` and `program` must outlive the parsing.
void add_manual_commands(CLI::App& app, const Program& program);

}  // namespace rhizodont::command_line
