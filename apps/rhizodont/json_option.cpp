// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "json_option.hpp"

#include "command_line/output_checks.hpp"

#include <fmt/core.h>

namespace rhizodont::command_line {

void JsonOption::add_to(CLI::App& command) {
  option_ = command.add_option("--json", file_, "Figures as JSON: to FILE, or to standard output (then give it last)")
                ->expected(0, 1)
                ->type_name("[FILE]");
}

bool JsonOption::has_file() const { return !file_.empty() && file_ != "-"; }

bool JsonOption::wants_table() const { return option_->count() == 0 || has_file(); }

std::vector<std::filesystem::path> JsonOption::outputs() const {
  if (!has_file()) return {};
  require_no_mesh_ending(file_, "a file of figures (--json)");
  return {file_};
}

std::vector<OutputFile> JsonOption::print_or_file(const nlohmann::ordered_json& json) const {
  if (option_->count() == 0) return {};
  // Names that are not UTF-8 must not stand in the way.
  const std::string text = json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
  if (has_file()) return {{file_, text}};
  fmt::print("{}", text);
  return {};
}

}  // namespace rhizodont::command_line
