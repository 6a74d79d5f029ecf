// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "command_line/output_options.hpp"

#include <string>

namespace rhizodont::command_line {

/// What is at work, on standard error: on a terminal one line that the next one replaces; with --verbose a line for
/// each, wherever they go; else, and with --quiet, nothing. It is gone when its object is.
class ProgressLine {
 public:
  explicit ProgressLine(const OutputOptions& output);
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;
  ~ProgressLine() { clear(); }

  /// Whether anything is said at all: if not, callbacks need not be given.
  bool is_shown() const { return kept_ || replaced_; }
  void say(const std::string& text);
  /// Takes the line away, so that something else may be printed.
  void clear();

 private:
  bool kept_, replaced_;
  bool is_there_ = false;
};

}  // namespace rhizodont::command_line
