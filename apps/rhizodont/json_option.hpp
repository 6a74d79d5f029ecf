// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include <optional>
#include <string>

namespace rhizodont::command_line {

/// The option `--json [FILE]`: figures as JSON to a file, or to standard output instead of the table.
class JsonOption {
 public:
  void add_to(CLI::App& command);

  /// True if the table is to be printed: no --json, or --json with a file.
  bool wants_table() const;

  /// Writes where the user asked; does nothing without the option.
  void write(const nlohmann::ordered_json& json) const;

 private:
  CLI::Option* option_ = nullptr;
  std::string file_;
};

}  // namespace rhizodont::command_line
