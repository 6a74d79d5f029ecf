// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
//
// As described in the manuals of the shells: bash, "Programmable Completion"; zshcompsys(1); fish, complete(1).
#include "command_line/completion.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace rhizodont::command_line {
namespace {

std::string replaced(std::string text, const std::string& what, const std::string& by) {
  for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + by.size()))
    text.replace(at, what.size(), by);
  return text;
}

/// As one word of bash and zsh.
std::string quoted(const std::string& text) { return "'" + replaced(text, "'", "'\\''") + "'"; }

std::string function_of(const DescribedCommand& command) { return "_" + replaced(joined_path(command, "_"), "-", "_"); }

bool has_argument_with_choices(const DescribedCommand& command) {
  return std::any_of(command.arguments.begin(), command.arguments.end(),
                     [](const DescribedOption& argument) { return !argument.choices.empty(); });
}

// bash

std::string words_of(const DescribedCommand& command) {
  std::string words;
  for (const DescribedOption& argument : command.arguments)
    for (const std::string& choice : argument.choices) words += choice + " ";
  for (const DescribedCommand& below : command.commands) words += below.name() + " ";
  for (const DescribedOption& option : command.options)
    for (const std::string& name : option.names) words += name + " ";
  if (!words.empty()) words.pop_back();
  return words;
}

/// "'rhizodont complete -o' | 'rhizodont complete --output'"
std::string bash_cases(const DescribedCommand& command, const DescribedOption& option) {
  std::string cases;
  for (const std::string& name : option.names)
    cases += (cases.empty() ? "" : " | ") + quoted(joined_path(command, " ") + " " + name);
  return cases;
}

/// What stands after an option that takes a value.
std::string bash_values(const DescribedCommand& program) {
  std::string text;
  for (const DescribedCommand* command : all_commands(program))
    for (const DescribedOption& option : command->options) {
      if (option.value.empty() || option.is_value_optional) continue;
      text += "    " + bash_cases(*command, option) + ") ";
      text += option.choices.empty()
                  ? "return ;;\n"
                  : fmt::format("words={} ;;\n", quoted(fmt::format("{}", fmt::join(option.choices, " "))));
    }
  return text;
}

// zsh

/// An explanation in brackets.
std::string zsh_text(const std::string& text) {
  return replaced(replaced(replaced(text, "\\", "\\\\"), "[", "\\["), "]", "\\]");
}

std::string zsh_value(const DescribedOption& option) {
  if (option.value.empty()) return "";
  const std::string colon = option.is_value_optional ? "::" : ":";
  if (!option.choices.empty()) return fmt::format("{}{}:({})", colon, option.value, fmt::join(option.choices, " "));
  return colon + option.value + (option.value == "NUMBER" ? ": " : ":_files");
}

std::string zsh_option(const DescribedOption& option) {
  std::string others, lines;
  for (const std::string& name : option.names) others += (others.empty() ? "" : " ") + name;
  for (const std::string& name : option.names)
    lines += fmt::format(" \\\n    {}", quoted(fmt::format("{}{}[{}]{}", option.is_repeated ? "*" : "(" + others + ")",
                                                           name, zsh_text(option.text), zsh_value(option))));
  return lines;
}

std::string zsh_function(const DescribedCommand& command) {
  const bool has_commands = !command.commands.empty();
  std::string text = function_of(command) + "() {\n";
  if (has_commands) text += "  local context state state_descr line\n  typeset -A opt_args\n";
  text += "  _arguments";
  if (has_commands) text += " -C";
  for (const DescribedOption& option : command.options) text += zsh_option(option);
  for (const DescribedOption& argument : command.arguments)
    if (!argument.choices.empty())
      text += fmt::format(" \\\n    '1:{}:({})'", argument.names.front(), fmt::join(argument.choices, " "));
  if (!has_commands) return text + " \\\n    '*:file:_files'\n}\n";
  text +=
      " \\\n    '1: :->command' \\\n    '*:: :->arguments'\n  case $state in\n    command)\n      local -a commands\n  "
      "    commands=(\n";
  for (const DescribedCommand& below : command.commands)
    text += "        " + quoted(below.name() + ":" + below.text) + "\n";
  text += "      )\n      _describe -t commands command commands\n";
  if (!command.arguments.empty()) text += "      _files\n";
  text += "      ;;\n    arguments)\n      case $words[1] in\n";
  for (const DescribedCommand& below : command.commands)
    text += fmt::format("        {}) {} ;;\n", below.name(), function_of(below));
  return text + "        *) _files ;;\n      esac\n      ;;\n  esac\n}\n";
}

// fish

std::string fish_quoted(const std::string& text) {
  return "'" + replaced(replaced(text, "\\", "\\\\"), "'", "\\'") + "'";
}

/// That the words so far are those of this command, and none of the commands below it.
std::string fish_condition(const DescribedCommand& command) {
  if (command.path.size() == 1) return "__fish_use_subcommand";
  std::string condition;
  for (std::size_t i = 1; i < command.path.size(); ++i)
    condition += (condition.empty() ? "" : "; and ") + ("__fish_seen_subcommand_from " + command.path[i]);
  for (const DescribedCommand& below : command.commands)
    condition += "; and not __fish_seen_subcommand_from " + below.name();
  return condition;
}

std::string fish_option(const DescribedOption& option) {
  std::string text;
  for (const std::string& name : option.names)
    text += name.starts_with("--") ? " -l " + name.substr(2) : " -s " + name.substr(1);
  if (!option.value.empty() && !option.is_value_optional)
    text += option.choices.empty()
                ? (option.value == "NUMBER" ? " -x" : " -r")
                : fmt::format(" -x -a {}", fish_quoted(fmt::format("{}", fmt::join(option.choices, " "))));
  return text + " -d " + fish_quoted(option.text);
}

}  // namespace

std::string bash_completion(const DescribedCommand& program) {
  const std::string& name = program.name();
  std::string paths, words, with_commands;
  for (const DescribedCommand* command : all_commands(program)) {
    const std::string path = quoted(joined_path(*command, " "));
    if (command != &program) paths += (paths.empty() ? "" : " | ") + path;
    words += fmt::format("        {}) words={} ;;\n", path, quoted(words_of(*command)));
    if (!command->commands.empty() || has_argument_with_choices(*command))
      with_commands += (with_commands.empty() ? "" : " | ") + path;
  }
  return fmt::format(
      R"(# {0} in bash; written by '{0} shell-completion bash'
{1}() {{
  local current=${{COMP_WORDS[COMP_CWORD]}} before=${{COMP_WORDS[COMP_CWORD - 1]}} command={0} words= i
  COMPREPLY=()
  # --name=value comes as three words
  if [[ $current == = ]]; then
    current=
  elif [[ $before == = && $COMP_CWORD -gt 1 ]]; then
    before=${{COMP_WORDS[COMP_CWORD - 2]}}
  fi
  for ((i = 1; i < COMP_CWORD; ++i)); do
    case "$command ${{COMP_WORDS[i]}}" in
      {2}) command+=" ${{COMP_WORDS[i]}}" ;;
    esac
  done
  case "$command $before" in
{3}    *)
      case $command in
        {4}) ;;
        *) [[ $current == -* ]] || return ;;
      esac
      case $command in
{5}      esac
      ;;
  esac
  mapfile -t COMPREPLY < <(compgen -W "$words" -- "$current")
}}
complete -o bashdefault -o default -F {1} {0}
)",
      name, function_of(program), paths, bash_values(program), with_commands, words);
}

std::string zsh_completion(const DescribedCommand& program) {
  std::string text =
      fmt::format("#compdef {0}\n# {0} in zsh; written by '{0} shell-completion zsh'\n\n", program.name());
  for (const DescribedCommand* command : all_commands(program)) text += zsh_function(*command) + "\n";
  return text + function_of(program) + " \"$@\"\n";
}

std::string fish_completion(const DescribedCommand& program) {
  std::string text = fmt::format("# {0} in fish; written by '{0} shell-completion fish'\n", program.name());
  for (const DescribedCommand* command : all_commands(program)) {
    const std::string beginning =
        fmt::format("complete -c {} -n {}", program.name(), fish_quoted(fish_condition(*command)));
    for (const DescribedCommand& below : command->commands)
      text += fmt::format("{}{} -a {} -d {}\n", beginning, command == &program ? " -f" : "", below.name(),
                          fish_quoted(below.text));
    for (const DescribedOption& argument : command->arguments)
      if (!argument.choices.empty())
        text +=
            fmt::format("{} -f -a {}\n", beginning, fish_quoted(fmt::format("{}", fmt::join(argument.choices, " "))));
    for (const DescribedOption& option : command->options) text += beginning + fish_option(option) + "\n";
  }
  return text;
}

}  // namespace rhizodont::command_line
