// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "json_option.hpp"

#include "rhizodont/io.hpp"

#include <fmt/core.h>

namespace rhizodont::command_line {

void JsonOption::add_to(CLI::App& command) {
  option_ = command.add_option("--json", file_, "Figures as JSON: to FILE, or to standard output (then give it last)")
                ->expected(0, 1)
                ->type_name("[FILE]");
}

bool JsonOption::wants_table() const { return option_->count() == 0 || !file_.empty(); }

void JsonOption::write(const nlohmann::ordered_json& json) const {
  if (option_->count() == 0) return;
  const std::string text = json.dump(2) + "\n";
  if (file_.empty())
    fmt::print("{}", text);
  else
    write_file_atomically(file_, text);
}

}  // namespace rhizodont::command_line
