// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "completion/type_table.hpp"

#include "rhizodont/error.hpp"
#include "teeth/fdi.hpp"

#include <fmt/format.h>

#include <cmath>
#include <sstream>

namespace rhizodont {
namespace {

constexpr const char* version = "1";

[[noreturn]] void refuse(const std::string& name) {
  throw InputError(fmt::format("The weight file's {} cannot be read: it is no table of tooth types.", name));
}

}  // namespace

std::string type_table_text(const TypeTable& table) {
  std::string text = version;
  for (const auto& [fdi, numbers] : table) {
    text += fmt::format("; {}", fdi);
    for (const double number : numbers) text += fmt::format(" {:.4f}", number);
  }
  return text;
}

TypeTable read_type_table(const std::string& text, std::size_t columns, const std::string& name) {
  std::istringstream entries(text);
  std::string entry;
  if (!std::getline(entries, entry, ';')) refuse(name);
  if (entry != version)
    throw InputError(fmt::format(
        "The weight file's {} has the form \"{}\", which this version does not know: take a newer one.", name, entry));
  TypeTable table;
  while (std::getline(entries, entry, ';')) {
    std::istringstream fields(entry);
    int fdi = 0;
    std::vector<double> numbers;
    if (!(fields >> fdi) || !is_permanent_tooth(fdi) || is_right_side(fdi)) refuse(name);
    for (double number = 0; fields >> number;) {
      if (!std::isfinite(number)) refuse(name);
      numbers.push_back(number);
    }
    if (!fields.eof() || numbers.size() != columns || !table.emplace(fdi, std::move(numbers)).second) refuse(name);
  }
  return table;
}

}  // namespace rhizodont
