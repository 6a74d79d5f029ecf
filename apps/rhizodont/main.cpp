// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "commands.hpp"
#include "rhizodont/error.hpp"
#include "version.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cstdio>
#include <exception>
#include <new>
#include <string>

namespace {

using rhizodont::ErrorCode;

constexpr std::size_t most_ids_shown = 10;

int report(ErrorCode code, const std::string& sentence) {
  fmt::print(stderr, "rhizodont: {}\n", sentence);
  return static_cast<int>(code);
}

int report(const rhizodont::Error& error) {
  std::string text = error.what();
  const auto& ids = error.elements();
  if (!ids.empty()) {
    text += " [";
    for (std::size_t i = 0; i < std::min(ids.size(), most_ids_shown); ++i)
      text += (i ? ", " : "") + std::to_string(ids[i]);
    if (ids.size() > most_ids_shown) text += fmt::format(", ... {} in all", ids.size());
    text += "]";
  }
  return report(error.code(), text);
}

void describe(CLI::App& app) {
  app.require_subcommand(1);
  app.set_version_flag("--version", std::string("rhizodont ") + RHIZODONT_VERSION);
  app.footer(
      "Exit codes: 0 done, 2 wrong usage, 3 unusable input, 4 no result that keeps the promises, 5 fault of the "
      "program.\n"
      "'rhizodont COMMAND --help' explains a command.");
#define RHIZODONT_COMMAND(name) rhizodont::command_line::add_##name##_command(app);
#include "command_list.inc"
#undef RHIZODONT_COMMAND
}

}  // namespace

int main(int argc, char** argv) {
  try {
    CLI::App app{"Whole teeth with roots from scanned crowns; the crown is kept to the bit.", "rhizodont"};
    describe(app);
    try {
      app.parse(argc, argv);
    } catch (const CLI::RuntimeError& done) {
      return done.get_exit_code();
    } catch (const CLI::Success& help) {
      return app.exit(help);
    } catch (const CLI::ParseError& error) {
      return report(ErrorCode::wrong_usage, std::string(error.what()) + " (see --help)");
    }
    return 0;
  } catch (const rhizodont::Error& error) {
    return report(error);
  } catch (const std::bad_alloc&) {
    return report(ErrorCode::internal, "the machine's memory is not enough for this");
  } catch (const std::exception& error) {
    return report(ErrorCode::internal, std::string("a fault of the program: ") + error.what());
  }
}
