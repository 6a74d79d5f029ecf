// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "commands.hpp"
#include "number_options.hpp"
#include "rhizodont/error.hpp"
#include "version.hpp"
#include "words.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <exception>
#include <filesystem>
#include <optional>
#include <string>
#include <system_error>
#include <vector>

namespace {

using rhizodont::ErrorCode;
using rhizodont::command_line::closest_word;
using rhizodont::command_line::error_line;
using rhizodont::command_line::fault_line;

int report(ErrorCode code, const std::string& sentence) {
  fmt::print(stderr, "rhizodont: {}\n", sentence);
  return static_cast<int>(code);
}

int report_unprintable() {
  return report(ErrorCode::unwritable, fmt::format("standard output cannot be written: {}", std::strerror(errno)));
}

/// What is still in the buffer may meet a full disk.
int finish_printing(int code) {
  errno = 0;
  return std::fflush(stdout) != 0 || std::ferror(stdout) != 0 ? report_unprintable() : code;
}

void describe(CLI::App& app) {
  app.require_subcommand(1);
  app.set_version_flag("--version", std::string("rhizodont ") + RHIZODONT_VERSION);
  app.footer(
      "Exit codes: 0 done, 2 wrong usage, 3 unusable input, 4 no result that keeps the promises, 5 fault of the "
      "program, 6 results cannot be written.\n"
      "'rhizodont COMMAND --help' explains a command.");
#define RHIZODONT_COMMAND(name) rhizodont::command_line::add_##name##_command(app);
#include "command_list.inc"
#undef RHIZODONT_COMMAND
  rhizodont::command_line::take_decimal_numbers(app);
}

std::vector<std::string> command_names(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; }))
    names.push_back(command->get_name());
  return names;
}

/// What the first word was probably meant to be, where it is no command.
std::optional<std::string> say_unknown_command(const CLI::App& app, const std::string& word) {
  const std::vector<std::string> names = command_names(app);
  if (word.starts_with('-') || std::find(names.begin(), names.end(), word) != names.end()) return std::nullopt;
  std::string sentence = fmt::format("there is no command '{}'", word);
  if (const auto meant = closest_word(word, names)) return sentence + fmt::format(": did you mean {}?", *meant);
  std::error_code ignored;
  if (std::filesystem::exists(word, ignored)) return sentence + fmt::format(": did you mean complete {}?", word);
  return sentence + fmt::format(": there are {}", fmt::join(names, ", "));
}

/// A line about a call that was not understood, with the option that was probably meant.
std::string say_misunderstood(const CLI::App& app, const CLI::ParseError& error) {
  for (const CLI::App* command : app.get_subcommands()) {
    std::vector<std::string> known;
    for (const CLI::Option* option : command->get_options())
      for (const std::string& name : option->get_lnames()) known.push_back("--" + name);
    for (const std::string& word : command->remaining())
      if (const auto meant = closest_word(word.substr(0, word.find('=')), known); meant && word.starts_with('-'))
        return fmt::format("there is no option {}: did you mean {}? (see {} --help)", word, *meant,
                           command->get_name());
  }
  return std::string(error.what()) + " (see --help)";
}

}  // namespace

int main(int argc, char** argv) {
  try {
    CLI::App app{"Whole teeth with roots from scanned crowns; the crown is kept to the bit.", "rhizodont"};
    describe(app);
    if (argc > 1)
      if (const auto sentence = say_unknown_command(app, argv[1])) return report(ErrorCode::wrong_usage, *sentence);
    try {
      app.parse(argc, argv);
    } catch (const CLI::RuntimeError& done) {
      return finish_printing(done.get_exit_code());
    } catch (const CLI::Success& help) {
      return finish_printing(app.exit(help));
    } catch (const CLI::ParseError& error) {
      return report(ErrorCode::wrong_usage, say_misunderstood(app, error));
    }
    return finish_printing(0);
  } catch (const rhizodont::Error& error) {
    return report(error.code(), error_line(error));
  } catch (const std::exception& error) {
    if (std::ferror(stdout) != 0) return report_unprintable();
    return report(ErrorCode::internal, fault_line(error));
  }
}
