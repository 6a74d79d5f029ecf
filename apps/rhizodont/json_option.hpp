// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "rhizodont/output_files.hpp"

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include <filesystem>
#include <string>
#include <vector>

namespace rhizodont::command_line {

/// The option `--json [FILE]`: figures as JSON to a file, or to standard output instead of the table.
class JsonOption {
 public:
  void add_to(CLI::App& command);

  /// True if the table is to be printed: no --json, or --json with a file.
  bool wants_table() const;

  /// The file to be written, if any. Throws UsageError for the name of a mesh.
  std::vector<std::filesystem::path> outputs() const;

  /// That file with its contents, if any; to standard output it is printed.
  std::vector<OutputFile> print_or_file(const nlohmann::ordered_json& json) const;

 private:
  bool has_file() const;

  CLI::Option* option_ = nullptr;
  std::string file_;
};

}  // namespace rhizodont::command_line
