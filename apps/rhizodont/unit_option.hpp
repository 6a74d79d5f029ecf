// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <CLI/CLI.hpp>

#include <string>

namespace rhizodont::command_line {

/// The option --unit. @param millimetres_per_unit  what it sets; must outlive the parsing
void add_unit_option(CLI::App& app, double& millimetres_per_unit, const std::string& description);

}  // namespace rhizodont::command_line
