// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <fmt/core.h>

#include <string>

namespace rhizodont::command_line {

/// A line of a table on standard output.
inline void print_table_row(const char* name, const std::string& value) { fmt::print("  {:<36}{}\n", name, value); }

}  // namespace rhizodont::command_line
