// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "unit_option.hpp"

#include "rhizodont/units.hpp"

namespace rhizodont::command_line {

void add_unit_option(CLI::App& app, double& millimetres_per_unit, const std::string& description) {
  app.add_option_function<std::string>(
         "--unit",
         [&millimetres_per_unit](const std::string& name) {
           millimetres_per_unit = rhizodont::millimetres_per_unit(name);
         },
         description)
      ->type_name("TEXT:{mm,cm,m,um,in,...}")
      ->default_str("mm");
}

}  // namespace rhizodont::command_line
