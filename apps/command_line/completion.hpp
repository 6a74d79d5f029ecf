// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "command_line/described_command.hpp"

#include <string>

namespace rhizodont::command_line {

// Scripts with which a shell completes a program's words: commands, options, and the words that an option takes; where
// anything else is to be given, names of files.

std::string bash_completion(const DescribedCommand& program);
std::string zsh_completion(const DescribedCommand& program);
std::string fish_completion(const DescribedCommand& program);

}  // namespace rhizodont::command_line
