// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "rhizodont/error.hpp"

#include <exception>
#include <optional>
#include <string>
#include <vector>

namespace rhizodont::command_line {

/// The word that was probably meant: one that begins so, or the one from which the fewest letters are wrong, missing,
/// too many or swapped, at most every third. Nothing if there is none or two are as near.
std::optional<std::string> closest_word(const std::string& word, const std::vector<std::string>& known);

/// An error as one line: its sentence and at most three of the ids concerned. `where_all_are`: how to get at the
/// others, such as "see report.json"; may be empty.
std::string error_line(const Error& error, const std::string& where_all_are = {});

/// What no error of the library's kinds says: no memory, or a fault of the program.
std::string fault_line(const std::exception& fault);

}  // namespace rhizodont::command_line
