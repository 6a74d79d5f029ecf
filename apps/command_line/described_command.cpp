// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "command_line/described_command.hpp"

#include <fmt/format.h>

#include <string_view>

namespace rhizodont::command_line {
namespace {

constexpr std::string_view others = "...";

/// Of "TEXT:{ply,stl}" the words, of "value in {drop->0,keep->1} OR {0,1}" the first ones. A last one of "..." says
/// that there may be others.
std::vector<std::string> choices_in(std::string_view type) {
  std::vector<std::string> choices;
  const std::size_t begin = type.find('{'), end = type.find('}');
  if (begin == std::string_view::npos || end == std::string_view::npos) return choices;
  type = type.substr(begin + 1, end - begin - 1);
  while (!type.empty()) {
    const std::string_view word = type.substr(0, type.find(','));
    choices.emplace_back(word.substr(0, word.find("->")));
    type.remove_prefix(std::min(word.size() + 1, type.size()));
  }
  return choices;
}

/// Of "INT:INT in [0 - 65535]" the kind.
std::string kind_of(const std::string& type) {
  if (type.starts_with("[")) return type.substr(1, type.find(']') - 1);
  for (const char* number : {"INT", "UINT", "FLOAT"})
    if (type.starts_with(number)) return "NUMBER";
  return "TEXT";
}

DescribedOption describe_option(const CLI::Option& option) {
  DescribedOption result;
  if (option.get_positional() && option.get_snames().empty() && option.get_lnames().empty()) {
    result.names.push_back(option.get_name(true, false));
  } else {
    for (const std::string& name : option.get_snames()) result.names.push_back("-" + name);
    for (const std::string& name : option.get_lnames()) result.names.push_back("--" + name);
  }
  result.text = option.get_description();
  result.is_required = option.get_required();
  if (option.get_items_expected_max() == 0) return result;
  const std::string type = option.get_type_name();
  result.choices = choices_in(type);
  result.takes_other_words = !result.choices.empty() && result.choices.back() == others;
  if (result.takes_other_words) result.choices.pop_back();
  result.value = kind_of(type);
  result.default_value = option.get_default_str();
  result.is_repeated = option.get_items_expected_max() > 1;
  result.is_value_optional = option.get_items_expected_min() == 0;
  return result;
}

DescribedCommand describe_below(const CLI::App& app, std::vector<std::string> path) {
  DescribedCommand result;
  result.path = std::move(path);
  result.text = app.get_description();
  for (const CLI::Option* option : app.get_options()) {
    DescribedOption one = describe_option(*option);
    (one.names.front().starts_with('-') ? result.options : result.arguments).push_back(std::move(one));
  }
  for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; })) {
    std::vector<std::string> below = result.path;
    below.push_back(command->get_name());
    result.commands.push_back(describe_below(*command, std::move(below)));
  }
  return result;
}

}  // namespace

DescribedCommand described(const CLI::App& app) { return describe_below(app, {app.get_name()}); }

std::vector<const DescribedCommand*> all_commands(const DescribedCommand& command) {
  std::vector<const DescribedCommand*> all{&command};
  for (const DescribedCommand& below : command.commands) {
    const std::vector<const DescribedCommand*> part = all_commands(below);
    all.insert(all.end(), part.begin(), part.end());
  }
  return all;
}

std::string joined_path(const DescribedCommand& command, const std::string& between) {
  return fmt::format("{}", fmt::join(command.path, between));
}

}  // namespace rhizodont::command_line
