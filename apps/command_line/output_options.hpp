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

/// What a command says and how: --quiet and --verbose, which every command has, and --json [FILE], which every command
/// with figures has. It must outlive the command.
class OutputOptions {
 public:
  void add_to(CLI::App& command);
  void add_with_figures_to(CLI::App& command);

  bool is_quiet() const { return quiet_; }
  bool is_verbose() const { return verbose_; }
  /// Whether figures were asked for as JSON.
  bool wants_figures() const;
  /// Whether JSON goes to standard output, which then has nothing else.
  bool prints_figures() const;
  /// Whether results are told in words or tables on standard output: neither --quiet nor JSON there.
  bool wants_words() const { return !quiet_ && !prints_figures(); }

  /// A line of such words.
  void tell(const std::string& line) const;
  /// A line on standard error for those who asked for details (--verbose).
  void detail(const std::string& line) const;

  /// The file of figures to be written, if any. Throws UsageError for the name of a mesh.
  std::vector<std::filesystem::path> outputs() const;
  /// That file with its contents, if any.
  std::vector<OutputFile> figures_file(const nlohmann::ordered_json& figures) const;
  /// The figures on standard output, if they are to be there.
  void print_figures(const nlohmann::ordered_json& figures) const;
  /// Both.
  std::vector<OutputFile> print_or_file(const nlohmann::ordered_json& figures) const;

 private:
  bool has_file() const;

  CLI::Option* json_ = nullptr;
  std::string file_;
  bool quiet_ = false, verbose_ = false;
};

/// Whether the command that was parsed was asked for details.
bool is_verbose(const CLI::App& app);

}  // namespace rhizodont::command_line
