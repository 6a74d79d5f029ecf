// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "command_line/described_command.hpp"

#include <string>
#include <utility>
#include <vector>

namespace rhizodont::command_line {

/// What manual pages say beside what a command's definition does.
struct ManualOptions {
  std::string version;
  std::vector<std::pair<int, std::string>> exit_codes;
  std::vector<std::pair<std::string, std::string>> environment;  ///< variables, and what each is for
};

/// The manual's page of a command, for man (macros of section 7 of the manual, "man"). `program`: the command at the
/// top.
std::string manual_page(const DescribedCommand& command, const DescribedCommand& program, const ManualOptions& options);

/// "rhizodont-batch-status.1"
std::string manual_name(const DescribedCommand& command);

}  // namespace rhizodont::command_line
