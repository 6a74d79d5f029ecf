// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "command_line/program.hpp"

#include "base/peak_memory.hpp"
#include "base/stopwatch.hpp"
#include "command_line/manual_commands.hpp"
#include "command_line/number_options.hpp"
#include "command_line/output_options.hpp"
#include "command_line/terminal.hpp"
#include "command_line/words.hpp"
#include "rhizodont/error.hpp"
#include "rhizodont/version.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <exception>
#include <filesystem>
#include <optional>
#include <sstream>
#include <string>
#include <system_error>
#include <vector>

namespace rhizodont::command_line {
namespace {

int report(const Program& program, ErrorCode code, const std::string& sentence) {
  print_error(program.name, sentence);
  return static_cast<int>(code);
}

/// `number`: of the system's error; 0 where it came long before and is no longer known.
int report_unprintable(const Program& program, int number) {
  return report(program, ErrorCode::unwritable,
                fmt::format("standard output cannot be written: {}",
                            number == 0 ? "a part of it did not get through" : std::strerror(number)));
}

/// What is still in the buffer may meet a full disk.
int finish_printing(const Program& program, int code) {
  errno = 0;
  const bool has_failed = std::fflush(stdout) != 0;
  const int number = errno;
  return has_failed || std::ferror(stdout) != 0 ? report_unprintable(program, has_failed ? number : 0) : code;
}

/// Help, or the version.
int print_help(const Program& program, const CLI::App& app, const CLI::Success& help) {
  std::ostringstream text;
  const int code = app.exit(help, text, text);
  fmt::print("{}", text.str());
  return finish_printing(program, code);
}

void describe(const Program& program, CLI::App& app) {
  app.require_subcommand(1);
  app.set_version_flag("--version", fmt::format("{} {}", program.name, RHIZODONT_VERSION));
  std::string codes;
  for (const auto& [code, meaning] : exit_codes())
    codes += fmt::format("{}{} {}", codes.empty() ? "" : ", ", code, meaning);
  app.footer("Exit codes: " + codes + ".\n'" + program.name + " COMMAND --help' explains a command.");
  for (const auto add_command : program.commands) add_command(app);
  add_manual_commands(app, program);
  take_decimal_numbers(app);
}

std::vector<std::string> command_names(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; }))
    names.push_back(command->get_name());
  return names;
}

/// What the first word was probably meant to be, where it is no command.
std::optional<std::string> say_unknown_command(const Program& program, const CLI::App& app, const std::string& word) {
  const std::vector<std::string> names = command_names(app);
  if (word.starts_with('-') || std::find(names.begin(), names.end(), word) != names.end()) return std::nullopt;
  std::string sentence = fmt::format("there is no command '{}'", word);
  if (const auto meant = closest_word(word, names)) return sentence + fmt::format(": did you mean {}?", *meant);
  std::error_code ignored;
  if (!program.default_command.empty() && std::filesystem::exists(word, ignored))
    return sentence + fmt::format(": did you mean {} {}?", program.default_command, word);
  return sentence + fmt::format(": there are {}", fmt::join(names, ", "));
}

/// For those who asked for details.
void say_cost(const CLI::App& app, double seconds) {
  if (is_verbose(app)) fmt::print(stderr, "{:.2f} s, at most {:.0f} MB\n", seconds, peak_memory_mb());
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

std::vector<std::pair<int, std::string>> exit_codes() {
  return {{0, "done"},
          {2, "wrong usage"},
          {3, "unusable input"},
          {4, "no result that keeps the promises"},
          {5, "fault of the program"},
          {6, "some teeth of several have no result"},
          {7, "results cannot be written"}};
}

int run_program(const Program& program, int argc, char** argv) {
  const Stopwatch watch;
  try {
    CLI::App app{program.purpose, program.name};
    describe(program, app);
    if (argc > 1)
      if (const auto sentence = say_unknown_command(program, app, argv[1]))
        return report(program, ErrorCode::wrong_usage, *sentence);
    try {
      app.parse(argc, argv);
    } catch (const CLI::RuntimeError& done) {
      say_cost(app, watch.seconds());
      return finish_printing(program, done.get_exit_code());
    } catch (const CLI::Success& help) {
      return print_help(program, app, help);
    } catch (const CLI::ParseError& error) {
      return report(program, ErrorCode::wrong_usage, say_misunderstood(app, error));
    }
    say_cost(app, watch.seconds());
    return finish_printing(program, 0);
  } catch (const Error& error) {
    return report(program, error.code(), error_line(error));
  } catch (const std::exception& error) {
    const auto* unprinted = dynamic_cast<const std::system_error*>(&error);
    if (std::ferror(stdout) != 0)
      return report_unprintable(program, unprinted == nullptr ? 0 : unprinted->code().value());
    return report(program, ErrorCode::internal, fault_line(error));
  }
}

}  // namespace rhizodont::command_line
