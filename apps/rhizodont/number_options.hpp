// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <CLI/CLI.hpp>

#include <string>

namespace rhizodont::command_line {

/// Makes every option that takes a number take decimal numbers alone, in this command and those below it: 034 is 34,
/// and an empty word, 0x22, "nan" or "14,2" are wrong usage.
void take_decimal_numbers(CLI::App& app);

/// Millimetres of a unit by any of its usual names, in upper or lower case: mm, millimetres, cm, m, um, µm, microns,
/// in, inch, inches. Throws UsageError for another.
double millimetres_per_unit(const std::string& name);

}  // namespace rhizodont::command_line
