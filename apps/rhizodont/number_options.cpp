// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "number_options.hpp"

#include "rhizodont/error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>

namespace rhizodont::command_line {
namespace {

template <class Number>
bool read_decimal(std::string_view text, Number& value) {
  if (text.starts_with('+')) text.remove_prefix(1);
  if (text.starts_with('+') || text.empty()) return false;
  const auto [end, failure] = std::from_chars(text.data(), text.data() + text.size(), value);
  return failure == std::errc() && end == text.data() + text.size();
}

/// Written anew without leading zeros, which CLI11 would take for octal.
std::string decimal_integer(std::string& text) {
  long long value = 0;
  if (!read_decimal(text, value)) return fmt::format("'{}' is not a whole number", text);
  text = std::to_string(value);
  return {};
}

std::string decimal_number(std::string& text) {
  double value = 0;
  if (read_decimal(text, value) && std::isfinite(value)) return {};
  return fmt::format("'{}' is not a number{}", text,
                     text.find(',') != std::string::npos ? ": write a point, not a comma" : "");
}

/// An empty word is a slip: a variable of the shell that was not set.
std::string some_word(const std::string& text) {
  return text.empty() ? "it needs a word, and an empty one was given" : "";
}

}  // namespace

void take_decimal_numbers(CLI::App& app) {
  for (CLI::Option* option : app.get_options()) {
    const std::string type = option->get_type_name();
    if (type.starts_with("INT") || type.starts_with("UINT")) option->transform(CLI::Validator(decimal_integer, ""));
    if (type.starts_with("TEXT")) option->check(CLI::Validator(some_word, ""));
    if (type.starts_with("FLOAT")) option->transform(CLI::Validator(decimal_number, ""));
  }
  for (CLI::App* command : app.get_subcommands([](CLI::App*) { return true; })) take_decimal_numbers(*command);
}

double millimetres_per_unit(const std::string& name) {
  static const std::map<std::string, double> units{
      {"mm", 1},          {"millimetre", 1},    {"millimeter", 1},    {"cm", 10},      {"centimetre", 10},
      {"centimeter", 10}, {"m", 1000},          {"metre", 1000},      {"meter", 1000}, {"in", 25.4},
      {"inch", 25.4},     {"inche", 25.4},      {"\"", 25.4},         {"um", 1e-3},    {"\u00b5m", 1e-3},
      {"\u03bcm", 1e-3},  {"micrometre", 1e-3}, {"micrometer", 1e-3}, {"micron", 1e-3}};
  std::string word;
  for (const char c : name)
    if (c != ' ' && c != '.') word += c >= 'A' && c <= 'Z' ? static_cast<char>(c + ('a' - 'A')) : c;
  auto unit = units.find(word);
  if (unit == units.end() && word.size() > 3 && word.ends_with('s')) unit = units.find(word.substr(0, word.size() - 1));
  if (unit != units.end()) return unit->second;
  double number = 0;
  if (read_decimal(name, number))
    throw UsageError(fmt::format("--unit takes a name, not the number {}: mm, cm, m, um or in (inches).", name));
  throw UsageError(fmt::format("--unit: '{}' is none of mm, cm, m, um and in (inches).", name));
}

}  // namespace rhizodont::command_line
