// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdio>
#include <string>

namespace rhizodont::command_line {

/// Whether a person sees what is written there as it is written.
bool is_terminal(std::FILE* stream);

enum class TextColour { red, green, yellow };

/// The text in a colour where `stream` is a terminal that has colours: NO_COLOR (https://no-color.org) is not set or
/// empty and TERM is not "dumb". Else the text as it is.
std::string coloured(std::FILE* stream, TextColour colour, const std::string& text);

/// "PROGRAM: SENTENCE" on standard error: how every error is said.
void print_error(const std::string& program, const std::string& sentence);

}  // namespace rhizodont::command_line
