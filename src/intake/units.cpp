// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "intake/units.hpp"

#include "base/lower_case.hpp"
#include "rhizodont/complete.hpp"
#include "rhizodont/error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string>

namespace rhizodont {

const std::vector<Unit>& known_units() {
  static const std::vector<Unit> units{
      {"millimetres", "mm", 1, {"millimetre", "millimeter"}},
      {"micrometres", "um", 1e-3, {"\u00b5m", "\u03bcm", "micrometre", "micrometer", "micron"}},
      {"centimetres", "cm", 10, {"centimetre", "centimeter"}},
      {"inches", "in", 25.4, {"inch", "inche", "\""}},
      {"metres", "m", 1000, {"metre", "meter"}}};
  return units;
}

std::string unit_in_words(double millimetres_per_unit) {
  for (const Unit& unit : known_units())
    if (unit.millimetres == millimetres_per_unit) return unit.name;
  return fmt::format("{} mm", millimetres_per_unit);
}

double millimetres_per_unit(const std::string& name) {
  std::string word;
  for (const char c : lower_case(name))
    if (c != ' ' && c != '.') word += c;
  const std::string singular = word.size() > 3 && word.ends_with('s') ? word.substr(0, word.size() - 1) : word;
  for (const Unit& unit : known_units())
    if (word == unit.option || std::any_of(unit.spellings.begin(), unit.spellings.end(), [&](const char* spelling) {
          return word == spelling || singular == spelling;
        }))
      return unit.millimetres;
  if (!word.empty() && word.find_first_not_of("0123456789") == std::string::npos)
    throw UsageError(fmt::format("--unit takes a name, not the number {}: mm, cm, m, um or in (inches).", name));
  throw UsageError(fmt::format("--unit: '{}' is none of mm, cm, m, um and in (inches).", name));
}

}  // namespace rhizodont
