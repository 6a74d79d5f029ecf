// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "command_line/manual_commands.hpp"

#include "command_line/completion.hpp"
#include "command_line/manual.hpp"
#include "command_line/output_checks.hpp"
#include "command_line/output_options.hpp"
#include "rhizodont/error.hpp"
#include "rhizodont/version.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

namespace rhizodont::command_line {
namespace {

struct CompletionCommand {
  std::string shell;
  OutputOptions said;
};

struct ManualCommand {
  std::vector<std::string> words;
  std::string folder;
  bool overwrite = false;
  OutputOptions said;
};

void print_completion(const CLI::App& app, const CompletionCommand& command) {
  const DescribedCommand program = described(app);
  const std::string script = command.shell == "bash"  ? bash_completion(program)
                             : command.shell == "zsh" ? zsh_completion(program)
                                                      : fish_completion(program);
  fmt::print("{}", script);
}

ManualOptions manual_options(const Program& program) {
  ManualOptions options{RHIZODONT_VERSION, exit_codes(), program.environment};
  options.environment.emplace_back("NO_COLOR", "If set and not empty, no colours are used on terminals");
  return options;
}

void write_manual(const CLI::App& app, const Program& named, const ManualCommand& command) {
  const DescribedCommand program = described(app);
  const std::vector<const DescribedCommand*> all = all_commands(program);
  const ManualOptions options = manual_options(named);
  if (command.folder.empty()) {
    std::vector<std::string> path{program.name()};
    path.insert(path.end(), command.words.begin(), command.words.end());
    const auto asked = std::find_if(all.begin(), all.end(), [&](const auto* one) { return one->path == path; });
    if (asked == all.end()) throw UsageError(fmt::format("There is no command '{}'.", fmt::join(path, " ")));
    fmt::print("{}", manual_page(**asked, program, options));
    return;
  }
  require_folder_name(command.folder, "pages");
  if (!command.words.empty()) throw UsageError("A folder takes the pages of all commands: name none, or no folder.");
  std::vector<OutputFile> pages;
  std::vector<std::filesystem::path> names;
  for (const DescribedCommand* one : all) {
    names.push_back(std::filesystem::path(command.folder) / manual_name(*one));
    pages.push_back({names.back(), manual_page(*one, program, options)});
  }
  require_safe_outputs({}, names);
  require_new(names, command.overwrite);
  write_output_files(pages);
  command.said.tell(fmt::format("{} pages in {}", pages.size(), command.folder));
}

}  // namespace

void add_manual_commands(CLI::App& app, const Program& program) {
  auto completion = std::make_shared<CompletionCommand>();
  CLI::App* completion_app =
      app.add_subcommand("shell-completion", "Print the script with which a shell completes words");
  completion_app->add_option("SHELL", completion->shell, "The shell")
      ->required()
      ->check(CLI::IsMember({"bash", "zsh", "fish"}));
  completion->said.add_to(*completion_app);
  completion_app->callback([&app, completion] { print_completion(app, *completion); });

  auto manual = std::make_shared<ManualCommand>();
  CLI::App* manual_app = app.add_subcommand("manual", "Print a page of the manual, for man, or write them all");
  manual_app->add_option("COMMAND", manual->words, "The command; without it the program's own page");
  manual_app->add_option("-o,--output", manual->folder, "Write the pages of all commands to this folder");
  manual_app->add_flag("--overwrite", manual->overwrite, "Replace pages that are there already");
  manual->said.add_to(*manual_app);
  manual_app->callback([&app, &program, manual] { write_manual(app, program, *manual); });
}

}  // namespace rhizodont::command_line
