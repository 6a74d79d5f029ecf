// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "command_line/output_options.hpp"

#include <CLI/CLI.hpp>

#include <filesystem>
#include <string>

namespace rhizodont::command_line {

/// The option --models. `folder` must outlive the command.
void add_models_option(CLI::App& command, std::string& folder);

/// The folder that was given, or the shipped models'; says which for those who want details.
std::filesystem::path models_folder(const std::string& given, const OutputOptions& output);

}  // namespace rhizodont::command_line
