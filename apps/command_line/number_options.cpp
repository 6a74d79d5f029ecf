// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "command_line/number_options.hpp"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <string>
#include <string_view>

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

/// CLI11 would take one below zero for a very large one.
std::string decimal_natural_number(std::string& text) {
  std::string wrong = decimal_integer(text);
  if (wrong.empty() && text.starts_with('-')) wrong = fmt::format("'{}' is below zero", text);
  return wrong;
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
    if (type.starts_with("INT")) option->transform(CLI::Validator(decimal_integer, ""));
    if (type.starts_with("UINT")) option->transform(CLI::Validator(decimal_natural_number, ""));
    if (type.starts_with("TEXT")) option->check(CLI::Validator(some_word, ""));
    if (type.starts_with("FLOAT")) option->transform(CLI::Validator(decimal_number, ""));
  }
  for (CLI::App* command : app.get_subcommands([](CLI::App*) { return true; })) take_decimal_numbers(*command);
}

}  // namespace rhizodont::command_line
