// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "command_line/progress_line.hpp"

#include "command_line/terminal.hpp"

#include <fmt/core.h>

#include <cstdio>

namespace rhizodont::command_line {

ProgressLine::ProgressLine(const OutputOptions& output)
    : kept_(output.is_verbose()), replaced_(!kept_ && !output.is_quiet() && is_terminal(stderr)) {}

void ProgressLine::say(const std::string& text) {
  if (kept_) fmt::print(stderr, "{}\n", text);
  if (!replaced_) return;
  fmt::print(stderr, "\r\033[K{}", text);
  std::fflush(stderr);
  is_there_ = true;
}

void ProgressLine::clear() {
  if (!is_there_) return;
  fmt::print(stderr, "\r\033[K");
  std::fflush(stderr);
  is_there_ = false;
}

}  // namespace rhizodont::command_line
