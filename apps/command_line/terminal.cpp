// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "command_line/terminal.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cstdlib>
#include <string_view>

namespace rhizodont::command_line {
namespace {

std::string_view environment(const char* name) {
  const char* value = std::getenv(name);
  return value == nullptr ? "" : value;
}

int number_of(TextColour colour) {
  switch (colour) {
    case TextColour::red:
      return 31;
    case TextColour::green:
      return 32;
    case TextColour::yellow:
      break;
  }
  return 33;
}

}  // namespace

bool is_terminal(std::FILE* stream) { return isatty(fileno(stream)) != 0; }

std::string coloured(std::FILE* stream, TextColour colour, const std::string& text) {
  if (!is_terminal(stream) || !environment("NO_COLOR").empty() || environment("TERM") == "dumb") return text;
  return fmt::format("\033[{}m{}\033[0m", number_of(colour), text);
}

void print_error(const std::string& program, const std::string& sentence) {
  fmt::print(stderr, "{} {}\n", coloured(stderr, TextColour::red, program + ":"), sentence);
}

}  // namespace rhizodont::command_line
