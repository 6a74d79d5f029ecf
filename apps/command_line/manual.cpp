// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "command_line/manual.hpp"

#include <fmt/format.h>

namespace rhizodont::command_line {
namespace {

/// Text that roff takes as it stands: no escape, no request, no hyphen that becomes a dash.
std::string plain(const std::string& text) {
  std::string safe;
  for (const char c : text) {
    if (c == '\\') {
      safe += "\\e";
    } else if (c == '-') {
      safe += "\\-";
    } else if (c == '\'') {
      safe += "\\(aq";
    } else {
      safe += c;
    }
  }
  return safe.starts_with('.') ? "\\&" + safe : safe;
}

std::string bold(const std::string& text) { return "\\fB" + plain(text) + "\\fR"; }
std::string italic(const std::string& text) { return "\\fI" + plain(text) + "\\fR"; }

std::string value_text(const DescribedOption& option) {
  const bool is_argument = !option.names.front().starts_with('-');  // whose name stands for its value
  if (option.value.empty()) return "";
  if (is_argument && option.choices.empty()) return option.is_repeated ? " ..." : "";
  std::string value;
  if (option.choices.empty()) {
    value = italic(option.value);
  } else {
    for (const std::string& choice : option.choices) value += (value.empty() ? "" : "|") + bold(choice);
    if (option.takes_other_words) value += "|" + italic(option.value);
  }
  if (option.is_repeated) value += " ...";
  return option.is_value_optional ? " [" + value + "]" : " " + value;
}

std::string paragraph(const DescribedOption& option) {
  std::string names;
  for (const std::string& name : option.names) names += (names.empty() ? "" : ", ") + bold(name);
  std::string text = ".TP\n" + names + value_text(option) + "\n" + plain(option.text);
  if (!option.text.ends_with('.')) text += ".";
  if (option.is_required && option.names.front().starts_with('-')) text += " Must be given.";
  if (!option.default_value.empty()) text += " Default: " + plain(option.default_value) + ".";
  return text + "\n";
}

std::string synopsis(const DescribedCommand& command) {
  std::string text = bold(joined_path(command, " "));
  if (!command.commands.empty() && command.arguments.empty()) return text + " " + italic("COMMAND") + " ...\n";
  for (const DescribedOption& argument : command.arguments) {
    const std::string name = italic(argument.names.front()) + (argument.is_repeated ? " ..." : "");
    text += argument.is_required ? " " + name : " [" + name + "]";
  }
  for (const DescribedOption& option : command.options)
    if (option.is_required) text += " " + bold(option.names.front()) + value_text(option);
  return text + " [" + italic("OPTIONS") + "]\n";
}

std::string see_also(const DescribedCommand& command, const DescribedCommand& program) {
  std::string text;
  for (const DescribedCommand* other : all_commands(program))
    if (other != &command) text += (text.empty() ? "" : ",\n") + (".BR " + plain(joined_path(*other, "-")) + " (1)");
  return text + "\n";
}

}  // namespace

std::string manual_name(const DescribedCommand& command) { return joined_path(command, "-") + ".1"; }

std::string manual_page(const DescribedCommand& command, const DescribedCommand& program,
                        const ManualOptions& options) {
  const std::string name = joined_path(command, "-");
  std::string upper;
  for (const char c : name) upper += c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c;
  std::string text =
      fmt::format(".TH {} 1 \"\" \"{} {}\" \"Rhizodont\"\n", plain(upper), program.name(), options.version);
  text += ".SH NAME\n" + plain(name) + " \\- " + plain(command.text) + "\n";
  text += ".SH SYNOPSIS\n" + synopsis(command);
  text += ".SH DESCRIPTION\n" + plain(command.text) + (command.text.ends_with('.') ? "\n" : ".\n");
  for (const auto& [title, part] :
       {std::pair("ARGUMENTS", &command.arguments), std::pair("OPTIONS", &command.options)}) {
    if (part->empty()) continue;
    text += fmt::format(".SH {}\n", title);
    for (const DescribedOption& option : *part) text += paragraph(option);
  }
  if (!command.commands.empty()) {
    text += ".SH COMMANDS\n";
    for (const DescribedCommand& below : command.commands)
      text += ".TP\n" + bold(below.name()) + "\n" + plain(below.text) + ".\n";
  }
  text += ".SH EXIT STATUS\n";
  for (const auto& [code, meaning] : options.exit_codes)
    text += fmt::format(".TP\n\\fB{}\\fR\n{}.\n", code, plain(meaning));
  text += ".SH ENVIRONMENT\n";
  for (const auto& [variable, meaning] : options.environment)
    text += ".TP\n" + bold(variable) + "\n" + plain(meaning) + ".\n";
  return text + ".SH SEE ALSO\n" + see_also(command, program);
}

}  // namespace rhizodont::command_line
