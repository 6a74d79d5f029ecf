// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "command_line/output_options.hpp"

#include "command_line/output_checks.hpp"

#include <fmt/core.h>

namespace rhizodont::command_line {
namespace {

constexpr const char* verbose_name = "--verbose";

std::string text_of_figures(const nlohmann::ordered_json& figures) {
  // Names that are not UTF-8 must not stand in the way.
  return figures.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

}  // namespace

void OutputOptions::add_to(CLI::App& command) {
  CLI::Option* quiet = command.add_flag("--quiet", quiet_, "Print nothing but errors, and what was asked for by name");
  command.add_flag(verbose_name, verbose_, "Say on standard error what is done, with time and memory")->excludes(quiet);
}

void OutputOptions::add_with_figures_to(CLI::App& command) {
  json_ = command.add_option("--json", file_, "Figures as JSON: to FILE, or to standard output (then give it last)")
              ->expected(0, 1)
              ->type_name("[FILE]");
  add_to(command);
}

bool OutputOptions::wants_figures() const { return json_ != nullptr && json_->count() > 0; }

bool OutputOptions::has_file() const { return !file_.empty() && file_ != "-"; }

bool OutputOptions::prints_figures() const { return wants_figures() && !has_file(); }

void OutputOptions::tell(const std::string& line) const {
  if (wants_words()) fmt::print("{}\n", line);
}

void OutputOptions::detail(const std::string& line) const {
  if (verbose_) fmt::print(stderr, "{}\n", line);
}

std::vector<std::filesystem::path> OutputOptions::outputs() const {
  if (!has_file()) return {};
  require_no_mesh_ending(file_, "a file of figures (--json)");
  return {file_};
}

std::vector<OutputFile> OutputOptions::figures_file(const nlohmann::ordered_json& figures) const {
  if (!has_file()) return {};
  return {{file_, text_of_figures(figures)}};
}

void OutputOptions::print_figures(const nlohmann::ordered_json& figures) const {
  if (prints_figures()) fmt::print("{}", text_of_figures(figures));
}

std::vector<OutputFile> OutputOptions::print_or_file(const nlohmann::ordered_json& figures) const {
  print_figures(figures);
  return figures_file(figures);
}

bool is_verbose(const CLI::App& app) {
  for (const CLI::App* command : app.get_subcommands()) {
    const CLI::Option* verbose = command->get_option_no_throw(verbose_name);
    if ((verbose != nullptr && verbose->count() > 0) || is_verbose(*command)) return true;
  }
  return false;
}

}  // namespace rhizodont::command_line
