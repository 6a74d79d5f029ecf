// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <CLI/CLI.hpp>

namespace rhizodont::command_line {

/// Makes every option that takes a number take decimal numbers alone, in this command and those below it: 034 is 34,
/// and an empty word, 0x22, "nan" or "14,2" are wrong usage.
void take_decimal_numbers(CLI::App& app);

}  // namespace rhizodont::command_line
