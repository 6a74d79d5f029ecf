// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "models_option.hpp"

#include "rhizodont/models.hpp"

namespace rhizodont::command_line {

void add_models_option(CLI::App& command, std::string& folder) {
  command.add_option("--models", folder,
                     "Folder with the models; without it that of RHIZODONT_MODELS, else the installed one");
}

std::filesystem::path models_folder(const std::string& given, const OutputOptions& output) {
  std::filesystem::path folder = given.empty() ? default_models_folder() : std::filesystem::path(given);
  output.detail("models: " + folder.string());
  return folder;
}

}  // namespace rhizodont::command_line
